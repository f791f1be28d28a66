/*
 * The tables of docs/adapter.md as checks use them: states and contacts written for a candidate, its forces and stresses
 * read back and indexed. Completeness is checked here, so that no check ever judges a number that was not written.
 */
#include "tables.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static FILE *open_for_writing(const char *path, char why[WHY_LENGTH])
{
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

bool states_write(const char *path, const struct state_row *row, size_t rows, char why[WHY_LENGTH])
{
    FILE *file = open_for_writing(path, why);
    if (!file)
        return false;
    fputs("state,id,species,x,y,z,ux,uy,uz,wx,wy,wz\n", file);
    for (size_t k = 0; k < rows; k++, row++) {
        fprintf(file, "%d,%d,%d", row->state, row->id, row->species);
        for (int c = 0; c < 9; c++)
            fprintf(file, ",%.17g", c < 3 ? row->x[c] : c < 6 ? row->u[c - 3] : row->w[c - 6]);
        fputc('\n', file);
    }
    return close_written(file, path, why);
}

bool contacts_write(const char *path, const struct contact_row *row, size_t rows, char why[WHY_LENGTH])
{
    FILE *file = open_for_writing(path, why);
    if (!file)
        return false;
    fputs("state,i,j,sx,sy,sz\n", file);
    for (size_t k = 0; k < rows; k++, row++)
        fprintf(file, "%d,%d,%d,%.17g,%.17g,%.17g\n", row->state, row->i, row->j, row->s[0], row->s[1], row->s[2]);
    return close_written(file, path, why);
}

/* Whether `value` is a whole number in [first, first + count); then *index = value - first. */
static bool whole_in(double value, double first, size_t count, size_t *index)
{
    if (!(value >= first && value < first + (double)count))
        return false;
    *index = (size_t)(value - first);
    return first + (double)*index == value;
}

static size_t name_index(const struct forces *f, const char *name, size_t n)
{
    size_t k = 0;
    while (k < f->names && !(strlen(f->name[k]) == n && strncmp(f->name[k], name, n) == 0))
        k++;
    return k;
}

static size_t slot(const struct forces *f, size_t state, size_t name, size_t particle)
{
    return (state * f->names + name) * f->count + particle;
}

static bool place_rows(const struct table *t, struct forces *f, char *seen, char why[WHY_LENGTH])
{
    for (size_t k = 0; k < t->rows; k++) {
        size_t state, particle;
        if (!whole_in(table_at(t, k, 0), 0, f->states, &state))
            return why_not(why, "%s: state %g does not exist; states run from 0 to %zu", t->path,
                           table_at(t, k, 0), f->states - 1);
        if (!whole_in(table_at(t, k, 2), 1, f->count, &particle))
            return why_not(why, "%s: state %zu has no particle with id %g; ids run from 1 to %zu", t->path, state,
                           table_at(t, k, 2), f->count);
        const size_t at = slot(f, state, (size_t)table_at(t, k, 1), particle);
        if (seen[at]++)
            return why_not(why, "%s: state %zu, force '%s', id %zu has two rows", t->path, state,
                           table_word(t, k, 1), particle + 1);
        for (size_t c = 0; c < 6; c++)
            f->value[6 * at + c] = table_at(t, k, 3 + c);
    }
    return true;
}

static bool all_there(const struct forces *f, const char *path, const char *wanted, const char *seen, char why[WHY_LENGTH])
{
    while (*wanted) {
        const size_t n = strcspn(wanted, ","), name = name_index(f, wanted, n);
        if (name == f->names)
            return why_not(why, "%s: no rows for force '%.*s'", path, (int)n, wanted);
        for (size_t state = 0; state < f->states; state++)
            for (size_t particle = 0; particle < f->count; particle++)
                if (!seen[slot(f, state, name, particle)])
                    return why_not(why, "%s: no row for state %zu, force '%.*s', id %zu", path, state, (int)n,
                                   wanted, particle + 1);
        wanted += n + (wanted[n] == ',');
    }
    return true;
}

bool forces_read(const char *path, size_t states, size_t count, const char *wanted, struct forces *f, char why[WHY_LENGTH])
{
    struct table t;
    *f = (struct forces){ .states = states, .count = count };
    if (!table_read(path, "state,force$,id,fx,fy,fz,tx,ty,tz", &t, why))
        return false;
    f->name = t.word; /* the table's words become the force names */
    f->names = t.words;
    const size_t slots = states * count * f->names;
    f->value = calloc(6 * slots + 1, sizeof *f->value);
    char *seen = calloc(slots + 1, 1);
    const bool good = place_rows(&t, f, seen, why) && all_there(f, path, wanted, seen, why);
    t.word = NULL;
    t.words = 0;
    table_free(&t);
    free(seen);
    if (!good)
        forces_free(f);
    return good;
}

const double *forces_at(const struct forces *f, size_t state, const char *name, int id)
{
    const size_t k = name_index(f, name, strlen(name));
    return k == f->names ? NULL : f->value + 6 * slot(f, state, k, (size_t)id - 1);
}

void forces_free(struct forces *f)
{
    for (size_t k = 0; k < f->names; k++)
        free(f->name[k]);
    free(f->name);
    free(f->value);
    *f = (struct forces){ 0 };
}

bool stress_read(const char *path, size_t states, const char *origin, double **value, char why[WHY_LENGTH])
{
    char columns[1024] = "state";
    for (int k = 0; k < 9; k++) {
        const size_t used = strlen(columns);
        snprintf(columns + used, sizeof columns - used, ",%s_%c%c", origin, "xyz"[k / 3], "xyz"[k % 3]);
    }
    struct table t;
    *value = NULL;
    if (!table_read(path, columns, &t, why))
        return false;
    bool good = table_expect_rows(&t, states, why);
    char *seen = calloc(states + 1, 1);
    *value = calloc(9 * states + 1, sizeof **value);
    for (size_t k = 0; good && k < t.rows; k++) {
        size_t state = 0;
        good = whole_in(table_at(&t, k, 0), 0, states, &state) && !seen[state]++;
        if (!good)
            why_not(why, "%s: state %g does not exist or has two rows", path, table_at(&t, k, 0));
        for (size_t c = 0; good && c < 9; c++)
            (*value)[9 * state + c] = table_at(&t, k, 1 + c);
    }
    free(seen);
    table_free(&t);
    if (!good) {
        free(*value);
        *value = NULL;
    }
    return good;
}
