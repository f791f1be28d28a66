/*
 * Layer 4: two lubricated spheres pushed together, or pulled apart, by constant forces along their line of centres
 *
 *     h - h_0 + S(h_0, h)/zeta + [(m_2/zeta_2) U_2 - (m_1/zeta_1) U_1].n = V t        exact, theory/pair_motion.c
 *     h - h_0 + S(h_0, h)/zeta = V t                                                  without inertia: the overdamped h(t)
 *
 * V is the speed at which the forces would part the spheres far from each other. Forces that are not opposite make the pair
 * drift as a whole; torques along the line, which lubrication does not resist, spin each sphere by itself. All of it starts from rest.
 *
 * Where they come to rest, the contact being there too, no scheme may be wrong by its step: spheres pressed together move with
 * U = (F_1 + F_2)/(zeta_1 + zeta_2) and an overlap that carries F_1 - zeta_1 U; spheres pulled apart with F_a/zeta_a each.
 */
#include "two_bodies.h"

#include <stdio.h>
#include <string.h>

/* What is the same for all pairs: the direction of every force and torque, and the rate constants of a pair along it. */
struct push { double n[3], force[2], torque[2], mass[2], zeta[2], parting, resistance /* zeta */; };

static bool direction_of(const json_t *scene, size_t species, double n[3])
{
    double load[6];
    for (size_t k = 0; k < species; k++) {
        scene_applied(scene, k, load);
        const double size = norm(load);
        for (int c = 0; size > 0 && c < 3; c++)
            n[c] = load[c] / size;
        if (size > 0)
            return true;
    }
    return false;
}

static struct push push_of(const json_t *scene, const struct model *m, const int species[2], const double n[3])
{
    struct push p = { .n = { n[0], n[1], n[2] } };
    for (int a = 0; a < 2; a++) {
        double load[6];
        const int kind = species[a] - 1;
        scene_applied(scene, (size_t)kind, load);
        p.force[a] = dot(load, n);
        p.torque[a] = dot(load + 3, n);
        p.mass[a] = 4.0 / 3.0 * M_PI * m->density[kind] * gsl_pow_3(m->radius[kind]);
        p.zeta[a] = 6.0 * M_PI * m->viscosity * m->radius[kind];
    }
    p.parting = p.force[1] / p.zeta[1] - p.force[0] / p.zeta[0];
    p.resistance = p.zeta[0] * p.zeta[1] / (p.zeta[0] + p.zeta[1]);
    return p;
}

/* The pairs of parameters.pairs: { "species": [1, 2], "xi": gap at the start }. */
static void place(const json_t *pairs, const json_t *scene, const struct model *m, const double n[3], double spacing, struct bodies *b,
                  struct push *push)
{
    size_t k;
    json_t *pair;
    json_array_foreach(pairs, k, pair)
    {
        double species[2];
        size_t two;
        parameter_list(pair, "species", species, &two, 2);
        for (int a = 0; a < 2; a++)
            b->species[k][a] = (int)species[a];
        push[k] = push_of(scene, m, b->species[k], n);
        b->motion[k] = bodies_motion(m, m->radius[b->species[k][0] - 1], m->radius[b->species[k][1] - 1]);
        struct theory_motion *motion = &b->motion[k];
        const double apart = (motion->radius[0] + motion->radius[1]) * (1.0 + 0.5 * scene_number(pair, "xi", NAN));
        for (int a = 0; a < 2; a++) {
            motion->density[a] = m->density[b->species[k][a] - 1];
            b->start[k].s[a].radius = motion->radius[a];
            for (int c = 0; c < 3; c++) {
                b->start[k].s[a].x[c] = (a ? 0.5 : -0.5) * apart * n[c];
                motion->applied[a][c] = push[k].force[a] * n[c];
                motion->applied_torque[a][c] = push[k].torque[a] * n[c];
            }
        }
        b->origin[k][2] = spacing * (double)k;
    }
}

/* Gap and velocities along the line, extrapolated; times as two_bodies.c does. */
static double extrapolated(const double q[REFINEMENTS])
{
    return (4.0 * (2.0 * q[2] - q[1]) - (2.0 * q[1] - q[0])) / 3.0;
}

static void judge_balance(struct check_run *run, const struct model *m, const struct bodies *b, const struct push *push, const struct comparison *c)
{
    struct worst exact = WORST_NONE, overdamped = WORST_NONE;
    for (size_t t = 0; t < c->times; t++)
        for (size_t k = 0; k < b->pairs; k++) {
            const struct push *p = &push[k];
            const double *a = b->motion[k].radius, gap = c->gap[t * b->pairs + k];
            const double apart[3] = { b->start[k].s[1].x[0] - b->start[k].s[0].x[0], b->start[k].s[1].x[1] - b->start[k].s[0].x[1],
                                      b->start[k].s[1].x[2] - b->start[k].s[0].x[2] };
            const double h0 = norm(apart) - a[0] - a[1], travel = p->parting * c->time[t];
            const double moved = gap - h0 + theory_squeeze_integral(&m->lubrication, a[0], a[1], h0, gap) / p->resistance;
            double inertia = 0.0, slow = 0.0;
            for (int side = 0; side < 2; side++) {
                double u[REFINEMENTS];
                for (int r = 0; r < REFINEMENTS; r++)
                    u[r] = dot(track_at(&c->track[r], t, 2 * k + (size_t)side)->u, p->n);
                inertia += (side ? 1 : -1) * p->mass[side] / p->zeta[side] * extrapolated(u);
                slow += p->mass[side] / p->zeta[side] * fabs(p->force[side]) / p->zeta[side];
            }
            worst_see(&exact, moved + inertia, travel, fabs(travel), k);
            /* the bracket is at most what free spheres would have at their terminal speeds: judged in units of that */
            worst_see(&overdamped, moved, travel, slow, k);
        }
    const double *a = b->motion[exact.at].radius, *o = b->motion[overdamped.at].radius;
    check_error(run, MODEL, "momentum balance", exact.measured, exact.expected, exact.error, run->gate_case->tolerance,
                "pair %zu (radii %g and %g): gap, squeezed fluid and momentum add up to %s; the forces have pushed for that", exact.at + 1, a[0], a[1],
                compare(&exact));
    check_error(run, MODEL, "overdamped gap", overdamped.measured, overdamped.expected, overdamped.error, 1.0,
                "pair %zu (radii %g and %g): the gap has moved as if for a travel of %.6g, not %.6g: more than inertia can explain", overdamped.at + 1,
                o[0], o[1], overdamped.measured, overdamped.expected);
}

/* Long after, with the contact: pressed or parted, at the velocities and the overlap that the forces say. */
static bool judge_rest(struct check_run *run, const json_t *given, const struct model *m, const struct bodies *b, const struct push *push)
{
    const json_t *parameters = run->gate_case->parameters;
    struct worst velocity = WORST_NONE, overlap = WORST_NONE, spin = WORST_NONE;
    struct track track;
    json_t *scene = json_deep_copy(given);
    const double k_n = scene_number(parameters, "normal_stiffness", NAN);
    scene_set(scene, "forces.contact", json_pack("{sf sf}", "normal_stiffness", k_n, "friction", 0.0));
    scene_set(scene, "dynamics.verlet.dt", json_real(scene_number(parameters, "rest_dt", NAN)));
    const int at = (int)scene_number(parameters, "rest_steps", NAN);
    struct state_row *row = bodies_rows(b, m);
    const bool good = row && track_ask(run, "rest", scene, row, 2 * b->pairs, &at, 1, &track);
    for (size_t k = 0; good && k < b->pairs; k++) {
        const struct push *p = &push[k];
        const struct track_point *s[2] = { track_at(&track, 0, 2 * k), track_at(&track, 0, 2 * k + 1) };
        const double together = (p->force[0] + p->force[1]) / (p->zeta[0] + p->zeta[1]), speed = fabs(p->parting), *a = b->motion[k].radius;
        double apart[3];
        for (int c = 0; c < 3; c++)
            apart[c] = s[1]->x[c] - s[0]->x[c];
        if (p->parting < 0)
            worst_see(&overlap, a[0] + a[1] - norm(apart), (p->force[0] - p->zeta[0] * together) / k_n, speed * p->resistance / k_n, k);
        for (int side = 0; side < 2; side++)
            for (int c = 0; c < 3; c++) {
                const double free_spin = p->torque[side] / (8.0 * M_PI * m->viscosity * gsl_pow_3(a[side])) * p->n[c];
                worst_see(&velocity, s[side]->u[c], (p->parting < 0 ? together : p->force[side] / p->zeta[side]) * p->n[c], speed, k);
                if (isfinite(s[side]->w[c]))
                    worst_see(&spin, s[side]->w[c], free_spin, speed / a[side], k);
            }
    }
    free(row);
    json_decref(scene);
    if (!good)
        return false;
    track_free(&track);
    const double settled = 1e-8;    /* exact at any step; what is left of the way there is e^-20 and less */
    check_error(run, MODEL, "in the end: velocity", velocity.measured, velocity.expected, velocity.error, settled,
                "pair %zu: pressed together spheres move with the sum of forces over the sum of drags, parted ones each with its own; the velocity is %s",
                velocity.at + 1, compare(&velocity));
    check_error(run, MODEL, "in the end: overlap", overlap.measured, overlap.expected, overlap.error, settled,
                "pair %zu: the overlap that carries the load is %s", overlap.at + 1, compare(&overlap));
    if (spin.error < 0)
        check_skip(run, "in the end: spin", "trajectory.csv gives no spins (wx, wy, wz)");
    else
        check_error(run, MODEL, "in the end: spin", spin.measured, spin.expected, spin.error, settled,
                    "pair %zu: a torque along the line of centres turns a sphere at T/(8 pi eta a^3); the spin is %s", spin.at + 1, compare(&spin));
    return true;
}

void check_pushed(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters, *pairs = json_object_get(parameters, "pairs");
    json_t *scene = json_deep_copy(run->gate_case->scene);
    double list[64], n[3] = { 0 };
    int at[64];
    size_t times;
    parameter_list(parameters, "at", list, &times, 64);
    for (size_t t = 0; t < times; t++)
        at[t] = (int)list[t];
    const double spacing = scene_number(parameters, "spacing", NAN);
    struct push push[16];
    struct model m;
    struct bodies b = { 0 };
    struct comparison c;
    if (json_array_size(pairs) <= 16 && model_read(run, scene, &m) && direction_of(scene, m.species, n) && bodies_make(&b, json_array_size(pairs))) {
        double fastest = 0.0;
        place(pairs, scene, &m, n, spacing, &b, push);
        for (size_t k = 0; k < b.pairs; k++)
            fastest = fmax(fastest, fabs(push[k].parting));
        scene_set(scene, "box.lengths", json_pack("[fff]", 21.3, 24.9, spacing * (double)b.pairs));
        if (bodies_compare(run, "pushed", scene, &b, scene_number(parameters, "dt", NAN), at, times, fastest, 2, &c)) {
            judge_balance(run, &m, &b, push, &c);
            bodies_judge(run, "pushed", &c, &b, scene_number(parameters, "coarse", NAN));
            bodies_picture(run, &c, &b, "gap of pairs under constant forces");
            comparison_free(&c);
            judge_rest(run, scene, &m, &b, push);
        }
    }
    bodies_free(&b);
    json_decref(scene);
}
