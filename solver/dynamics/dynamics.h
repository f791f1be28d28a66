/* Every equation of motion. */
#ifndef DYNAMICS_H
#define DYNAMICS_H

#include "core/dynamics.h"

extern const struct dynamics verlet, predicted_verlet, split;

#endif
