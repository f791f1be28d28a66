/* Counting verdicts, exit codes, and JUnit XML: the form that every CI system reads. */
#include "report.h"

#include "markup.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct tally report_tally(const struct finished_case *done, size_t count)
{
    struct tally t = { 0 };
    for (size_t k = 0; k < count; k++) {
        t.passed += done[k].verdict == VERDICT_PASS;
        t.skipped += done[k].verdict == VERDICT_SKIP;
        t.inconclusive += done[k].verdict == VERDICT_INCONCLUSIVE;
        t.failed += done[k].verdict == VERDICT_FAIL || done[k].verdict == VERDICT_INCONCLUSIVE;
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
    fprintf(file, "%s: ", verdict_word(r->verdict));
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

static void testcase(FILE *file, const struct finished_case *done)
{
    const struct result *worst = results_worst(&done->results);
    fprintf(file, "  <testcase classname=\"gate.%s\" name=\"", layer_name(done->gate_case->layer));
    markup_text(file, done->gate_case->name);
    fprintf(file, "\" time=\"%.3f\">\n", done->seconds);
    const char *sentence = worst && worst->sentence ? worst->sentence : "no result";
    if (done->verdict == VERDICT_SKIP) {
        fputs("    <skipped message=\"", file);
        markup_text(file, sentence);
        fputs("\"/>\n", file);
    } else if (done->verdict != VERDICT_PASS) {
        fprintf(file, "    <failure type=\"%s\" message=\"", done->verdict == VERDICT_FAIL ? "fail" : "inconclusive");
        markup_text(file, sentence);
        fputs("\">", file);
        for (size_t k = 0; k < done->results.count; k++)
            if (done->results.item[k].verdict != VERDICT_PASS)
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
    property(file, "gate", p->suite_version);
    property(file, "suite", p->suite_hash);
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
