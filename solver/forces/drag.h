/* Stokes drag: what the noise of the same drag needs to know. */
#ifndef FORCES_DRAG_H
#define FORCES_DRAG_H

#include "core/suspension.h"

struct drag {
    struct force base;
    double viscosity;                   /* eta [M/(L T)] */
    bool torque;                        /* spheres are also held to the liquid's rotation */
};

static inline double drag_of(const struct drag *law, double a) { return 6.0 * M_PI * law->viscosity * a; }
static inline double spin_drag_of(const struct drag *law, double a) { return 8.0 * M_PI * law->viscosity * a * a * a; }

#endif
