/*
 * Contact histories carried from an old list of candidates to the new one, by (i, j, image). Only for scenes with friction.
 */
#ifndef CORE_HISTORY_H
#define CORE_HISTORY_H

#include "core/neighbours.h"

struct remembered { struct candidate key; vec3 history; };

/* The non-zero histories of the present list, sorted; NULL if there is no memory for them. The caller frees them. */
struct remembered *history_remember(const struct neighbours *n, int *kept, struct error *e);

/* Histories for a new list: those remembered, zero for new pairs. */
void history_recall(struct neighbours *n, const struct remembered *old, int kept, struct error *e);

#endif
