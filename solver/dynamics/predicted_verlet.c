/*
 * Velocity Verlet with predicted velocities in the forces
 *
 *     kick    U = U_n + dt/2 a_n            half-step velocity: this one moves the particles
 *     drift   x += dt U
 *             box to t + dt; pairs
 *     force   a_{n+1} = F(x, U + dt/2 a_n)/m        at the full-step velocity that the old forces predict
 *     kick    U_{n+1} = U + dt/2 a_{n+1}
 *
 * The prediction is right to dt^2, so the scheme is second order for forces that depend smoothly on velocity too (drag,
 * lubrication); with half-step velocities it would be first. Stable while w^2 dt^2 + 4 g dt < 4: half the friction that `verlet` bears.
 *
 * With noise of linear drag, eps = drag dt/m, exact at any step: full-step <U^2> = (kT/m)/(1 + eps/2), low to first order, while half-step
 * <U^2> = (kT/m)(1 - eps/2)/((1 - eps)(1 + eps/2)) is right to eps^2. So where friction changes with the gap, density is wrong to second order
 * only: (1 - eps)^(1/3) (1 + eps/2)^(2/3), about 1 - eps^2/4 (derived in docs/integrators.md). Source: Groot & Warren (1997), lambda = 1.
 */
#include "core/motion.h"
#include "dynamics/dynamics.h"

#include <stdlib.h>

struct half_step { vec3 *velocity, *spin; };

static void predicted_free(struct suspension *s)
{
    struct half_step *half = s->dynamics_state;
    if (!half)
        return;
    free(half->velocity);
    free(half->spin);
    free(half);
    s->dynamics_state = NULL;
}

static bool predicted_begin(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    const size_t n = (size_t)s->particles.count + 1;
    if (!s->dynamics_state) {
        struct half_step *half = calloc(1, sizeof *half);
        s->dynamics_state = half;
        if (!half || !(half->velocity = calloc(n, sizeof(vec3))) || !(half->spin = calloc(n, sizeof(vec3))))
            return error_out_of_memory(e);
    }
    return verlet.begin(self, s, relisted, e);
}

/*
 * In a flow that changes, forces at predicted velocities want the images of that moment, too; with those of the middle of the step a pair across a
 * face would be wrong to first order. Histories follow the half-step velocities and keep the images of the middle: they get the difference back.
 */
static void predict_images(struct suspension *s)
{
    const struct particles *p = &s->particles;
    struct box *b = &s->box;
    struct near_pairs *near = &s->neighbours.near;
    for (int k = 0; b->flow && k < near->count; k++) {
        struct pair *pair = &near->pair[k];
        const vec3 offset = minus(scaled(pair->normal, pair->distance), minus(p->position[pair->j], p->position[pair->i]));
        const vec3 more = minus(mat3_times(&b->gradient, offset), mat3_times(&b->image_gradient, offset));
        pair->image_velocity = plus(pair->image_velocity, more);
        if (pair->history)
            *pair->history = plus(*pair->history, scaled(more, s->dt));
    }
    b->image_gradient = b->gradient;                        /* drag alike */
}

static bool predicted_step(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    struct half_step *half = s->dynamics_state;
    struct particles *p = &s->particles;
    (void)self;
    kick(s, 0.5 * s->dt, 0.5 * s->dt);
    drift(s, s->dt);
    s->step++;
    box_set_time(&s->box, s->start_time + (double)s->step * s->dt);
    if (!suspension_find(s, relisted, e))
        return false;
    for (int i = 0; i < p->count; i++) {                    /* kept after wrapping, which may have changed them */
        half->velocity[i] = p->velocity[i];
        if (p->spin)
            half->spin[i] = p->spin[i];
    }
    kick(s, 0.5 * s->dt, 0.0);                              /* predicts, with the old forces */
    predict_images(s);
    struct moment now = moment_of(s, s->dt);
    now.drift_velocity = half->velocity;
    now.drift_spin = half->spin;
    suspension_add_forces(s, ALL_KINDS, &now);
    for (int i = 0; i < p->count; i++) {
        p->velocity[i] = half->velocity[i];
        if (p->spin)
            p->spin[i] = half->spin[i];
    }
    kick(s, 0.5 * s->dt, 0.0);
    return true;
}

const struct dynamics predicted_verlet = { "predicted_verlet", predicted_step, predicted_begin, predicted_free, NULL };
