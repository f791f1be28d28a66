/* Lines for people and logs. The columns are fixed so that a log can be read, and cut, by eye. */
#include "terminal.h"

#include "coverage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SENTENCES_AT_MOST = 6 };

static const char *colour(enum verdict v)
{
    static const char *const codes[] = { "\033[32m", "\033[90m", "\033[33m", "\033[1;31m" };
    return isatty(STDOUT_FILENO) ? codes[v] : "";
}

static const char *plain(void)
{
    return isatty(STDOUT_FILENO) ? "\033[0m" : "";
}

void terminal_number(char *text, size_t room, double x)
{
    if (isnan(x))
        snprintf(text, room, "-");
    else
        snprintf(text, room, "%.6g", x);
}

void terminal_error(char *text, size_t room, const struct result *r)
{
    if (!isnan(r->p))
        snprintf(text, room, "p %.2g", r->p);
    else if (!isnan(r->error))
        snprintf(text, room, "%.2g", r->error);
    else
        snprintf(text, room, "-");
}

void terminal_open(const struct provenance *p)
{
    printf("gate %s, suite %s (%s), candidate '%s' (%s), entry level %s, %s precision; not tested: %s\n", p->gate_version, p->suite,
           p->suite_hash, p->candidate, p->candidate_hash, p->level, p->precision, p->not_tested);
    printf("%-10s %-28s %-34s %13s %13s %9s  %-12s %s\n", "layer", "case", "worst of", "measured", "expected", "error",
           "verdict", "seconds");
    fflush(stdout);
}

static int worse_first(const void *a, const void *b)
{
    const struct result *p = *(const struct result *const *)a, *q = *(const struct result *const *)b;
    if (result_counts(p) != result_counts(q))
        return (int)result_counts(q) - (int)result_counts(p);
    return p->judgement != q->judgement ? (int)p->judgement - (int)q->judgement : (p > q) - (p < q);
}

/* Wrapped at 116 columns, indented under the case's line. */
static void print_wrapped(enum verdict shade, const char *label, const char *sentence)
{
    printf("           %s%s%s:", colour(shade), label, plain());
    int column = 24;
    for (const char *word = sentence ? sentence : ""; *word;) {
        const int n = (int)strcspn(word, " \n");
        if (column + n > 116)
            column = printf("\n               ") - 1;
        else
            putchar(' ');
        printf("%.*s", n, word);
        column += n + 1;
        word += n;
        word += strspn(word, " \n");
    }
    putchar('\n');
}

/* What is wrong ends with the name of the quantity, by which known.json accepts it. */
static void print_sentence(const struct result *r)
{
    char text[3 * WHY_LENGTH];
    snprintf(text, sizeof text, r->verdict == VERDICT_SKIP ? "%s" : "%s [%s]", r->sentence ? r->sentence : "", r->what);
    print_wrapped(result_counts(r), r->accepted ? "known" : r->verdict == VERDICT_FAIL ? "fails" : verdict_word(r->verdict), text);
}

/* What a quantity is called without the variant of the scene: "x along y, time 1.3: torque" is a "torque". */
static const char *kind_of(const struct result *r)
{
    const char *colon = strrchr(r->what, ':');
    return colon ? colon + 1 : r->what;
}

/* One of each kind comes before a second of any: six times the same sentence would hide the one that names the term. */
static void different_first(const struct result **order, int count)
{
    const struct result **again = malloc(((size_t)count + 1) * sizeof *again);
    int first = 0, later = 0;
    for (int k = 0; k < count; k++) {
        bool seen = false;
        for (int n = 0; n < first && !seen; n++)
            seen = result_counts(order[n]) == result_counts(order[k]) && strcmp(kind_of(order[n]), kind_of(order[k])) == 0;
        if (seen)
            again[later++] = order[k];
        else
            order[first++] = order[k];
    }
    memcpy(order + first, again, (size_t)later * sizeof *again);
    free(again);
}

static void print_sentences(const struct results *r)
{
    const struct result **order = malloc((r->count + 1) * sizeof *order);
    int count = 0;
    for (size_t k = 0; k < r->count; k++)
        if (r->item[k].verdict != VERDICT_PASS)
            order[count++] = &r->item[k];
    qsort(order, (size_t)count, sizeof *order, worse_first);
    different_first(order, count);
    for (int k = 0; k < count && k < SENTENCES_AT_MOST; k++)
        print_sentence(order[k]);
    if (count > SENTENCES_AT_MOST)
        printf("           ... and %d more; the report has them all\n", count - SENTENCES_AT_MOST);
    free(order);
}

void terminal_case(const struct finished_case *done)
{
    char measured[32] = "-", expected[32] = "-", error[32] = "-";
    const struct result *worst = results_worst(&done->results);
    if (worst) {
        terminal_number(measured, sizeof measured, worst->measured);
        terminal_number(expected, sizeof expected, worst->expected);
        terminal_error(error, sizeof error, worst);
    }
    printf("%-10s %-28s %-34.34s %13s %13s %9s  %s%-12s%s %.1f\n", layer_name(done->gate_case->layer), done->gate_case->name,
           worst ? worst->what : "no result", measured, expected, error, colour(finished_counts(done)), finished_word(done),
           plain(), done->seconds);
    if (done->remark)
        print_wrapped(finished_counts(done), finished_word(done), done->remark);
    const size_t skipped = results_not_judged(&done->results);
    if (skipped && skipped < done->results.count)
        printf("           %zu of %zu not judged\n", skipped, done->results.count);
    print_sentences(&done->results);
    fflush(stdout);
}

/* Cases that pass in what was judged, and how much of them was not. */
static void name_passed_in_part(const struct finished_case *done, size_t count)
{
    bool first = true;
    for (size_t k = 0; k < count; k++) {
        const size_t skipped = results_not_judged(&done[k].results);
        if (finished_counts(&done[k]) != VERDICT_PASS || skipped == 0)
            continue;
        printf("%s %s (%zu of %zu)", first ? "passed, but for what was not judged:" : ",", done[k].gate_case->name, skipped, done[k].results.count);
        first = false;
    }
    if (!first)
        putchar('\n');
}

/* Names the cases that are called this way ("FAIL", "known", "warns"). */
static void name_those(const char *head, const char *word, const struct finished_case *done, size_t count)
{
    bool first = true;
    for (size_t k = 0; k < count; k++)
        if (strcmp(finished_word(&done[k]), word) == 0) {
            printf("%s %s", first ? head : ",", done[k].gate_case->name);
            first = false;
        }
    if (!first)
        putchar('\n');
}

void terminal_close(const struct provenance *p, const struct finished_case *done, size_t count, struct tally t)
{
    double candidate = 0;
    for (size_t k = 0; k < count; k++)
        candidate += done[k].candidate_seconds;
    if (p->coverage)
        coverage_print(p->coverage);
    name_those("failed:", "FAIL", done, count);
    name_those("healed, to be taken out of known.json (counted as failed):", "HEALED", done, count);
    name_those("expired in known.json (counted as failed):", "EXPIRED", done, count);
    name_those("inconclusive (counted as failed):", "inconclusive", done, count);
    name_those("known failures (counted as skipped):", "known", done, count);
    name_those("fail, but are newer than the suite asked (warnings, counted as skipped):", "warns", done, count);
    name_passed_in_part(done, count);
    name_those("skipped, the candidate does not have this physics:", "skip", done, count);
    printf("%.1f s, of which %.1f s of candidate runs\n", p->seconds, candidate);
    printf("%d passed, %d failed, %d skipped\n", t.passed, t.failed, t.skipped);
}
