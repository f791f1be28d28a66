/* What the engine cannot do. */
#ifndef ENGINE_REFUSE_H
#define ENGINE_REFUSE_H

#include "simulation.h"

/* False with a sentence and exit code 2 if the scene has something that the engine has not. */
bool engine_can(const struct simulation *sim, struct error *e);

#endif
