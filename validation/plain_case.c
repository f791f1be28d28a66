/* A question as plain text. Words with anything but letters, digits and . _ + - are quoted: a list-directed read would stop at a slash or a comma. */
#include "geometry.h"
#include "plain.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static void write_word(FILE *file, const char *word)
{
    bool bare = *word != '\0';
    for (const char *c = word; *c; c++)
        bare = bare && (isalnum((unsigned char)*c) || strchr("._+-", *c));
    if (!bare)
        fputc('"', file);
    for (const char *c = word; *c; c++)
        fputc(*c == '"' ? '\'' : *c == '\n' ? ' ' : *c, file);
    if (!bare)
        fputc('"', file);
}

/* name value, for everything below `json`. */
static void write_scalars(FILE *file, const char *name, const json_t *json)
{
    char inner[512];
    const char *key;
    size_t k;
    json_t *item, *all = (json_t *)(uintptr_t)json;
    if (json_is_object(json)) {
        json_object_foreach(all, key, item)
        {
            snprintf(inner, sizeof inner, "%s.%s", name, key);
            write_scalars(file, inner, item);
        }
        return;
    }
    if (json_is_array(json)) {
        fprintf(file, "%s.count %zu\n", name, json_array_size(json));
        json_array_foreach(all, k, item)
        {
            snprintf(inner, sizeof inner, "%s.%zu", name, k + 1);
            write_scalars(file, inner, item);
        }
        return;
    }
    fprintf(file, "%s ", name);
    if (json_is_string(json))
        write_word(file, json_string_value(json));
    else if (json_is_integer(json))
        fprintf(file, "%lld", (long long)json_integer_value(json));
    else if (json_is_real(json))
        fprintf(file, "%.17g", json_real_value(json));
    else
        fputs(json_is_true(json) ? "true" : json_is_false(json) ? "false" : "none", file);
    fputc('\n', file);
}

/* The cell at the start's time and dU_I/dx_K. */
static void write_cell(FILE *file, const json_t *scene)
{
    double gradient[3][3], cell[3][3];
    if (!scene_cell(scene, cell, gradient))
        return;
    for (int v = 0; v < 3; v++)
        for (int k = 0; k < 3; k++)
            fprintf(file, "cell.%d.%d %.17g\n", v + 1, k + 1, cell[v][k]);
    for (int v = 0; v < 3; v++)
        for (int k = 0; k < 3; k++)
            fprintf(file, "gradient.%d.%d %.17g\n", v + 1, k + 1, gradient[v][k]);
    fprintf(file, "volume %.17g\n", fabs(cell[0][0] * (cell[1][1] * cell[2][2] - cell[1][2] * cell[2][1])
                                         - cell[0][1] * (cell[1][0] * cell[2][2] - cell[1][2] * cell[2][0])
                                         + cell[0][2] * (cell[1][0] * cell[2][1] - cell[1][1] * cell[2][0])));
}

static void write_forces(FILE *file, const json_t *scene)
{
    json_t *forces = scene_get(scene, "forces"), *force;
    const char *name;
    int at = 0;
    fprintf(file, "forces.count %zu\n", json_object_size(forces));
    for (int noise = 0; noise < 2; noise++)
        json_object_foreach(forces, name, force)
            if ((strstr(name, "_noise") != NULL) == noise)
                fprintf(file, "forces.%d %s\n", ++at, name);
}

static FILE *open_for_writing(const char *folder, const char *name, char path[PATH_LENGTH], char why[WHY_LENGTH])
{
    path_join(path, folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        why_not(why, "cannot write %s", path);
    return file;
}

static bool close_written(FILE *file, const char *path, char why[WHY_LENGTH])
{
    const bool bad = ferror(file) != 0;
    if (fclose(file) != 0 || bad)
        return why_not(why, "cannot write %s: disk full?", path);
    return true;
}

bool plain_write_case(const char *folder, const json_t *question, const json_t *scene, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    FILE *file = open_for_writing(folder, "case.txt", path, why);
    if (!file)
        return false;
    write_scalars(file, "case", question);
    write_scalars(file, "scene", scene);
    write_forces(file, scene);
    write_cell(file, scene);
    return close_written(file, path, why);
}

bool plain_write_states(const char *folder, const struct state_row *row, size_t rows, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    FILE *file = open_for_writing(folder, "states.txt", path, why);
    if (!file)
        return false;
    fprintf(file, "%zu\n", rows);
    for (size_t k = 0; k < rows; k++, row++) {
        fprintf(file, "%d %d %d", row->state, row->id, row->species);
        for (int c = 0; c < 9; c++)
            fprintf(file, " %.17g", c < 3 ? row->x[c] : c < 6 ? row->u[c - 3] : row->w[c - 6]);
        fputc('\n', file);
    }
    return close_written(file, path, why);
}

bool plain_write_contacts(const char *folder, const struct contact_row *row, size_t rows, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    FILE *file = open_for_writing(folder, "contacts.txt", path, why);
    if (!file)
        return false;
    fprintf(file, "%zu\n", rows);
    for (size_t k = 0; k < rows; k++, row++)
        fprintf(file, "%d %d %d %.17g %.17g %.17g\n", row->state, row->i, row->j, row->s[0], row->s[1], row->s[2]);
    return close_written(file, path, why);
}
