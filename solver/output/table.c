#include "output/table.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool destination_make(struct destination *to, const char *folder, struct error *e)
{
    if (snprintf(to->folder, sizeof to->folder, "%s", folder) >= (int)sizeof to->folder)
        return error_raise(e, ERROR_INPUT, "the name of the folder to write to has %zu letters; it may have %zu", strlen(folder), sizeof to->folder - 1);
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
    struct stat info;
    t->resumed = to->resuming && fstat(fileno(t->file), &info) == 0;
    t->found = t->resumed ? (int64_t)info.st_size : 0;
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
    if (t->found < t->length)
        return error_raise(e, ERROR_INPUT, "%s is shorter than the %lld bytes that the checkpoint knows of", t->path, (long long)t->length);
    if (fflush(t->file) != 0 || ftruncate(fileno(t->file), (off_t)t->length) != 0)
        return error_raise(e, ERROR_RUN, "%s cannot be cut back to %lld bytes: %s", t->path, (long long)t->length, strerror(errno));
    t->resumed = false;
    return true;
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
    if (t->resumed && (fflush(t->file) != 0 || ftruncate(fileno(t->file), (off_t)t->found) != 0))
        error_raise(e, ERROR_RUN, "%s cannot be left as it was: %s", t->path, strerror(errno));
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
