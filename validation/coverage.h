/*
 * The coverage matrix: physics term x layer x verdict x what was not tested. Nothing in it is written by hand: each case says in
 * `terms` which of its quantities judge which term (validation/terms.json lists the terms), and the verdicts are those of the run.
 */
#ifndef COVERAGE_H
#define COVERAGE_H

#include "report.h"

#include <stdio.h>

/* Cases by what became of the quantities that judge the term. `left_out`: not asked, by tier or choice. */
struct coverage_cell { int cases, passed, failed, inconclusive, skipped, left_out; };

struct coverage_row {
    const char *term, *group, *about;
    struct coverage_cell layer[LAYER_PUBLISHED + 1];    /* [0]: all layers together */
};

struct coverage {
    json_t *terms;
    struct coverage_row *row;
    size_t rows;
    const struct suite_of_cases *suite;
    const struct finished_case *done;
    size_t count;
};

/* `terms_file`: terms.json. Borrows suite and done. A term that a case names and the file does not is an error of the suite. */
bool coverage_make(const char *terms_file, const struct suite_of_cases *suite, const struct finished_case *done, size_t count,
                   struct coverage *c, char why[WHY_LENGTH]);
void coverage_free(struct coverage *c);

/* What one case says of a term: false if the case was not asked. `quantities`: how many of its results judge the term. */
bool coverage_evidence(const struct coverage *c, const struct gate_case *gate_case, const char *term, enum verdict *verdict,
                       size_t *quantities);

/* "FAIL", "inconclusive", "pass", "not judged": of one cell. */
const char *coverage_word(const struct coverage_cell *cell);

/* A few lines for the terminal: how many terms, which failed by which case, which were not judged and why. */
void coverage_print(const struct coverage *c);
/* The matrix; each row opens to the cases behind it. */
void coverage_html(FILE *f, const struct coverage *c);

#endif
