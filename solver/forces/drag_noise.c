/*
 * Brownian force and torque that belong to the Stokes drag of a sphere
 *
 *     F_i = sqrt(2 kT/dt) sqrt(6 pi eta a) psi,        T_i = sqrt(2 kT/dt) sqrt(8 pi eta a^3) phi
 *
 *     psi, phi   independent vectors of mean 0 and variance 1, new each step
 *
 * so that <F F> dt = 2 kT (drag coefficient): fluctuation and dissipation balance at temperature kT.
 * Source: Ermak & McCammon (1978); Li (2026) eq 3.20, 3.21.
 */
#include "core/noise.h"
#include "forces/drag.h"
#include "forces/forces.h"

#include <stdlib.h>

struct drag_noise {
    struct force base;
    const struct drag *drag;
    double kT;
    enum noise_law law;
    struct noise_key key;
};

static void drag_noise_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                           struct stress *stress)
{
    const struct drag_noise *noise = (const struct drag_noise *)self;
    const double g = sqrt(2.0 * noise->kT / now->dt);
    (void)near, (void)stress;
    for (int i = 0; i < p->count; i++) {
        const struct noise_place place = { NOISE_DRAG, now->step, p->tag[i], 0, 0 };
        const double a = radius_of(p, i);
        vec3 psi, phi;
        noise_vectors(noise->law, &noise->key, &place, &psi, &phi);
        p->force[i] = plus(p->force[i], scaled(psi, g * sqrt(drag_of(noise->drag, a))));
        if (noise->drag->torque)
            p->torque[i] = plus(p->torque[i], scaled(phi, g * sqrt(spin_drag_of(noise->drag, a))));
    }
}

/* "drag_noise": { "distribution": "gaussian" } */
struct force *drag_noise_new(struct settings *s, const struct suspension *in, struct error *e)
{
    static const char *const laws[] = NOISE_LAWS;
    struct drag_noise *noise = calloc(1, sizeof *noise);
    if (!noise)
        return error_out_of_memory(e), NULL;
    noise->base = (struct force){ .name = "drag_noise", .kind = NOISE, .add = drag_noise_add };
    noise->drag = (const struct drag *)suspension_force(in, "drag");
    noise->kT = in->kT;
    noise->key = in->key;
    noise->law = (enum noise_law)settings_choice(s, "distribution", laws, e);
    if (!noise->drag)
        settings_refuse(s, "", e, "needs forces.drag, whose fluctuation it is");
    return &noise->base;
}
