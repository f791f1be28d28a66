/*
 * The page for people: one file, no network, no script. What is wrong stands first, in sentences; then each layer with
 * its numbers; each case opens to all of its results, its pictures, its tolerance with the reason, and its flags.
 */
#include "coverage.h"
#include "html_style.h"
#include "markup.h"
#include "terminal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const layer_asks[] = {
    "Force, torque and stress of frozen pairs, each term alone and together.",
    "Covariance of the Brownian forces on a frozen configuration.",
    "One free particle: diffusion, velocity autocorrelation, drift in shear.",
    "Two bodies: collisions, friction, lubrication approach, equipartition.",
    "The dilute limit: Einstein's viscosity and the phi\302\262 coefficient of the model.",
    "Dense suspensions against independent codes and equations of state.",
    "Published curves and tables.",
};

static const char *const kind[] = { "pass", "skip", "unsure", "fail" };

/* `word`: null for the plain word of the verdict. */
static void badge(FILE *f, enum verdict v, const char *word)
{
    static const char *const plain[] = { "pass", "skipped", "inconclusive", "FAIL" };
    fprintf(f, "<span class=\"badge %s\">%s</span>", kind[v], word ? word : plain[v]);
}

static void case_badge(FILE *f, const struct finished_case *done)
{
    const bool plain = done->standing == COUNTS || (done->standing == ADVISORY && done->verdict <= VERDICT_SKIP);
    badge(f, finished_counts(done), plain ? NULL : finished_word(done));
}

static void cell(FILE *f, double x)
{
    char text[32];
    terminal_number(text, sizeof text, x);
    fprintf(f, "<td class=num>%s</td>", strcmp(text, "-") == 0 ? "\342\200\223" : text);
}

static void error_cell(FILE *f, const struct result *r)
{
    char text[32];
    terminal_error(text, sizeof text, r);
    fprintf(f, "<td class=num>%s</td>", strcmp(text, "-") == 0 ? "\342\200\223" : text);
}

static void limit_cell(FILE *f, const struct result *r)
{
    if (!isnan(r->p) && !isnan(r->declared))
        fprintf(f, "<td class=num>sees %.2g, must see %.2g</td>", r->resolution, r->declared);
    else
        cell(f, r->tolerance);
}

static void heading(FILE *f, const struct provenance *p, const struct finished_case *done, size_t count, struct tally t)
{
    const char *colour = t.failed > t.inconclusive ? "fail" : t.failed ? "unsure" : t.passed ? "pass" : "skip";
    fprintf(f, "<header class=%s><p class=kicker>sheargate verdict</p><h1>", colour);
    if (t.failed == 0 && t.passed > 0)
        fprintf(f, "All %d cases that could be asked passed", t.passed);
    else if (t.failed == 0)
        fputs("Nothing could be judged", f);
    else
        fprintf(f, "%d of %d cases %s", t.failed, t.failed + t.passed, t.failed > t.inconclusive ? "failed" : "are inconclusive");
    fputs("</h1><p class=command><code>", f);
    markup_text(f, p->candidate);
    fprintf(f, "</code> \302\267 suite %s (%s) \302\267 %s \302\267 %.1f s</p><p class=command>Not tested: ", p->suite, p->suite_hash,
            p->date, p->seconds);
    markup_text(f, p->not_tested);
    fputs("</p></header>\n<div class=tiles>", f);
    const struct { const char *colour, *word; int n; } tiles[] = { { "pass", "passed", t.passed },
                                                                 { "fail", "failed", t.failed - t.inconclusive },
                                                                 { "unsure", "inconclusive", t.inconclusive },
                                                                 { "skip", "skipped", t.skipped } };
    for (size_t k = 0; k < sizeof tiles / sizeof *tiles; k++)
        fprintf(f, "<div class=\"tile %s\"><b>%d</b>%s</div>", tiles[k].n ? tiles[k].colour : "none", tiles[k].n, tiles[k].word);
    size_t results = 0;
    for (size_t k = 0; k < count; k++)
        results += done[k].results.count;
    fprintf(f, "<div class=\"tile none\"><b>%zu</b>quantities judged</div></div>\n", results);
}

/* The sentences of one case that say what is wrong, invariants first. */
static void wrong_in_case(FILE *f, const struct finished_case *done)
{
    enum { SENTENCES_AT_MOST = 8 };
    int told = 0, all = 0;
    fprintf(f, "<div class=\"wrong %s\"><p class=where>", kind[finished_counts(done)]);
    case_badge(f, done);
    fprintf(f, " %s / <a href=\"#%s\">%s</a></p><ul>\n", layer_name(done->gate_case->layer), done->gate_case->name,
            done->gate_case->name);
    if (done->remark) {
        fputs("<li>", f);
        markup_text(f, done->remark);
        fputs("</li>\n", f);
    }
    for (int rank = 0; rank < 3; rank++)
        for (size_t i = 0; i < done->results.count; i++) {
            const struct result *r = &done->results.item[i];
            const int mine = r->verdict == VERDICT_INCONCLUSIVE ? 2 : r->judgement == MODEL ? 1 : 0;
            if (result_counts(r) < VERDICT_INCONCLUSIVE || mine != rank || ++all > SENTENCES_AT_MOST)
                continue;
            fputs("<li>", f);
            markup_text(f, r->sentence);
            fputs("</li>\n", f);
            told++;
        }
    if (all > told)
        fprintf(f, "<li>and %d more, below</li>", all - told);
    fputs("</ul></div>\n", f);
}

static void wrong_terms(FILE *f, const struct finished_case *done, size_t count, struct tally t)
{
    if (t.failed == 0)
        return;
    fputs("<section><h2>What is wrong</h2><p class=lead>The first case names the most: later ones build on it. In each, broken "
          "invariants stand first (they need no formula of ours), then disagreement with the declared model.</p>\n", f);
    for (size_t k = 0; k < count; k++)
        if (finished_counts(&done[k]) >= VERDICT_INCONCLUSIVE)
            wrong_in_case(f, &done[k]);
    fputs("</section>\n", f);
}

/* Failures that do not turn the run red: accepted ones with their reason, and those of cases newer than the suite asked. */
static void tolerated(FILE *f, const struct finished_case *done, size_t count)
{
    bool first = true;
    for (size_t k = 0; k < count; k++) {
        const struct result *worst = results_worst(&done[k].results);
        if (done[k].standing != KNOWN && !(done[k].standing == ADVISORY && done[k].verdict > VERDICT_SKIP))
            continue;
        if (first)
            fputs("<section><h2>Wrong, but not counted</h2><p class=lead>Failures that known.json accepts, and warnings of cases newer than "
                  "the suite asked.</p>\n", f);
        first = false;
        fputs("<div class=\"wrong skip\"><p class=where>", f);
        case_badge(f, &done[k]);
        fprintf(f, " %s / <a href=\"#%s\">%s</a></p><ul><li>", layer_name(done[k].gate_case->layer), done[k].gate_case->name,
                done[k].gate_case->name);
        markup_text(f, done[k].remark ? done[k].remark : worst && worst->sentence ? worst->sentence : "no result");
        fputs("</li></ul></div>\n", f);
    }
    fputs(first ? "" : "</section>\n", f);
}

static void picture(FILE *f, const struct finished_case *done, const struct result *r)
{
    char path[PATH_LENGTH], line[4096];
    path_join(path, done->work, r->picture);
    FILE *svg = fopen(path, "r");
    if (!svg)
        return;
    fputs("<figure>", f);
    while (fgets(line, sizeof line, svg))
        if (strncmp(line, "<?xml", 5) != 0 && strncmp(line, "<!DOCTYPE", 9) != 0)
            fputs(line, f);
    fclose(svg);
    fputs("</figure>\n", f);
}

static void result_row(FILE *f, const struct result *r)
{
    fputs("<tr><td>", f);
    markup_text(f, r->what);
    fprintf(f, "</td><td>%s</td>", r->judgement == INVARIANT ? "invariant" : "model");
    cell(f, r->measured);
    cell(f, r->expected);
    error_cell(f, r);
    limit_cell(f, r);
    fputs("<td>", f);
    badge(f, result_counts(r), r->accepted ? "known" : NULL);
    fputs("</td></tr>\n", f);
    if (r->verdict == VERDICT_PASS && !r->notes)
        return;
    fputs("<tr class=more><td colspan=7>", f);
    if (r->verdict != VERDICT_PASS)
        markup_text(f, r->sentence);
    if (r->notes) {
        fputs(" <span class=notes>", f);
        markup_text(f, r->notes);
        fputs("</span>", f);
    }
    fputs("</td></tr>\n", f);
}

static void words(FILE *f, const char *head, const json_t *list, bool link)
{
    size_t k;
    json_t *word;
    if (json_array_size(list) == 0)
        return;
    fprintf(f, "<dt>%s</dt><dd>", head);
    json_array_foreach(list, k, word)
    {
        fputs(k ? ", " : "", f);
        if (link)
            fprintf(f, "<a href=\"#flag-%s\">", json_string_value(word));
        markup_text(f, json_string_value(word));
        fputs(link ? "</a>" : "", f);
    }
    fputs("</dd>", f);
}

/* One case: a line that opens. */
static void one_case(FILE *f, const struct finished_case *done)
{
    const struct gate_case *c = done->gate_case;
    const struct result *worst = results_worst(&done->results);
    fprintf(f, "<details id=\"%s\"%s><summary><span class=name>%s</span><span class=asks>", c->name,
            finished_counts(done) >= VERDICT_INCONCLUSIVE ? " open" : "", c->name);
    markup_text(f, c->about);
    fputs("</span><span class=nums>", f);
    if (worst && done->verdict != VERDICT_SKIP) {
        char error[32];
        terminal_error(error, sizeof error, worst);
        const size_t skipped = results_not_judged(&done->results);
        fprintf(f, "%zu judged", done->results.count - skipped);
        if (skipped)
            fprintf(f, ", %zu not", skipped);
        fprintf(f, "<br>worst %s%s", isnan(worst->p) ? "error " : "", error);
    }
    fputs("</span>", f);
    case_badge(f, done);
    fputs("</summary><div class=body><dl>", f);
    if (c->reason) {
        fprintf(f, "<dt>tolerance</dt><dd>%g: ", c->tolerance);
        markup_text(f, c->reason);
        fputs("</dd>", f);
    }
    words(f, "needs", c->needs, false);
    words(f, "would show", c->flags, true);
    fprintf(f, "<dt>time</dt><dd>%.2f s, %.2f s of it the candidate</dd></dl>\n", done->seconds, done->candidate_seconds);
    for (size_t k = 0; k < done->results.count; k++)
        if (done->results.item[k].picture)
            picture(f, done, &done->results.item[k]);
    fputs("<table><thead><tr><th>quantity<th>judged as<th class=num>measured<th class=num>expected<th class=num>error"
          "<th class=num>tolerance<th>verdict</tr></thead><tbody>\n", f);
    for (enum judgement j = INVARIANT; j <= MODEL; j++)
        for (size_t k = 0; k < done->results.count; k++)
            if (done->results.item[k].judgement == j)
                result_row(f, &done->results.item[k]);
    fputs("</tbody></table></div></details>\n", f);
}

static void layers(FILE *f, const struct finished_case *done, size_t count)
{
    for (int layer = LAYER_PAIR; layer <= LAYER_PUBLISHED; layer++) {
        int asked = 0, passed = 0;
        for (size_t k = 0; k < count; k++)
            if ((int)done[k].gate_case->layer == layer) {
                asked++;
                passed += finished_counts(&done[k]) == VERDICT_PASS;
            }
        if (asked == 0)
            continue;
        fprintf(f, "<section><h2><span class=number>%d</span> %s <span class=count>%d of %d passed</span></h2>"
                   "<p class=lead>%s</p>\n", layer, layer_name((enum layer)layer), passed, asked, layer_asks[layer - 1]);
        for (size_t k = 0; k < count; k++)
            if ((int)done[k].gate_case->layer == layer)
                one_case(f, &done[k]);
        fputs("</section>\n", f);
    }
}

static bool flag_used(const struct finished_case *done, size_t count, const char *flag)
{
    for (size_t k = 0; k < count; k++)
        if (case_lists(done[k].gate_case->flags, flag))
            return true;
    return false;
}

static void flags(FILE *f, const struct finished_case *done, size_t count, const json_t *explained)
{
    const char *flag;
    json_t *entry;
    fputs("<section><h2>Classes of mistake these cases look for</h2><dl class=flags>\n", f);
    json_object_foreach((json_t *)(uintptr_t)explained, flag, entry)
    {
        if (!flag_used(done, count, flag))
            continue;
        fprintf(f, "<dt id=\"flag-%s\">%s</dt><dd>", flag, flag);
        markup_text(f, json_string_value(json_object_get(entry, "mistake")));
        fputs(" <i>Effect:</i> ", f);
        markup_text(f, json_string_value(json_object_get(entry, "effect")));
        fputs(" <i>Seen in:</i> ", f);
        markup_text(f, json_string_value(json_object_get(entry, "seen")));
        fputs(" <i>State upstream:</i> ", f);
        markup_text(f, json_string_value(json_object_get(entry, "upstream")));
        fputs("</dd>\n", f);
    }
    fputs("</dl></section>\n", f);
}

static void fact(FILE *f, const char *name, const char *value)
{
    fprintf(f, "<dt>%s</dt><dd>", name);
    markup_text(f, value);
    fputs("</dd>", f);
}

static void provenance(FILE *f, const struct provenance *p)
{
    char text[160];
    fputs("<section><h2>Provenance</h2><dl>", f);
    fact(f, "date", p->date);
    fact(f, "gate", p->gate_version);
    snprintf(text, sizeof text, "%s, cases %s", p->suite, p->suite_hash);
    fact(f, "suite", text);
    fact(f, "candidate", p->candidate);
    fact(f, "candidate hash", p->candidate_hash);
    snprintf(text, sizeof text, "entry level %s, %s precision", p->level, p->precision);
    fact(f, "declared", text);
    snprintf(text, sizeof text, "%u", p->seed_offset);
    fact(f, "seed offset", text);
    fact(f, "not tested", p->not_tested);
    fputs("</dl></section>\n", f);
}

bool report_html(const char *path, const struct provenance *p, const struct finished_case *done, size_t count,
                 const char *flags_file, char why[WHY_LENGTH])
{
    json_error_t error;
    json_t *explained = json_load_file(flags_file, 0, &error);
    if (!explained)
        return why_not(why, "%s:%d:%d: %s", flags_file, error.line, error.column, error.text);
    FILE *f = fopen(path, "w");
    if (!f) {
        json_decref(explained);
        return why_not(why, "cannot write %s", path);
    }
    fprintf(f, "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport content=\"width=device-width\">"
               "<title>sheargate verdict</title><style>\n%s%s</style></head><body><main>\n", html_style, html_style_coverage);
    heading(f, p, done, count, report_tally(done, count));
    wrong_terms(f, done, count, report_tally(done, count));
    tolerated(f, done, count);
    layers(f, done, count);
    flags(f, done, count, explained);
    provenance(f, p);
    if (p->coverage)
        coverage_html(f, p->coverage);
    fputs("</main></body></html>\n", f);
    json_decref(explained);
    return fclose(f) == 0 ? true : why_not(why, "cannot write %s: disk full?", path);
}
