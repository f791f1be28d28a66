/*
 * Layer 3, flows that change with time: what the drives of single_stages.c and the runs of stages_late.c, which begin in the middle of one, have in common.
 */
#ifndef STAGES_H
#define STAGES_H

#include "single.h"

enum { STAGES_SPHERES = 8 };

/* With the flow, every other one thrown; where none is (speed 0) up to two cells away, too: crossing faces is not the only way to feel the cell. */
void stages_place(struct check_run *run, const struct model *m, const struct theory_stage *stage, size_t stages, double speed, struct state_row start[STAGES_SPHERES]);

/* The moments of a table: every so many steps, `rows` in all; `travelled`: the strain before the run began. */
struct rows_of_run { double begin, dt, travelled; int every; size_t rows; };

/* Drag's stress and the strain of every row against the flow of that moment. False after recording that it cannot be read. */
bool stages_judge_flow(struct check_run *run, const char *drive, const char *name, const struct model *m, const struct theory_stage *stage, size_t stages,
                       const struct rows_of_run *of);

/* A run of free spheres through these stages that begins in the middle. False: no answer; recorded already. */
bool stages_try_late(struct check_run *run, const json_t *drive, size_t number, double begin);

#endif
