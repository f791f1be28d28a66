/*
 * Stokes drag of a sphere in the background flow
 *
 *     F_i = 6 pi eta a (U_inf(x) - U)         T_i = 8 pi eta a^3 (Omega_inf - W)        S_i = (20/3) pi eta a^3 E
 *
 *     U_inf, Omega_inf, E   velocity, half the vorticity, and strain rate of the undisturbed liquid   [L/T], [1/T]
 *     S                     stresslet, the sphere's part of the stress: (5/2) phi in the viscosity    [M L^2/T^2]
 *
 * Source: Stokes (1851), Einstein (1906); Li (2026) eq 3.5, 3.6. No hindrance: neighbours act by lubrication only.
 */
#include "forces/drag.h"
#include "forces/forces.h"

#include <stdlib.h>

static void drag_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                     struct stress *stress)
{
    const struct drag *law = (const struct drag *)self;
    const struct box *box = now->box;
    (void)near;
    for (int i = 0; i < p->count; i++) {
        const double a = radius_of(p, i);
        const vec3 lag = minus(mat3_times(&box->image_gradient, p->position[i]), p->velocity[i]);
        p->force[i] = plus(p->force[i], scaled(lag, drag_of(law, a)));
        if (law->torque)
            p->torque[i] = plus(p->torque[i], scaled(minus(box->spin, p->spin[i]), spin_drag_of(law, a)));
    }
    for (int i = 0; stress && i < p->count; i++) {
        const double a = radius_of(p, i), strength = 20.0 / 3.0 * M_PI * law->viscosity * a * a * a;
        for (int k = 0; k < 9; k++)
            stress->sum[self->origin[0]].m[k / 3][k % 3] += strength * box->strain_rate.m[k / 3][k % 3];
    }
}

static void drag_respond_alone(const struct force *self, const struct particles *p, int a, double *drag, double *spin_drag)
{
    const struct drag *law = (const struct drag *)self;
    *drag += drag_of(law, p->kind[a].radius) / p->kind[a].mass;
    if (law->torque)
        *spin_drag += spin_drag_of(law, p->kind[a].radius) / p->kind[a].inertia;
}

/* "drag": { "torque": true } */
struct force *drag_new(struct settings *s, const struct suspension *in, struct error *e)
{
    struct drag *law = calloc(1, sizeof *law);
    if (!law)
        return error_out_of_memory(e), NULL;
    law->base = (struct force){ .name = "drag", .origin_name = { "drag" }, .kind = FRICTION, .add = drag_add, .respond_alone = drag_respond_alone };
    law->viscosity = in->viscosity;
    law->torque = law->base.rotates = settings_flag(s, "torque", e);
    if (!(in->viscosity > 0.0))
        settings_refuse(s, "", e, "needs fluid.viscosity above 0");
    return &law->base;
}
