/*
 * Recording results and the one rule for alarms.
 *
 * A correct candidate gives p-values spread evenly over (0, 1), so some are small by chance. Stage 1 alarms at
 * p < 1e-4; the check then runs again with a fresh seed and four times the samples, and only p < 1e-6/(number of
 * statistical results in the suite) fails. Both together happen by chance less than once in 1e10 runs of the suite;
 * a real fault that raised the first alarm comes back with p far smaller.
 */
#include "check.h"
#include "offline.h"
#include "precision.h"
#include "tables.h"

#include <fnmatch.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char *copy_text(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    return strcpy(copy, text);
}

static char *format_text(const char *format, va_list arguments)
{
    char text[2 * WHY_LENGTH];
    vsnprintf(text, sizeof text, format, arguments);
    return copy_text(text);
}

static struct result *append(struct check_run *run, enum judgement judgement, const char *what, double measured,
                             double expected)
{
    struct results *all = &run->results;
    all->item = realloc(all->item, (all->count + 1) * sizeof *all->item);
    struct result *r = &all->item[all->count++];
    *r = (struct result){ .judgement = judgement, .measured = measured, .expected = expected, .error = NAN, .tolerance = NAN,
                          .p = NAN, .first_p = NAN, .resolution = NAN, .declared = NAN };
    r->what = copy_text(what);
    return r;
}

/* Fills the sentence of a result from the arguments of a variadic caller. */
#define WITH_SENTENCE(r)                                                                                                    \
    do {                                                                                                                    \
        va_list arguments;                                                                                                  \
        va_start(arguments, sentence);                                                                                      \
        (r)->sentence = format_text(sentence, arguments);                                                                   \
        va_end(arguments);                                                                                                  \
    } while (0)

/*
 * What fails the tolerance of the case has the allowance of the declared precision and level on top. Where that is more than a verdict can stand, what
 * lies in between is not judged.
 */
static void allow_for_precision(const struct check_run *run, struct result *r)
{
    double more = run->allowance;
    if (run->amplification > 0 && r->tolerance < 1e-8)      /* of a run: such a tolerance is rounding of a double times what the run makes of it */
        more = fmax(more, r->tolerance * run->amplification);
    r->allowance = more;
    if (r->error <= r->tolerance + fmin(more, ALLOWANCE_AT_MOST))
        r->verdict = VERDICT_PASS;
    else if (r->error <= r->tolerance + more) {
        char text[WHY_LENGTH];
        snprintf(text, sizeof text, "not judged: an error of %.2g is within what may be expected (%.2g, %s), but too much for a verdict", r->error, more,
                 run->allowance_reason);
        free(r->sentence);
        r->sentence = copy_text(text);
        r->verdict = VERDICT_SKIP;
    } else
        return;
    r->tolerance += fmin(more, ALLOWANCE_AT_MOST);
    result_notes(r, "The tolerance is %.2g wider than that of the case %s.", fmin(more, ALLOWANCE_AT_MOST), run->allowance_reason);
}

double check_rounding(const struct check_run *run, double of_double)
{
    return fmax(of_double, fmin(run->allowance, ALLOWANCE_AT_MOST));
}

struct result *check_error(struct check_run *run, enum judgement judgement, const char *what, double measured, double expected,
                           double error, double tolerance, const char *sentence, ...)
{
    struct result *r = append(run, judgement, what, measured, expected);
    WITH_SENTENCE(r);
    r->error = error;
    r->tolerance = tolerance;
    r->verdict = error <= tolerance ? VERDICT_PASS : VERDICT_FAIL;
    if (error < 0) {                            /* WORST_NONE: of all that should have been compared nothing was there */
        free(r->sentence);
        r->sentence = copy_text("nothing was compared: what the candidate wrote has not one of the rows that are asked for");
        r->verdict = VERDICT_FAIL;
    }
    if (r->verdict == VERDICT_FAIL && run->allowance > 0 && !(error < 0))
        allow_for_precision(run, r);
    return r;
}

struct result *check_p(struct check_run *run, enum judgement judgement, const char *what, double measured, double expected,
                       double p, double resolution, double declared, const char *sentence, ...)
{
    struct result *r = append(run, judgement, what, measured, expected);
    WITH_SENTENCE(r);
    r->p = r->first_p = p;
    r->resolution = resolution;
    r->declared = declared;
    r->verdict = VERDICT_PASS; /* settled by check_judge; a sample too small to see what it must never passes */
    if (isnan(p))
        r->verdict = VERDICT_FAIL;
    else if (resolution > declared)
        r->verdict = VERDICT_INCONCLUSIVE;
    return r;
}

struct result *check_interval(struct check_run *run, enum judgement judgement, const char *what, double measured,
                              double standard_error, double expected, double margin, const char *sentence, ...)
{
    struct result *r = append(run, judgement, what, measured, expected);
    WITH_SENTENCE(r);
    const double distance = fabs(measured - expected), half_width = 4 * standard_error;
    r->error = distance + half_width;
    r->tolerance = margin;
    r->resolution = half_width;
    if (distance + half_width <= margin)
        r->verdict = VERDICT_PASS;
    else if (distance - half_width <= margin && isfinite(distance))
        r->verdict = VERDICT_INCONCLUSIVE;
    else
        r->verdict = VERDICT_FAIL;
    return r;
}

struct result *check_skip(struct check_run *run, const char *what, const char *sentence, ...)
{
    struct result *r = append(run, INVARIANT, what, NAN, NAN);
    WITH_SENTENCE(r);
    r->verdict = VERDICT_SKIP;
    return r;
}

struct result *check_inconclusive(struct check_run *run, const char *what, const char *sentence, ...)
{
    struct result *r = append(run, INVARIANT, what, NAN, NAN);
    WITH_SENTENCE(r);
    r->verdict = VERDICT_INCONCLUSIVE;
    return r;
}

void check_garbage(struct check_run *run, const char *why)
{
    check_error(run, INVARIANT, "readable answer", NAN, NAN, NAN, NAN, "candidate wrote garbage or too little: %s", why);
}

bool check_table(struct check_run *run, const char *out, const char *file, const char *columns, const char *what, struct table *t)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    path_join(path, out, file);
    if (access(path, F_OK) != 0) {
        if (capabilities_list(run->candidate->capabilities, "observers"))
            check_error(run, INVARIANT, what, NAN, NAN, NAN, NAN, "the scene asks for %s, and the candidate has not written it; one that has no tables of a run declares so: "
                        "capabilities without \"observers\" (docs/adapter.md)", file);
        else
            check_skip(run, what, "the candidate writes no %s", file);
        return false;
    }
    if (!table_read(path, columns, t, why)) {
        check_garbage(run, why);
        return false;
    }
    if (t->rows > 0)
        return true;
    table_free(t);
    snprintf(why, sizeof why, "%s has no rows", file);
    check_garbage(run, why);
    return false;
}

void result_picture(struct result *r, const char *svg_file_in_work_folder)
{
    free(r->picture);
    r->picture = copy_text(svg_file_in_work_folder);
}

void result_notes(struct result *r, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    free(r->notes);
    r->notes = format_text(format, arguments);
    va_end(arguments);
}

static void free_result(struct result *r)
{
    free(r->what);
    free(r->sentence);
    free(r->picture);
    free(r->notes);
}

void results_free(struct results *r)
{
    for (size_t k = 0; k < r->count; k++)
        free_result(&r->item[k]);
    free(r->item);
    *r = (struct results){ 0 };
}

enum verdict result_counts(const struct result *r)
{
    return r->accepted ? VERDICT_SKIP : r->verdict;
}

/* What matters most: a failed invariant before a failed model, among equals the one furthest beyond its limit; last what was not judged. */
static double badness(const struct result *r)
{
    if (r->verdict == VERDICT_SKIP)
        return -1;
    const double excess = !isnan(r->p) ? -log10(r->p + 1e-300) / 6 : r->error / r->tolerance;
    return 1e6 * (double)(int)result_counts(r) + (result_counts(r) == VERDICT_FAIL && r->judgement == INVARIANT ? 5e5 : 0)
           + (isnan(excess) ? 4e5 : fmin(excess, 4e5));
}

const struct result *results_worst(const struct results *r)
{
    const struct result *worst = NULL;
    for (size_t k = 0; k < r->count; k++)
        if (!worst || badness(&r->item[k]) > badness(worst))
            worst = &r->item[k];
    return worst;
}

/* Pass only if something passed and nothing is worse than skipped; no result at all is no pass. */
enum verdict results_verdict(const struct results *r)
{
    bool passed = false;
    enum verdict worst = VERDICT_PASS;
    for (size_t k = 0; k < r->count; k++) {
        passed = passed || r->item[k].verdict == VERDICT_PASS;
        if (result_counts(&r->item[k]) > worst)
            worst = result_counts(&r->item[k]);
    }
    if (r->count == 0)
        return VERDICT_INCONCLUSIVE;
    return worst == VERDICT_SKIP && passed ? VERDICT_PASS : worst;
}

size_t results_not_judged(const struct results *r)
{
    size_t skipped = 0;
    for (size_t k = 0; k < r->count; k++)
        skipped += r->item[k].verdict == VERDICT_SKIP;
    return skipped;
}

const char *verdict_word(enum verdict v)
{
    static const char *const words[] = { "pass", "skip", "inconclusive", "FAIL" };
    return words[v];
}

static const struct result *find(const struct results *all, const char *what)
{
    for (size_t k = 0; k < all->count; k++)
        if (strcmp(all->item[k].what, what) == 0)
            return &all->item[k];
    return NULL;
}

static bool alarms(const struct result *r)
{
    return !isnan(r->p) && r->p < STAGE_ONE_ALARM;
}

/* The final verdict of a result that alarmed, from its rerun. Keeps what the rerun says; it saw four times as much. */
static void settle(struct result *first, const struct result *again, double limit)
{
    const double p1 = first->p;
    if (!again || isnan(again->p)) {
        first->verdict = VERDICT_INCONCLUSIVE;
        result_notes(first, "First p = %.2g is an alarm; the rerun gave no such result.", p1);
        return;
    }
    first->p = again->p;
    first->measured = again->measured;
    first->expected = again->expected;
    first->resolution = again->resolution;
    free(first->sentence);
    first->sentence = copy_text(again->sentence);
    if (again->picture)
        result_picture(first, again->picture);
    first->verdict = again->p < limit ? VERDICT_FAIL : again->verdict;
    result_notes(first, "First p = %.2g; rerun with a fresh seed and 4 times the samples p = %.2g, limit %.2g.%s%s", p1,
                 again->p, limit, again->notes ? " " : "", again->notes ? again->notes : "");
}

/* Failures of the rerun that need no statistics (a crash, a broken identity) count as well. */
static void keep_failures(struct check_run *run, const struct results *again)
{
    for (size_t k = 0; k < again->count; k++) {
        const struct result *r = &again->item[k];
        if (r->verdict != VERDICT_FAIL || !isnan(r->p))
            continue;
        const struct result *known = find(&run->results, r->what);
        if (known && known->verdict == VERDICT_FAIL)
            continue;
        struct result *added = append(run, r->judgement, r->what, r->measured, r->expected);
        added->error = r->error;
        added->tolerance = r->tolerance;
        added->verdict = r->verdict;
        added->sentence = copy_text(r->sentence);
        result_notes(added, "Seen in the rerun.");
    }
}

/* A seed of its own for every case, attempt and offset; offset 0, attempt 1 is the seed written in the case. */
static unsigned attempt_seed(unsigned seed, unsigned offset, int attempt)
{
    if (offset == 0 && attempt == 1)
        return seed;
    uint64_t z = ((uint64_t)seed << 32) + 2 * (uint64_t)offset + (uint64_t)attempt;
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return (unsigned)(z >> 32);
}

static void run_attempt(struct check_run *run, const struct check *check, int attempt, unsigned seed_offset)
{
    run->attempt = attempt;
    run->samples = attempt == 1 ? 1 : 4;
    run->seed = attempt_seed(run->gate_case->seed, seed_offset, attempt);
    check->run(run);
}

/*
 * A case that has failed without a second look: something that needs no statistics is wrong, or a p is so small that four times the samples
 * could not change the verdict. Alarms beside it stay unsettled.
 */
static bool settled_at_once(struct check_run *run)
{
    bool failed = false;
    for (size_t k = 0; k < run->results.count; k++)
        failed = failed || run->results.item[k].verdict == VERDICT_FAIL || run->results.item[k].p < DECISIVE;
    for (size_t k = 0; k < run->results.count && failed; k++) {
        struct result *r = &run->results.item[k];
        if (alarms(r)) {
            r->verdict = r->p < DECISIVE ? VERDICT_FAIL : VERDICT_INCONCLUSIVE;
            result_notes(r, r->p < DECISIVE ? "p = %.2g at the first look needs no second." : "First p = %.2g is an alarm; not looked at again, for the case has failed.", r->p);
        }
    }
    return failed;
}

/* A case that names a quantity for a term must have judged one: else the coverage matrix claims what nobody asked. */
static void judge_terms(struct check_run *run)
{
    const char *term;
    json_t *patterns;
    json_object_foreach(run->gate_case->terms, term, patterns)
        for (size_t p = 0; p < json_array_size(patterns); p++) {
            const char *pattern = json_string_value(json_array_get(patterns, p));
            size_t k = 0;
            while (k < run->results.count && fnmatch(pattern, run->results.item[k].what, 0) != 0)
                k++;
            if (k == run->results.count)
                check_error(run, INVARIANT, "terms of the case", NAN, NAN, NAN, NAN,
                            "the case says that its quantity '%s' judges the term '%s', and it has judged no such quantity; this "
                            "is a mistake in the suite", pattern, term);
        }
}

void check_judge(struct check_run *run, const struct check *check, int p_values, unsigned seed_offset)
{
    run_attempt(run, check, 1, seed_offset);
    if (results_verdict(&run->results) == VERDICT_PASS) /* else it may not have come so far */
        judge_terms(run);
    bool alarm = false;
    int given = 0;
    for (size_t k = 0; k < run->results.count; k++) {
        alarm = alarm || alarms(&run->results.item[k]);
        given += !isnan(run->results.item[k].p);
    }
    if (given > run->gate_case->p_values)
        check_error(run, INVARIANT, "number of p-values", given, run->gate_case->p_values, given, run->gate_case->p_values,
                    "the check gives more p-values than its case declares; this is a mistake in the suite");
    if (!alarm || settled_at_once(run) || offline_waits(run->candidate))
        return;
    struct results first = run->results;
    run->results = (struct results){ 0 };
    run_attempt(run, check, 2, seed_offset);
    struct results again = run->results;
    run->results = first;
    for (size_t k = 0; k < run->results.count; k++)
        if (alarms(&run->results.item[k]))
            settle(&run->results.item[k], offline_waits(run->candidate) ? NULL : find(&again, run->results.item[k].what), SUITE_ALARM_RATE / p_values);
    if (!offline_waits(run->candidate))
        keep_failures(run, &again);
    results_free(&again);
}
