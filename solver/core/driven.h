/*
 * Driven particles in a flow that changes
 *
 * A driven particle, followed without wrapping, keeps the velocity of its species. What is stored is the velocity of the image in the cell,
 *
 *     U = U_kind - G(t) X,     X the vector of the lattice from that image to the particle itself
 *
 * which changes with G. `ahead`: how far the moment of the velocities is ahead of the box's time; dt/2 between the kicks of velocity Verlet,
 * 0 after the second, when half of a jump of G has been made, as free particles have half of its impulse [T].
 * In steady flow nothing changes.
 */
#ifndef CORE_DRIVEN_H
#define CORE_DRIVEN_H

#include "core/suspension.h"

void driven_keep(struct suspension *s, double ahead);

#endif
