/* What an equation of motion is: one file of dynamics/ each, which spells its step. */
#ifndef CORE_DYNAMICS_H
#define CORE_DYNAMICS_H

#include "core/suspension.h"

struct dynamics {
    const char *name;
    /* Moves the suspension by s->dt; forces and stresses are then those at the new time. */
    bool (*step)(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e);
    /* Forces at the start, where nothing has moved yet. */
    bool (*begin)(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e);
    void (*free)(struct suspension *s);     /* what it keeps in s->dynamics_state; NULL: nothing */
    bool (*friction)(const struct dynamics *self, struct suspension *s, struct error *e);   /* its friction and noise alone; NULL: it is explicit */
};

#endif
