/* See export.h. */
#include "export.h"

#include <dirent.h>
#include <stdio.h>
#include <string.h>

static const char *const kept[] = { "--layer", "--case", "--needs", "--tier", "--seed-offset", "--level", "--capabilities" };

bool export_keeps(const char *option)
{
    for (size_t k = 0; k < sizeof kept / sizeof *kept; k++)
        if (strcmp(option, kept[k]) == 0)
            return true;
    return false;
}

static bool is_empty(const char *folder)
{
    DIR *d = opendir(folder);
    int entries = 0;
    while (d && readdir(d))
        entries++;
    if (d)
        closedir(d);
    return entries <= 2;
}

/* One option to be kept; a file of capabilities as a copy, for the folder may go elsewhere. */
static bool keep(json_t *chosen, const char *folder, const char *key, const char *value, char why[WHY_LENGTH])
{
    char file[PATH_LENGTH];
    json_error_t error;
    bool good = true;
    json_object_set_new(chosen, key, json_string(value));
    if (strcmp(key, "--capabilities") != 0)
        return true;
    json_t *capabilities = json_load_file(value, 0, &error);
    path_join(file, folder, "capabilities.json");
    if (!capabilities)
        good = error.line < 0 ? why_not(why, "%s: %s", value, error.text) : why_not(why, "%s:%d:%d: %s", value, error.line, error.column, error.text);
    else if ((good = folder_make(folder, why)) && json_dump_file(capabilities, file, JSON_INDENT(1)) != 0)
        good = why_not(why, "cannot write %s", file);
    json_object_set_new(chosen, key, json_string(file));
    json_decref(capabilities);
    return good;
}

bool export_begin(const char *folder, int count, char **options, const char *capabilities, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    if (!is_empty(folder))
        return why_not(why, "%s is not empty; export writes to a new folder", folder);
    json_t *chosen = json_object();
    bool good = true;
    for (int k = 0; k + 1 < count && good; k += 2) {
        if (export_keeps(options[k]))
            good = keep(chosen, folder, options[k], options[k + 1], why);
    }
    if (good && capabilities && !json_object_get(chosen, "--capabilities"))
        good = keep(chosen, folder, "--capabilities", capabilities, why);
    path_join(path, folder, "gate-export.json");
    json_t *all = json_pack("{ss sO}", "contract", CONTRACT, "options", chosen);
    if (good && (good = folder_make(folder, why)) && json_dump_file(all, path, JSON_INDENT(1)) != 0)
        good = why_not(why, "cannot write %s", path);
    json_decref(all);
    json_decref(chosen);
    return good;
}

bool export_options(const char *folder, json_t **options, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    json_error_t error;
    path_join(path, folder, "gate-export.json");
    json_t *all = json_load_file(path, 0, &error);
    if (!all)
        return why_not(why, "%s is no folder of `gate export`: %s", folder, error.text);
    *options = json_incref(json_object_get(all, "options"));
    json_decref(all);
    const char *capabilities = json_string_value(json_object_get(*options, "--capabilities"));
    if (capabilities) {         /* the folder may have moved */
        path_join(path, folder, "capabilities.json");
        json_object_set_new(*options, "--capabilities", json_string(path));
    }
    return true;
}
