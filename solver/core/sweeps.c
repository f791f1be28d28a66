#include "core/sweeps.h"

#include <stdlib.h>
#include <string.h>

/* Does it act on pairs: has a range, or reads what such a force left with them? Else on each particle alone. */
static bool is_of_pairs(const struct force *f) { return f->range_factor > 0.0 || f->keeps_resistance; }

/* Adds friction and noise of the pair forces on the pairs of `near`, or of the others. */
static void act(const struct suspension *s, bool on_pairs, struct near_pairs *near, const struct moment *now, struct stress *stress)
{
    for (int k = 0; k < s->force_count; k++)
        if (s->force[k]->kind & (FRICTION | NOISE) && is_of_pairs(s->force[k]) == on_pairs)
            s->force[k]->add(s->force[k], (struct particles *)&s->particles, near, now, stress);
}

/* B: the matrix of lone particles is diagonal. */
static void step_alone(const struct friction *f, struct suspension *s, const struct moment *now, struct stress *stress)
{
    struct particles *p = &s->particles;
    memset(p->force, 0, (size_t)p->count * sizeof *p->force);
    if (p->torque)
        memset(p->torque, 0, (size_t)p->count * sizeof *p->torque);
    act(s, false, NULL, now, stress);
    suspension_flatten(s);
    for (int i = 0; i < p->count; i++) {
        const double *D = f->diagonal + i * f->width;
        if (p->kind[p->species[i]].driven)
            continue;
        p->velocity[i] = plus(p->velocity[i], scaled(p->force[i], 2.0 * f->half_dt / D[0]));
        if (p->spin)
            p->spin[i] = plus(p->spin[i], scaled(p->torque[i], 2.0 * f->half_dt / D[3]));
    }
}

/* Half the change that a factor makes of one pair. */
struct pair_change { vec3 velocity_i, velocity_j, spin_i, spin_j; };

/*
 * Solves (M + h R) change = h F for one pair, h half the factor's duration. Along n it is one number. Across n the equations for
 * a = P x n / m_eff (P the impulse on i), and for both spins, have the same matrix for either direction across:
 *
 *     [ m_eff + h Y_A    h B_1          h B_2        ] [ a   ]       [ F x n ]
 *     [ h B_1            I_i + h C_11   h C_12       ] [ W_i ]  =  h [ T_i   ]        solved as L D L^T
 *     [ h B_2            h C_12         I_j + h C_22 ] [ W_j ]       [ T_j   ]
 *
 * An infinite mass or moment of inertia gives 0 where it should.
 */
static struct pair_change solve_pair(const struct resistance *R, vec3 n, double h, const double m[2], const double I[2], vec3 F, vec3 T_i, vec3 T_j)
{
    const double m_eff = 1.0 / (1.0 / m[0] + 1.0 / m[1]);
    const double along = h * dot(F, n) / (1.0 + h * R->X_A / m_eff);
    const double d_1 = m_eff + h * R->Y_A, l_2 = h * R->B_1 / d_1, l_3 = h * R->B_2 / d_1;
    const double d_2 = I[0] + h * R->C_11 - l_2 * h * R->B_1, e = h * R->C_12 - l_2 * h * R->B_2, k = e / d_2;
    const double d_3 = I[1] + h * R->C_22 - l_3 * h * R->B_2 - k * e;
    const vec3 y_1 = scaled(cross(F, n), h), y_2 = minus(scaled(across(T_i, n), h), scaled(y_1, l_2));
    const vec3 y_3 = minus(minus(scaled(across(T_j, n), h), scaled(y_1, l_3)), scaled(y_2, k));
    const vec3 W_j = scaled(y_3, 1.0 / d_3), W_i = minus(scaled(y_2, 1.0 / d_2), scaled(W_j, k));
    const vec3 a = minus(scaled(y_1, 1.0 / d_1), plus(scaled(W_i, l_2), scaled(W_j, l_3)));
    const vec3 P = plus(scaled(n, along), scaled(cross(n, a), m_eff));
    return (struct pair_change){ scaled(P, 1.0 / m[0]), scaled(P, -1.0 / m[1]), W_i, W_j };
}

/* A particle and its own image move alike: only their common spin is resisted. T: what both sides feel together. */
static struct pair_change solve_own_image(const struct resistance *R, vec3 n, double h, double I, vec3 T)
{
    return (struct pair_change){ .spin_i = scaled(across(T, n), h / (I + h * (R->C_11 + 2.0 * R->C_12 + R->C_22))) };
}

static void change_pair(struct particles *p, const struct pair *pair, const struct pair_change *c)
{
    p->velocity[pair->i] = plus(p->velocity[pair->i], c->velocity_i);
    p->velocity[pair->j] = plus(p->velocity[pair->j], c->velocity_j);
    if (p->spin) {
        p->spin[pair->i] = plus(p->spin[pair->i], c->spin_i);
        p->spin[pair->j] = plus(p->spin[pair->j], c->spin_j);
    }
}

/* P_k. The pair is shown to the forces as a list of its own; its two halves of a step each book half of its stress. */
static void step_pair(const struct friction *f, struct suspension *s, const struct friction_link *link, const struct moment *now,
                      struct stress *stress)
{
    struct particles *p = &s->particles;
    struct pair alone = s->neighbours.near.pair[link->pair];
    struct resistance left;
    struct near_pairs near = { .count = 1, .pair = &alone, .resistance = &left };
    const int end[2] = { link->i, link->j };
    double m[2], I[2];
    for (int side = 0; side < 2; side++) {
        m[side] = mass_of(p, end[side]);
        I[side] = inertia_of(p, end[side]);
        p->force[end[side]] = vec(0, 0, 0);
        if (p->torque)
            p->torque[end[side]] = vec(0, 0, 0);
    }
    act(s, true, &near, now, NULL);
    vec3 F = p->force[link->i], T_i = p->torque ? p->torque[link->i] : vec(0, 0, 0), T_j = p->torque ? p->torque[link->j] : vec(0, 0, 0);
    if (s->dimensions == 2)
        F.z = T_i.x = T_i.y = T_j.x = T_j.y = 0.0;
    const struct pair_change c = link->i == link->j ? solve_own_image(&link->resistance, link->normal, f->half_dt, I[0], T_i)
                                                    : solve_pair(&link->resistance, link->normal, f->half_dt, m, I, F, T_i, T_j);
    change_pair(p, &alone, &c);
    if (stress) {
        alone.weight *= 0.5;
        act(s, true, &near, now, stress);       /* at the mean velocity of this factor */
    }
    change_pair(p, &alone, &c);
}

/* change += times v */
static void note_velocities(struct friction *f, const struct particles *p, double times)
{
    for (int k = 0; k < f->count * f->width; k++) {
        const int i = k / f->width, c = k % f->width;
        const vec3 v = c < 3 ? p->velocity[i] : p->spin[i];
        f->change[k] += times * (c % 3 == 0 ? v.x : c % 3 == 1 ? v.y : v.z);
    }
}

struct ordered { uint64_t tags; uint32_t image; const struct friction_link *link; };

static int by_tags(const void *left, const void *right)
{
    const struct ordered *a = left, *b = right;
    return a->tags != b->tags ? (a->tags > b->tags) - (a->tags < b->tags) : (a->image > b->image) - (a->image < b->image);
}

bool sweeps_step(struct friction *f, struct suspension *s, struct error *e)
{
    struct particles *p = &s->particles;
    struct moment now = moment_of(s, 0.0);
    if (!friction_gather(f, s, 0.5 * s->dt, e))
        return false;
    struct ordered *order = malloc(((size_t)f->links + 1) * sizeof *order);
    if (!order)
        return error_out_of_memory(e);
    for (int k = 0; k < f->links; k++)
        order[k] = (struct ordered){ (uint64_t)p->tag[f->link[k].i] << 32 | (uint32_t)p->tag[f->link[k].j],
                                     s->neighbours.near.pair[f->link[k].pair].image, &f->link[k] };
    qsort(order, (size_t)f->links, sizeof *order, by_tags);
    memset(f->change, 0, (size_t)(f->count * f->width) * sizeof *f->change);
    note_velocities(f, p, -0.5);
    struct stress *const stress = s->measuring ? &s->stress : NULL;
    now.dt = 0.5 * s->dt;
    now.step = 2 * s->step;
    step_alone(f, s, &now, stress);             /* the stress of lone particles is the flow's: once for both halves */
    for (int k = 0; k < f->links; k++)
        step_pair(f, s, order[k].link, &now, stress);
    now.step++;                                 /* fresh noise */
    for (int k = f->links - 1; k >= 0; k--)
        step_pair(f, s, order[k].link, &now, stress);
    step_alone(f, s, &now, NULL);
    free(order);
    note_velocities(f, p, 0.5);
    return true;
}
