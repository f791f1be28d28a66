/*
 * Layer 4, shared parts: pairs of spheres, each pair alone in a box of its own stretch, run by the candidate at three steps and solved
 * by theory/pair_motion.c.
 */
#ifndef TWO_BODIES_H
#define TWO_BODIES_H

#include "single.h"

enum { REFINEMENTS = 3 };       /* dt, dt/2, dt/4 */

/* Pairs at places of their own; `start` is relative to the pair's origin. */
struct bodies {
    size_t pairs;
    struct theory_motion *motion;
    struct theory_pair_state *start;
    double (*origin)[3];
    int (*species)[2];      /* from 1; 0: the one with the radius */
};
bool bodies_make(struct bodies *b, size_t pairs);
void bodies_free(struct bodies *b);
/* Rows of states.csv, two to a pair. Caller frees. */
struct state_row *bodies_rows(const struct bodies *b, const struct model *m);
/* Where a scene says its time step: "dynamics.verlet.dt" and the like. */
void step_key(const json_t *scene, char path[96]);
/* The forces that the scene declares; the laws live in the model, which must outlive it. */
struct theory_motion bodies_motion(const struct model *m, double radius_1, double radius_2);

/* Errors of one kind of quantity: at each step, between successive steps, and of the value extrapolated to dt = 0. */
struct convergence { const char *name; double at[REFINEMENTS]; struct worst extrapolated; };
enum { PLACE, VELOCITY, SPIN, GAP, QUANTITIES };

struct comparison {
    struct convergence of[QUANTITIES];
    size_t times;
    double *time, *gap, *gap_expected;      /* [time][pair]: of the finest run */
    struct theory_pair_state *expected;     /* [time][pair] */
    struct track track[REFINEMENTS];
};
/*
 * Run `scene` for the steps in `at` (of size dt; at dt/2 twice as many) and compare. `speed` is what velocities are measured
 * against. `orders`: powers of dt to extrapolate away, 1 (once) or 2 (dt and dt^2). False: recorded already.
 */
bool bodies_compare(struct check_run *run, const char *name, json_t *scene, const struct bodies *b, double dt, const int *at, size_t times,
                    double speed, int orders, struct comparison *c);
void comparison_free(struct comparison *c);
/* Results: errors at dt within `coarse` (of the gap, parameters.coarse_gap where it is said), halving with it, and the extrapolated values within the tolerance of the case. */
void bodies_judge(struct check_run *run, const char *label, const struct comparison *c, const struct bodies *b, double coarse);
void bodies_picture(struct check_run *run, const struct comparison *c, const struct bodies *b, const char *title);

void check_encounter(struct check_run *run);
void check_approach(struct check_run *run);
void check_pushed(struct check_run *run);
void check_equipartition(struct check_run *run);
void check_boltzmann(struct check_run *run);
void check_trapped_pair(struct check_run *run);
void check_metamorphic(struct check_run *run);
void check_sheared_pairs(struct check_run *run);
void check_observers(struct check_run *run);
void check_resume(struct check_run *run);
void check_flat(struct check_run *run);
void check_grip_lost(struct check_run *run);
void check_passing(struct check_run *run);
void check_flat_dynamics(struct check_run *run);

void check_drawn_step(struct check_run *run);
void check_sliding(struct check_run *run);

#endif
