/* Pair lubrication: what the noise of the same pairs needs to know. */
#ifndef FORCES_LUBRICATION_H
#define FORCES_LUBRICATION_H

#include "core/suspension.h"

struct lubrication {
    struct force base;
    double inner_gap, outer_gap;        /* xi_min, xi_max */
    bool exact_rotation;
    struct resistance_sizes sizes[MAX_SPECIES][MAX_SPECIES];
};

/* xi = 2 h/(a_i + a_j); the sum of radii is the distance less the gap. */
static inline double lubrication_gap(const struct pair *pair) { return 2.0 * pair->gap / (pair->distance - pair->gap); }

#endif
