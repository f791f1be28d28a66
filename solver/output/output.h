/* What a run writes besides its observers' tables. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include "core/observer.h"
#include "core/settings.h"
#include "output/table.h"

struct observer *dump_new(struct settings *s, struct suspension *of, struct error *e);

/* A line on the terminal that says how far a run is; silent where the error output is no terminal. */
struct progress { double started, shown; int64_t first, last; bool wanted; };
void progress_start(struct progress *p, int64_t first, int64_t last);
void progress_show(struct progress *p, const struct suspension *s);
void progress_end(struct progress *p);

#endif
