/*
 * The same scene in other units of length, mass and time must give the same physics: every quantity changes by the
 * product of powers that its dimension says. Constants left in the code, factors that are one in the author's units,
 * and dimensionless gaps that are not, all break it; no reference value is needed.
 */
#include "pair_checks.h"

#include <stdio.h>
#include <string.h>

static void fill(struct check_run *run, struct model *m, struct pair_book *book)
{
    double xi[16], flow[3];
    size_t gaps;
    parameter_list(run->gate_case->parameters, "xi", xi, &gaps, 16);
    gsl_rng *random = pair_random(run);
    for (size_t b = 0; b < m->species; b++)
        for (size_t g = 0; g < gaps; g++) {
            struct pair_state p = random_pair(random, m->radius[0], m->radius[b], xi[g]);
            for (int side = 0; side < 2; side++) {
                apply(m->gradient, p.s[side].x, flow);
                for (int k = 0; k < 3; k++)
                    p.s[side].u[k] += flow[k];
            }
            p.with_history = m->has_contact && xi[g] < 0;
            random_vector(random, 0.003 * m->radius[0], p.history);
            book_add(book, &p);
        }
    gsl_rng_free(random);
}

static struct pair_book translated(const struct pair_book *book, const struct units *u)
{
    struct pair_book other = { 0 };
    for (size_t k = 0; k < book->count; k++) {
        struct pair_state p = book->item[k];
        for (int side = 0; side < 2; side++) {
            p.s[side].radius *= u->length;
            for (int d = 0; d < 3; d++) {
                p.s[side].x[d] *= u->length;
                p.s[side].u[d] *= unit_of(u, 1, 0, -1);
                p.s[side].w[d] *= unit_of(u, 0, 0, -1);
            }
        }
        for (int d = 0; d < 3; d++)
            p.history[d] *= u->length;
        book_add(&other, &p);
    }
    return other;
}

static void see(const struct pair_book *book, const struct pair_answer *here, const struct pair_answer *there, const char *force,
                const struct units *u, struct worst *f, struct worst *t)
{
    double scale_f = 0, scale_t = 0; /* the largest of all states: weak ones lose digits in the conversion */
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < book->count; k++)
            for (int id = 1; id <= 2; id++) {
                const double *one = forces_at(&here->forces, k, force, id), *two = forces_at(&there->forces, k, force, id);
                for (int d = 0; d < 3 && pass == 1; d++) {
                    worst_see(f, two[d] / unit_of(u, 1, 1, -2), one[d], scale_f, k);
                    worst_see(t, two[3 + d] / unit_of(u, 2, 1, -2), one[3 + d], scale_t, k);
                }
                scale_f = fmax(scale_f, norm(one));
                scale_t = fmax(scale_t, norm(one + 3));
            }
}

static void judge(struct check_run *run, const struct pair_book *book, const char *what, const struct worst *w)
{
    check_error(run, INVARIANT, what, w->measured, w->expected, w->error, run->gate_case->tolerance,
                "%s changes with the units: %s; worst at %s: a constant or a power of a radius, the viscosity, the rate is "
                "missing or too many", what, compare(w), describe(&book->item[w->at], w->at));
}

void pair_units(struct check_run *run)
{
    const json_t *given = run->gate_case->parameters;
    const char *force = json_string_value(json_object_get(given, "force"));
    const struct units u = { scene_number(given, "length", 1), scene_number(given, "mass", 1), scene_number(given, "time", 1) };
    struct model m;
    if (!force || !model_read(run, run->gate_case->scene, &m))
        return;
    struct pair_book book = { 0 };
    fill(run, &m, &book);
    struct pair_book other = translated(&book, &u);
    json_t *scene = scene_in_units(run->gate_case->scene, &u);
    struct pair_answer here = { 0 }, there = { 0 };
    if (book_ask(run, "own-units", run->gate_case->scene, &book, force, &here)
        && book_ask(run, "other-units", scene, &other, force, &there)) {
        struct worst f = WORST_NONE, t = WORST_NONE;
        see(&book, &here, &there, force, &u, &f, &t);
        judge(run, &book, "force", &f);
        judge(run, &book, "torque", &t);
    }
    forces_free(&here.forces);
    forces_free(&there.forces);
    book_free(&book);
    book_free(&other);
    json_decref(scene);
}
