/*
 * Exponential repulsion of frozen pairs, over size ratios and gaps in units of its own range, from deep overlap to beyond the cut-off.
 * First what needs no formula: third law, relabelling, no torque, nothing beyond the cut-off, stress from the candidate's own
 * force, `total`. Then force and stress, and the force a hair inside the cut-off, which is not shifted.
 */
#include "pair_checks.h"

#include <stdlib.h>

struct seen { struct worst third_law, relabelling, torque, range, total, own_stress, force, stress; };

static void fill(struct check_run *run, const struct model *m, struct pair_book *book)
{
    double at[64];
    size_t gaps;
    parameter_list(run->gate_case->parameters, "kappas", at, &gaps, 64);
    gsl_rng *random = pair_random(run);
    for (size_t b = 0; b < m->species; b++)
        for (size_t g = 0; g < gaps; g++) {
            const struct pair_state p = random_pair(random, m->radius[0], m->radius[b], 2 * at[g] * m->repulsion.kappa_factor);
            book_add(book, &p);
        }
    const size_t half = book->count;
    for (size_t k = 0; k < half; k++) {
        const struct pair_state other = swapped(&book->item[k]);
        book_add(book, &other);
    }
    gsl_rng_free(random);
}

static void see(struct seen *s, const struct model *m, const struct pair_book *book, const struct pair_answer *a, const double *stress)
{
    static const double none[6] = { 0 };
    for (size_t k = 0; k < book->count; k++) {
        const struct pair_state *p = &book->item[k];
        const double *own[2] = { forces_at(&a->forces, k, "repulsion", 1), forces_at(&a->forces, k, "repulsion", 2) };
        struct theory_pair e;
        double n[3], r, minus[3], dyad[9];
        const double h = pair_geometry(p, n, &r), sizes = r - h;
        theory_repulsion_pair(&m->repulsion, p->s, &e);
        const double scale = theory_repulsion_energy(&m->repulsion, p->s[0].radius, p->s[1].radius, h) / (m->repulsion.kappa_factor * sizes);
        for (int d = 0; d < 3; d++)
            minus[d] = -own[0][d];
        for (int d = 0; d < 9; d++)
            dyad[d] = own[0][d / 3] * r * n[d % 3];
        worst_see_vector(&s->third_law, own[1], minus, 3, scale, k);
        for (int side = 0; side < 2; side++) {
            worst_see_vector(&s->torque, own[side] + 3, none, 3, scale * sizes, k);
            worst_see_vector(&s->total, forces_at(&a->forces, k, "total", 1 + side), own[side], 6, scale, k);
            if (h > m->repulsion.cutoff * m->repulsion.kappa_factor * sizes)
                worst_see_vector(&s->range, own[side], none, 3, scale, k);
            if (k < book->count / 2)
                worst_see_vector(&s->relabelling, forces_at(&a->forces, k + book->count / 2, "repulsion", 2 - side), own[side], 3, scale, k);
        }
        worst_see_vector(&s->own_stress, stress + 9 * k, dyad, 9, scale * r, k);
        worst_see_vector(&s->force, own[0], e.force[0], 3, scale, k);
        worst_see_vector(&s->stress, stress + 9 * k, &e.stress[0][0], 9, scale * r, k);
    }
}

static void judge(struct check_run *run, const struct pair_book *book, enum judgement judgement, const char *what, const struct worst *w,
                  const char *sentence)
{
    check_error(run, judgement, what, w->measured, w->expected, w->error, run->gate_case->tolerance, "%s: %s; worst at %s", sentence,
                compare(w), describe(&book->item[w->at], w->at));
}

void pair_repulsion(struct check_run *run)
{
    struct model m;
    struct pair_book book = { 0 };
    struct pair_answer answer = { 0 };
    double *stress = NULL;
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    fill(run, &m, &book);
    if (book_ask(run, "pairs", run->gate_case->scene, &book, "repulsion,total", &answer))
        stress = answer_stress(run, &answer, book.count, "repulsion", m.volume);
    if (stress) {
        struct seen s = { WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE };
        see(&s, &m, &book, &answer, stress);
        judge(run, &book, INVARIANT, "third law", &s.third_law, "the force on 2 is not minus the force on 1");
        judge(run, &book, INVARIANT, "relabelling", &s.relabelling, "exchanging the labels 1 and 2 changes the physics");
        judge(run, &book, INVARIANT, "no torque", &s.torque, "a force along the line of centres turns nothing");
        judge(run, &book, INVARIANT, "total = sum of parts", &s.total, "`total` is not the repulsion");
        judge(run, &book, INVARIANT, "range", &s.range, "there is a force beyond the cut-off");
        judge(run, &book, INVARIANT, "stress from own forces", &s.own_stress, "the stress is not F (x) r / V of the candidate's own force");
        judge(run, &book, MODEL, "force", &s.force, "the force on 1 is");
        judge(run, &book, MODEL, "stress", &s.stress, "the stress times the volume is");
    }
    free(stress);
    forces_free(&answer.forces);
    book_free(&book);
}
