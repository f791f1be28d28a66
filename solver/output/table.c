#include "output/table.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool destination_make(struct destination *to, const char *folder, struct error *e)
{
    snprintf(to->folder, sizeof to->folder, "%s", folder);
    if (mkdir(folder, 0777) == 0 || errno == EEXIST)
        return true;
    return error_raise(e, ERROR_RUN, "%s cannot be made: %s", folder, strerror(errno));
}

bool table_open(struct table *t, const struct destination *to, const char *name, struct error *e)
{
    snprintf(t->path, sizeof t->path, "%s/%s", to->folder, name);
    t->file = fopen(t->path, to->resuming ? "a" : "w");
    if (!t->file)
        return error_raise(e, ERROR_RUN, "%s cannot be written: %s", t->path, strerror(errno));
    fputs(to->provenance, t->file);
    return true;
}

bool table_check(struct table *t, struct error *e)
{
    if (fflush(t->file) != 0 || ferror(t->file))
        return error_raise(e, ERROR_RUN, "%s could not be written in full: %s", t->path, strerror(errno));
    t->length = (int64_t)ftello(t->file);
    return true;
}

static bool cut_back(void *table, struct error *e)
{
    struct table *t = table;
    struct stat info;
    if (fflush(t->file) != 0 || fstat(fileno(t->file), &info) != 0 || ftruncate(fileno(t->file), (off_t)t->length) != 0)
        return error_raise(e, ERROR_RUN, "%s cannot be cut back to %lld bytes: %s", t->path, (long long)t->length, strerror(errno));
    return (int64_t)info.st_size >= t->length ||
           error_raise(e, ERROR_INPUT, "%s is shorter than the %lld bytes that the checkpoint knows of", t->path, (long long)t->length);
}

void table_remember(struct table *t, const char *name, struct fields *f)
{
    fflush(t->file);
    fsync(fileno(t->file));                     /* a checkpoint must not know more than the disk */
    if (t->length == 0)
        t->length = (int64_t)ftello(t->file);   /* a header and no row yet; a resumed run has the length from its checkpoint */
    fields_take(f, (struct field){ .name = name, .at = &t->length, .size = sizeof t->length, .loaded = cut_back, .owner = t });
}

bool table_close(struct table *t, struct error *e)
{
    if (!t->file)
        return true;
    const bool good = table_check(t, e), closed = fclose(t->file) == 0;
    t->file = NULL;
    return (good && closed) || error_raise(e, ERROR_RUN, "%s could not be written in full: %s", t->path, strerror(errno));
}

bool table_open_whole(struct table *t, const struct destination *to, const char *name, struct error *e)
{
    char fresh[200];
    struct destination anew = *to;
    anew.resuming = false;
    snprintf(fresh, sizeof fresh, "%s.tmp", name);
    return table_open(t, &anew, fresh, e);
}

bool table_place(struct table *t, struct error *e)
{
    char path[sizeof t->path];
    snprintf(path, sizeof path, "%.*s", (int)strlen(t->path) - 4, t->path);
    if (!table_close(t, e))
        return false;
    return rename(t->path, path) == 0 || error_raise(e, ERROR_RUN, "%s cannot be named %s: %s", t->path, path, strerror(errno));
}
