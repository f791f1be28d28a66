/* What the two halves of the host share: host_start.c sets LAMMPS up, host.c serves it. */
#ifndef HOST_H
#define HOST_H

#include "engine.h"

/* One command of a LAMMPS deck. */
void host_command(const struct engine *g, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* realloc that ends all ranks where there is no memory. */
void *host_grown(const struct engine *g, void *array, size_t size);

/* The callback of `fix external`: everything physical. `engine`: a struct engine. */
void host_evaluate(void *engine, int64_t step, int own, int *id, double **x, double **host_force);

#endif
