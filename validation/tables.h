/*
 * The files that pass between gate and candidate: CSV read by column name, NPY, states, contacts, and paths inside a JSON
 * scene. Every reader returns false and says in `why` exactly what is wrong, with file and line, so that the author of a
 * candidate can mend it without a debugger.
 */
#ifndef TABLES_H
#define TABLES_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { WHY_LENGTH = 1280, PATH_LENGTH = 1024 };

/* Writes the reason of a failure and returns false, so that a failing function can end with it. */
bool why_not(char why[WHY_LENGTH], const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Numbers of a CSV file: `rows` x `columns` in the order in which the columns were asked for. */
struct table {
    size_t rows, columns;
    double *value;
    char **word;   /* distinct words of the text columns; a text cell holds the index of its word */
    size_t words;
    char path[PATH_LENGTH];
};

/*
 * Read the named columns ("state,force$,id,fx,turn_x?"): a `$` marks a text column, a `?` one that may be missing (NaN).
 * Lines starting with `#` are skipped; the first other line is the header; NaN and infinity are refused as bad numbers.
 */
bool table_read(const char *path, const char *columns, struct table *t, char why[WHY_LENGTH]);
bool table_expect_rows(const struct table *t, size_t rows, char why[WHY_LENGTH]);
double table_at(const struct table *t, size_t row, size_t column);
const char *table_word(const struct table *t, size_t row, size_t column);
bool table_has(const char *path, const char *column); /* whether the header names this column */
void table_free(struct table *t);

/* NPY 1.0, little-endian float64, C order, exactly this shape (0 in `shape`: any size, filled in). Caller frees *data. */
bool npy_read(const char *path, int dimensions, size_t shape[], double **data, char why[WHY_LENGTH]);

struct state_row { int state, id, species; double x[3], u[3], w[3]; };
struct contact_row { int state, i, j; double s[3]; };

bool states_write(const char *path, const struct state_row *row, size_t rows, char why[WHY_LENGTH]);
bool contacts_write(const char *path, const struct contact_row *row, size_t rows, char why[WHY_LENGTH]);

/* Answer to protocol `forces`, by state, force name and id. Every state must have the same number of particles. */
struct forces {
    size_t states, count;  /* particles per state */
    char **name;           /* the force names found, `total` among them */
    size_t names;
    double *value;         /* [state][name][id - 1][6]: force, torque */
};
/* Checks that each state, each of the wanted forces (comma separated) and each id has exactly one row. */
bool forces_read(const char *path, size_t states, size_t count, const char *wanted, struct forces *f, char why[WHY_LENGTH]);
const double *forces_at(const struct forces *f, size_t state, const char *name, int id); /* 6 numbers; null if no such force */
void forces_free(struct forces *f);

/* Answer stress.csv to protocol `forces`: the nine components of one origin ("lubrication"), value[state][9]. Caller frees. */
bool stress_read(const char *path, size_t states, const char *origin, double **value, char why[WHY_LENGTH]);

/* Paths inside JSON: "forces.lubrication.inner_gap". `scene_set` makes missing objects on the way and takes over `value`. */
json_t *scene_get(const json_t *scene, const char *path);
double scene_number(const json_t *scene, const char *path, double otherwise);
bool scene_set(json_t *scene, const char *path, json_t *value);

/* "folder/name", cut off at the length of a path. */
void path_join(char path[PATH_LENGTH], const char *folder, const char *name);

/* Folders and files. `folder_make` makes parents too; `folder_remove` removes a folder and all in it. */
bool folder_make(const char *path, char why[WHY_LENGTH]);
bool folder_remove(const char *path);
uint64_t file_hash(const char *path, uint64_t start); /* FNV-1a over the bytes, continued from `start`; start at HASH_START */
#define HASH_START UINT64_C(14695981039346656037)

#endif
