/*
 * gate: judges any program that computes suspension physics, through files (docs/adapter.md). It never links the solver.
 *
 * This file is the commands: which cases, in which order, against which candidate, and what is written where.
 */
#include "calibrate.h"
#include "coverage.h"
#include "export.h"
#include "github.h"
#include "known.h"
#include "options.h"
#include "versions.h"
#include "terminal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* validation/ beside the folder of the program (build/gate), or below the current folder. */
static void find_suite(char folder[PATH_LENGTH])
{
    char program[PATH_LENGTH], guess[PATH_LENGTH];
    const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    snprintf(folder, PATH_LENGTH, "validation");
    for (ssize_t k = n; k > 0; k--) {
        if (k != n && program[k] != '/')
            continue;
        program[k] = '\0';
        path_join(guess, program, "validation/cases");
        if (access(guess, R_OK) == 0) {
            path_join(folder, program, "validation");
            return;
        }
    }
}

/* Layers without a chosen case, and how many cases were left out of the others. */
static void say_not_tested(const struct options *o, const struct suite_of_cases *suite, size_t chosen, char *text, size_t room)
{
    text[0] = '\0';
    for (int layer = LAYER_PAIR; layer <= LAYER_PUBLISHED; layer++) {
        bool tested = false;
        for (size_t k = 0; k < suite->count; k++)
            tested = tested || ((int)suite->item[k].layer == layer && options_want(o, &suite->item[k]));
        const size_t used = strlen(text);
        if (!tested)
            snprintf(text + used, room - used, "%s%s", used ? ", " : "layers ", layer_name((enum layer)layer));
    }
    const size_t used = strlen(text);
    if (chosen < suite->count)
        snprintf(text + used, room - used, "%s%zu more cases left out by tier (%s) or choice", used ? "; " : "",
                 suite->count - chosen, tier_name(o->tier));
    else if (used == 0)
        snprintf(text, room, "nothing was left out");
}

static int list_cases(const struct gate_case **chosen, size_t count)
{
    for (size_t k = 0; k < count; k++)
        printf("%-10s %-28s %-8s %s\n", layer_name(chosen[k]->layer), chosen[k]->name, tier_name(chosen[k]->tier),
               chosen[k]->about);
    return 0;
}

/* Everything that is read after the run: files, GitHub's page, the last lines of the terminal. */
static bool write_reports(const struct options *o, struct provenance *p, const struct suite_of_cases *suite,
                          const struct finished_case *done, size_t count, char why[WHY_LENGTH])
{
    char junit[PATH_LENGTH], html[PATH_LENGTH], flags[PATH_LENGTH], terms[PATH_LENGTH];
    struct coverage coverage;
    path_join(junit, o->report, "junit.xml");
    path_join(html, o->report, "index.html");
    path_join(flags, o->suite_dir, "flags.json");
    path_join(terms, o->suite_dir, "terms.json");
    bool good = coverage_make(terms, suite, done, count, &coverage, why);
    p->coverage = good ? &coverage : NULL;
    good = good && folder_make(o->report, why) && report_junit(junit, p, done, count, why)
           && report_html(html, p, done, count, flags, why) && github_report(p, done, count, o->known, why);
    if (good)
        printf("report: %s/index.html\n", o->report);
    else
        fprintf(stderr, "gate: %s\n", why);
    terminal_close(p, done, count, report_tally(done, count));
    p->coverage = NULL;
    coverage_free(&coverage);
    return good;
}

static void quiet(const struct finished_case *done)
{
    (void)done;
}

/* Writes the lists of an exported folder. */
static bool say_what_waits(const struct options *o, char why[WHY_LENGTH])
{
    size_t questions, waiting;
    if (!offline_list(o->folder, &questions, &waiting, why))
        return false;
    if (o->exporting)
        printf("%zu questions in %s; %s/README.txt says how to answer them\n", questions, o->folder, o->folder);
    else if (waiting)
        printf("%zu of %zu questions have no answer yet: sh %s/run.sh ADAPTER, then judge again\n", waiting, questions, o->folder);
    return true;
}

/* What is known of the candidate, of its suite, and of the day: the first line. */
static void fill_provenance(const struct options *o, const struct suite_choice *choice, struct provenance *p)
{
    const time_t now = time(NULL);
    *p = (struct provenance){ .gate_version = GATE_VERSION, .candidate = o->candidate, .level = "A", .precision = "double",
                              .seed_offset = o->seed_offset };
    snprintf(p->suite, sizeof p->suite, "%s%s", choice->version,
             choice->pinned ? " as frozen, asked for" : choice->as_frozen ? " as frozen" : ", not as frozen");
    snprintf(p->suite_hash, sizeof p->suite_hash, "%s", choice->hash);
    strftime(p->date, sizeof p->date, "%Y-%m-%dT%H:%M:%SZ", gmtime(&now));
}

static int run_cases(const struct options *o, const struct suite_of_cases *suite, const struct suite_choice *choice,
                     const struct gate_case **chosen, size_t count)
{
    char why[WHY_LENGTH], today[16], *work;
    struct provenance p;
    struct known_list known = { 0 };
    fill_provenance(o, choice, &p);
    snprintf(today, sizeof today, "%.10s", p.date);
    if (o->known && !known_load(o->known, suite, today, &known, why)) {
        known_free(&known);
        return usage("%s", why);
    }
    if (!folder_make(o->work, why))
        return usage("%s", why);
    work = realpath(o->work, NULL); /* absolute: a candidate may change its folder */
    struct run_plan plan = { .gate_case = chosen, .count = count, .work = work, .jobs = o->jobs, .p_values = suite->p_values,
                             .seed_offset = o->seed_offset, .stop_after = o->stop_after, .patience = o->patience, .keep = o->keep, .known = &known };
    struct capabilities capabilities;
    if (!capabilities_choose(o->capabilities, o->candidate, o->level, &capabilities, why)) {
        free(work);
        known_free(&known);
        return usage("%s", why);
    }
    plan.candidate = (struct candidate){ .command = o->candidate ? o->candidate : o->folder, .bytes = (size_t)1 << 30, .capabilities = &capabilities };
    plan.offline = o->folder;
    p.candidate = plan.candidate.command;
    p.level = level_letter(capabilities.level);
    p.precision = capabilities.precision;
    if (!candidate_hash(&plan.candidate, p.candidate_hash) && !o->folder) {
        free(work);
        known_free(&known);
        return usage("there is no program '%.*s' to run as the candidate", (int)strcspn(o->candidate, " \t"), o->candidate);
    }
    if (o->calibrating) {
        suite_hash(chosen, count, p.suite_hash);
        const bool good = calibrate_run(&plan, &p, o->seeds, o->table, why);
        free(work);
        known_free(&known);
        const int code = good ? calibrate_summary(o->table, why) : EXIT_USAGE;
        return code == EXIT_USAGE ? usage("%s", why) : code;
    }
    say_not_tested(o, suite, count, p.not_tested, sizeof p.not_tested);

    struct finished_case *done = calloc(count, sizeof *done);
    const double start = candidate_now();
    if (!o->exporting)
        terminal_open(&p);
    count = run_all(&plan, done, o->exporting ? quiet : terminal_case);
    p.seconds = candidate_now() - start;

    const bool written = o->exporting || write_reports(o, &p, suite, done, count, why);
    const bool listed = !o->folder || say_what_waits(o, why);
    const int code = !written ? EXIT_USAGE : o->exporting ? 0 : report_exit_code(report_tally(done, count));
    for (size_t k = 0; k < count; k++)
        finished_free(&done[k]);
    free(done);
    free(work);
    known_free(&known);
    capabilities_free(&capabilities);
    return listed ? code : usage("%s", why);
}

/* One flag of flags.json, or all their names. */
static int explain(const char *flag, const char *suite_dir)
{
    char path[PATH_LENGTH], folder[PATH_LENGTH], why[WHY_LENGTH];
    struct suite_of_cases suite;
    json_error_t where;
    path_join(path, suite_dir, "flags.json");
    path_join(folder, suite_dir, "cases");
    json_t *flags = json_load_file(path, 0, &where), *entry;
    if (!flags)
        return usage("%s:%d:%d: %s", path, where.line, where.column, where.text);
    const char *name;
    if (!flag)
        json_object_foreach(flags, name, entry)
            printf("%-34s %s\n", name, json_string_value(json_object_get(entry, "mistake")));
    entry = flag ? json_object_get(flags, flag) : NULL;
    int code = flag && !entry ? usage("there is no flag '%s'; `gate explain` lists them", flag) : 0;
    if (entry && !cases_load(folder, &suite, why))
        code = usage("%s", why);
    else if (entry) {
        printf("%s\n\n  mistake   %s\n  effect    %s\n  seen      %s\n  upstream  %s\n  cases    ", flag, json_string_value(json_object_get(entry, "mistake")),
               json_string_value(json_object_get(entry, "effect")), json_string_value(json_object_get(entry, "seen")),
               json_string_value(json_object_get(entry, "upstream")));
        for (size_t k = 0; k < suite.count; k++)
            if (case_lists(suite.item[k].flags, flag))
                printf(" %s", suite.item[k].name);
        printf("\n");
        cases_free(&suite);
    }
    json_decref(flags);
    return code;
}

static int with_suite(const char *verb, const struct options *o)
{
    struct suite_of_cases suite;
    struct suite_choice choice;
    char why[WHY_LENGTH], folder[PATH_LENGTH];
    path_join(folder, o->suite_dir, "cases");
    if (!cases_load(folder, &suite, why))
        return usage("%s", why);
    if (strcmp(verb, "freeze") == 0) {
        const bool good = suite_freeze(&suite, o->suite_dir, why);
        cases_free(&suite);
        return good ? printf("suite " GATE_SUITE " frozen\n") < 0 : usage("%s", why);
    }
    if (!suite_choose(&suite, o->suite_dir, o->suite, &choice, why)) {
        cases_free(&suite);
        return usage("%s", why);
    }
    int code = options_check(o, &suite);
    const struct gate_case **chosen = calloc(suite.count, sizeof *chosen);
    size_t count = 0;
    for (size_t k = 0; k < suite.count && code == 0; k++) {
        if (!options_want(o, &suite.item[k]))
            continue;
        chosen[count++] = &suite.item[k];
        if (!check_find(suite.item[k].check))
            code = usage("%s/case.json: there is no check '%s'", suite.item[k].folder, suite.item[k].check);
    }
    if (code == 0 && count == 0)
        code = usage("no case is left after --layer, --case, --needs and --tier");
    if (code == 0)
        code = strcmp(verb, "list") == 0 ? list_cases(chosen, count) : run_cases(o, &suite, &choice, chosen, count);
    free(chosen);
    cases_free(&suite);
    return code;
}

int main(int argc, char **argv)
{
    const char *verb = argc > 1 ? argv[1] : "";
    if (strcmp(verb, "--help") == 0 || strcmp(verb, "-h") == 0)
        return fputs(options_help, stdout) < 0;
    if (strcmp(verb, "--version") == 0)
        return printf("gate %s, suite %s\n", GATE_VERSION, GATE_SUITE) < 0;
    if (strcmp(verb, "run") != 0 && strcmp(verb, "list") != 0 && strcmp(verb, "calibrate") != 0 && strcmp(verb, "explain") != 0
        && strcmp(verb, "freeze") != 0 && strcmp(verb, "export") != 0 && strcmp(verb, "judge") != 0)
        return usage("%s'%s'; see gate --help", *verb ? "unknown command " : "say `run`, `list`, `explain`, `export`, `judge`, `calibrate` or `freeze`, not ", verb);

    struct options o = { .report = "build/report", .work = "build/cases", .jobs = 1, .patience = 1,
                         .calibrating = strcmp(verb, "calibrate") == 0 };
    find_suite(o.suite_dir);
    if (strcmp(verb, "explain") == 0)
        return argc > 3 ? usage("explain takes one flag") : explain(argc == 3 ? argv[2] : NULL, o.suite_dir);
    const bool offline = strcmp(verb, "export") == 0 || strcmp(verb, "judge") == 0;
    o.exporting = strcmp(verb, "export") == 0;
    o.folder = offline && argc > 2 && argv[2][0] != '-' ? argv[2] : NULL;
    for (size_t n = o.folder ? strlen(o.folder) : 0; n > 1 && argv[2][n - 1] == '/'; n--)
        argv[2][n - 1] = '\0';
    if (offline && !o.folder)
        return usage("%s needs a folder", verb);
    json_t *kept = NULL;        /* options with which the folder was exported */
    char why[WHY_LENGTH];
    if (strcmp(verb, "judge") == 0 && !export_options(o.folder, &kept, why))
        return usage("%s", why);
    const char *key;
    json_t *value;
    int code = 0;
    json_object_foreach(kept, key, value)
        code = code ? code : options_parse(&o, key, json_string_value(value));
    for (int k = offline ? 3 : 2; k < argc && code == 0; k += 2) {
        if (strcmp(argv[k], "--help") == 0)
            return fputs(options_help, stdout) < 0;
        if (strcmp(verb, "judge") == 0 && export_keeps(argv[k]))
            return usage("%s was settled by `gate export`; export anew to choose otherwise", argv[k]);
        code = options_parse(&o, argv[k], k + 1 < argc ? argv[k + 1] : NULL);
    }
    char beside[PATH_LENGTH];       /* capabilities that stand beside a candidate are kept as those that are named */
    const bool found = o.exporting && o.candidate && !o.capabilities && capabilities_beside(o.candidate, beside);
    if (code == 0 && o.exporting && !export_begin(o.folder, argc - 3, argv + 3, found ? beside : NULL, why))
        return usage("%s", why);
    if (code != 0)
        return code;
    if (!offline && strcmp(verb, "list") != 0 && strcmp(verb, "freeze") != 0 && (!o.candidate || o.candidate[strspn(o.candidate, " \t")] == '\0'))
        return usage("%s needs --candidate COMMAND", verb);
    if (o.calibrating && (!o.seeds || !o.table))
        return usage("calibrate needs --seeds N and --table FILE");
    code = with_suite(verb, &o);
    json_decref(kept);
    return code;
}
