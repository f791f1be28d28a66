/* Reasons of failures, folders, file hashes, and dotted paths inside a JSON scene. */
#include "tables.h"

#include <errno.h>
#include <ftw.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

bool why_not(char why[WHY_LENGTH], const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, WHY_LENGTH, format, arguments);
    va_end(arguments);
    return false;
}

void path_join(char path[PATH_LENGTH], const char *folder, const char *name)
{
    if (snprintf(path, PATH_LENGTH, "%s/%s", folder, name) >= PATH_LENGTH)
        path[PATH_LENGTH - 1] = '\0';
}

bool folder_make(const char *path, char why[WHY_LENGTH])
{
    char part[PATH_LENGTH];
    snprintf(part, sizeof part, "%s", path);
    for (char *at = part + 1;; at++) {
        const char here = *at;
        if (here != '/' && here != '\0')
            continue;
        *at = '\0';
        struct stat there;
        if (mkdir(part, 0777) != 0 && !(errno == EEXIST && stat(part, &there) == 0 && S_ISDIR(there.st_mode)))
            return why_not(why, "cannot make the folder %s: %s", part, strerror(errno));
        *at = here;
        if (here == '\0')
            return true;
    }
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status;
    (void)kind;
    (void)where;
    return remove(path);
}

bool folder_remove(const char *path)
{
    return nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS) == 0 || errno == ENOENT;
}

uint64_t file_hash(const char *path, uint64_t start)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return start;
    unsigned char buffer[65536];
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, file)) > 0;)
        for (size_t k = 0; k < n; k++)
            start = (start ^ buffer[k]) * UINT64_C(1099511628211);
    fclose(file);
    return start;
}

/* The next key of a dotted path; false at its end. */
static bool next_key(const char **path, char key[64])
{
    const size_t n = strcspn(*path, ".");
    if (n == 0)
        return false;
    snprintf(key, 64, "%.*s", (int)n, *path);
    *path += n + ((*path)[n] == '.');
    return true;
}

json_t *scene_get(const json_t *scene, const char *path)
{
    char key[64];
    json_t *at = (json_t *)(uintptr_t)scene;
    while (at && next_key(&path, key))
        at = json_object_get(at, key);
    return at;
}

double scene_number(const json_t *scene, const char *path, double otherwise)
{
    const json_t *found = scene_get(scene, path);
    return json_is_number(found) ? json_number_value(found) : otherwise;
}

bool scene_set(json_t *scene, const char *path, json_t *value)
{
    char key[64], deeper[64];
    next_key(&path, key);
    while (next_key(&path, deeper)) {
        json_t *inner = json_object_get(scene, key);
        if (!json_is_object(inner)) {
            inner = json_object();
            json_object_set_new(scene, key, inner);
        }
        scene = inner;
        snprintf(key, sizeof key, "%s", deeper);
    }
    return json_object_set_new(scene, key, value) == 0;
}
