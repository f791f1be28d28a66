#include "observers/rows.h"

#include <stdlib.h>

static void rows_remember(struct observer *self, struct fields *f)
{
    struct rows *o = (struct rows *)self;
    table_remember(&o->table, o->file, f);
}

static bool rows_close(struct observer *self, struct error *e)
{
    struct rows *o = (struct rows *)self;
    const bool good = table_close(&o->table, e);
    free(o->scratch);
    free(o);
    return good;
}

void *rows_new(size_t size, const char *file, struct settings *s, struct error *e)
{
    struct rows *o = calloc(1, size);
    if (!o)
        return error_out_of_memory(e), NULL;
    o->file = file;
    o->base.remember = rows_remember;
    o->base.close = rows_close;
    o->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    return o;
}

bool rows_open(struct rows *o, const struct destination *to, size_t scratch, struct error *e)
{
    o->scratch = calloc(1, scratch + 1);
    return (o->scratch || error_out_of_memory(e)) && table_open(&o->table, to, o->file, e);
}

FILE *rows_begin(struct rows *o, const struct suspension *s)
{
    fprintf(o->table.file, "%lld,%.17g", (long long)s->step, s->box.time);
    return o->table.file;
}

bool rows_end(struct rows *o, struct error *e)
{
    fputc('\n', o->table.file);
    return table_check(&o->table, e);
}
