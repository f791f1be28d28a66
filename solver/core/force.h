/*
 * What a force is. One file of forces/ each: a struct that begins with this one, its functions, its constructor.
 */
#ifndef CORE_FORCE_H
#define CORE_FORCE_H

#include "core/box.h"
#include "core/pairs.h"
#include "core/stress.h"

#include <stdint.h>

/* When and after what motion forces are asked for. */
struct moment {
    const struct box *box;
    int64_t step;                           /* number of the step: the noise's clock */
    double dt;                              /* its length: the noise's strength [T] */
    const vec3 *drift_velocity, *drift_spin;/* of the displacement just made, which histories follow */
    double drift_time;                      /* its duration; 0: nothing has moved since the last evaluation [T] */
};

/* How a force answers a small change of a pair: for the step limit. */
struct response { double normal_stiffness, tangential_stiffness, normal_dashpot, tangential_dashpot; struct resistance resistance; };

/* What a force depends on tells a step when to ask for it: positions (and histories); velocities, linearly; chance. */
enum force_kind { POTENTIAL = 1, FRICTION = 2, NOISE = 4, ALL_KINDS = 7 };

struct force {
    const char *name;
    const char *origin_name[2];             /* of its stress; NULL: books none */
    int origin[2];                          /* their rows in the stress */
    enum force_kind kind;
    bool rotates;                           /* reads spins or gives torques */
    bool keeps_history, keeps_resistance, keeps_anchor;     /* what it needs of the pair list, of the particles */
    double range_factor;                    /* pairs nearer than range_factor (a_i + a_j) feel it; 0: not a pair force */

    /* Adds to the forces and torques of `p`; to `stress` too when somebody measures (else it is NULL). */
    void (*add)(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now, struct stress *stress);
    /* Adds the stiffness and resistance of species a, b at a gap; of a lone sphere: rates of drag per mass and inertia. NULL: none. */
    void (*respond)(const struct force *self, const struct particles *p, int a, int b, double gap, struct response *r);
    void (*respond_alone)(const struct force *self, const struct particles *p, int a, double *drag, double *spin_drag);
    double (*stiffness_alone)(const struct force *self, const struct particles *p, int a);      /* of a lone sphere [M/T^2]; NULL: none */
};

#endif
