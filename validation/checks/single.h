/*
 * Layer 3, shared parts: many free spheres in one box, each a realisation of its own (nothing acts between them), run by the
 * candidate, and where they are at given steps.
 */
#ifndef SINGLE_H
#define SINGLE_H

#include "pair.h"

/* What trajectory.csv says of one sphere at one step. `turn`: angle turned through since the start; NaN where it is not given. */
struct track_point { double x[3], u[3], w[3], turn[3]; };
struct track { size_t steps, count; struct track_point *point; /* [step asked for][id - 1] */ };

/*
 * Run `scene` from these states for at[steps - 1] steps and read the spheres at each step of `at` (ascending). The scene gets its
 * run and output from here, with the angles turned through where it says that spheres turn. False: recorded already.
 */
bool track_ask(struct check_run *run, const char *name, json_t *scene, const struct state_row *start, size_t count, const int *at,
               size_t steps, struct track *t);
/* Its two halves, for those who ask for more outputs: what to write into the scene before asking, and the reading. */
void track_want(json_t *scene, const int *at, size_t steps);
bool track_load(struct check_run *run, const char *out, const int *at, size_t steps, size_t count, struct track *t);
/* The k-th lag of a table, from 1, in samples: 1 to 16, then 9 to 16 times each power of 2; and how many a run of so many samples has. */
size_t lag_of(size_t k);
size_t lags_due(double levels, size_t samples);
/* Whether a time that was written, however few digits it has, is this moment. */
bool time_is(double said, double time, double dt);
const struct track_point *track_at(const struct track *t, size_t step, size_t sphere);
void track_free(struct track *t);

/* Mass, moment of inertia and frictions of a sphere of species 1. */
struct free_sphere { double radius, mass, inertia, friction, spin_friction; };
struct free_sphere free_sphere(const struct model *m);

/* Stages as a scene's text says them, durations from strains too; returns how many. And the integral of their G from 0 to t, in closed form. */
enum { STAGES = 8 };
size_t stages_read(const json_t *list, struct theory_stage stage[STAGES]);
void stages_strain(const struct theory_stage *stage, size_t stages, double t, double S[3][3]);

void check_langevin(struct check_run *run);
void check_shear(struct check_run *run);
void check_tether(struct check_run *run);
void check_stages(struct check_run *run);
void check_stages_drawn(struct check_run *run);
void check_run_length(struct check_run *run);
void check_thermal(struct check_run *run);
void check_random_start(struct check_run *run);
void check_stages_moments(struct check_run *run);
void check_stages_pair(struct check_run *run);
void check_noise_period(struct check_run *run);

#endif
