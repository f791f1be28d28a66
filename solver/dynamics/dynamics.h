/* Every equation of motion. */
#ifndef DYNAMICS_H
#define DYNAMICS_H

#include "core/dynamics.h"
#include "core/settings.h"

extern const struct dynamics verlet, predicted_verlet, split;

/* The one that the scene names, its settings, and what follows from it for the suspension; then its step. */
bool dynamics_choose(struct settings *root, struct suspension *s, const struct dynamics **d, struct settings *chosen, struct error *e);
bool step_choose(struct settings *chosen, struct suspension *s, struct error *e);

#endif
