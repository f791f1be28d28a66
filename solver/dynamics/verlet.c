/*
 * Velocity Verlet with half-step velocities in the forces (LAMMPS's convention)
 *
 *     m dU/dt = F,   I dW/dt = T,   dx/dt = U
 *
 *     kick    U += dt/2 F/m,  W += dt/2 T/I
 *     drift   x += dt U
 *             box to t + dt; pairs (wrapping and remapping velocities where the list is made anew)
 *     force   F, T at the new x, with the half-step U, W
 *     kick    U += dt/2 F/m,  W += dt/2 T/I
 *
 * Second order where forces depend on positions only; first order in drag and friction. For linear drag
 * the full-step <U^2> = kT/m and the diffusion coefficient are exact at any step; half-step <U^2> is high by
 * 1/(1 - eps/2), eps = drag dt/m, so a pair whose friction changes with its gap feels a spurious potential -kT ln(1 - eps/2).
 * Stable while w^2 dt^2 + 2 g dt < 4 for every mode of stiffness rate w and friction rate g.
 * Source: Verlet (1967), Swope et al. (1982).
 */
#include "core/motion.h"
#include "dynamics/dynamics.h"

static bool verlet_step(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    (void)self;
    kick(s, 0.5 * s->dt, 0.5 * s->dt);
    drift(s, s->dt);
    s->step++;
    box_set_time(&s->box, s->start_time + (double)s->step * s->dt);
    if (!suspension_find(s, relisted, e))
        return false;
    const struct moment now = moment_of(s, s->dt);
    suspension_add_forces(s, ALL_KINDS, &now);
    kick(s, 0.5 * s->dt, 0.0);
    return true;
}

static bool verlet_begin(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    (void)self;
    if (!suspension_find(s, relisted, e))
        return false;
    const struct moment now = moment_of(s, 0.0);
    suspension_add_forces(s, ALL_KINDS, &now);
    return true;
}

const struct dynamics verlet = { "verlet", verlet_step, verlet_begin, NULL, NULL };
