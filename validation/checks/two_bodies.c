/*
 * Layer 4, shared parts: running pairs at three steps and comparing them with the high-order solution (two_bodies.h)
 *
 * Velocity Verlet with half-step velocities takes every drag half a step late, so its errors are of first order:
 *
 *     q(dt) = q + c_1 dt + c_2 dt^2 + ...
 *
 * as long as the forces are smooth along the path. Three steps dt, dt/2, dt/4 remove two terms (Richardson):
 *
 *     q' = 2 q(dt/2) - q(dt) ,   q'' = 2 q(dt/4) - q(dt/2) ,   q ~ (4 q'' - q')/3
 *
 * so that a wrong coefficient, which does not vanish with dt, is seen orders of magnitude below the error of any one step. A scheme of
 * second order is served as well: the first combination leaves its dt^2, the second removes it. Where a path touches, parts or begins to
 * slide, the moment falls anywhere within a step and the errors have a part of order dt^2 that is not smooth: one power is removed only.
 */
#include "two_bodies.h"
#include "pair_picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool bodies_make(struct bodies *b, size_t pairs)
{
    *b = (struct bodies){ pairs, calloc(pairs, sizeof *b->motion), calloc(pairs, sizeof *b->start), calloc(pairs, sizeof *b->origin),
                          calloc(pairs, sizeof *b->species) };
    return b->motion && b->start && b->origin && b->species;
}

void bodies_free(struct bodies *b)
{
    free(b->motion);
    free(b->start);
    free(b->origin);
    free(b->species);
    *b = (struct bodies){ 0 };
}

struct theory_motion bodies_motion(const struct model *m, double radius_1, double radius_2)
{
    struct theory_motion motion = { .radius = { radius_1, radius_2 }, .lubrication = m->has_lubrication ? &m->lubrication : NULL,
                                    .contact = m->has_contact ? &m->contact : NULL, .drag = m->has_drag, .drag_torque = m->drag_torque,
                                    .viscosity = m->viscosity };
    for (int a = 0; a < 2; a++)
        motion.density[a] = m->density[model_species(m, motion.radius[a]) - 1];
    memcpy(motion.gradient, m->gradient, sizeof motion.gradient);
    return motion;
}

static double gap_of(const double first[3], const double second[3], const struct theory_motion *m)
{
    const double r[3] = { second[0] - first[0], second[1] - first[1], second[2] - first[2] };
    return norm(r) - m->radius[0] - m->radius[1];
}

void step_key(const json_t *scene, char path[96])
{
    snprintf(path, 96, "dynamics.%s.dt", json_object_iter_key(json_object_iter(scene_get(scene, "dynamics"))));
}

/* One number at the three steps; returns its extrapolation and sees its errors. */
static double see(struct convergence *of, const double q[REFINEMENTS], double expected, double scale, int orders, size_t at)
{
    const double once = 2.0 * q[2] - q[1], coarse = 2.0 * q[1] - q[0], best = orders > 1 ? (4.0 * once - coarse) / 3.0 : once;
    for (int r = 0; r < REFINEMENTS; r++) {
        const double error = fabs(q[r] - expected) / scale;
        if (!(error <= of->at[r]))
            of->at[r] = error;
    }
    worst_see(&of->extrapolated, best, expected, scale, at);
    return best;
}

static void compare_pair(struct comparison *c, const struct bodies *b, size_t t, size_t pair, double speed, int orders)
{
    const struct theory_motion *m = &b->motion[pair];
    const struct theory_pair_state *now = &c->expected[t * b->pairs + pair];
    const double size = 0.5 * (m->radius[0] + m->radius[1]);
    double gap[REFINEMENTS];
    for (int k = 0; k < 3; k++)
        for (size_t side = 0; side < 2; side++) {
            double x[REFINEMENTS], u[REFINEMENTS], w[REFINEMENTS];
            for (int r = 0; r < REFINEMENTS; r++) {
                const struct track_point *p = track_at(&c->track[r], t, 2 * pair + side);
                x[r] = p->x[k] - b->origin[pair][k];
                u[r] = p->u[k];
                w[r] = p->w[k];
            }
            see(&c->of[PLACE], x, now->s[side].x[k], size, orders, pair);
            see(&c->of[VELOCITY], u, now->s[side].u[k], speed, orders, pair);
            if (isfinite(w[0]))
                see(&c->of[SPIN], w, now->s[side].w[k], speed / size, orders, pair);
        }
    for (int r = 0; r < REFINEMENTS; r++)
        gap[r] = gap_of(track_at(&c->track[r], t, 2 * pair)->x, track_at(&c->track[r], t, 2 * pair + 1)->x, m);
    const double expected = gap_of(now->s[0].x, now->s[1].x, m), least = (m->lubrication ? m->lubrication->inner_gap : 1e-3) * size;
    c->gap_expected[t * b->pairs + pair] = expected;
    c->gap[t * b->pairs + pair] = see(&c->of[GAP], gap, expected, fmax(fabs(expected), least), orders, pair);
}

static bool solve(struct check_run *run, const struct bodies *b, struct comparison *c)
{
    for (size_t pair = 0; pair < b->pairs; pair++) {
        struct theory_pair_state now = b->start[pair];
        for (size_t t = 0; t < c->times; t++) {
            if (!theory_pair_motion(&b->motion[pair], c->time[t] - (t ? c->time[t - 1] : 0.0), 1e-12, &now)) {
                check_garbage(run, "the reference solution did not reach its end; this is a mistake in the suite");
                return false;
            }
            c->expected[t * b->pairs + pair] = now;
        }
    }
    return true;
}

struct state_row *bodies_rows(const struct bodies *b, const struct model *m)
{
    struct state_row *row = calloc(2 * b->pairs, sizeof *row);
    for (size_t i = 0; row && i < 2 * b->pairs; i++) {
        const struct theory_sphere *s = &b->start[i / 2].s[i % 2];
        const int species = b->species[i / 2][i % 2];
        row[i] = (struct state_row){ .id = (int)i + 1, .species = species ? species : model_species(m, s->radius) };
        for (int k = 0; k < 3; k++)
            row[i].x[k] = s->x[k] + b->origin[i / 2][k];
        memcpy(row[i].u, s->u, sizeof row[i].u);
        memcpy(row[i].w, s->w, sizeof row[i].w);
    }
    return row;
}

static bool ask(struct check_run *run, const char *name, json_t *scene, const struct bodies *b, const struct model *m, double dt,
                const int *at, size_t times, struct comparison *c)
{
    struct state_row *start = bodies_rows(b, m);
    bool good = start != NULL;
    for (int r = 0; good && r < REFINEMENTS; r++) {
        int fine[64];
        char run_name[96], step[96];
        step_key(scene, step);
        for (size_t t = 0; t < times; t++)
            fine[t] = at[t] << r;
        snprintf(run_name, sizeof run_name, "%s-dt-%d", name, 1 << r);
        scene_set(scene, step, json_real(ldexp(dt, -r)));
        good = track_ask(run, run_name, scene, start, 2 * b->pairs, fine, times, &c->track[r]);
    }
    free(start);
    return good;
}

bool bodies_compare(struct check_run *run, const char *name, json_t *scene, const struct bodies *b, double dt, const int *at, size_t times,
                    double speed, int orders, struct comparison *c)
{
    static const char *const names[QUANTITIES] = { "place", "velocity", "spin", "gap" };
    struct model m;
    *c = (struct comparison){ .times = times, .time = calloc(times, sizeof(double)), .gap = calloc(times * b->pairs, sizeof(double)),
                              .gap_expected = calloc(times * b->pairs, sizeof(double)), .expected = calloc(times * b->pairs, sizeof *c->expected) };
    for (int q = 0; q < QUANTITIES; q++)
        c->of[q] = (struct convergence){ names[q], { 0 }, WORST_NONE };
    bool good = model_read(run, scene, &m) && times > 0 && times <= 64;
    for (size_t t = 0; t < times; t++)
        c->time[t] = at[t] * dt;
    good = good && ask(run, name, scene, b, &m, dt, at, times, c) && solve(run, b, c);
    for (size_t t = 0; good && t < times; t++)
        for (size_t pair = 0; pair < b->pairs; pair++)
            compare_pair(c, b, t, pair, speed, orders);
    if (!good)
        comparison_free(c);
    return good;
}

void comparison_free(struct comparison *c)
{
    for (int r = 0; r < REFINEMENTS; r++)
        track_free(&c->track[r]);
    free(c->time);
    free(c->gap);
    free(c->gap_expected);
    free(c->expected);
    *c = (struct comparison){ 0 };
}

void bodies_judge(struct check_run *run, const char *label, const struct comparison *c, const struct bodies *b, double coarse)
{
    char name[128];
    double ratio = 0.0;
    int slowest = 0;
    for (int q = 0; q < QUANTITIES; q++) {
        const struct convergence *of = &c->of[q];
        if (of->extrapolated.error < 0) {
            snprintf(name, sizeof name, "%s: %s", label, of->name);
            check_skip(run, name, "trajectory.csv gives no spins (wx, wy, wz)");
            continue;
        }
        const struct theory_motion *m = &b->motion[of->extrapolated.at];
        snprintf(name, sizeof name, "%s: %s at dt", label, of->name);
        const double most = q == GAP ? scene_number(run->gate_case->parameters, "coarse_gap", coarse) : coarse;
        check_error(run, MODEL, name, of->at[0], 0, of->at[0], most, "the %s is off by %.3g of its scale already at the given step: that is no "
                    "error of a small step", of->name, of->at[0]);
        snprintf(name, sizeof name, "%s: %s as dt vanishes", label, of->name);
        struct result *r = check_error(run, MODEL, name, of->extrapolated.measured, of->extrapolated.expected, of->extrapolated.error,
                                       run->gate_case->tolerance, "pair %zu (radii %g and %g): the %s extrapolated to dt = 0 is %s; the equations of "
                                       "motion give that", of->extrapolated.at + 1, m->radius[0], m->radius[1], of->name,
                                       compare(&of->extrapolated));
        result_notes(r, "largest error at dt, dt/2, dt/4: %.3g, %.3g, %.3g; extrapolated: %.3g", of->at[0], of->at[1], of->at[2],
                     of->extrapolated.error);
        for (int k = 1; k < REFINEMENTS; k++)      /* below the tolerance, or declared rounding, there is nothing left to halve */
            if (of->at[k - 1] > run->gate_case->tolerance + run->allowance && of->at[k] / of->at[k - 1] > ratio) {
                ratio = of->at[k] / of->at[k - 1];
                slowest = q;
            }
    }
    snprintf(name, sizeof name, "%s: errors halve with dt", label);
    check_error(run, INVARIANT, name, ratio, 0.5, ratio, 0.6, "with half the step the error of the %s is still %.3g of what it was: a scheme of first "
                "order gives 0.5, of second 0.25; what does not vanish with dt is wrong physics", c->of[slowest].name, ratio);
}

/* Gaps against time: lines the solution, points the candidate's extrapolated ones. */
void bodies_picture(struct check_run *run, const struct comparison *c, const struct bodies *b, const char *title)
{
    static const char *const numbers[7] = { "1", "2", "3", "4", "5", "6", "7" };
    struct curve curve[7];
    double line[7][64], point[7][64];
    const int curves = b->pairs < 7 ? (int)b->pairs : 7;
    for (int k = 0; k < curves; k++) {
        for (size_t t = 0; t < c->times; t++) {
            line[k][t] = c->gap_expected[t * b->pairs + (size_t)k];
            point[k][t] = c->gap[t * b->pairs + (size_t)k];
        }
        curve[k] = (struct curve){ .name = numbers[k], .line = line[k], .point = point[k] };
    }
    char path[PATH_LENGTH];
    path_join(path, run->work, "gaps.svg");
    if (run->results.count > 0 && picture_curves(path, title, "time", c->time, c->times, curve, curves))
        result_picture(&run->results.item[0], "gaps.svg");
}

const struct check two_bodies_checks[] = {
    { "approach", check_approach },   { "pushed", check_pushed },   { "encounter", check_encounter },       { "boltzmann", check_boltzmann },
    { "trapped-pair", check_trapped_pair },
    { "equipartition", check_equipartition }, { "metamorphic", check_metamorphic }, { "observers", check_observers }, { "resume", check_resume }, { "flat", check_flat }, { "grip-lost", check_grip_lost }, { "passing", check_passing }, { "flat-dynamics", check_flat_dynamics }, { NULL, NULL },
};
