/*
 * What a check is. A check gets a case, asks the candidate (case folder out, numbers back), and records results: one per
 * quantity judged. It never prints and never decides about the run; the gate turns results into lines and exit codes.
 *
 *     static void my_check(struct check_run *run)
 *     {
 *         struct question q = { .protocol = "forces", .scene = scene, .state = rows, .states = n };
 *         char out[PATH_LENGTH];
 *         if (!check_ask(run, "pairs", &q, out))
 *             return;                                    // skip or failure is recorded already
 *         if (!forces_read(..., why)) { check_garbage(run, why); return; }
 *         check_error(run, INVARIANT, "third law", measured, expected, error, run->gate_case->tolerance,
 *                     "force on 2 is %.3g of minus the force on 1", ratio);
 *     }
 *     const struct check my_checks[] = { { "my-check", my_check }, { NULL, NULL } };   // row in checks/families.c
 *
 * Statistical results: the check says only p (and what it could resolve). The gate calls the check a second time with
 * attempt 2, a fresh seed and samples 4 when a p is below 1e-4, and fails only what is then below 1e-6/(statistical
 * results of the suite). So a check must take its seed from run->seed and multiply its sample count by run->samples.
 */
#ifndef CHECK_H
#define CHECK_H

#include "candidate.h"
#include "case.h"

/* In order of severity: a case is as bad as its worst result. */
enum verdict { VERDICT_PASS, VERDICT_SKIP, VERDICT_INCONCLUSIVE, VERDICT_FAIL };
/* Invariants need no formula of ours and are judged first; model is agreement with what the candidate declares. */
enum judgement { INVARIANT, MODEL };

struct result {
    char *what;                         /* short: "X_A", "third law of lubrication"; unique within its case */
    enum judgement judgement;
    double measured, expected;          /* the numbers for people; NaN where there is no single one */
    double error, tolerance;            /* judged: error <= tolerance; NaN for statistical results */
    double allowance;                   /* what the tolerance holds beyond that of the case */
    double p;                           /* NaN for deterministic results */
    double first_p;                     /* of the first attempt, where a rerun has replaced p; else the same */
    double resolution, declared;        /* smallest relative fault this sample can see, and the one it must see; NaN: not said */
    enum verdict verdict;
    char *sentence;                     /* names the wrong term in a full sentence; shown unless passed */
    char *picture;                      /* SVG file in the work folder, or null */
    char *notes;                        /* longer text for the report, or null */
    const char *accepted;               /* known.json accepts this failure, and why; else null; borrowed (known.h) */
};

struct results { struct result *item; size_t count; };

struct check_run {
    const struct gate_case *gate_case;
    const struct candidate *candidate;
    char work[PATH_LENGTH];             /* own folder, empty at the start; a rerun asks in folders of its own */
    unsigned seed;                      /* of this attempt: use it in scenes and for anything random */
    int attempt;                        /* 1, or 2 for the rerun */
    int samples;                        /* multiply sample counts by this: 1 or 4 */
    struct results results;
    double candidate_seconds;           /* wall time spent in the candidate so far */
    const char *keep;                   /* folder for what took long to compute, or null: checks that run for hours go on where they stopped */
    double allowance;                   /* what the answers so far may be off beyond a tolerance: declared precision, level (precision.h) */
    double amplification;               /* of roundoff, in runs whose tolerance is itself rounding; 0: none */
    char allowance_reason[200];
    bool replaying;                     /* judge the answers that are there once more: nothing is asked (conventions.h) */
};

struct check { const char *name; void (*run)(struct check_run *run); };
const struct check *check_find(const char *name);   /* over all families (checks/families.c) */

/* What the candidate is asked; borrowed, nothing is taken over. Null arrays: no such file. */
struct question {
    const char *protocol;               /* "forces", "noise", "friction", "run"; "steps" is for level_b.c */
    json_t *scene;                      /* complete scene; "about" is added if missing */
    const struct state_row *state;      size_t states;   /* rows of states.csv */
    const struct contact_row *contact;  size_t contacts; /* rows of contacts.csv */
    size_t draws;                       /* for "noise", "friction" */
    size_t steps;                       /* for "steps" */
    bool stress;                        /* for "steps": is it asked for */
    int pause;                          /* for "run": the step after which it stops and goes on from what is on disk; 0: none */
};

/*
 * Write the case folder run->work/<name>/case, start the candidate, leave its output folder in `out`. False if there is no
 * answer to read: what happened has been recorded (exit 77 as skip, all else as failure) and the check should return.
 */
bool check_ask(struct check_run *run, const char *name, const struct question *q, char out[PATH_LENGTH]);

/* The same for a question within a question: folder <name>/<part>. No level or physics is looked at. */
bool check_ask_part(struct check_run *run, const char *name, const char *part, const struct question *q, char out[PATH_LENGTH]);

/* The candidate answered with something unreadable: record a failure with this sentence (file and line are in it). */
void check_garbage(struct check_run *run, const char *why);
/* One of the tables that a candidate need not write. False if it is not there (`what` is skipped), cannot be read or is empty (recorded). */
struct table;
bool check_table(struct check_run *run, const char *out, const char *file, const char *columns, const char *what, struct table *t);

/* What the answers so far may be off by rounding, relatively: of doubles as said, more where level or declared precision leave less. */
double check_rounding(const struct check_run *run, double of_double);

/* Progress of a long check ("draw 2000 of 20000"); shown only on a terminal. */
void check_progress(struct check_run *run, const char *format, ...) __attribute__((format(printf, 2, 3)));

/*
 * Recording. Each returns the new result, valid until the next one is recorded, so that picture and notes can be added
 * (result_picture, result_notes). The sentence is formatted; it is needed only where the result may not pass.
 */
/* Deterministic: passes if error <= tolerance; a NaN fails. */
struct result *check_error(struct check_run *run, enum judgement judgement, const char *what, double measured, double expected,
                           double error, double tolerance, const char *sentence, ...) __attribute__((format(printf, 8, 9)));
/* "Obeys": difference test. Inconclusive if what the sample can see (resolution) is coarser than what it must (declared). */
struct result *check_p(struct check_run *run, enum judgement judgement, const char *what, double measured, double expected,
                       double p, double resolution, double declared, const char *sentence, ...)
    __attribute__((format(printf, 9, 10)));
/*
 * "Agrees": equivalence test. The interval measured +- 4 standard errors lies inside expected +- margin: pass; outside:
 * fail; across an edge: inconclusive.
 */
struct result *check_interval(struct check_run *run, enum judgement judgement, const char *what, double measured,
                              double standard_error, double expected, double margin, const char *sentence, ...)
    __attribute__((format(printf, 8, 9)));
struct result *check_skip(struct check_run *run, const char *what, const char *sentence, ...)
    __attribute__((format(printf, 3, 4)));
struct result *check_inconclusive(struct check_run *run, const char *what, const char *sentence, ...)
    __attribute__((format(printf, 3, 4)));

void result_picture(struct result *r, const char *svg_file_in_work_folder);
void result_notes(struct result *r, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* --- for the gate --- */

#define STAGE_ONE_ALARM 1e-4
#define FEW_DIGITS 1e-5             /* errors below look like numbers of few digits, not like wrong physics; the six of %g are within */
#define SUITE_ALARM_RATE 1e-6
#define DECISIVE 1e-20              /* far below SUITE_ALARM_RATE over any number of results */

/* Runs the check with the two-stage rule; the results are final afterwards. `p_values`: those of the whole suite. */
void check_judge(struct check_run *run, const struct check *check, int p_values, unsigned seed_offset);
enum verdict result_counts(const struct result *r); /* its verdict; an accepted failure counts as skipped */
enum verdict results_verdict(const struct results *r);
const struct result *results_worst(const struct results *r);  /* one that was not judged only where none was */
size_t results_not_judged(const struct results *r);
const char *verdict_word(enum verdict v);           /* "pass", "skip", "inconclusive", "FAIL" */
json_t *results_to_json(const struct results *r);
bool results_from_json(const json_t *j, struct results *r);
void results_free(struct results *r);

#endif
