/*
 * CSV and NPY as numbers. The whole file is read at once and walked in place with strtod: 10 MB take about a tenth of
 * a second, which is less than the candidate needed to print them.
 */
#include "tables.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS_AT_MOST = 128, NAME_LENGTH = 64 };

/* A column that the caller asked for. */
struct wanted { char name[NAME_LENGTH]; bool text, optional; int at; /* place in the file, -1: not there */ };

/* A file being read: cursor and line number for messages. */
struct reader { const char *path; char *text, *at; size_t line; };

static bool read_whole(const char *path, char **text, size_t *length, char why[WHY_LENGTH])
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return why_not(why, "%s is missing", path);
    size_t room = 1 << 16, used = 0;
    char *buffer = malloc(room + 1);
    for (size_t got; (got = fread(buffer + used, 1, room - used, file)) > 0;) {
        used += got;
        if (used == room)
            buffer = realloc(buffer, (room *= 2) + 1);
    }
    fclose(file);
    buffer[used] = '\0';
    *text = buffer;
    *length = used;
    return true;
}

static void next_line(struct reader *r)
{
    r->at += strcspn(r->at, "\n");
    if (*r->at == '\n') {
        r->at++;
        r->line++;
    }
}

/* To the first line that is neither a `#` line nor empty; false at the end of the file. */
static bool skip_comments(struct reader *r)
{
    while (*r->at == '#' || *r->at == '\n' || *r->at == '\r')
        next_line(r);
    return *r->at != '\0';
}

static size_t parse_wanted(const char *columns, struct wanted wanted[COLUMNS_AT_MOST])
{
    size_t count = 0;
    while (*columns && count < COLUMNS_AT_MOST) {
        size_t n = strcspn(columns, ",");
        struct wanted *w = &wanted[count++];
        *w = (struct wanted){ .at = -1 };
        const size_t whole = n;
        for (; n > 0 && strchr("$?", columns[n - 1]); n--)
            *(columns[n - 1] == '$' ? &w->text : &w->optional) = true;
        snprintf(w->name, sizeof w->name, "%.*s", (int)n, columns);
        columns += whole + (columns[whole] == ',');
    }
    return count;
}

/* The field that starts at the cursor, without surrounding blanks; moves to its end (comma or end of line). */
static size_t field(struct reader *r, const char **start)
{
    r->at += strspn(r->at, " \t");
    *start = r->at;
    size_t n = strcspn(r->at, ",\r\n");
    r->at += n;
    while (n > 0 && ((*start)[n - 1] == ' ' || (*start)[n - 1] == '\t'))
        n--;
    return n;
}

/* Finds the wanted columns in the header line. `asker[c]` is the wanted column at place c of the file, or -1. */
static bool parse_header(struct reader *r, struct wanted *wanted, size_t count, int asker[COLUMNS_AT_MOST], int *places,
                         char why[WHY_LENGTH])
{
    int place = 0;
    for (;; place++) {
        const char *name;
        const size_t n = field(r, &name);
        if (place == COLUMNS_AT_MOST)
            return why_not(why, "%s:%zu: more than %d columns", r->path, r->line, COLUMNS_AT_MOST);
        asker[place] = -1;
        for (size_t w = 0; w < count; w++)
            if (strlen(wanted[w].name) == n && strncmp(wanted[w].name, name, n) == 0) {
                if (wanted[w].at >= 0)
                    return why_not(why, "%s:%zu: column '%s' appears twice", r->path, r->line,
                                   wanted[w].name);
                wanted[w].at = place;
                asker[place] = (int)w;
            }
        if (*r->at != ',')
            break;
        r->at++;
    }
    *places = place + 1;
    for (size_t w = 0; w < count; w++)
        if (wanted[w].at < 0 && !wanted[w].optional)
            return why_not(why, "%s:%zu: column '%s' is missing from the header%s", r->path, r->line,
                           wanted[w].name, strchr(r->text, ';') && !strchr(r->text, ',') ? ": fields are separated by commas, not semicolons" : "");
    return true;
}

static double word_index(struct table *t, const char *start, size_t n)
{
    for (size_t k = 0; k < t->words; k++)
        if (strlen(t->word[k]) == n && strncmp(t->word[k], start, n) == 0)
            return (double)k;
    t->word = realloc(t->word, (t->words + 1) * sizeof *t->word);
    t->word[t->words] = calloc(n + 1, 1);
    memcpy(t->word[t->words], start, n);
    return (double)t->words++;
}

static bool parse_cell(struct reader *r, struct table *t, const struct wanted *w, double *value, char why[WHY_LENGTH])
{
    const char *start;
    if (w->text) {
        const size_t n = field(r, &start);
        *value = word_index(t, start, n);
        return true;
    }
    char *end;
    start = r->at + strspn(r->at, " \t");
    *value = strtod(start, &end);
    const char *after = end + strspn(end, " \t");
    /* strtod skips line ends too: a number must start on this line */
    const bool number = end != start && !isspace((unsigned char)*start) && strchr(",\r\n", *after) && isfinite(*value);
    const size_t n = field(r, &start);
    if (!number)
        why_not(why, "%s:%zu: column '%s' holds '%.*s', not a finite number", r->path, r->line, w->name,
                (int)(n < 40 ? n : 40), start);
    return number;
}

static bool parse_row(struct reader *r, struct table *t, const struct wanted *wanted, const int *asker, int places,
                      char why[WHY_LENGTH])
{
    double *row = t->value + t->rows * t->columns;
    for (size_t c = 0; c < t->columns; c++)
        row[c] = NAN;
    for (int place = 0; place < places; place++) {
        if (asker[place] >= 0) {
            if (!parse_cell(r, t, &wanted[asker[place]], &row[asker[place]], why))
                return false;
        } else {
            r->at += strcspn(r->at, ",\r\n");
        }
        const bool last = place == places - 1;
        if (last != (*r->at != ','))
            return why_not(why, "%s:%zu: %s columns than the header, which has %d", r->path, r->line,
                           last ? "more" : "fewer", places);
        r->at += !last;
    }
    t->rows++;
    next_line(r);
    return true;
}

bool table_read(const char *path, const char *columns, struct table *t, char why[WHY_LENGTH])
{
    struct wanted wanted[COLUMNS_AT_MOST];
    int asker[COLUMNS_AT_MOST], places = 0;
    size_t length, room = 1024;
    *t = (struct table){ .columns = parse_wanted(columns, wanted) };
    snprintf(t->path, sizeof t->path, "%s", path);

    struct reader r = { .path = path, .line = 1 };
    if (!read_whole(path, &r.text, &length, why))
        return false;
    r.at = r.text + (length >= 3 && memcmp(r.text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0);      /* a byte-order mark is no part of the first name */
    bool good = memchr(r.text, '\0', length) == NULL;
    if (!good)
        why_not(why, "%s: is not a text file", path);
    else if (!(good = skip_comments(&r)))
        why_not(why, "%s: is empty: no header line", path);
    else if ((good = parse_header(&r, wanted, t->columns, asker, &places, why)))
        next_line(&r);
    t->value = malloc(room * t->columns * sizeof *t->value);
    while (good && skip_comments(&r)) {
        if (t->rows == room)
            t->value = realloc(t->value, (room *= 2) * t->columns * sizeof *t->value);
        good = parse_row(&r, t, wanted, asker, places, why);
    }
    free(r.text);
    if (!good)
        table_free(t);
    return good;
}

bool table_expect_rows(const struct table *t, size_t rows, char why[WHY_LENGTH])
{
    if (t->rows != rows)
        why_not(why, "%s: has %zu rows, expected %zu", t->path, t->rows, rows);
    return t->rows == rows;
}

double table_at(const struct table *t, size_t row, size_t column)
{
    return t->value[row * t->columns + column];
}

const char *table_word(const struct table *t, size_t row, size_t column)
{
    return t->word[(size_t)table_at(t, row, column)];
}

bool table_has(const char *path, const char *column)
{
    struct table t;
    char why[WHY_LENGTH], quoted[NAME_LENGTH + 2];
    snprintf(quoted, sizeof quoted, "%s$", column); /* as text: any content will do */
    const bool has = table_read(path, quoted, &t, why);
    if (has)
        table_free(&t);
    return has;
}

void table_free(struct table *t)
{
    for (size_t k = 0; k < t->words; k++)
        free(t->word[k]);
    free(t->word);
    free(t->value);
    *t = (struct table){ 0 };
}

/* The text after `'key':` in the header dictionary of an NPY file; null if it is not there. */
static const char *npy_key(const char *header, const char *key)
{
    const char *found = strstr(header, key);
    found = found ? strchr(found, ':') : NULL;
    return found ? found + 1 + strspn(found + 1, " ") : NULL;
}

static bool npy_shape(const char *header, int dimensions, size_t shape[], const char *path, char why[WHY_LENGTH])
{
    const char *order = npy_key(header, "'fortran_order'"), *descr = npy_key(header, "'descr'");
    const char *at = npy_key(header, "'shape'");
    if (!descr || strncmp(descr, "'<f8'", 5) != 0)
        return why_not(why, "%s: descr is not '<f8' (little-endian float64)", path);
    if (!order || strncmp(order, "False", 5) != 0)
        return why_not(why, "%s: fortran_order is not False (C order)", path);
    if (!at || *at != '(')
        return why_not(why, "%s: the header has no shape", path);
    at++;
    for (int d = 0; d < dimensions; d++) {
        char *end;
        const unsigned long long n = strtoull(at, &end, 10);
        if (end == at)
            return why_not(why, "%s: shape has %d dimensions, expected %d", path, d, dimensions);
        if (shape[d] != 0 && shape[d] != n)
            return why_not(why, "%s: dimension %d of shape is %llu, expected %zu", path, d, n, shape[d]);
        shape[d] = (size_t)n;
        at = end + strspn(end, " ,");
    }
    if (*at != ')')
        return why_not(why, "%s: shape has more than %d dimensions", path, dimensions);
    return true;
}

bool npy_read(const char *path, int dimensions, size_t shape[], double **data, char why[WHY_LENGTH])
{
    char *text;
    size_t length;
    *data = NULL;
    if (!read_whole(path, &text, &length, why))
        return false;
    const unsigned char *byte = (const unsigned char *)text;
    bool good = length >= 10 && memcmp(text, "\x93NUMPY\x01", 7) == 0;
    if (!good)
        why_not(why, "%s: is not an NPY file of version 1", path);
    const size_t header = good ? (size_t)byte[8] + 256u * byte[9] : 0;
    if (good && !(good = 10 + header <= length && header > 0))
        why_not(why, "%s: its header is cut off", path);
    if (good) {
        text[10 + header - 1] = '\0'; /* the header ends with a line end */
        good = npy_shape(text + 10, dimensions, shape, path, why);
    }
    size_t count = 1;
    for (int d = 0; good && d < dimensions; d++)
        count *= shape[d];
    if (good && !(good = (length - 10 - header) / sizeof **data == count))
        why_not(why, "%s: holds %zu numbers, its shape says %zu", path, (length - 10 - header) / sizeof **data,
                count);
    if (good) {
        *data = malloc((count ? count : 1) * sizeof **data);
        memcpy(*data, text + 10 + header, count * sizeof **data); /* little-endian machines only, as all we run on */
        for (size_t k = 0; good && k < count; k++)
            if (!(good = isfinite((*data)[k])))
                why_not(why, "%s: number %zu is not finite", path, k);
    }
    free(text);
    if (!good) {
        free(*data);
        *data = NULL;
    }
    return good;
}
