/* Questions for forces and for noise, put to a candidate that can only start from given particles and make steps (docs/adapter.md, "steps"). */
#ifndef LEVEL_B_H
#define LEVEL_B_H

#include "check.h"

/*
 * Answers `q` in folder/out as a candidate of level A would have done, from questions of protocol `steps` in folders below `folder`. False: no answer, and
 * what happened has been recorded. Raises run->allowance by what the differences of velocities are uncertain.
 */
bool level_b_ask(struct check_run *run, const char *name, const struct question *q, const char *folder, char out[PATH_LENGTH]);

/* --- its parts --- */

/* Velocities of an answer to `steps`: value[(state (steps + 1) + step) particles + particle][6]. Caller frees. False with file, state, step, particle. */
bool steps_read(const char *out, const struct question *q, size_t states, size_t particles, double (**value)[6], char why[WHY_LENGTH]);
/* Whether the velocities of step 0 are those given, to the roundoff declared. */
bool steps_start(const char *out, const struct question *q, size_t states, size_t particles, const double (*value)[6], double roundoff,
                 char why[WHY_LENGTH]);
bool level_b_noise(struct check_run *run, const char *name, const struct question *q, const char *out);
/* A copy of the scene with this time step of velocity Verlet, and no run or output. */
json_t *steps_scene(const json_t *scene, double dt);
/* Estimates of the friction (force over velocity) of drag and lubrication on each sphere, in its strongest and its weakest direction; on top of what is there. */
void estimate_friction(const json_t *scene, const struct state_row *row, size_t rows, double *strongest, double *weakest);
double mass_of_row(const json_t *scene, const struct state_row *row);

#endif
