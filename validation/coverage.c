/* The coverage matrix from the cases' own words and the verdicts of the run. */
#include "coverage.h"

#include "markup.h"

#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct finished_case *find_done(const struct coverage *c, const struct gate_case *gate_case)
{
    for (size_t k = 0; k < c->count; k++)
        if (c->done[k].gate_case == gate_case)
            return &c->done[k];
    return NULL;
}

static bool judges(const json_t *patterns, const char *what)
{
    for (size_t p = 0; p < json_array_size(patterns); p++)
        if (fnmatch(json_string_value(json_array_get(patterns, p)), what, 0) == 0)
            return true;
    return false;
}

/* A candidate that crashed or cannot do it has no such quantities; then the case speaks for the term. */
bool coverage_evidence(const struct coverage *c, const struct gate_case *gate_case, const char *term, enum verdict *verdict,
                       size_t *quantities)
{
    const struct finished_case *done = find_done(c, gate_case);
    const json_t *patterns = json_object_get(gate_case->terms, term);
    *quantities = 0;
    if (!done)
        return false;
    bool passed = false;
    enum verdict worst = VERDICT_PASS;
    for (size_t k = 0; k < done->results.count; k++) {
        const struct result *r = &done->results.item[k];
        if (!judges(patterns, r->what))
            continue;
        ++*quantities;
        passed = passed || r->verdict == VERDICT_PASS;
        if (result_counts(r) > worst)
            worst = result_counts(r);
    }
    if (*quantities == 0)
        worst = finished_counts(done);
    else if (worst == VERDICT_SKIP && passed)
        worst = VERDICT_PASS;
    if (done->standing == ADVISORY && worst > VERDICT_SKIP)
        worst = VERDICT_SKIP;
    *verdict = worst;
    return true;
}

static void count(struct coverage_cell *cell, bool asked, enum verdict v)
{
    cell->cases++;
    cell->left_out += !asked;
    cell->passed += asked && v == VERDICT_PASS;
    cell->skipped += asked && v == VERDICT_SKIP;
    cell->inconclusive += asked && v == VERDICT_INCONCLUSIVE;
    cell->failed += asked && v == VERDICT_FAIL;
}

static void fill_row(const struct coverage *c, struct coverage_row *row)
{
    for (size_t k = 0; k < c->suite->count; k++) {
        const struct gate_case *one = &c->suite->item[k];
        enum verdict v = VERDICT_SKIP;
        size_t quantities;
        if (!json_object_get(one->terms, row->term))
            continue;
        const bool asked = coverage_evidence(c, one, row->term, &v, &quantities);
        count(&row->layer[0], asked, v);
        count(&row->layer[one->layer], asked, v);
    }
}

static bool terms_are_known(const struct coverage *c, const char *file, char why[WHY_LENGTH])
{
    const char *term;
    json_t *patterns;
    for (size_t k = 0; k < c->suite->count; k++)
        json_object_foreach(c->suite->item[k].terms, term, patterns)
            if (!json_object_get(c->terms, term))
                return why_not(why, "%s/case.json: there is no term '%s' in %s", c->suite->item[k].folder, term, file);
    return true;
}

bool coverage_make(const char *terms_file, const struct suite_of_cases *suite, const struct finished_case *done, size_t number,
                   struct coverage *c, char why[WHY_LENGTH])
{
    json_error_t error;
    const char *term;
    json_t *entry;
    *c = (struct coverage){ .terms = json_load_file(terms_file, JSON_REJECT_DUPLICATES, &error), .suite = suite, .done = done,
                            .count = number };
    if (!c->terms)
        return why_not(why, "%s:%d:%d: %s", terms_file, error.line, error.column, error.text);
    if (!terms_are_known(c, terms_file, why))
        return false;
    c->row = calloc(json_object_size(c->terms) + 1, sizeof *c->row);
    json_object_foreach(c->terms, term, entry)
    {
        struct coverage_row *row = &c->row[c->rows++];
        row->term = term;
        row->group = json_string_value(json_object_get(entry, "group"));
        row->about = json_string_value(json_object_get(entry, "about"));
        if (!row->group || !row->about)
            return why_not(why, "%s: '%s' needs a 'group' and an 'about'", terms_file, term);
        fill_row(c, row);
    }
    return true;
}

void coverage_free(struct coverage *c)
{
    free(c->row);
    json_decref(c->terms);
    *c = (struct coverage){ 0 };
}

const char *coverage_word(const struct coverage_cell *cell)
{
    return cell->failed ? "FAIL" : cell->inconclusive ? "inconclusive" : cell->passed ? "pass" : "not judged";
}

/* The cases by which a term is wrong. */
static void print_wrong(const struct coverage *c, const struct coverage_row *row)
{
    int told = 0;
    printf("  %-12s %s:", coverage_word(&row->layer[0]), row->term);
    for (size_t k = 0; k < c->suite->count; k++) {
        enum verdict v;
        size_t quantities;
        const struct gate_case *one = &c->suite->item[k];
        if (json_object_get(one->terms, row->term) && coverage_evidence(c, one, row->term, &v, &quantities)
            && v >= VERDICT_INCONCLUSIVE && ++told <= 4)
            printf(" %s", one->name);
    }
    printf(told > 4 ? " and %d more\n" : "\n", told - 4);
}

/* Whether nothing judged the term: because it was skipped, or because no case of its was asked. */
static bool not_judged(const struct coverage_row *row, bool skipped)
{
    return strcmp(coverage_word(&row->layer[0]), "not judged") == 0 && (row->layer[0].skipped > 0) == skipped;
}

/* A word of a list that is wrapped at 116 columns. */
static void print_word(const char *head, const char *before, const char *word, int *column)
{
    const int n = (int)(strlen(before) + strlen(word)) + 2;
    if (*column == 0)
        *column = printf("%s", head);
    else if (*column + n > 116)
        *column = printf(",\n      ") - 2;
    else
        *column += printf(", ");
    *column += printf("%s%s", before, word);
}

/* Terms that nothing judged; where it is all of a group (they stand together in terms.json), the group. */
static void print_not_judged(const struct coverage *c, const char *head, bool skipped)
{
    int column = 0;
    for (size_t first = 0, next; first < c->rows; first = next) {
        size_t n = 0;
        for (next = first; next < c->rows && strcmp(c->row[next].group, c->row[first].group) == 0; next++)
            n += not_judged(&c->row[next], skipped);
        if (n == next - first)
            print_word(head, "all of ", c->row[first].group, &column);
        for (size_t k = first; k < next && n < next - first; k++)
            if (not_judged(&c->row[k], skipped))
                print_word(head, "", c->row[k].term, &column);
    }
    if (column)
        putchar('\n');
}

void coverage_print(const struct coverage *c)
{
    enum { LINES = 12 };
    int passed = 0, wrong = 0, told = 0;
    for (size_t k = 0; k < c->rows; k++) {
        const struct coverage_cell *all = &c->row[k].layer[0];
        wrong += all->failed > 0 || all->inconclusive > 0;
        passed += strcmp(coverage_word(all), "pass") == 0;
    }
    printf("physics terms: %d pass, %d wrong or inconclusive, %d not judged, of %zu\n", passed, wrong,
           (int)c->rows - passed - wrong, c->rows);
    for (size_t k = 0; k < c->rows; k++)
        if ((c->row[k].layer[0].failed || c->row[k].layer[0].inconclusive) && ++told <= LINES)
            print_wrong(c, &c->row[k]);
    if (told > LINES)
        printf("  ... and %d more; the report has them all\n", told - LINES);
    print_not_judged(c, "  not judged, left out by tier or choice: ", false);
    print_not_judged(c, "  not judged, not supported or a known failure: ", true);
}

/* --- the page --- */

static void html_cell(FILE *f, const struct coverage_cell *cell)
{
    const int judged = cell->passed + cell->failed + cell->inconclusive;
    if (cell->cases == 0)
        fputs("<span></span>", f);
    else if (judged == 0)
        fprintf(f, "<span class=none>%s</span>", cell->skipped ? "skipped" : "not asked");
    else if (cell->failed)
        fprintf(f, "<span class=fail>FAIL %d of %d</span>", cell->failed, judged);
    else if (cell->inconclusive)
        fprintf(f, "<span class=unsure>unsure %d of %d</span>", cell->inconclusive, judged);
    else
        fprintf(f, "<span class=pass>%d</span>", cell->passed);
}

/* One row opened: each case that judges the term, by how many quantities, with which verdict, or why not. */
static void html_cases(FILE *f, const struct coverage *c, const struct coverage_row *row)
{
    static const char *const kind[] = { "pass", "none", "unsure", "fail" }, *const word[] = { "pass", "skipped", "inconclusive", "FAIL" };
    fputs("<p>", f);
    markup_text(f, row->about);
    fputs("</p><ul>", f);
    for (size_t k = 0; k < c->suite->count; k++) {
        const struct gate_case *one = &c->suite->item[k];
        enum verdict v;
        size_t quantities;
        if (!json_object_get(one->terms, row->term))
            continue;
        if (!coverage_evidence(c, one, row->term, &v, &quantities))
            fprintf(f, "<li><span class=none>not asked</span> %s / %s (%s tier)</li>", layer_name(one->layer), one->name,
                    tier_name(one->tier));
        else
            fprintf(f, "<li><span class=%s>%s</span> %s / <a href=\"#%s\">%s</a>, %zu %s</li>", kind[v], word[v],
                    layer_name(one->layer), one->name, one->name, quantities, quantities == 1 ? "quantity" : "quantities");
    }
    fputs("</ul>", f);
}

/* What is missing from a row, in a few words. */
static void html_not_tested(FILE *f, const struct coverage_cell *all)
{
    fputs("<span class=missing>", f);
    if (all->skipped)
        fprintf(f, "%d skipped", all->skipped);
    if (all->left_out)
        fprintf(f, "%s%d not asked", all->skipped ? ", " : "", all->left_out);
    fputs("</span>", f);
}

void coverage_html(FILE *f, const struct coverage *c)
{
    fputs("<section class=coverage><h2>What was tested</h2><p class=lead>Physics terms against layers: how many cases judged the term. A "
          "row opens to the cases. Skipped: the candidate does not have it, or known.json accepts its failure. Not asked: left out by "
          "tier or choice.</p>\n<div class=\"row head\"><span>term</span>", f);
    for (int layer = LAYER_PAIR; layer <= LAYER_PUBLISHED; layer++)
        fprintf(f, "<span>%s</span>", layer_name((enum layer)layer));
    fputs("<span>not tested</span></div>\n", f);
    for (size_t k = 0; k < c->rows; k++) {
        const struct coverage_row *row = &c->row[k];
        if (k == 0 || strcmp(row->group, c->row[k - 1].group) != 0) {
            fputs("<p class=group>", f);
            markup_text(f, row->group);
            fputs("</p>", f);
        }
        fputs("<details><summary class=row><span class=name>", f);
        markup_text(f, row->term);
        fputs("</span>", f);
        for (int layer = LAYER_PAIR; layer <= LAYER_PUBLISHED; layer++)
            html_cell(f, &row->layer[layer]);
        html_not_tested(f, &row->layer[0]);
        fputs("</summary><div class=body>", f);
        html_cases(f, c, row);
        fputs("</div></details>\n", f);
    }
    fputs("</section>\n", f);
}
