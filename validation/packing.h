/*
 * Starting states made by the gate itself, so that two candidates can start from the same spheres and neither made them:
 * random centres in a periodic box, pushed apart until nothing overlaps. Independent of any solver.
 */
#ifndef PACKING_H
#define PACKING_H

#include "tables.h"

struct packing_species { double radius; int count; };

/* Edge of the cube in which these spheres take up the volume fraction phi. */
double packing_edge(const struct packing_species *species, int species_count, double phi);

/*
 * Fill `row` (sum of the counts; state 0, ids from 1, species in order) with spheres in the cell
 * [0, edge)^3. Velocities follow the shear u_x = rate y, spins are half its vorticity. False if after many steps some pair
 * still overlaps (too dense: beyond a volume fraction of about 0.6).
 */
bool packing_make(const struct packing_species *species, int species_count, double edge, double rate, unsigned seed,
                  struct state_row *row, char why[WHY_LENGTH]);

/* Largest overlap of any pair, relative to the sum of its radii; negative: the smallest relative gap. */
double packing_overlap(const struct packing_species *species, double edge, const struct state_row *row, int count);

#endif
