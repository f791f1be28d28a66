/*
 * Brownian forces and torques that belong to pair lubrication, with g = sqrt(2 kT/dt)
 *
 *     F_i = g (sqrt(X_A) n n + sqrt(Y_A) (I - n n)) theta,     F_j = -F_i
 *     T_i = g [ B_1/sqrt(Y_A) theta x n + sqrt(C_11 - B_1^2/Y_A) (I - n n) chi ]
 *     T_j = g [ B_2/sqrt(Y_A) theta x n - sqrt(C_22 - B_2^2/Y_A) (I - n n) chi ]
 *
 *     theta, chi   independent vectors of mean 0 and variance 1, one of each per pair and step
 *
 * so that the covariance of (F_i, F_j, T_i, T_j) is (2 kT/dt) R, with the very resistances of the drag in the same step.
 * Source: Li (2026) eq 3.22-3.24. The minus before the last root is the ansatz of her eq 3.28; her eq 3.24 prints a plus, for which
 * <T_i T_j> would come out as 2 B_1 B_2/Y_A - C_12 instead of C_12: four times too large for equal spheres.
 */
#include "core/noise.h"
#include "forces/lubrication.h"
#include "forces/forces.h"

#include <stdlib.h>

struct lubrication_noise {
    struct force base;
    const struct lubrication *drag;
    double kT;
    enum noise_law law;
    struct noise_key key;
    bool flat;              /* two dimensions: no force across the plane, which would be taken off the spheres but not off the stress */
};

static void lubrication_noise_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                                  struct stress *stress)
{
    const struct lubrication_noise *noise = (const struct lubrication_noise *)self;
    const double g = sqrt(2.0 * noise->kT / now->dt);
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        if (lubrication_gap(pair) > noise->drag->outer_gap)
            continue;
        const struct noise_place place = { NOISE_LUBRICATION, now->step, p->tag[pair->i], p->tag[pair->j], pair->image };
        vec3 theta, chi;
        noise_vectors(noise->law, &noise->key, &place, &theta, &chi);
        theta.z = noise->flat ? 0.0 : theta.z;
        const struct resistance *R = &near->resistance[k];
        const vec3 n = pair->normal;
        const double root_X = g * sqrt(R->X_A), root_Y = g * sqrt(R->Y_A);
        const double per_root_Y = g * g / root_Y;                           /* g / sqrt(Y_A) */
        const vec3 force = plus(scaled(theta, root_Y), scaled(n, (root_X - root_Y) * dot(theta, n)));
        const vec3 twist = scaled(cross(theta, n), per_root_Y), spin = scaled(across(chi, n), g);
        const double own_i = sqrt(R->C_11 - R->B_1 * R->B_1 / R->Y_A), own_j = sqrt(R->C_22 - R->B_2 * R->B_2 / R->Y_A);
        pair_push(p, pair, force);
        pair_turn(p, pair, plus(scaled(twist, R->B_1), scaled(spin, own_i)), minus(scaled(twist, R->B_2), scaled(spin, own_j)));
        if (stress)
            stress_add_pair(stress, self->origin[0], pair, force);
    }
}

/* "lubrication_noise": { "distribution": "gaussian" } */
struct force *lubrication_noise_new(struct settings *s, const struct suspension *in, struct error *e)
{
    static const char *const laws[] = NOISE_LAWS;
    struct lubrication_noise *noise = calloc(1, sizeof *noise);
    if (!noise)
        return error_out_of_memory(e), NULL;
    noise->base = (struct force){ .name = "lubrication_noise", .origin_name = { "lubrication_noise" }, .kind = NOISE, .rotates = true,
                                  .keeps_resistance = true, .add = lubrication_noise_add };
    noise->drag = (const struct lubrication *)suspension_force(in, "lubrication");
    noise->kT = in->kT, noise->key = in->key, noise->flat = in->dimensions == 2;
    noise->law = (enum noise_law)settings_choice(s, "distribution", laws, e);
    if (!noise->drag)
        settings_refuse(s, "", e, "needs forces.lubrication, whose fluctuation it is");
    return &noise->base;
}
