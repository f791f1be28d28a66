/*
 * What people and machines read after a run: JUnit XML for CI systems, one self-contained HTML page for people.
 */
#ifndef REPORT_H
#define REPORT_H

#include "check.h"

/* One case that has been run (or skipped). */
struct finished_case {
    const struct gate_case *gate_case;
    struct results results;
    enum verdict verdict;
    double seconds, candidate_seconds;
    char work[PATH_LENGTH];
};

struct provenance {
    const char *suite_version;      /* of this gate */
    char suite_hash[17], candidate_hash[17];
    const char *candidate;
    const char *level, *precision;
    char date[32];
    char not_tested[WHY_LENGTH];    /* layers and tiers that were left out, and physics the candidate does not have */
    double seconds;
    unsigned seed_offset;
};

struct tally { int passed, failed, skipped, inconclusive; };    /* cases; inconclusive is also counted in failed */
struct tally report_tally(const struct finished_case *done, size_t count);
int report_exit_code(struct tally t);                           /* 0, 1, 3, 77 */

bool report_junit(const char *path, const struct provenance *p, const struct finished_case *done, size_t count,
                  char why[WHY_LENGTH]);
/* `flags_file`: flags.json, which explains the classes of mistake that cases name. */
bool report_html(const char *path, const struct provenance *p, const struct finished_case *done, size_t count,
                 const char *flags_file, char why[WHY_LENGTH]);

#endif
