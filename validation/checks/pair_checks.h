/* The checks of layer 1, one or two to a file; pair.c lists them. */
#ifndef PAIR_CHECKS_H
#define PAIR_CHECKS_H

#include "pair.h"

void pair_forces(struct check_run *run);        /* force, torque, stress of frozen pairs, one force at a time */
void pair_resistance(struct check_run *run);    /* R column by column, and its coefficients one by one */
void pair_frames(struct check_run *run);        /* the same pair inside the box, across its faces, moved, turned */
void pair_rigid(struct check_run *run);         /* rigid motion feels no lubrication, but for the known h/r */
void pair_crowd(struct check_run *run);         /* many spheres in a strained or small box, against all images */
void pair_drawn(struct check_run *run);         /* the same for scenes drawn at random */
void pair_drag(struct check_run *run);          /* one-body drag in many flows */
void pair_units(struct check_run *run);         /* the same scene in other units */
void pair_repulsion(struct check_run *run);     /* exponential repulsion and its cut-off */
void pair_applied(struct check_run *run);       /* constant forces and torques by species */
void pair_cut_off(struct check_run *run);       /* exactly at the cut-offs of lubrication and repulsion */

#endif
