/*
 * What a checkpoint holds, as one table: each row a name and where the bytes live. Saving walks the table and writes,
 * loading walks the same table and reads, so that the two cannot drift apart.
 *
 * A row of fixed size must find as many bytes in the file as it has. A `grown` row is an array that may have any length:
 * saving writes `size` bytes of it, loading makes it anew with what the file holds. Its count is a row of its own.
 */
#ifndef CORE_FIELDS_H
#define CORE_FIELDS_H

#include "core/error.h"

#include <stddef.h>

enum { MAX_FIELDS = 192 };

struct field {
    const char *name;                               /* at most 39 letters */
    void *at;                                       /* fixed size */
    void *grown;                                    /* or where the pointer to an array on the heap is kept */
    size_t size;                                    /* bytes */
    bool (*loaded)(void *owner, struct error *e);   /* called once the bytes are in place; NULL: nothing to do */
    void *owner;
};

struct fields { int count; struct field field[MAX_FIELDS]; };

static inline void fields_take(struct fields *f, struct field one)
{
    if (f->count < MAX_FIELDS)
        f->field[f->count] = one;
    f->count++;                                     /* past the end: the checkpoint refuses the table */
}

static inline void fields_add(struct fields *f, const char *name, void *at, size_t size)
{
    fields_take(f, (struct field){ .name = name, .at = at, .size = size });
}

static inline void fields_grown(struct fields *f, const char *name, void *grown, size_t size)
{
    fields_take(f, (struct field){ .name = name, .grown = grown, .size = size });
}

#endif
