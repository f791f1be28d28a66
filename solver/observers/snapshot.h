/*
 * All pairs within a distance of one's own choice, at one moment: a search on copies, so that looking leaves the run's own
 * list alone. All images are found, however small the cell.
 */
#ifndef OBSERVERS_SNAPSHOT_H
#define OBSERVERS_SNAPSHOT_H

#include "core/suspension.h"

struct snapshot { struct box box; struct particles particles; struct neighbours search; /* its `near` has the pairs */ };

/* Pairs whose centres are nearer than `distance` or whose gap is below `gap`. */
bool snapshot_take(struct snapshot *at, const struct suspension *s, double distance, double gap, struct error *e);
void snapshot_free(struct snapshot *at);

#endif
