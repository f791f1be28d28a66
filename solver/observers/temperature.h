/* Mean kinetic energies, for the table and for averages. */
#ifndef OBSERVERS_TEMPERATURE_H
#define OBSERVERS_TEMPERATURE_H

#include "core/suspension.h"

/* <m c_k^2> and <I w_k^2> of the particles of one species (-1: all) along each axis; how many particles. */
int temperatures_of(const struct suspension *s, int species, double translation[3], double rotation[3]);

#endif
