/*
 * Points of a table of sheared runs: each the case's scene with some numbers changed. In `parameters.points`, each with
 *
 *     name, x             what it is called, and where it stands in a plot
 *     rate, density       of the first shear, of all species
 *     set                 any path of the scene and its value: { "forces.contact.friction": 0.5 }
 *     phi, counts, strain, discard, every, snapshots, ...   in place of the case's own
 *
 * `discard` strains of `strain` are thrown away; stress is written `every` so many steps, `snapshots` frames in what is left.
 */
#ifndef SHEARED_POINT_H
#define SHEARED_POINT_H

#include "dense.h"
#include "flow.h"

/* A number of the point, else of the case. */
double point_number(const struct check_run *run, const json_t *point, const char *key, double otherwise);

/*
 * Realisation k of the point, ready to be asked: all points of a realisation with the same sizes start from the same spheres. False: recorded.
 */
bool point_start(struct check_run *run, const json_t *point, int k, struct dense_start *s, struct flow *flow);

/* Processor time of all candidates so far. [s] */
double children_seconds(void);

#endif
