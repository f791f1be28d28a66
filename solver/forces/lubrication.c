/*
 * Lubrication between two unequal spheres: squeeze, shear and rotation
 *
 *     F_i = (X_A n n + Y_A (I - n n)) dU + (B_1 W_i + B_2 W_j) x n,     F_j = -F_i,     dU = U_j - U_i
 *     T_i = B_1 dU x n - (I - n n)(C_11 W_i + C_12 W_j)
 *     T_j = B_2 dU x n - (I - n n)(C_12 W_i + C_22 W_j)
 *
 *     X_A ... C_22   resistances at the dimensionless gap xi = 2 h/(a_i + a_j), see core/resistance.h; they stay at their
 *                    inner-gap values below it, also in contact, and end at the outer gap (kept at xi = xi_max)
 *     U, W           laboratory velocities: near contact only the motion of the two surfaces matters, the flow's own
 *                    share cancels; peculiar velocities here would miss the lubrication of affine motion altogether
 *
 * Source: Jeffrey & Onishi (1984); Li (2026) eq 3.8-3.18. Angular momentum is kept to h/r, the price of truncation;
 * `rotation_correction: exact` scales the rotation columns by r/(a_i + a_j) so that a rigidly turning pair feels nothing.
 * The stress is F_i (x) (x_j - x_i): at this order the same as the sum of the two stresslets.
 */
#include "forces/lubrication.h"
#include "forces/forces.h"

#include <stdlib.h>

static void lubrication_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                            struct stress *stress)
{
    const struct lubrication *law = (const struct lubrication *)self;
    (void)now;
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        const int i = pair->i, j = pair->j;
        const double xi = lubrication_gap(pair);
        if (xi > law->outer_gap)
            continue;
        const double turn = law->exact_rotation ? pair->distance / (pair->distance - pair->gap) : 1.0;
        const struct resistance R = resistance_at(&law->sizes[p->species[i]][p->species[j]], xi, law->inner_gap, turn);
        if (near->resistance)
            near->resistance[k] = R;

        const vec3 dU = minus(plus(p->velocity[j], pair->image_velocity), p->velocity[i]);
        vec3 torque_i, torque_j;
        const vec3 force = resistance_act(&R, pair->normal, dU, p->spin[i], p->spin[j], &torque_i, &torque_j);
        pair_push(p, pair, force);
        pair_turn(p, pair, torque_i, torque_j);
        if (stress)
            stress_add_pair(stress, self->origin[0], pair, force);
    }
}

static void lubrication_respond(const struct force *self, const struct particles *p, int a, int b, double gap, struct response *r)
{
    const struct lubrication *law = (const struct lubrication *)self;
    const double xi = 2.0 * gap / (p->kind[a].radius + p->kind[b].radius);
    if (xi <= law->outer_gap)
        r->resistance = resistance_at(&law->sizes[a][b], xi, law->inner_gap, law->exact_rotation ? 1.0 + 0.5 * xi : 1.0);
}

/* "lubrication": { "inner_gap": 1e-3, "outer_gap": 0.05, "rotation_correction": "none" } */
struct force *lubrication_new(struct settings *s, const struct suspension *in, struct error *e)
{
    static const char *const corrections[] = { "none", "exact", NULL };
    const struct particles *p = &in->particles;
    struct lubrication *law = calloc(1, sizeof *law);
    if (!law)
        return error_out_of_memory(e), NULL;
    law->base = (struct force){ .name = "lubrication", .origin_name = { "lubrication" }, .kind = FRICTION, .rotates = true,
                                .add = lubrication_add, .respond = lubrication_respond };
    law->inner_gap = settings_positive(s, "inner_gap", e);
    law->outer_gap = settings_positive(s, "outer_gap", e);
    law->exact_rotation = settings_choice(s, "rotation_correction", corrections, e) == 1;
    if (!error_raised(e) && !(law->inner_gap < law->outer_gap))
        settings_refuse(s, "outer_gap", e, "must be above inner_gap, %g", law->inner_gap);
    if (!error_raised(e) && !(law->outer_gap < 1.0))
        settings_refuse(s, "outer_gap", e, "must be below 1: beyond it ln(1/xi) is negative and the drag would drive");
    if (!(in->viscosity > 0.0))
        settings_refuse(s, "", e, "needs fluid.viscosity above 0");
    law->base.range_factor = (1.0 + 0.5 * law->outer_gap) * (1.0 + 1e-12);     /* rounding must not end it before xi_max does */
    for (int a = 0; a < p->species_count; a++)
        for (int b = 0; b < p->species_count; b++)
            law->sizes[a][b] = resistance_of_sizes(in->viscosity, p->kind[a].radius, p->kind[b].radius);
    return &law->base;
}
