/* A suite of unit tests: a name and its tests. Each tests/<what>_test.c defines one; run.c lists them. */
#ifndef SUITE_H
#define SUITE_H

#include <stdbool.h>

struct unit_test { const char *name; void (*run)(void); };
struct suite { const char *name; const struct unit_test *test; /* ends with a null name */ };

/* Assert |measured - expected| <= tolerance; prints both numbers where it fails; NaN fails. */
void check_close(double measured, double expected, double tolerance, const char *what);
void check_relative(double measured, double expected, double tolerance, const char *what);
void check_true(bool holds, const char *what);

#endif
