/*
 * Symmetric split with an implicit friction step
 *
 *     kick      dt/2   contact, repulsion and other forces of position          U, W
 *     drift     dt/2                                                            x
 *     friction  dt     drag, lubrication and all noise at fixed x, midpoint     U, W     (core/friction.h, or core/sweeps.h)
 *     drift     dt/2                                                            x
 *     kick      dt/2   with the forces at the new x
 *
 * The friction step keeps the Maxwell distribution, Stokes-Einstein diffusion and terminal velocity exactly at any dt, so no
 * spurious potential appears where friction changes with the gap. Kicks and drifts around it make the whole second order where forces
 * are smooth; positions in a harmonic contact are sampled exactly, while the kinetic temperature there is low by w^2 dt^2/4.
 * Stable while w dt < 2 for the stiffness rates w alone. With X_A dt/(2 m_eff) well above 1 velocities of a squeezed pair
 * alternate in sign from step to step ("ring") without growing.
 *
 * Lubrication and drag stresses are those of the mean velocity (v + v')/2: of the impulses really applied. Histories of contacts follow
 * the mean velocity of the two drifts. Source: Strang (1968) for the order of the parts; Leimkuhler & Matthews (2013) for what it samples.
 */
#include "core/friction.h"
#include "core/motion.h"
#include "core/sweeps.h"
#include "dynamics/dynamics.h"

#include <stdlib.h>
#include <string.h>

struct split_state { struct friction friction; vec3 *mean_velocity, *mean_spin; };

static void split_free(struct suspension *s)
{
    struct split_state *own = s->dynamics_state;
    if (!own)
        return;
    friction_free(&own->friction);
    free(own->mean_velocity);
    free(own->mean_spin);
    free(own);
    s->dynamics_state = NULL;
}

static bool make_state(struct suspension *s, struct error *e)
{
    const size_t n = (size_t)s->particles.count + 1;
    if (s->dynamics_state)
        return true;
    struct split_state *own = calloc(1, sizeof *own);
    s->dynamics_state = own;
    return (own && (own->mean_velocity = calloc(n, sizeof(vec3))) && (own->mean_spin = calloc(n, sizeof(vec3)))) || error_out_of_memory(e);
}

static bool split_begin(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    (void)self;
    if (!make_state(s, e) || !suspension_find(s, relisted, e))
        return false;
    const struct moment now = moment_of(s, 0.0);
    if (s->measuring)
        suspension_add_forces(s, FRICTION | NOISE, &now);   /* part of the stress at the start, but not of the first kick */
    suspension_add_forces(s, POTENTIAL, &now);
    return true;
}

/* U, W over dt at fixed positions; particles' forces are those of the mean velocity afterwards. */
static bool friction_step(const struct dynamics *self, struct suspension *s, struct error *e)
{
    (void)self;
    if (!make_state(s, e))
        return false;
    struct friction *f = &((struct split_state *)s->dynamics_state)->friction;
    const struct moment now = moment_of(s, 0.0);
    const bool measuring = s->measuring;
    if (s->friction_sweeps)
        return sweeps_step(f, s, e);
    if (!friction_gather(f, s, s->dt, e))
        return false;
    s->measuring = false;
    suspension_add_forces(s, FRICTION | NOISE, &now);
    if (!friction_solve(f, s, s->friction_residual, e))
        return false;
    friction_move(f, &s->particles, 1.0);                   /* the mean velocity, for the stress of what was applied */
    s->measuring = measuring;
    if (measuring)
        suspension_add_forces(s, FRICTION | NOISE, &now);
    friction_move(f, &s->particles, 1.0);
    return true;
}

/* Mean velocity of the two drifts: v' less half the friction step's change. Taken after wrapping, which moved v' alike. */
static void mean_motion(struct split_state *own, const struct particles *p)
{
    const struct friction *f = &own->friction;
    for (int i = 0; i < p->count; i++) {
        const double *c = f->change + i * f->width;
        own->mean_velocity[i] = minus(p->velocity[i], vec(c[0], c[1], c[2]));
        if (p->spin)
            own->mean_spin[i] = minus(p->spin[i], vec(c[3], c[4], c[5]));
    }
}

static bool split_step(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    struct split_state *own = s->dynamics_state;
    bool halfway;
    kick(s, 0.5 * s->dt, 0.5 * s->dt);
    drift(s, 0.5 * s->dt);
    s->step++;
    box_set_time(&s->box, s->start_time + ((double)s->step - 0.5) * s->dt);
    if (!suspension_find(s, &halfway, e) || !friction_step(self, s, e))
        return false;
    drift(s, 0.5 * s->dt);
    box_set_time(&s->box, s->start_time + (double)s->step * s->dt);
    if (!suspension_find(s, relisted, e))
        return false;
    *relisted = *relisted || halfway;
    mean_motion(own, &s->particles);
    struct moment now = moment_of(s, s->dt);
    now.drift_velocity = own->mean_velocity;
    now.drift_spin = own->mean_spin;
    suspension_add_forces(s, POTENTIAL, &now);
    kick(s, 0.5 * s->dt, 0.0);
    return true;
}

const struct dynamics split = { "split", split_step, split_begin, split_free, friction_step };
