/* What observers that write a row each time have in common: a growing table, its place in a checkpoint, scratch memory. */
#ifndef OBSERVERS_ROWS_H
#define OBSERVERS_ROWS_H

#include "observers/observers.h"

struct rows { struct observer base; struct table table; const char *file; void *scratch; };

/* An observer of `size` bytes that begins with struct rows, due at "every" so many steps; NULL without memory. */
void *rows_new(size_t size, const char *file, struct settings *s, struct error *e);
bool rows_open(struct rows *o, const struct destination *to, size_t scratch, struct error *e);
FILE *rows_begin(struct rows *o, const struct suspension *s);           /* prints step and time */
bool rows_end(struct rows *o, struct error *e);

#endif
