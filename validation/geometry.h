/* The cell of a scene and the pairs of spheres that are near each other in it: what it takes to say how delicate a question is. */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include "tables.h"

/* Cell vectors (rows) at the start's time and velocity gradient. False where the scene leaves them open: stages, random starts, no box. */
bool scene_cell(const json_t *scene, double cell[3][3], double gradient[3][3]);

struct near_pair { size_t first, i, j; /* rows: of the state, of its two spheres */ double a[2], gap; };
/*
 * Calls `see` for every pair of one state whose gap is below `reach` (a_i + a_j), every image by itself, also of a sphere with itself. `row`: all
 * states one after the other, as in states.csv.
 */
void near_pairs(const json_t *scene, const struct state_row *row, size_t rows, double reach,
                void (*see)(void *context, const struct near_pair *pair), void *context);
/* The largest gap over a_i + a_j at which some pair force of the scene acts. */
double scene_reach(const json_t *scene);
double species_number(const json_t *scene, int species, const char *key);   /* species from 1; NaN if there is none */

#endif
