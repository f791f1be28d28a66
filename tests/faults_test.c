/* The list of faults must fit the code: each text to replace is there exactly once, or `make faults` tests nothing. */
#include "suite.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int times_in_file(const char *path, const char *text)
{
    FILE *in = fopen(path, "r");
    char *all = calloc(1, 200000);
    int found = 0;
    if (in && all && fread(all, 1, 199999, in) > 0)
        for (const char *at = strstr(all, text); at; at = strstr(at + 1, text))
            found++;
    if (in)
        fclose(in);
    free(all);
    return found;
}

static void list_fits(const char *path, size_t least, bool with_origin)
{
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, NULL), *fault;
    size_t k;
    check_true(json_array_size(json_object_get(root, "faults")) >= least, "the list, read from the top of the checkout");
    json_array_foreach(json_object_get(root, "faults"), k, fault) {
        const char *name = json_string_value(json_object_get(fault, "name")), *file = json_string_value(json_object_get(fault, "file"));
        const char *find = json_string_value(json_object_get(fault, "find")), *replace = json_string_value(json_object_get(fault, "replace"));
        check_true(name && file && find && replace && strcmp(find, replace) != 0, "name, file, find and another replace");
        check_true(!with_origin || (json_is_string(json_object_get(fault, "class")) && json_is_string(json_object_get(fault, "origin"))), "class and origin");
        check_close(times_in_file(file ? file : "", find ? find : "?"), 1, 0, name ? name : "fault");
    }
    json_decref(root);
}

static void each_fault_fits_once(void)
{
    list_fits("validation/faults/faults.json", 400, true);
    list_fits("validation/faults/readers.json", 40, true);
    list_fits("tools/engine/faults.json", 8, false);
}

static const struct unit_test tests[] = { { "each fault's text is in the code exactly once", each_fault_fits_once }, { NULL, NULL } };
const struct suite faults_suite = { "faults", tests };
