/*
 * One-body drag in many flows: 6 pi eta a (U(x) - u), 8 pi eta a^3 (half the vorticity - w), stresslet (20/3) pi eta a^3 E.
 * First what needs no formula: a sphere that moves and turns with the flow feels nothing; drag takes energy from motion
 * relative to it. Then the coefficients, by sphere and by flow plane.
 */
#include "pair_checks.h"
#include "pair_pattern.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct seen { struct worst still, power, force, torque, stress, total; struct pattern force_pattern, torque_pattern, flow[2] /* what the flow adds to force, torque */; };

static void flow_at(struct model *m, const double x[3], double u[3], double w[3])
{
    apply(m->gradient, x, u);
    for (int k = 0; k < 3; k++)
        w[k] = 0.5 * (m->gradient[(k + 2) % 3][(k + 1) % 3] - m->gradient[(k + 1) % 3][(k + 2) % 3]);
}

/* Two spheres anywhere in the cell, apart; every other state moves with the flow. */
static void fill(struct check_run *run, struct model *m, struct pair_book *book)
{
    const int repeats = (int)scene_number(run->gate_case->parameters, "repeats", 4);
    gsl_rng *random = pair_random(run);
    for (size_t b = 0; b < m->species; b++)
        for (int k = 0; k < 2 * repeats; k++) {
            struct pair_state p = random_pair(random, m->radius[0], m->radius[b], 1 + k);
            for (int side = 0; side < 2; side++) {
                for (int v = 0; v < 3; v++) { /* the same shift for both keeps them apart, inside or outside the cell */
                    p.s[side].x[v] += 0.31 * k * m->cell[v][v] - 3;
                }
                if (k % 2)
                    flow_at(m, p.s[side].x, p.s[side].u, p.s[side].w);
            }
            book_add(book, &p);
        }
    gsl_rng_free(random);
}

/* Force and torque less those of the sphere's own motion in a fluid at rest. */
static void see_flow(const struct model *m, struct seen *s, const struct theory_sphere *sphere, const double own[6],
                     const double force[3], const double torque[3], double f, double t)
{
    static const double rest[3][3] = { { 0 } };
    double still[3], still_torque[3], stresslet[3][3], mine[2][3], expected[2][3];
    theory_drag(m->viscosity, m->drag_torque, rest, sphere, still, still_torque, stresslet);
    for (int d = 0; d < 3; d++) {
        mine[0][d] = own[d] - still[d];
        mine[1][d] = own[3 + d] - still_torque[d];
        expected[0][d] = force[d] - still[d];
        expected[1][d] = torque[d] - still_torque[d];
    }
    for (int part = 0; part < 2; part++)
        pattern_see(&s->flow[part], mine[part], expected[part], 3, part ? t : f, sphere->radius / m->radius[0], NAN, NULL, NULL);
}

static void see(struct model *m, const struct pair_book *book, const struct pair_answer *a, const double *stress, struct seen *s)
{
    for (size_t k = 0; k < book->count; k++) {
        double sum[9] = { 0 }, sum_scale = 0;
        for (int side = 0; side < 2; side++) {
            const struct theory_sphere *sphere = &book->item[k].s[side];
            const double *own = forces_at(&a->forces, k, "drag", 1 + side), *total = forces_at(&a->forces, k, "total", 1 + side);
            double u[3], w[3], force[3], torque[3], stresslet[3][3], power = 0;
            flow_at(m, sphere->x, u, w);
            const double a1 = sphere->radius, f = 6 * M_PI * m->viscosity * a1 * (norm(u) + norm(sphere->u));
            const double t = 8 * M_PI * m->viscosity * a1 * a1 * a1 * (norm(w) + norm(sphere->w));
            theory_drag(m->viscosity, m->drag_torque, (const double (*)[3])m->gradient, sphere, force, torque, stresslet);
            if (k % 2) {
                worst_see_vector(&s->still, own, (const double[3]){ 0 }, 3, f, k);
                worst_see_vector(&s->still, own + 3, (const double[3]){ 0 }, 3, t, k);
            } else {
                for (int d = 0; d < 3; d++)
                    power += own[d] * (sphere->u[d] - u[d]) + own[3 + d] * (sphere->w[d] - w[d]);
                worst_see(&s->power, fmax(power, 0), 0, f * (norm(u) + norm(sphere->u)), k);
                worst_see_vector(&s->force, own, force, 3, f, k);
                worst_see_vector(&s->torque, own + 3, torque, 3, t, k);
                pattern_see(&s->force_pattern, own, force, 3, f, a1 / m->radius[0], NAN, NULL, NULL);
                pattern_see(&s->torque_pattern, own + 3, torque, 3, t, a1 / m->radius[0], NAN, NULL, NULL);
                see_flow(m, s, sphere, own, force, torque, f, t);
            }
            worst_see_vector(&s->total, total, own, 6, f, k);
            for (int d = 0; d < 9; d++)
                sum[d] += stresslet[d / 3][d % 3];
            sum_scale += 20 * M_PI / 3 * m->viscosity * a1 * a1 * a1 * (norm(m->gradient[0]) + norm(m->gradient[1]) + norm(m->gradient[2]));
        }
        worst_see_vector(&s->stress, stress + 9 * k, sum, 9, sum_scale, k);
    }
}

static void judge(struct check_run *run, const struct pair_book *book, enum judgement judgement, const char *variant,
                  const char *quantity, const struct worst *w, const struct pattern *pattern, const struct pattern *flow,
                  const char *fault)
{
    char what[128], words[2048] = "";
    if (pattern)
        snprintf(words, sizeof words, " %s", pattern_words(pattern));
    if (flow && pattern_simple(flow) && !pattern_simple(pattern))
        snprintf(words, sizeof words, " wrong by what the flow adds to it: that is %s", pattern_words(flow));
    snprintf(what, sizeof what, "%s: %s", variant, quantity);
    const struct pair_state *p = &book->item[w->at];
    check_error(run, judgement, what, w->measured, w->expected, w->error, run->gate_case->tolerance,
                "%s: %s%s: %s; worst at radii %g and %g (state %zu)", variant, fault, words, compare(w), p->s[0].radius,
                p->s[1].radius, w->at);
}

void pair_drag(struct check_run *run)
{
    size_t k;
    json_t *variant;
    json_array_foreach(json_object_get(run->gate_case->parameters, "variants"), k, variant)
    {
        const char *name = json_string_value(json_object_get(variant, "name"));
        json_t *scene = variant_scene(run->gate_case, variant);
        if (json_object_get(variant, "torque"))
            scene_set(scene, "forces.drag.torque", json_incref(json_object_get(variant, "torque")));
        struct model m;
        struct pair_book book = { 0 };
        struct pair_answer answer = { 0 };
        double *stress = NULL;
        if (name && model_read(run, scene, &m)) {
            fill(run, &m, &book);
            if (book_ask(run, name, scene, &book, "drag,total", &answer))
                stress = answer_stress(run, &answer, book.count, "drag", m.volume);
        }
        if (stress) {
            struct seen s = { .still = WORST_NONE, .power = WORST_NONE, .force = WORST_NONE, .torque = WORST_NONE, .stress = WORST_NONE,
                              .total = WORST_NONE };
            pattern_start(&s.force_pattern, run->gate_case->tolerance);
            pattern_start(&s.torque_pattern, run->gate_case->tolerance);
            pattern_start(&s.flow[0], run->gate_case->tolerance);
            pattern_start(&s.flow[1], run->gate_case->tolerance);
            s.force_pattern.of_size = s.torque_pattern.of_size = s.flow[0].of_size = s.flow[1].of_size = "the radius";
            see(&m, &book, &answer, stress, &s);
            judge(run, &book, INVARIANT, name, "at rest in the flow", &s.still, NULL, NULL, "a sphere that moves and turns with the flow is dragged");
            judge(run, &book, INVARIANT, name, "power", &s.power, NULL, NULL, "drag gives energy to motion relative to the flow");
            judge(run, &book, INVARIANT, name, "total = sum of parts", &s.total, NULL, NULL, "`total` is not the drag");
            judge(run, &book, MODEL, name, "force", &s.force, &s.force_pattern, &s.flow[0], "6 pi eta a (U - u) is");
            judge(run, &book, MODEL, name, "torque", &s.torque, &s.torque_pattern, &s.flow[1],
                  m.drag_torque ? "8 pi eta a^3 (half the vorticity - w) is" : "the torque, switched off, is");
            judge(run, &book, MODEL, name, "stresslet", &s.stress, NULL, NULL, "(20/3) pi eta a^3 E, summed over both spheres, is");
        }
        const bool answered = stress != NULL;
        free(stress);
        forces_free(&answer.forces);
        book_free(&book);
        json_decref(scene);
        if (!answered && results_verdict(&run->results) == VERDICT_FAIL)
            return; /* it will not do better in the others; but one that is not supported says nothing of them */
    }
}
