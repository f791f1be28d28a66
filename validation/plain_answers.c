/*
 * Answers in plain text, made into the files that checks read. A table is a stream of values: line breaks do not count, since list-directed output
 * may wrap; `#` starts a comment; 1.5D-03, 3*0.0 and, with three digits, 1.5-103 are what Fortran may write.
 */
#include "plain.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { TOKEN = 64, COLUMNS_AT_MOST = 24 };

struct stream { const char *path, *name; FILE *file; size_t line; int repeats; char token[TOKEN]; };

/* The next value as text; false at the end of the file. */
static bool next_token(struct stream *s)
{
    if (s->repeats > 0) {
        s->repeats--;
        return true;
    }
    int c = fgetc(s->file), n = 0;
    while (c != EOF && (isspace(c) || c == ',' || c == '#')) {
        while (c == '#' && (c = fgetc(s->file)) != EOF && c != '\n')
            c = '#';
        s->line += c == '\n';
        c = fgetc(s->file);
    }
    for (; c != EOF && !isspace(c) && c != ',' && c != '#'; c = fgetc(s->file))
        if (n < TOKEN - 1 && c != '\'' && c != '"')
            s->token[n++] = (char)c;
    if (c != EOF)
        ungetc(c, s->file);
    s->token[n] = '\0';
    char *star = strchr(s->token, '*');
    if (star && star > s->token && strspn(s->token, "0123456789") == (size_t)(star - s->token)) {
        s->repeats = atoi(s->token) - 1;
        memmove(s->token, star + 1, strlen(star));
    }
    return n > 0;
}

static bool as_number(struct stream *s, const char *column, double *value, char why[WHY_LENGTH])
{
    char text[TOKEN + 1], *end;
    strcpy(text, s->token);
    for (char *c = text; *c; c++)
        *c = *c == 'd' || *c == 'D' ? 'e' : *c;
    *value = strtod(text, &end);
    if (end != text && (*end == '-' || *end == '+') && strspn(end + 1, "0123456789") == strlen(end + 1) && strlen(end) == 4 && !strchr(text, 'e')) {
        memmove(end + 1, end, strlen(end) + 1);         /* no room for the letter of the exponent */
        *end = 'e';
        *value = strtod(text, &end);
    }
    return (*text && *end == '\0' && isfinite(*value))
           || why_not(why, "%s:%zu: column '%s' holds '%s', not a finite number", s->path, s->line, column, s->token);
}

static bool open_stream(struct stream *s, const char *path, char why[WHY_LENGTH])
{
    *s = (struct stream){ .path = path, .file = fopen(path, "r"), .line = 1 };
    return s->file || why_not(why, "%s cannot be read", path);
}

/* One row of the named columns; `$` marks a word. 1: read, 0: the file ends, -1: wrong. */
static int read_row(struct stream *s, const char *const column[], size_t columns, double *value, char word[TOKEN], char why[WHY_LENGTH])
{
    for (size_t k = 0; k < columns; k++) {
        if (!next_token(s)) {
            if (k == 0)
                return 0;
            why_not(why, "%s:%zu: the last row has %zu values; rows have %zu", s->path, s->line, k, columns);
            return -1;
        }
        if (column[k][0] == '$')
            strcpy(word, s->token);
        else if (!as_number(s, column[k], &value[k], why))
            return -1;
    }
    return 1;
}

static size_t split_columns(char *names, const char *column[COLUMNS_AT_MOST])
{
    size_t n = 0;
    for (char *at = strtok(names, ","); at && n < COLUMNS_AT_MOST; at = strtok(NULL, ","))
        column[n++] = at;
    return n;
}

/* Whether `<name>.txt` is there and `<name><usual>` is not. */
static bool given_as_text(const char *out, const char *name, const char *usual, char from[PATH_LENGTH], char to[PATH_LENGTH])
{
    char file[80];
    snprintf(file, sizeof file, "%s.txt", name);
    path_join(from, out, file);
    snprintf(file, sizeof file, "%s%s", name, usual);
    path_join(to, out, file);
    return access(from, R_OK) == 0 && access(to, R_OK) != 0;
}

/* A table of the same columns: only the form changes. */
static bool make_csv(const char *out, const char *name, const char *columns, char why[WHY_LENGTH])
{
    char from[PATH_LENGTH], to[PATH_LENGTH], names[400], word[TOKEN] = "";
    const char *column[COLUMNS_AT_MOST];
    double value[COLUMNS_AT_MOST];
    struct stream s;
    if (!given_as_text(out, name, ".csv", from, to))
        return true;
    snprintf(names, sizeof names, "%s", columns);
    const size_t n = split_columns(names, column);
    if (!open_stream(&s, from, why))
        return false;
    FILE *file = fopen(to, "w");
    for (size_t k = 0; file && k < n; k++)
        fprintf(file, "%s%s", column[k] + (column[k][0] == '$'), k + 1 < n ? "," : "\n");
    int read = file ? 1 : -1;
    while (read == 1 && (read = read_row(&s, column, n, value, word, why)) == 1)
        for (size_t k = 0; k < n; k++)
            if (column[k][0] == '$')
                fprintf(file, "%s,", word);
            else
                fprintf(file, "%.17g%c", value[k], k + 1 < n ? ',' : '\n');
    fclose(s.file);
    if (!file || fclose(file) != 0)
        return why_not(why, "cannot write %s", to);
    return read == 0 || (remove(to), false);
}

/* Rows by state (or step) and origin become rows by state with nine columns per origin. */
struct stress { double key[3], *value; bool *there; };

static size_t origin_of(char (*origin)[TOKEN], size_t *origins, const char *word)
{
    for (size_t k = 0; k < *origins; k++)
        if (strcmp(origin[k], word) == 0)
            return k;
    if (*origins == 16)
        return 16;
    strcpy(origin[*origins], word);
    return (*origins)++;
}

static bool write_stress(const char *to, const char *from, const char *keys, size_t key_count, const struct stress *row, size_t rows,
                         char (*origin)[TOKEN], size_t origins, char why[WHY_LENGTH])
{
    FILE *file = fopen(to, "w");
    if (!file)
        return why_not(why, "cannot write %s", to);
    bool good = true;
    fputs(keys, file);
    for (size_t o = 0; o < origins; o++)
        for (int k = 0; k < 9; k++)
            fprintf(file, ",%s_%c%c", origin[o], "xyz"[k / 3], "xyz"[k % 3]);
    for (size_t r = 0; r < rows && good; r++) {
        for (size_t k = 0; k < key_count; k++)
            fprintf(file, "%c%.17g", k ? ',' : '\n', row[r].key[k]);
        for (size_t o = 0; o < origins && good; o++) {
            good = row[r].there[o] || why_not(why, "%s: no row for %s %g, origin '%s'", from, strncmp(keys, "step", 4) ? "state" : "step", row[r].key[0], origin[o]);
            for (int k = 0; k < 9; k++)
                fprintf(file, ",%.17g", row[r].value[9 * o + (size_t)k]);
        }
    }
    fputc('\n', file);
    if (fclose(file) != 0)
        return why_not(why, "cannot write %s", to);
    return good || (remove(to), false);
}

static bool make_stress(const char *out, const char *keys, char why[WHY_LENGTH])
{
    char from[PATH_LENGTH], to[PATH_LENGTH], names[200], word[TOKEN] = "", origin[16][TOKEN];
    const char *column[COLUMNS_AT_MOST];
    double value[COLUMNS_AT_MOST];
    struct stress *row = NULL;
    size_t rows = 0, origins = 0;
    struct stream s;
    if (!given_as_text(out, "stress", ".csv", from, to))
        return true;
    snprintf(names, sizeof names, "%s,$origin,xx,xy,xz,yx,yy,yz,zx,zy,zz", keys);
    const size_t n = split_columns(names, column), key_count = n - 10;
    if (!open_stream(&s, from, why))
        return false;
    int read;
    while ((read = read_row(&s, column, n, value, word, why)) == 1) {
        const size_t o = origin_of(origin, &origins, word);
        if (rows == 0 || memcmp(row[rows - 1].key, value, key_count * sizeof *value) != 0) {
            row = realloc(row, (rows + 1) * sizeof *row);
            row[rows] = (struct stress){ .value = calloc(9 * 16, sizeof(double)), .there = calloc(16, sizeof(bool)) };
            memcpy(row[rows++].key, value, key_count * sizeof *value);
        }
        if (o == 16 || row[rows - 1].there[o]) {
            why_not(why, "%s:%zu: %s '%s'", from, s.line, o == 16 ? "too many origins:" : "two rows of one state or step for origin", word);
            read = -1;
            break;
        }
        row[rows - 1].there[o] = true;
        memcpy(row[rows - 1].value + 9 * o, value + key_count + 1, 9 * sizeof *value);
    }
    fclose(s.file);
    const bool good = read == 0 && write_stress(to, from, keys, key_count, row, rows, origin, origins, why);
    for (size_t r = 0; r < rows; r++) {
        free(row[r].value);
        free(row[r].there);
    }
    free(row);
    return good;
}

bool npy_write(const char *path, size_t rows, size_t particles, const double *value, char why[WHY_LENGTH])
{
    char text[119];
    FILE *file = fopen(path, "wb");
    if (!file)
        return why_not(why, "cannot write %s", path);
    const int length = snprintf(text, sizeof text, "{'descr': '<f8', 'fortran_order': False, 'shape': (%zu, %zu, 6), }", rows, particles);
    fwrite("\x93NUMPY\x01\x00\x76\x00", 1, 10, file);
    fprintf(file, "%s%*s\n", text, 117 - length, "");
    const size_t count = rows * particles * 6;
    const bool good = fwrite(value, sizeof *value, count, file) == count;
    return fclose(file) == 0 && good ? true : why_not(why, "cannot write %s: disk full?", path);
}

static bool make_npy(const char *out, const char *name, size_t particles, char why[WHY_LENGTH])
{
    char from[PATH_LENGTH], to[PATH_LENGTH];
    struct stream s;
    double *value = NULL;
    size_t count = 0, room = 0;
    if (!given_as_text(out, name, ".npy", from, to))
        return true;
    if (!open_stream(&s, from, why))
        return false;
    bool good = true;
    while (good && next_token(&s)) {
        if (count == room)
            value = realloc(value, (room = room ? 2 * room : 4096) * sizeof *value);
        static const char *const column[] = { "fx", "fy", "fz", "tx", "ty", "tz" };
        good = as_number(&s, column[count % 6], &value[count], why);
        count++;
    }
    fclose(s.file);
    if (good && (count == 0 || count % (6 * particles) != 0))
        good = why_not(why, "%s: holds %zu numbers, no multiple of 6 for each of %zu particles", from, count, particles);
    good = good && npy_write(to, count / (6 * particles), particles, value, why);
    free(value);
    return good;
}

bool plain_answers(const char *out, const struct plain_shape *shape, char why[WHY_LENGTH])
{
    const bool run = strcmp(shape->protocol, "run") == 0, steps = strcmp(shape->protocol, "steps") == 0;
    char columns[160];
    snprintf(columns, sizeof columns, "%sstep,time,id,x,y,z,ux,uy,uz,wx,wy,wz,species%s", steps ? "state," : "", shape->turn ? ",turn_x,turn_y,turn_z" : "");
    return make_csv(out, "forces", "state,$force,id,fx,fy,fz,tx,ty,tz", why) && make_csv(out, "trajectory", columns, why)
           && make_stress(out, run ? "step,time,strain" : "state", why)
           && make_npy(out, "noise_drag_noise", shape->particles, why) && make_npy(out, "noise_lubrication_noise", shape->particles, why)
           && make_npy(out, "friction", shape->particles, why);
}
