/* GitHub's workflow commands and step summary (docs.github.com, "Workflow commands for GitHub Actions"). */
#include "github.h"

#include "coverage.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { ANNOTATIONS_AT_MOST = 10, SENTENCES_AT_MOST = 6 };

/* Values of properties escape more than messages do. */
static void escaped(FILE *f, const char *text, bool in_property)
{
    for (; text && *text; text++)
        if (*text == '%' || *text == '\n' || *text == '\r' || (in_property && (*text == ':' || *text == ',')))
            fprintf(f, "%%%02X", (unsigned char)*text);
        else
            fputc(*text, f);
}

/* Markdown: every sign that could mean something is made plain. */
static void plain(FILE *f, const char *text)
{
    for (; text && *text; text++) {
        if (strchr("\\`*_{}[]<>#|~$&!", *text))
            fputc('\\', f);
        fputc(*text == '\n' ? ' ' : *text, f);
    }
}

/* The first word of the command that is a file given relative to the current folder; false if there is none. */
static bool adapter_file(const char *command, char path[PATH_LENGTH])
{
    while (*command) {
        command += strspn(command, " \t\"'");
        const size_t n = strcspn(command, " \t\"'");
        struct stat status;
        snprintf(path, PATH_LENGTH, "%.*s", (int)(n < PATH_LENGTH ? n : PATH_LENGTH - 1), command);
        if (n > 0 && path[0] != '/' && stat(path, &status) == 0 && S_ISREG(status.st_mode)) {
            if (strncmp(path, "./", 2) == 0)
                memmove(path, path + 2, strlen(path + 2) + 1);
            return true;
        }
        command += n;
    }
    return false;
}

static bool shown(const struct finished_case *done)
{
    return finished_counts(done) >= VERDICT_INCONCLUSIVE || (done->standing == ADVISORY && done->verdict > VERDICT_SKIP);
}

static const char *what_is_wrong(const struct finished_case *done)
{
    const struct result *worst = results_worst(&done->results);
    if (done->remark && (done->standing == HEALED || done->standing == EXPIRED))
        return done->remark;
    return worst && worst->sentence ? worst->sentence : "no result";
}

static void annotate(FILE *out, const struct provenance *p, const struct finished_case *done, const char *known_file)
{
    char file[PATH_LENGTH];
    const bool by_list = done->standing == HEALED || done->standing == EXPIRED;
    fprintf(out, "::%s ", finished_counts(done) >= VERDICT_INCONCLUSIVE ? "error" : "warning");
    if (by_list && known_file) {
        fputs("file=", out);
        escaped(out, known_file, true);
        fputc(',', out);
    } else if (adapter_file(p->candidate, file)) {
        fputs("file=", out);
        escaped(out, file, true);
        fputc(',', out);
    }
    fputs("title=", out);
    escaped(out, layer_name(done->gate_case->layer), true);
    fprintf(out, " / ");
    escaped(out, done->gate_case->name, true);
    fprintf(out, " (%s)::", finished_word(done));
    escaped(out, what_is_wrong(done), false);
    fputc('\n', out);
}

void github_annotate(FILE *out, const struct provenance *p, const struct finished_case *done, size_t count, const char *known_file)
{
    size_t all = 0, told = 0;
    for (size_t k = 0; k < count; k++)
        all += shown(&done[k]);
    const char *worst = report_tally(done, count).failed ? "error" : "warning";
    for (int errors = 1; errors >= 0; errors--)     /* errors before warnings */
        for (size_t k = 0; k < count; k++) {
            if (!shown(&done[k]) || (finished_counts(&done[k]) >= VERDICT_INCONCLUSIVE) != (errors == 1))
                continue;
            if (++told < ANNOTATIONS_AT_MOST || all == ANNOTATIONS_AT_MOST)
                annotate(out, p, &done[k], known_file);
        }
    if (all > ANNOTATIONS_AT_MOST)
        fprintf(out, "::%s title=sheargate::%zu more cases are wrong; the summary of this step and the report name them\n", worst,
                all - ANNOTATIONS_AT_MOST + 1);
}

static void summary_case(FILE *out, const struct finished_case *done)
{
    int told = 0, all = 0;
    fprintf(out, "\n**%s / %s** (%s)\n\n", layer_name(done->gate_case->layer), done->gate_case->name, finished_word(done));
    if (done->remark) {
        fputs("- ", out);
        plain(out, done->remark);
        fputc('\n', out);
    }
    for (enum judgement j = INVARIANT; j <= MODEL; j++)
        for (size_t k = 0; k < done->results.count; k++) {
            const struct result *r = &done->results.item[k];
            if (r->judgement != j || r->verdict < VERDICT_INCONCLUSIVE || ++all > SENTENCES_AT_MOST)
                continue;
            fputs(r->verdict == VERDICT_INCONCLUSIVE ? "- inconclusive: " : j == INVARIANT ? "- invariant: " : "- model: ", out);
            plain(out, r->sentence);
            fputc('\n', out);
            told++;
        }
    if (all > told)
        fprintf(out, "- and %d more\n", all - told);
}

static void summary_cases(FILE *out, const char *head, bool red, const struct finished_case *done, size_t count)
{
    bool first = true;
    for (size_t k = 0; k < count; k++) {
        const bool not_counted = done[k].standing == KNOWN || (done[k].standing == ADVISORY && done[k].verdict > VERDICT_SKIP);
        if (red ? finished_counts(&done[k]) < VERDICT_INCONCLUSIVE : !not_counted)
            continue;
        if (first)
            fprintf(out, "\n### %s\n", head);
        first = false;
        summary_case(out, &done[k]);
    }
}

static void summary_layers(FILE *out, const struct finished_case *done, size_t count)
{
    fputs("\n| layer | passed | failed | skipped |\n| --- | ---: | ---: | ---: |\n", out);
    for (int layer = LAYER_PAIR; layer <= LAYER_PUBLISHED; layer++) {
        int n[3] = { 0 };
        for (size_t k = 0; k < count; k++)
            if ((int)done[k].gate_case->layer == layer) {
                const enum verdict v = finished_counts(&done[k]);
                n[v == VERDICT_PASS ? 0 : v == VERDICT_SKIP ? 2 : 1]++;
            }
        if (n[0] + n[1] + n[2] > 0)
            fprintf(out, "| %d %s | %d | %d | %d |\n", layer, layer_name((enum layer)layer), n[0], n[1], n[2]);
    }
}

static void summary_terms(FILE *out, const struct coverage *c)
{
    fputs("\n<details><summary>Physics terms</summary>\n\n| term | verdict | cases: pass, fail, inconclusive | not tested: skipped, not "
          "asked |\n| --- | --- | --- | --- |\n", out);
    for (size_t k = 0; k < c->rows; k++) {
        const struct coverage_cell *all = &c->row[k].layer[0];
        fputs("| ", out);
        plain(out, c->row[k].term);
        fprintf(out, " | %s | %d, %d, %d | %d, %d |\n", coverage_word(all), all->passed, all->failed, all->inconclusive,
                all->skipped, all->left_out);
    }
    fputs("\n</details>\n", out);
}

void github_summary(FILE *out, const struct provenance *p, const struct finished_case *done, size_t count)
{
    const struct tally t = report_tally(done, count);
    fprintf(out, "## sheargate: %d passed, %d failed, %d skipped\n\ngate %s, suite %s (%s), candidate `%s` (%s), entry level %s, %s "
                 "precision; not tested: ", t.passed, t.failed, t.skipped, p->gate_version, p->suite, p->suite_hash, p->candidate,
            p->candidate_hash, p->level, p->precision);
    plain(out, p->not_tested);
    fputc('\n', out);
    summary_layers(out, done, count);
    summary_cases(out, "What is wrong", true, done, count);
    summary_cases(out, "Wrong, but not counted", false, done, count);
    if (p->coverage)
        summary_terms(out, p->coverage);
}

bool github_report(const struct provenance *p, const struct finished_case *done, size_t count, const char *known_file,
                   char why[WHY_LENGTH])
{
    const char *on_github = getenv("GITHUB_ACTIONS"), *path = getenv("GITHUB_STEP_SUMMARY");
    if (!on_github || strcmp(on_github, "true") != 0)
        return true;
    github_annotate(stdout, p, done, count, known_file);
    if (!path || !*path)
        return true;
    FILE *out = fopen(path, "a");
    if (!out)
        return why_not(why, "cannot write %s (GITHUB_STEP_SUMMARY)", path);
    github_summary(out, p, done, count);
    return fclose(out) == 0 ? true : why_not(why, "cannot write %s: disk full?", path);
}
