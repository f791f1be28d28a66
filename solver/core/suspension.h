/*
 * A suspension: liquid, cell, particles, the forces that its scene names, and the time. What a step moves.
 */
#ifndef CORE_SUSPENSION_H
#define CORE_SUSPENSION_H

#include "core/force.h"
#include "core/neighbours.h"

enum { MAX_FORCES = 16 };

struct suspension {
    double viscosity;                       /* eta  [M/(L T)] */
    double kT;                              /*      [M L^2/T^2] */
    int dimensions;
    bool rotates;                           /* particles spin */
    struct noise_key { uint32_t seed, realisation; } key;
    struct box box;
    struct particles particles;
    struct neighbours neighbours;
    struct force *force[MAX_FORCES];
    int force_count;
    struct stress stress;
    int kinetic_origin;
    bool measuring;                         /* the next evaluation also sums the stress */
    double overlap_limit;                   /* a run stops at a deeper one; fraction of the smaller radius */
    void *dynamics_state;                   /* what the equation of motion keeps between steps */
    bool implicit_friction, friction_sweeps, predicted_friction;    /* solved (all at once, or pair by pair), or at predicted velocities */
    double friction_residual;               /* to which an implicit friction step is solved */
    int64_t step;
    double start_time, dt;                  /* time = start_time + step dt */
};

/* The present moment after a drift at the particles' own velocities; of no duration: nothing has moved. */
static inline struct moment moment_of(const struct suspension *s, double drift_time)
{
    return (struct moment){ &s->box, s->step, s->dt, s->particles.velocity, s->particles.spin, drift_time };
}

const struct force *suspension_force(const struct suspension *s, const char *name);     /* NULL: the scene has none */

/* Takes up a force: its range, its stress rows, what it keeps. */
void suspension_take(struct suspension *s, struct force *f);

/* Pairs at the present positions; forces of these kinds on them, in place of those before. The stress is only added to. */
bool suspension_find(struct suspension *s, bool *relisted, struct error *e);
void suspension_add_forces(struct suspension *s, unsigned kinds, const struct moment *now);
/* In two dimensions no force leaves the plane and no torque lies in it. */
void suspension_flatten(struct suspension *s);
void suspension_free(struct suspension *s);

#endif
