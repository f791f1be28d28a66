/* Several images of one pair. */
#ifndef CORE_IMAGES_H
#define CORE_IMAGES_H

#include "core/box.h"

enum { MOST_IMAGES = 100 };     /* along an edge, within a range; cells are not that thin */
/* Is some vector of the lattice shorter than `distance`? Two images of a particle are one such vector apart. */
bool images_meet(const struct box *b, double distance);

#endif
