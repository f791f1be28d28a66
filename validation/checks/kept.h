/*
 * What took long to compute, kept as it comes: one line of KEEP/<case>.csv per realisation and code, so that a table of hours can be
 * interrupted at any moment and goes on where it was. A line counts only for the very scene, start included, that it was computed from.
 */
#ifndef KEPT_H
#define KEPT_H

#include "check.h"

struct kept {
    const struct check_run *run;
    char path[PATH_LENGTH];         /* empty: nothing is kept (no --keep) */
    const char *columns;            /* names of the values, separated by commas; borrowed */
    int values;
    char program[2][17];            /* hashes of candidate and reference, noted with each line */
    struct table found;
    bool any;
};

/* False, and recorded, if the file there cannot be read. */
bool kept_open(struct kept *k, struct check_run *run, const char *columns, int values);
/* 16 hex digits over the scene, whose seed, realisation and cell name its start too. */
void kept_hash(const json_t *scene, char hex[17]);
/* Both codes' values of that realisation; false: not there. */
bool kept_find(const struct kept *k, const char *point, int realisation, const char *scene, double core_seconds[2], double *candidate, double *reference);
void kept_add(const struct kept *k, const char *point, int realisation, const char *scene, const double core_seconds[2], const double *candidate,
              const double *reference);
void kept_close(struct kept *k);

#endif
