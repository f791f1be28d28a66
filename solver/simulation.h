/* A run: a suspension, its equation of motion, its observers, and how long. */
#ifndef SIMULATION_H
#define SIMULATION_H

#include "core/dynamics.h"
#include "core/observer.h"
#include "output/checkpoint.h"
#include "output/output.h"

enum { MAX_OBSERVERS = 16 };

struct simulation {
    char about[300];
    struct suspension suspension;
    const struct dynamics *dynamics;
    struct observer *observer[MAX_OBSERVERS];
    int observer_count;
    struct destination destination;
    struct checkpoint checkpoint;
    int64_t last_step;
    struct progress progress;
};

/* Forces at the start, and whether the run can begin: no step above its limit, no overlap beyond the model. Writes nothing. */
bool simulation_begin(struct simulation *sim, struct error *e);
/* From there to the last step. */
bool simulation_run(struct simulation *sim, struct error *e);
bool simulation_close(struct simulation *sim, struct error *e);

#endif
