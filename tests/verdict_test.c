/*
 * What surrounds a verdict: pinned suites, accepted failures, what GitHub is told, and the coverage matrix. The gate is called
 * from outside on copies of the suite in which one number was changed, and on candidates that are wrong on purpose.
 */
#include "coverage.h"
#include "github.h"
#include "known.h"
#include "suite.h"
#include "versions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/verdict-test-XXXXXX";

/* Runs a shell command in which %s is the folder of the programs; its output into `said`. Exit code. */
static int shell(const char *format, char said[8192])
{
    char programs[512], command[4096];
    const ssize_t n = readlink("/proc/self/exe", programs, sizeof programs - 1);
    programs[n > 0 ? n : 0] = '\0';
    *strrchr(programs, '/') = '\0';
    snprintf(command, sizeof command, "F=%s; B=%s; exec 2>&1; ", folder, programs);
    snprintf(command + strlen(command), sizeof command - strlen(command), "%s", format);
    FILE *pipe = popen(command, "r");
    size_t used = pipe ? fread(said, 1, 8191, pipe) : 0;
    said[used] = '\0';
    for (char rest[4096]; pipe && fread(rest, 1, sizeof rest, pipe) > 0;)
        ;
    const int status = pipe ? pclose(pipe) : -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void says(const char *text, const char *part)
{
    check_true(strstr(text, part) != NULL, part);
    if (!strstr(text, part))
        printf("\n    in: %s\n", text);
}

static bool write_text(const char *name, const char *text)
{
    char path[PATH_LENGTH];
    path_join(path, folder, name);
    FILE *file = fopen(path, "w");
    return file && fputs(text, file) >= 0 && fclose(file) == 0;
}

/* --- pinned suites --- */

static void the_manifest_is_not_stale(void)
{
    struct suite_of_cases suite;
    char why[WHY_LENGTH] = "";
    json_t *manifest = json_load_file("validation/suite-" GATE_SUITE ".json", 0, NULL);
    check_true(manifest && cases_load("validation/cases", &suite, why), why);
    const bool fits = manifest && suite_fits(&suite, manifest, why);
    if (!fits)
        printf("\n    suite " GATE_SUITE " is not as frozen: %s; before its release `make suite-manifest`, afterwards a new version\n", why);
    check_true(fits, why);
    json_decref(manifest);
    cases_free(&suite);
}

static void a_changed_tolerance_is_noticed(void)
{
    char said[8192];
    check_close(shell("cp -r validation/cases validation/flags.json validation/terms.json validation/suite-1.0.json $F", said), 0, 0, "copied");
    const char *run = "$B/gate run --candidate true --layer dilute --case einstein-slope --suite 1.0 --suite-dir $F --work $F/w --report $F/r";
    check_close(shell(run, said), 1, 0, "the suite as frozen runs (and the empty candidate fails)");
    says(said, "suite 1.0 as frozen, asked for");
    check_close(shell("sed -i 's/\"value\": 1e-10/\"value\": 1e-9/' $F/cases/1-pair/drag/case.json", said), 0, 0, "tolerance changed");
    check_close(shell(run, said), 2, 0, "refused");
    says(said, "case 'drag' has the tolerance 1e-09; in suite 1.0 it is 1e-10");
    check_close(shell("$B/gate run --candidate true --case einstein-slope --suite-dir $F --work $F/w --report $F/r", said), 1, 0, "unpinned");
    says(said, "suite 1.0, not as frozen");
    check_close(shell("cp validation/cases/1-pair/drag/case.json $F/cases/1-pair/drag", said), 0, 0, "tolerance restored");
    check_close(shell("sed -i 's/\"viscosity\": 0.7/\"viscosity\": 0.8/' $F/cases/1-pair/units-drag/case.json", said), 0, 0, "scene changed");
    check_close(shell(run, said), 2, 0, "refused");
    says(said, "case 'units-drag' does not ask what it asks in suite 1.0");
    check_close(shell("cp -r validation/cases/1-pair/units-drag $F/cases/1-pair; rm -r $F/cases/1-pair/applied", said), 0, 0, "case removed");
    check_close(shell(run, said), 2, 0, "refused");
    says(said, "case 'applied' of suite 1.0 is not here any more");
    check_close(shell("cp -r validation/cases/1-pair/applied $F/cases/1-pair; sed -i 's/\"about\": \"/&Really: /' $F/cases/1-pair/drag/case.json", said),
                0, 0, "words changed");
    check_close(shell(run, said), 1, 0, "words may improve");
    check_close(shell("$B/gate run --candidate true --suite 9.3 --suite-dir $F", said), 2, 0, "no such suite");
    says(said, "there is no suite 9.3");
    check_close(shell("$B/gate run --candidate true --suite latest --suite-dir $F", said), 2, 0, "no version");
}

static void newer_cases_only_warn(void)
{
    char said[8192];
    check_close(shell("cp -r $F/cases/1-pair/drag $F/cases/1-pair/drag-too && sed -i 's/\"since\": \"1.0\"/\"since\": \"1.1\"/' "
                      "$F/cases/1-pair/drag-too/case.json", said), 0, 0, "a case of the next version");
    check_close(shell("$B/gate run --candidate true --case drag-too --suite 1.0 --suite-dir $F --work $F/w --report $F/r", said), 77, 0,
                "nothing that counts");
    says(said, "warnings, counted as skipped): drag-too");
    says(said, "0 passed, 0 failed, 1 skipped");
    check_close(shell("$B/gate run --candidate true --case drag-too,drag --suite-dir $F --work $F/w --report $F/r", said), 1, 0,
                "the older one is red");
    says(said, "0 passed, 1 failed, 1 skipped");
    check_close(shell("sed -i 's/\"since\": \"1.1\"/\"since\": \"one\"/' $F/cases/1-pair/drag-too/case.json; $B/gate list --suite-dir $F", said),
                2, 0, "no version");
    says(said, "'since' is 'one'");
}

/* --- accepted failures --- */

/* A suite of one case, and what became of it. */
struct invented { struct gate_case one; struct suite_of_cases suite; struct finished_case done; };

static void invent(struct invented *i, double error)
{
    struct check_run run = { 0 };
    *i = (struct invented){ .one = { .name = "case", .layer = LAYER_PAIR } };
    i->suite = (struct suite_of_cases){ &i->one, 1, 0 };
    check_error(&run, MODEL, "left: force", 1, 2, error, 0.1, "left is wrong");
    check_error(&run, MODEL, "right: force", 1, 1, 0, 0.1, "right is wrong");
    i->done = (struct finished_case){ .gate_case = &i->one, .results = run.results, .verdict = results_verdict(&run.results) };
}

static char remark[WHY_LENGTH];         /* what `settled` said */

/* The word for the case after this file of accepted failures; "refused" where it cannot be read. */
static const char *settled(const char *entry, double error, enum verdict *counts)
{
    static char text[400], path[PATH_LENGTH], why[WHY_LENGTH];
    struct invented i;
    struct known_list list;
    invent(&i, error);
    snprintf(text, sizeof text, "{\"known\": [%s]}", entry);
    write_text("known.json", text);
    path_join(path, folder, "known.json");
    const char *word = "refused";
    if (known_load(path, &i.suite, "2026-11-28", &list, why)) {
        known_settle(&list, &i.done);
        word = finished_word(&i.done);
        *counts = finished_counts(&i.done);
        snprintf(remark, sizeof remark, "%s", i.done.remark ? i.done.remark : "");
    }
    known_free(&list);
    finished_free(&i.done);
    return word;
}

static void known_failures(void)
{
    enum verdict v = VERDICT_PASS;
    const char *whole = "{\"case\": \"case\", \"reason\": \"r\", \"expires\": \"2026-11-28\"}";
    check_true(strcmp(settled(whole, 1, &v), "known") == 0 && v == VERDICT_SKIP, "accepted up to its last day");
    check_true(strcmp(settled(whole, 0, &v), "HEALED") == 0 && v == VERDICT_FAIL, "healed is red");
    const char *left = "{\"case\": \"case\", \"quantity\": \"left*\", \"reason\": \"r\", \"expires\": \"2027-01-01\"}";
    check_true(strcmp(settled(left, 1, &v), "known") == 0 && v == VERDICT_SKIP, "one quantity");
    const char *right = "{\"case\": \"case\", \"quantity\": \"right*\", \"reason\": \"r\", \"expires\": \"2027-01-01\"}";
    check_true(strcmp(settled(right, 1, &v), "HEALED") == 0 && v == VERDICT_FAIL, "another quantity than the one that fails");
    const char *up = "{\"case\": \"case\", \"quantity\": \"up*\", \"reason\": \"r\", \"expires\": \"2027-01-01\"}";
    check_true(strcmp(settled(up, 1, &v), "HEALED") == 0 && v == VERDICT_FAIL, "a quantity that does not exist");
    check_true(strstr(remark, "what is wrong is called 'left: force'") != NULL, remark);
    const char *old = "{\"case\": \"case\", \"reason\": \"r\", \"expires\": \"2026-11-27\"}";
    check_true(strcmp(settled(old, 1, &v), "EXPIRED") == 0 && v == VERDICT_FAIL, "expired is red");
    check_true(strcmp(settled(old, 0, &v), "EXPIRED") == 0 && v == VERDICT_FAIL, "expired, though it passes");
    check_true(strcmp(settled("", 1, &v), "FAIL") == 0 && strcmp(settled("", 0, &v), "pass") == 0, "an empty list changes nothing");
    const char *const refused[] = {
        "{\"case\": \"cse\", \"reason\": \"r\", \"expires\": \"2027-01-01\"}", "{\"case\": \"case\", \"expires\": \"2027-01-01\"}",
        "{\"case\": \"case\", \"reason\": \"r\", \"expires\": \"2027-02-30\"}", "{\"case\": \"case\", \"reason\": \"r\", \"expires\": \"soon\"}",
        "{\"case\": \"case\", \"reason\": \"r\", \"expires\": \"2027-01-01\", \"quantitiy\": \"*\"}", "\"case\"", "{\"case\": 1}",
    };
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++)
        check_true(strcmp(settled(refused[k], 1, &v), "refused") == 0, refused[k]);
}

static void what_is_not_accepted_stays_red(void)
{
    struct invented i;
    struct check_run run = { 0 };
    invent(&i, 1);
    run.results = i.done.results;
    check_error(&run, INVARIANT, "up: force", 1, 2, 1, 0.1, "up is wrong");
    i.done.results = run.results;
    const struct known_entry entry = { .case_name = "case", .quantity = "left*", .reason = "r", .expires = "2027-01-01" };
    const struct known_list list = { .item = (struct known_entry *)(uintptr_t)&entry, .count = 1 };
    known_settle(&list, &i.done);
    check_true(finished_counts(&i.done) == VERDICT_FAIL && i.done.standing == COUNTS, "a second fault is new");
    check_true(strcmp(results_worst(&i.done.results)->what, "up: force") == 0, "and is the one shown");
    finished_free(&i.done);
}

static void accepted_failures_from_outside(void)
{
    char said[8192];
    const char *run = "$B/gate run --candidate true --case drag,einstein-slope --known $F/known.json --work $F/w --report $F/r";
    write_text("known.json", "{\"known\": [{\"case\": \"drag\", \"reason\": \"no drag & <yet>\", \"expires\": \"9999-12-31\"},"
                             " {\"case\": \"einstein-slope\", \"reason\": \"nor this\", \"expires\": \"9999-12-31\"}]}");
    check_close(shell(run, said), 77, 0, "all that fails is accepted");
    says(said, "known failures (counted as skipped): drag, einstein-slope");
    check_close(shell("xmllint --noout --nonet --dtdvalid validation/junit.dtd $F/r/junit.xml && grep -c '<skipped message=\"known: ' $F/r/junit.xml",
                      said), 0, 0, "in JUnit they are skipped, with the reason");
    says(said, "2");
    write_text("known.json", "{\"known\": [{\"case\": \"dragg\", \"reason\": \"r\", \"expires\": \"9999-12-31\"}]}");
    check_close(shell(run, said), 2, 0, "an entry that names no case");
    says(said, "known[0]: there is no case 'dragg'");
}

/* --- order --- */

/* Whether `first` stands before `second` in a file of the work folder, from the last `after` on. */
static bool in_order(const char *file, const char *after, const char *first, const char *second)
{
    char path[PATH_LENGTH], *text = calloc(1, 1 << 18);
    path_join(path, folder, file);
    FILE *in = fopen(path, "r");
    if (in) {
        text[fread(text, 1, (1 << 18) - 1, in)] = '\0';
        fclose(in);
    }
    const char *from = strstr(text, after), *a = from ? strstr(from, first) : NULL, *b = from ? strstr(from, second) : NULL;
    const bool good = a && b && a < b;
    free(text);
    return good;
}

static void invariants_stand_first(void)
{
    struct check_run run = { 0 };
    json_t *words = json_array();
    const struct gate_case one = { .name = "case", .about = "about", .layer = LAYER_PAIR, .needs = words, .flags = words };
    check_error(&run, MODEL, "coefficient", 1, 2, 1e6, 0.1, "the model is wrong");
    check_error(&run, INVARIANT, "third law", 1, 2, 1, 0.1, "an invariant is broken");
    struct finished_case done = { .gate_case = &one, .results = run.results, .verdict = VERDICT_FAIL };
    const struct provenance p = { .gate_version = "1", .candidate = "c", .level = "A", .precision = "double", .date = "2026-01-01" };
    char path[PATH_LENGTH], why[WHY_LENGTH] = "";
    path_join(path, folder, "order.xml");
    check_true(report_junit(path, &p, &done, 1, why), why);
    check_true(in_order("order.xml", "<failure", "message=\"an invariant is broken", "the model is wrong"), "JUnit: message");
    check_true(in_order("order.xml", "\">FAIL", "an invariant is broken", "the model is wrong"), "JUnit: text");
    path_join(path, folder, "order.html");
    check_true(report_html(path, &p, &done, 1, "validation/flags.json", why), why);
    check_true(in_order("order.html", "What is wrong", "an invariant is broken", "the model is wrong"), "page: what is wrong");
    check_true(in_order("order.html", "<tbody>", "third law", "coefficient"), "page: table");
    path_join(path, folder, "order.md");
    FILE *file = fopen(path, "w");
    github_summary(file, &p, &done, 1);
    fclose(file);
    check_true(in_order("order.md", "What is wrong", "an invariant is broken", "the model is wrong"), "GitHub");
    finished_free(&done);
    json_decref(words);
}

/* --- GitHub --- */

static void github_is_told_at_most_ten_times(void)
{
    enum { MANY = 13 };
    struct invented i[MANY];
    struct finished_case done[MANY];
    char path[PATH_LENGTH], line[2048];
    path_join(path, folder, "annotations");
    for (size_t many = 9; many <= MANY; many += many == 9 ? 1 : 3) {
        for (size_t k = 0; k < many; k++) {
            invent(&i[k], 1);
            snprintf(i[k].one.name, sizeof i[k].one.name, "case-%zu", k);
            done[k] = i[k].done;
            done[k].gate_case = &i[k].one;
        }
        free(done[0].results.item[0].sentence);
        done[0].results.item[0].sentence = strcpy(malloc(64), "100% wrong,\nin two lines: see");
        const struct provenance p = { .candidate = "sh Makefile --fast" };
        FILE *file = fopen(path, "w+");
        github_annotate(file, &p, done, many, NULL);
        rewind(file);
        size_t lines = 0;
        while (fgets(line, sizeof line, file)) {
            if (lines++ == 0)
                check_true(strcmp(line, "::error file=Makefile,title=pair / case-0 (FAIL)::100%25 wrong,%0Ain two lines: see\n") == 0, line);
            check_true(strncmp(line, "::error ", 8) == 0, line);
        }
        check_close((double)lines, (double)(many < 10 ? many : 10), 0, "annotations");
        check_true((strstr(line, "4 more cases are wrong") != NULL) == (many == MANY), line);
        fclose(file);
        for (size_t k = 0; k < many; k++)
            finished_free(&done[k]);
    }
}

static void github_from_outside(void)
{
    char said[8192];
    const char *run = "GITHUB_ACTIONS=true GITHUB_STEP_SUMMARY=$F/summary.md $B/gate run --candidate true --case drag,einstein-slope "
                      "--work $F/w --report $F/r | tail -20";
    check_close(shell(run, said), 0, 0, "run");
    says(said, "::error title=pair / drag (FAIL)::candidate wrote garbage");
    const char *last_line = "\n0 passed, 2 failed, 0 skipped\n";
    check_true(strlen(said) > strlen(last_line) && strcmp(said + strlen(said) - strlen(last_line), last_line) == 0, "counts come last");
    check_close(shell("cat $F/summary.md", said), 0, 0, "the summary is there");
    says(said, "## sheargate: 0 passed, 2 failed, 0 skipped");
    says(said, "**pair / drag** (FAIL)");
    says(said, "| drag torque | FAIL |");
    check_close(shell("env -u GITHUB_ACTIONS $B/gate run --candidate true --case drag --work $F/w --report $F/r | grep -c ::error", said), 1, 0,
                "elsewhere nothing of the kind");
}

/* --- coverage --- */

static void every_term_is_covered(void)
{
    struct suite_of_cases suite;
    struct coverage c;
    char why[WHY_LENGTH] = "";
    check_true(cases_load("validation/cases", &suite, why) && coverage_make("validation/terms.json", &suite, NULL, 0, &c, why), why);
    for (size_t k = 0; k < c.rows; k++) {
        check_true(c.row[k].layer[0].cases > 0, c.row[k].term);
        check_true(strcmp(coverage_word(&c.row[k].layer[0]), "not judged") == 0, "nothing was asked");
        for (size_t j = 0; j + 1 < k; j++)
            check_true(strcmp(c.row[j].group, c.row[k].group) != 0 || strcmp(c.row[k - 1].group, c.row[k].group) == 0, "a group stands together");
    }
    coverage_free(&c);
    cases_free(&suite);
}

static void coverage_says_what_was_judged(void)
{
    struct invented i;
    struct coverage c;
    char why[WHY_LENGTH] = "", path[PATH_LENGTH];
    invent(&i, 1);
    i.one.terms = json_pack("{s[s] s[s] s[s]}", "left term", "left*", "right term", "right*", "both", "*: force");
    struct gate_case other = { .name = "other", .layer = LAYER_DENSE, .terms = json_pack("{s[s] s[s]}", "right term", "*", "more", "*") };
    struct gate_case cases[2] = { i.one, other };
    struct suite_of_cases suite = { cases, 2, 0 };
    i.done.gate_case = &cases[0];
    write_text("terms.json", "{\"left term\": {\"group\": \"g\", \"about\": \"a\"}, \"right term\": {\"group\": \"g\", \"about\": \"a\"},"
                             " \"both\": {\"group\": \"g\", \"about\": \"a\"}, \"more\": {\"group\": \"h\", \"about\": \"a\"}}");
    path_join(path, folder, "terms.json");
    check_true(coverage_make(path, &suite, &i.done, 1, &c, why), why);
    check_true(strcmp(coverage_word(&c.row[0].layer[0]), "FAIL") == 0, "its quantity fails");
    check_true(strcmp(coverage_word(&c.row[1].layer[LAYER_PAIR]), "pass") == 0 && c.row[1].layer[LAYER_DENSE].left_out == 1, "its passes");
    check_true(strcmp(coverage_word(&c.row[2].layer[0]), "FAIL") == 0 && c.row[2].layer[0].cases == 1, "one of two fails");
    check_true(strcmp(coverage_word(&c.row[3].layer[0]), "not judged") == 0 && c.row[3].layer[0].left_out == 1, "not asked");
    coverage_free(&c);
    i.done.results.item[0].accepted = "accepted";
    check_true(coverage_make(path, &suite, &i.done, 1, &c, why) && c.row[0].layer[0].skipped == 1, "accepted: not judged");
    coverage_free(&c);
    json_object_set_new(cases[0].terms, "misspelt", json_pack("[s]", "*"));
    check_true(!coverage_make(path, &suite, &i.done, 1, &c, why) && strstr(why, "there is no term 'misspelt'"), why);
    coverage_free(&c);
    json_decref(cases[0].terms);
    json_decref(cases[1].terms);
    finished_free(&i.done);
}

static void judges_one(struct check_run *run)
{
    check_error(run, MODEL, "force", 1, 1, 0, 1, "-");
}

static void a_term_without_quantity_is_a_mistake(void)
{
    const struct check check = { "one", judges_one };
    struct gate_case one = { .terms = json_pack("{s[s]}", "third law", "forc?") };
    struct check_run run = { .gate_case = &one };
    check_judge(&run, &check, 10, 0);
    check_true(results_verdict(&run.results) == VERDICT_PASS, "the quantity is there");
    results_free(&run.results);
    json_object_set_new(one.terms, "torque balance", json_pack("[s]", "torque*"));
    check_judge(&run, &check, 10, 0);
    check_true(results_verdict(&run.results) == VERDICT_FAIL, "no quantity judges the term");
    says(results_worst(&run.results)->sentence, "mistake in the suite");
    results_free(&run.results);
    json_decref(one.terms);
}

/* A state upstream carries the day on which it was read, or says that it is not known. */
static void every_flag_says_what_is_known_upstream(void)
{
    static const char *const honest[] = { "(thread as stored, read 20", "not known", "no report known to us", "known to us on 20", "measured by us",
                                          "nothing to mend" };
    const char *flag;
    json_t *entry, *flags = json_load_file("validation/flags.json", JSON_REJECT_DUPLICATES, NULL);
    check_true(json_object_size(flags) > 0, "flags.json");
    json_object_foreach(flags, flag, entry)
    {
        const char *upstream = json_string_value(json_object_get(entry, "upstream"));
        bool said = false;
        for (size_t k = 0; k < sizeof honest / sizeof *honest; k++)
            said = said || (upstream && strstr(upstream, honest[k]));
        check_true(said && json_object_size(entry) == 4, flag);
    }
    json_decref(flags);
}

static void first(void)
{
    check_true(mkdtemp(folder) != NULL, "a folder to work in");
}

static void last(void)
{
    check_true(folder_remove(folder), "the folder is removed");
}

static const struct unit_test tests[] = {
    { "work folder", first },
    { "the manifest is not stale", the_manifest_is_not_stale },
    { "a changed tolerance is noticed", a_changed_tolerance_is_noticed },
    { "newer cases only warn", newer_cases_only_warn },
    { "known failures", known_failures },
    { "what is not accepted stays red", what_is_not_accepted_stays_red },
    { "accepted failures from outside", accepted_failures_from_outside },
    { "invariants stand first", invariants_stand_first },
    { "GitHub is told at most ten times", github_is_told_at_most_ten_times },
    { "GitHub from outside", github_from_outside },
    { "every flag says what is known upstream", every_flag_says_what_is_known_upstream },
    { "every term is covered", every_term_is_covered },
    { "coverage says what was judged", coverage_says_what_was_judged },
    { "a term without quantity is a mistake", a_term_without_quantity_is_a_mistake },
    { "work folder removed", last },
    { NULL, NULL },
};

const struct suite verdict_suite = { "verdict", tests };
