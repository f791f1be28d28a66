/*
 * Configurations from a CSV table: state,id,species,x,y,z,ux,uy,uz,wx,wy,wz (columns by name; docs/formats.md).
 */
#include "protocols/protocols.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum column { STATE, ID, SPECIES, X, Y, Z, UX, UY, UZ, WX, WY, WZ, COLUMNS };
static const char *const column_name[COLUMNS] = { "state", "id", "species", "x", "y", "z", "ux", "uy", "uz", "wx", "wy", "wz" };

struct row { double value[COLUMNS]; };
struct state_file { char path[256]; int rows, states; struct row *row; int *first; /* of each state, and the end */ };

enum { LINE = 4096, FIELDS = 64 };

/* The next cell of a line, which may be empty; NULL after the last. */
static char *next_cell(char **rest)
{
    char *cell = *rest;
    if (!cell)
        return NULL;
    char *end = cell + strcspn(cell, ",\r\n");
    *rest = *end == ',' ? end + 1 : NULL;
    *end = '\0';
    return cell;
}

/* Which column of the file is which of ours; -1: not one that we read. */
static bool read_header(char *line, int field[FIELDS], const char *path, struct error *e)
{
    bool seen[COLUMNS] = { false };
    char *rest = line, *name;
    for (int f = 0; f < FIELDS; f++)
        field[f] = -1;
    for (int f = 0; f < FIELDS && (name = next_cell(&rest)); f++)
        for (int c = 0; c < COLUMNS; c++)
            if (strcmp(name, column_name[c]) == 0) {
                if (seen[c])
                    return error_raise(e, ERROR_INPUT, "%s: column \"%s\" is there twice", path, name);
                field[f] = c;
                seen[c] = true;
            }
    for (int c = ID; c < COLUMNS; c++)
        if (!seen[c])
            return error_raise(e, ERROR_INPUT, "%s: column \"%s\" is missing", path, column_name[c]);
    return true;
}

static bool read_row(char *line, const int field[FIELDS], struct row *row, const char *path, int number, struct error *e)
{
    char *rest = line, *text;
    int found = 0;
    memset(row, 0, sizeof *row);
    for (int f = 0; f < FIELDS && (text = next_cell(&rest)); f++) {
        if (field[f] < 0)
            continue;
        char *end;
        row->value[field[f]] = strtod(text, &end);
        if (end == text || *end || !isfinite(row->value[field[f]]))
            return error_raise(e, ERROR_INPUT, "%s:%d: \"%.40s\" in column \"%s\" is not a finite number", path, number, text, column_name[field[f]]);
        found++;
    }
    int wanted = 0;
    for (int f = 0; f < FIELDS; f++)
        wanted += field[f] >= 0;
    return found == wanted || error_raise(e, ERROR_INPUT, "%s:%d: %d values where %d are needed", path, number, found, wanted);
}

static bool index_states(struct state_file *f, struct error *e)
{
    f->first = malloc(((size_t)f->rows + 2) * sizeof *f->first);
    if (!f->first)
        return error_out_of_memory(e);
    for (int r = 0; r < f->rows; r++) {
        const double state = f->row[r].value[STATE];
        if (r == 0 || state != f->states - 1) {
            if (state != f->states)
                return error_raise(e, ERROR_INPUT, "%s: state %g where %d is due; states count from 0, each in one piece", f->path, state, f->states);
            f->first[f->states++] = r;
        }
        if (f->row[r].value[ID] != r - f->first[f->states - 1] + 1)
            return error_raise(e, ERROR_INPUT, "%s: id %g where %d is due; ids count from 1 in each state", f->path, f->row[r].value[ID],
                               r - f->first[f->states - 1] + 1);
    }
    f->first[f->states] = f->rows;
    return f->states > 0 || error_raise(e, ERROR_INPUT, "%s: no particles", f->path);
}

struct state_file *state_file_read(const char *path, struct error *e)
{
    FILE *in = fopen(path, "r");
    struct state_file *f = calloc(1, sizeof *f);
    char line[LINE];
    int field[FIELDS], number = 0, room = 0;
    bool header = false, good = in && f;
    if (!in)
        error_raise(e, ERROR_INPUT, "%s cannot be opened", path);
    if (f)
        snprintf(f->path, sizeof f->path, "%s", path);
    while (good && fgets(line, sizeof line, in)) {
        number++;
        if (strlen(line) == LINE - 1)
            good = error_raise(e, ERROR_INPUT, "%s:%d: line too long", path, number);
        else if (line[0] == '#' || line[0] == '\n' || line[0] == '\r')
            continue;
        else if (!header)
            header = good = read_header(line, field, path, e);
        else {
            if (f->rows == room) {
                room = room ? 2 * room : 256;
                struct row *more = realloc(f->row, (size_t)room * sizeof *more);
                if (!more) {
                    good = error_out_of_memory(e);
                    break;
                }
                f->row = more;
            }
            good = read_row(line, field, &f->row[f->rows], path, number, e);
            f->rows += good;
        }
    }
    if (in)
        fclose(in);
    good = good && index_states(f, e);
    if (!good) {
        state_file_free(f);
        return NULL;
    }
    return f;
}

void state_file_free(struct state_file *f)
{
    if (!f)
        return;
    free(f->row);
    free(f->first);
    free(f);
}

int state_file_count(const struct state_file *f) { return f->states; }

bool state_file_place(const struct state_file *f, int state, struct suspension *in, struct error *e)
{
    struct particles *p = &in->particles;
    const struct row *row = f->row + f->first[state];
    if (!particles_allocate(p, f->first[state + 1] - f->first[state], in->rotates, e))
        return false;
    for (int i = 0; i < p->count; i++) {
        const double *v = row[i].value;
        const double kind = v[SPECIES];
        if (kind != floor(kind) || kind < 1 || kind > p->species_count)
            return error_raise(e, ERROR_INPUT, "%s: particle %d of state %d has species %g; the scene has 1 to %d", f->path, i + 1, state,
                               kind, p->species_count);
        if (in->dimensions == 2 && (v[Z] != 0.0 || v[UZ] != 0.0 || v[WX] != 0.0 || v[WY] != 0.0))
            return error_raise(e, ERROR_INPUT, "%s: particle %d of state %d has z %g, uz %g, wx %g, wy %g; in two dimensions they are 0", f->path, i + 1, state,
                               v[Z], v[UZ], v[WX], v[WY]);
        const vec3 inside = mat3_times(&in->box.inverse, vec(v[X], v[Y], v[Z]));
        for (int k = 0; k < 3; k++)
            if (!(fabs(k == 0 ? inside.x : k == 1 ? inside.y : inside.z) < 1e9))
                return error_raise(e, ERROR_INPUT, "%s: particle %d of state %d lies more than 1e9 cells away at (%g, %g, %g)", f->path, i + 1, state, v[X], v[Y], v[Z]);
        p->species[i] = (int)kind - 1;
        p->position[i] = vec(v[X], v[Y], v[Z]);
        p->velocity[i] = vec(v[UX], v[UY], v[UZ]);
        if (p->spin)
            p->spin[i] = vec(v[WX], v[WY], v[WZ]);
    }
    start_moving(p);
    return true;
}
