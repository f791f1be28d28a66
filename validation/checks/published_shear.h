/* Layer 7, sheared suspensions: what the parts share. See published_shear.c. */
#ifndef PUBLISHED_SHEAR_H
#define PUBLISHED_SHEAR_H

#include "dense.h"
#include "flow.h"

/*
 * Quantities of a point, one number per realisation. After those of flow.h, from snapshots of where the particles are:
 * ANISOTROPY   (c - e)/(c + e): pairs nearer than xi = 0.05 on the compressive side (n_x n_y rate < 0) and on the extensional one
 * ANISOTROPY_CONTACT   the same of pairs nearer than xi = 0.005
 * FABRIC       |<exp(2 i angle)>| of pairs nearer than xi = 0.05 in the flow-gradient plane: 0 if all directions are alike, 1 if all are one
 * STRUCTURAL   structural Brownian viscosity, shell 0.05 a; STRUCTURAL_THIN: shell 0.02 a; STRUCTURAL_ZERO: both extrapolated to 0
 * OVERLAP      largest overlap of a pair, relative to the sum of radii
 * PEAK_11, PEAK_12, PEAK_22   where g(r) is largest near the sum of radii of two species [radius of the first species]
 */
enum {
    ANISOTROPY = FLOW_QUANTITIES, ANISOTROPY_CONTACT, FABRIC, STRUCTURAL, STRUCTURAL_THIN, STRUCTURAL_ZERO, OVERLAP, PEAK_11, PEAK_12, PEAK_22,
    POINT_QUANTITIES
};

/* g(r) of all pairs up to STRUCTURE_RANGE radii, and g at contact (xi < 0.05) in the flow-gradient plane against the angle from the flow. */
enum { STRUCTURE_BINS = 200, STRUCTURE_ANGLES = 24 };
#define STRUCTURE_RANGE 4.0
struct structure { double g[STRUCTURE_BINS], ring[STRUCTURE_ANGLES], snapshots; };

/*
 * Read out/trajectory.csv of a run that began at `s`. Fills quantities from ANISOTROPY on in `value`, and adds to `sum` (which
 * starts as zeros; divide by sum->snapshots). False: recorded.
 */
bool structure_read(struct check_run *run, const char *out, const struct dense_start *s, double discard, double value[POINT_QUANTITIES],
                    struct structure *sum);

#endif
