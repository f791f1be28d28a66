/*
 * Layer 4: two spheres squeeze the fluid between them, alone and with nothing else that acts
 *
 *     m_eff dv/dt = - X_A(h) v ,  v = - dh/dt     gives     v(h) = v_0 - (1/m_eff) int_h^h0 X_A dh'       theory/pair_motion.c
 *
 * so that a pair thrown together stops at the gap where the integral has eaten all its momentum, whatever the time it takes. The gate
 * throws each pair so that it should stop at a given gap, in a random direction, the pair as a whole drifting: neither direction nor
 * drift may matter. No drag: the pair keeps its momentum, stays on its line, and does not turn, to rounding at any step.
 *
 * The closed form is asked of gap and speed of the same moment; the solution in time, by two_bodies.c, says when it happens.
 */
#include "two_bodies.h"

#include <stdio.h>
#include <string.h>

struct invariants { struct worst momentum, line, spin; };

/* Throw pair `k`: from gap xi_0 along n, fast enough to stop at xi_stop. Returns the speed of approach. */
static double throw(const struct model *m, struct bodies *b, size_t k, const double n[3], const double drift[3], double from, double stop)
{
    const struct theory_motion *motion = &b->motion[k];
    const double *a = motion->radius, mean = 0.5 * (a[0] + a[1]);
    const double m1 = theory_sphere_mass(motion, 0), m2 = theory_sphere_mass(motion, 1), effective = m1 * m2 / (m1 + m2);
    const double speed = theory_squeeze_integral(&m->lubrication, a[0], a[1], mean * stop, mean * from) / effective;
    for (int side = 0; side < 2; side++) {
        struct theory_sphere *s = &b->start[k].s[side];
        s->radius = a[side];
        for (int c = 0; c < 3; c++) {
            s->x[c] = (side ? 0.5 : -0.5) * (a[0] + a[1] + mean * from) * n[c];
            s->u[c] = drift[c] + (side ? -m1 : m2) / (m1 + m2) * speed * n[c];
        }
    }
    return speed;
}

static void see_invariants(const struct bodies *b, const struct comparison *c, const double *speed, struct invariants *worst)
{
    for (size_t t = 0; t < c->times; t++)
        for (size_t k = 0; k < b->pairs; k++) {
            const struct track_point *p[2] = { track_at(&c->track[0], t, 2 * k), track_at(&c->track[0], t, 2 * k + 1) };
            const struct theory_sphere *s = b->start[k].s;
            double r[3], r0[3], off[3], mass[2];
            for (int side = 0; side < 2; side++) {
                mass[side] = theory_sphere_mass(&b->motion[k], side);
                if (isfinite(p[side]->w[0]))
                    worst_see_vector(&worst->spin, p[side]->w, (const double[3]){ 0 }, 3, speed[k] / s[side].radius, k);
            }
            for (int x = 0; x < 3; x++) {
                r[x] = p[1]->x[x] - p[0]->x[x];
                r0[x] = s[1].x[x] - s[0].x[x];
                worst_see(&worst->momentum, mass[0] * p[0]->u[x] + mass[1] * p[1]->u[x], mass[0] * s[0].u[x] + mass[1] * s[1].u[x],
                          (mass[0] + mass[1]) * speed[k], k);
            }
            cross(r, r0, off);
            worst_see_vector(&worst->line, off, (const double[3]){ 0 }, 3, norm(r) * norm(r0), k);
        }
}

/* Speed against gap, both extrapolated: v(h) + (1/m_eff) int_h^h0 X_A dh' = v_0 at every moment. */
static void judge_closed_form(struct check_run *run, const struct model *m, const struct bodies *b, const struct comparison *c,
                              const double *speed, double from)
{
    struct worst w = WORST_NONE;
    for (size_t t = 0; t < c->times; t++)
        for (size_t k = 0; k < b->pairs; k++) {
            const struct theory_motion *motion = &b->motion[k];
            const double *a = motion->radius, mean = 0.5 * (a[0] + a[1]);
            const double m1 = theory_sphere_mass(motion, 0), m2 = theory_sphere_mass(motion, 1), effective = m1 * m2 / (m1 + m2);
            double v[REFINEMENTS];
            for (int r = 0; r < REFINEMENTS; r++) {
                const struct track_point *one = track_at(&c->track[r], t, 2 * k), *two = track_at(&c->track[r], t, 2 * k + 1);
                double apart[3], away[3];
                for (int x = 0; x < 3; x++) {
                    apart[x] = two->x[x] - one->x[x];
                    away[x] = two->u[x] - one->u[x];
                }
                v[r] = -dot(apart, away) / norm(apart);
            }
            const double once = 2.0 * v[2] - v[1], coarse = 2.0 * v[1] - v[0], now = (4.0 * once - coarse) / 3.0;
            const double eaten = theory_squeeze_integral(&m->lubrication, a[0], a[1], c->gap[t * b->pairs + k], mean * from) / effective;
            worst_see(&w, now + eaten, speed[k], speed[k], k);
        }
    const struct theory_motion *at = &b->motion[w.at];
    check_error(run, MODEL, "speed and gap", w.measured, w.expected, w.error, run->gate_case->tolerance, "radii %g and %g: speed left and momentum "
                "eaten by the squeezing resistance add up to %s", at->radius[0], at->radius[1], compare(&w));
}

static void judge_invariants(struct check_run *run, const struct invariants *w)
{
    const double rounding = 1e-11;      /* a thousand steps of forces of size X_A v, each good to 1e-16 */
    check_error(run, INVARIANT, "momentum of the pair", w->momentum.measured, w->momentum.expected, w->momentum.error, rounding,
                "a pair on which nothing acts from outside has momentum %s", compare(&w->momentum));
    check_error(run, INVARIANT, "stays on its line", w->line.error, 0, w->line.error, rounding,
                "two spheres moving along their line of centres leave it by an angle of %.3g", w->line.error);
    if (w->spin.error >= 0)
        check_error(run, INVARIANT, "no spin", w->spin.measured, 0, w->spin.error, rounding,
                    "two spheres moving along their line of centres begin to spin: %s", compare(&w->spin));
}

void check_approach(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    double ratio[8], stop[8], list[64], speed[64], fastest = 0.0;
    int at[64];
    size_t sizes, stops, times;
    parameter_list(parameters, "radii", ratio, &sizes, 8);
    parameter_list(parameters, "stop", stop, &stops, 8);
    parameter_list(parameters, "at", list, &times, 64);
    for (size_t t = 0; t < times; t++)
        at[t] = (int)list[t];
    const double from = scene_number(parameters, "from", NAN), spacing = scene_number(parameters, "spacing", NAN);
    json_t *scene = json_deep_copy(run->gate_case->scene);
    gsl_rng *random = pair_random(run);
    struct model m;
    struct bodies b = { 0 };
    struct comparison c;
    if (sizes * stops <= 64 && model_read(run, scene, &m) && bodies_make(&b, sizes * stops)) {
        double drift[3], n[3];
        random_vector(random, 0.4, drift);
        for (size_t k = 0; k < b.pairs; k++) {
            random_direction(random, n);
            b.motion[k] = bodies_motion(&m, k % 2 ? m.radius[0] : ratio[k / stops], k % 2 ? ratio[k / stops] : m.radius[0]);
            speed[k] = throw(&m, &b, k, n, drift, from, stop[k % stops]);
            fastest = fmax(fastest, speed[k]);
            b.origin[k][2] = spacing * (double)k;
        }
        scene_set(scene, "box.lengths", json_pack("[fff]", 21.3, 24.9, spacing * (double)b.pairs));
        if (bodies_compare(run, "approach", scene, &b, scene_number(parameters, "dt", NAN), at, times, fastest, 2, &c)) {
            struct invariants w = { WORST_NONE, WORST_NONE, WORST_NONE };
            see_invariants(&b, &c, speed, &w);
            judge_invariants(run, &w);
            judge_closed_form(run, &m, &b, &c, speed, from);
            bodies_judge(run, "approach", &c, &b, scene_number(parameters, "coarse", NAN));
            bodies_picture(run, &c, &b, "gap of pairs that squeeze the fluid out");
            comparison_free(&c);
        }
    }
    bodies_free(&b);
    gsl_rng_free(random);
    json_decref(scene);
}
