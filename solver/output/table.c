#include "output/table.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

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
    t->file = fopen(t->path, "w");
    if (!t->file)
        return error_raise(e, ERROR_RUN, "%s cannot be written: %s", t->path, strerror(errno));
    fputs(to->provenance, t->file);
    return true;
}

bool table_check(struct table *t, struct error *e)
{
    if (fflush(t->file) != 0 || ferror(t->file))
        return error_raise(e, ERROR_RUN, "%s could not be written in full: %s", t->path, strerror(errno));
    return true;
}

bool table_close(struct table *t, struct error *e)
{
    if (!t->file)
        return true;
    const bool good = table_check(t, e), closed = fclose(t->file) == 0;
    t->file = NULL;
    return (good && closed) || error_raise(e, ERROR_RUN, "%s could not be written in full: %s", t->path, strerror(errno));
}
