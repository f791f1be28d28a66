/*
 * Rigid motion of a pair. Translation and turning about n feel no lubrication at all. Turning with omega across n: the
 * surfaces do not slide, but the truncated model sees h (omega x n) of sliding, since its levers end at the radius:
 *     F_1 = Y_A h (omega x n),    the fraction h/r of Y_A r omega,
 * negative in overlap, and exactly 0 with the rotation correction. Y_A is measured from the candidate, not computed.
 */
#include "pair_checks.h"

#include <stdio.h>

enum { TRANSLATION, TWIST, TURN, SLIDE, PROBES };

static void set(struct pair_state *p, int probe, const double n[3], const double omega[3], const double across[3])
{
    for (int side = 0; side < 2; side++) {
        struct theory_sphere *s = &p->s[side];
        double spin[3];
        for (int k = 0; k < 3; k++) {
            spin[k] = probe == TWIST ? 0.8 * n[k] : probe == TURN ? omega[k] : 0;
            s->w[k] = spin[k];
        }
        cross(spin, s->x, s->u);
        for (int k = 0; k < 3; k++)
            s->u[k] += probe == TRANSLATION ? omega[k] : probe == SLIDE ? side * across[k] : 0;
    }
}

static void fill(struct check_run *run, const struct model *m, struct pair_book *book)
{
    double xi[32], n[3], r, omega[3], across[3];
    size_t gaps;
    parameter_list(run->gate_case->parameters, "xi", xi, &gaps, 32);
    gsl_rng *random = pair_random(run);
    for (size_t b = 0; b < m->species; b++)
        for (size_t g = 0; g < gaps; g++) {
            struct pair_state p = random_pair(random, m->radius[0], m->radius[b], xi[g]);
            pair_geometry(&p, n, &r);
            random_vector(random, 0.6, omega);
            const double along = dot(omega, n);
            for (int k = 0; k < 3; k++)
                omega[k] -= along * n[k];
            cross(omega, n, across);
            for (int probe = 0; probe < PROBES; probe++) {
                set(&p, probe, n, omega, across);
                book_add(book, &p);
            }
        }
    gsl_rng_free(random);
}

static void see(const struct model *m, const struct pair_book *book, const struct pair_answer *a, struct worst worst[PROBES])
{
    for (size_t first = 0; first < book->count; first += PROBES) {
        const double *own[PROBES];
        for (size_t probe = 0; probe < PROBES; probe++)
            own[probe] = forces_at(&a->forces, first + probe, "lubrication", 1);
        const struct pair_state *turning = &book->item[first + TURN];
        double n[3], r, across[3];
        const double h = pair_geometry(turning, n, &r);
        cross(turning->s[0].w, n, across);
        /* sliding of sphere 2 with `across` gives F_1 = Y_A across; turning sees Y_A h/r of r across */
        const double slide = dot(own[SLIDE], across), turn = dot(own[TURN], across) / (slide * r);
        worst_see(&worst[TURN], turn, m->lubrication.exact_rotation ? 0 : h / r, 1, first + TURN);
        for (size_t probe = TRANSLATION; probe <= TWIST; probe++) {
            struct expected e;
            expect_lubrication(m, &book->item[first + probe], &e);
            const double speed = norm(book->item[first + probe].s[0].u) + norm(book->item[first + probe].s[1].u);
            double c[THEORY_SCALARS];
            theory_scalars(&m->lubrication, turning->s[0].radius, turning->s[1].radius, r, c);
            const double scale = c[THEORY_XA] * speed + e.force_scale;
            worst_see_vector(&worst[probe], own[probe], (const double[6]){ 0 }, 3, scale, first + probe);
            worst_see_vector(&worst[probe], own[probe] + 3, (const double[6]){ 0 }, 3, scale * r, first + probe);
        }
    }
}

void pair_rigid(struct check_run *run)
{
    struct model m;
    struct pair_book book = { 0 };
    struct pair_answer answer = { 0 };
    struct worst worst[PROBES] = { WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE };
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    fill(run, &m, &book);
    if (book_ask(run, "motions", run->gate_case->scene, &book, "lubrication", &answer)) {
        static const char *const what[] = { "rigid translation", "turning about n", "turning across n: h/r" };
        static const char *const fault[] = { "a pair that moves as one feels lubrication", "turning about n feels lubrication",
                                             "a pair that turns as one should feel the fraction h/r (or 0 with the rotation "
                                             "correction) of the sliding force: velocities are not those of the surfaces, or "
                                             "flow or vorticity is subtracted from one of velocity and spin only" };
        see(&m, &book, &answer, worst);
        for (int probe = TRANSLATION; probe <= TURN; probe++)
            check_error(run, INVARIANT, what[probe], worst[probe].measured, worst[probe].expected, worst[probe].error,
                        run->gate_case->tolerance, "%s: %s; worst at %s", fault[probe], compare(&worst[probe]),
                        describe(&book.item[worst[probe].at], worst[probe].at));
    }
    forces_free(&answer.forces);
    book_free(&book);
}
