/* Counting verdicts, exit codes, and JUnit XML: the form that every CI system reads. */
#include "report.h"

#include "markup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum verdict finished_counts(const struct finished_case *done)
{
    switch (done->standing) {
    case KNOWN: return VERDICT_SKIP;
    case HEALED:
    case EXPIRED: return VERDICT_FAIL;
    case ADVISORY: return done->verdict > VERDICT_SKIP ? VERDICT_SKIP : done->verdict;
    case COUNTS: break;
    }
    return done->verdict;
}

const char *finished_word(const struct finished_case *done)
{
    switch (done->standing) {
    case KNOWN: return "known";
    case HEALED: return "HEALED";
    case EXPIRED: return "EXPIRED";
    case ADVISORY: return done->verdict > VERDICT_SKIP ? "warns" : verdict_word(done->verdict);
    case COUNTS: break;
    }
    return verdict_word(done->verdict);
}

void finished_free(struct finished_case *done)
{
    results_free(&done->results);
    free(done->remark);
    done->remark = NULL;
}

struct tally report_tally(const struct finished_case *done, size_t count)
{
    struct tally t = { 0 };
    for (size_t k = 0; k < count; k++) {
        const enum verdict v = finished_counts(&done[k]);
        t.passed += v == VERDICT_PASS;
        t.skipped += v == VERDICT_SKIP;
        t.inconclusive += v == VERDICT_INCONCLUSIVE;
        t.failed += v == VERDICT_FAIL || v == VERDICT_INCONCLUSIVE;
    }
    return t;
}

int report_exit_code(struct tally t)
{
    if (t.failed > t.inconclusive)
        return 1;
    if (t.inconclusive > 0)
        return 3;
    return t.passed > 0 ? 0 : 77;
}

static void property(FILE *file, const char *name, const char *value)
{
    fprintf(file, "    <property name=\"%s\" value=\"", name);
    markup_text(file, value);
    fputs("\"/>\n", file);
}

/* A result as one line of text: what, numbers, sentence. */
static void result_line(FILE *file, const struct result *r)
{
    fprintf(file, "%s: ", r->accepted ? "known" : verdict_word(r->verdict));
    markup_text(file, r->what);
    fprintf(file, ": measured %.17g, expected %.17g, ", r->measured, r->expected);
    if (isnan(r->p))
        fprintf(file, "error %.3g, tolerance %.3g", r->error, r->tolerance);
    else
        fprintf(file, "p %.3g", r->p);
    if (r->verdict != VERDICT_PASS && r->sentence) {
        fputs(": ", file);
        markup_text(file, r->sentence);
    }
    fputc('\n', file);
}

/* "healed: <what known.json has to do with it>: <the worst sentence>" */
static void message(FILE *file, const struct finished_case *done)
{
    const struct result *worst = results_worst(&done->results);
    if (done->standing != COUNTS) {
        markup_text(file, done->standing == ADVISORY ? "newer than the suite asked, a warning" : finished_word(done));
        fputs(": ", file);
    }
    if (done->remark) {
        markup_text(file, done->remark);
        fputs(": ", file);
    }
    markup_text(file, worst && worst->sentence ? worst->sentence : "no result");
}

static void testcase(FILE *file, const struct finished_case *done)
{
    const enum verdict v = finished_counts(done);
    fprintf(file, "  <testcase classname=\"gate.%s\" name=\"", layer_name(done->gate_case->layer));
    markup_text(file, done->gate_case->name);
    fprintf(file, "\" time=\"%.3f\">\n", done->seconds);
    if (v == VERDICT_SKIP) {
        fputs("    <skipped message=\"", file);
        message(file, done);
        fputs("\"/>\n", file);
    } else if (v != VERDICT_PASS) {
        fprintf(file, "    <failure type=\"%s\" message=\"", v == VERDICT_FAIL ? "fail" : "inconclusive");
        message(file, done);
        fputs("\">", file);
        for (enum judgement j = INVARIANT; j <= MODEL; j++)
            for (size_t k = 0; k < done->results.count; k++)
                if (done->results.item[k].judgement == j && done->results.item[k].verdict != VERDICT_PASS)
                    result_line(file, &done->results.item[k]);
        fputs("</failure>\n", file);
    }
    fputs("    <system-out>", file);
    for (size_t k = 0; k < done->results.count; k++)
        result_line(file, &done->results.item[k]);
    fputs("</system-out>\n  </testcase>\n", file);
}

bool report_junit(const char *path, const struct provenance *p, const struct finished_case *done, size_t count,
                  char why[WHY_LENGTH])
{
    FILE *file = fopen(path, "w");
    if (!file)
        return why_not(why, "cannot write %s", path);
    const struct tally t = report_tally(done, count);
    fprintf(file, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n<testsuite name=\"gate\" tests=\"%zu\" failures=\"%d\" "
                  "errors=\"0\" skipped=\"%d\" time=\"%.3f\" timestamp=\"%s\">\n  <properties>\n",
            count, t.failed, t.skipped, p->seconds, p->date);
    property(file, "gate", p->gate_version);
    property(file, "suite", p->suite);
    property(file, "suite-hash", p->suite_hash);
    property(file, "candidate", p->candidate);
    property(file, "candidate-hash", p->candidate_hash);
    property(file, "level", p->level);
    property(file, "precision", p->precision);
    property(file, "not-tested", p->not_tested);
    fputs("  </properties>\n", file);
    for (size_t k = 0; k < count; k++)
        testcase(file, &done[k]);
    fputs("</testsuite>\n</testsuites>\n", file);
    return fclose(file) == 0 ? true : why_not(why, "cannot write %s: disk full?", path);
}
