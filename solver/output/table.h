/* Tables that grow: CSV with provenance lines above the header. */
#ifndef OUTPUT_TABLE_H
#define OUTPUT_TABLE_H

#include "core/observer.h"

#include <stdio.h>

/* The folder that a run writes to; made if it is not there. */
bool destination_make(struct destination *to, const char *folder, struct error *e);

struct table { FILE *file; char path[512]; };

bool table_open(struct table *t, const struct destination *to, const char *name, struct error *e);
/* Fails if anything of the table was not written: the disk may be full. */
bool table_check(struct table *t, struct error *e);
bool table_close(struct table *t, struct error *e);

#endif
