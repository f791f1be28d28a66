/*
 * What people and machines read after a run: JUnit XML for CI systems, one self-contained HTML page for people.
 */
#ifndef REPORT_H
#define REPORT_H

#include "check.h"

/* What a verdict counts for in this run. Only a case that counts, has healed or has expired can turn the run red. */
enum standing {
    COUNTS,                         /* as its verdict says */
    KNOWN,                          /* all that is wrong is accepted by known.json: counted as skipped */
    HEALED,                         /* known.json accepts a failure that is none any more: red, until the entry is taken out */
    EXPIRED,                        /* the date of an entry of known.json is past: red */
    ADVISORY                        /* newer than the suite asked: a warning where it fails, counted as skipped then */
};

/* One case that has been run (or skipped). */
struct finished_case {
    const struct gate_case *gate_case;
    struct results results;
    enum verdict verdict;           /* of what is not accepted; of everything where the case is KNOWN */
    enum standing standing;
    char *remark;                   /* what known.json has to do with it, in a sentence, or null */
    double seconds, candidate_seconds;
    char work[PATH_LENGTH];
};
enum verdict finished_counts(const struct finished_case *done);     /* as which verdict it is counted */
const char *finished_word(const struct finished_case *done);        /* "pass", "known", "HEALED", "warns", ... */
void finished_free(struct finished_case *done);

struct provenance {
    const char *gate_version;       /* of this program */
    char suite[96];                 /* "1.0 as frozen", "1.0, changed since it was frozen" */
    char suite_hash[17], candidate_hash[17];
    const char *candidate;
    const char *level, *precision;
    char date[32];
    char not_tested[WHY_LENGTH];    /* layers and tiers that were left out, and physics the candidate does not have */
    double seconds;
    unsigned seed_offset;
    const struct coverage *coverage;    /* may be null (coverage.h) */
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
