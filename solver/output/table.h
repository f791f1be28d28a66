/* Tables that grow: CSV with provenance lines above the header. */
#ifndef OUTPUT_TABLE_H
#define OUTPUT_TABLE_H

#include "core/observer.h"

#include <stdio.h>

/* The folder that a run writes to; made if it is not there. */
bool destination_make(struct destination *to, const char *folder, struct error *e);

/* length: as far as it has been written, for checkpoints. found: how long it was when a resumed run opened it, until the checkpoint has been put in place. */
struct table { FILE *file; char path[512]; int64_t length; bool resumed; int64_t found; };

/* A run that is resumed goes on with the table that is there; its header, written again, is cut off with the rest. One that is not gone
 * on with after all is left as it was. */
bool table_open(struct table *t, const struct destination *to, const char *name, struct error *e);
/* Fails if anything of the table was not written: the disk may be full. */
bool table_check(struct table *t, struct error *e);
/* The row of a checkpoint that holds how long the table is; on resume the table is cut back to that. */
void table_remember(struct table *t, const char *name, struct fields *f);
bool table_close(struct table *t, struct error *e);

/* Tables that are written as a whole at the end of a run: under a temporary name until they are complete. */
bool table_open_whole(struct table *t, const struct destination *to, const char *name, struct error *e);
bool table_place(struct table *t, struct error *e);

#endif
