/*
 * The gate's own machinery: verdicts and the two-stage rule with invented checks, candidates that misbehave in every way
 * we could think of, exit codes, the reports, and the suite's cases as a whole.
 */
#include "report.h"
#include "suite.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static char folder[] = "/tmp/gate-test-XXXXXX";

/* --- verdicts --- */

static double p_of_attempt[2], resolution;
static unsigned seeds[2];
static int calls, samples_seen;

static void invented(struct check_run *run)
{
    seeds[run->attempt - 1] = run->seed;
    samples_seen = run->samples;
    calls++;
    check_p(run, INVARIANT, "noise", 1.1, 1, p_of_attempt[run->attempt - 1], resolution, 0.05, "noise is off");
}

/* The verdict of a check that gives these p-values, in a suite of ten statistical results (limit 1e-7). */
static enum verdict two_stages(double first, double second)
{
    const struct gate_case one = { .seed = 5, .p_values = 1 };
    const struct check check = { "invented", invented };
    struct check_run run = { .gate_case = &one };
    p_of_attempt[0] = first;
    p_of_attempt[1] = second;
    calls = 0;
    check_judge(&run, &check, 10, 0);
    const enum verdict v = results_verdict(&run.results);
    results_free(&run.results);
    return v;
}

static void alarms_need_two_stages(void)
{
    resolution = 0.01;
    check_true(two_stages(0.3, 0) == VERDICT_PASS && calls == 1, "an ordinary p passes at once");
    check_true(two_stages(2e-4, 0) == VERDICT_PASS && calls == 1, "2e-4 is no alarm");
    check_true(two_stages(1e-5, 0.4) == VERDICT_PASS && calls == 2, "an alarm that the rerun does not confirm");
    check_true(samples_seen == 4 && seeds[0] == 5 && seeds[1] != 5, "the rerun has four times the samples and a fresh seed");
    check_true(two_stages(1e-5, 2e-7) == VERDICT_PASS, "above 1e-6/10");
    check_true(two_stages(1e-5, 5e-8) == VERDICT_FAIL, "below 1e-6/10");
    check_true(two_stages(0, 0) == VERDICT_FAIL, "certainty");
    check_true(two_stages(NAN, 0.5) == VERDICT_FAIL, "a NaN is no p-value");
    resolution = 0.2;
    check_true(two_stages(0.3, 0) == VERDICT_INCONCLUSIVE, "a sample too small to see the declared fault never passes");
    check_true(two_stages(1e-5, 1e-20) == VERDICT_FAIL, "but it may fail");
}

static void deterministic_and_interval_verdicts(void)
{
    struct check_run run = { 0 };
    check_true(check_error(&run, MODEL, "a", 1, 1, 1e-11, 1e-10, "-")->verdict == VERDICT_PASS, "small error");
    check_true(results_verdict(&run.results) == VERDICT_PASS, "pass");
    check_true(check_skip(&run, "s", "not there")->verdict == VERDICT_SKIP, "skip");
    check_true(results_verdict(&run.results) == VERDICT_PASS, "a skip beside a pass");
    check_true(strcmp(results_worst(&run.results)->what, "a") == 0, "what was not judged is not the worst");
    check_true(results_not_judged(&run.results) == 1, "but counted");
    check_true(check_interval(&run, MODEL, "b", 1.02, 0.005, 1, 0.05, "-")->verdict == VERDICT_PASS, "interval inside");
    check_true(check_interval(&run, MODEL, "c", 1.02, 0.010, 1, 0.05, "-")->verdict == VERDICT_INCONCLUSIVE, "across the edge");
    check_true(results_verdict(&run.results) == VERDICT_INCONCLUSIVE, "inconclusive");
    check_true(check_interval(&run, MODEL, "d", 1.10, 0.010, 1, 0.05, "-")->verdict == VERDICT_FAIL, "interval outside");
    check_true(check_interval(&run, MODEL, "e", NAN, 0.010, 1, 0.05, "-")->verdict == VERDICT_FAIL, "NaN agrees with nothing");
    check_true(check_error(&run, MODEL, "f", NAN, 1, NAN, 1e-10, "-")->verdict == VERDICT_FAIL, "NaN error");
    check_true(results_verdict(&run.results) == VERDICT_FAIL, "fail");
    check_error(&run, INVARIANT, "g", 2, 1, 1e-9, 1e-10, "broken");
    check_true(strcmp(results_worst(&run.results)->what, "g") == 0, "a broken invariant is worse than a wrong number");
    results_free(&run.results);
    check_true(results_verdict(&run.results) == VERDICT_INCONCLUSIVE, "no result at all is no pass");
}

static void results_survive_json(void)
{
    struct check_run run = { 0 };
    struct results back;
    result_notes(check_p(&run, INVARIANT, "p", 1.0 / 3, INFINITY, 1e-300, 0.01, 0.05, "sentence %d", 7), "notes");
    check_error(&run, MODEL, "e", NAN, -INFINITY, NAN, 1, "%s", "wrong");
    json_t *json = results_to_json(&run.results);
    check_true(json && results_from_json(json, &back) && back.count == 2, "there and back");
    check_true(back.item[0].measured == 1.0 / 3 && isinf(back.item[0].expected) && back.item[0].p == 1e-300, "numbers");
    check_true(isnan(back.item[1].measured) && back.item[1].expected == -INFINITY && isnan(back.item[1].p), "no numbers");
    check_true(strcmp(back.item[0].sentence, "sentence 7") == 0 && strcmp(back.item[0].notes, "notes") == 0, "texts");
    check_true(back.item[0].verdict == VERDICT_PASS && back.item[1].verdict == VERDICT_FAIL, "verdicts");
    json_decref(json);
    results_free(&run.results);
    results_free(&back);
}

static void exit_codes(void)
{
    struct finished_case done[4] = { { .verdict = VERDICT_PASS }, { .verdict = VERDICT_SKIP }, { .verdict = VERDICT_INCONCLUSIVE },
                                     { .verdict = VERDICT_FAIL } };
    check_true(report_exit_code(report_tally(done, 1)) == 0, "all pass");
    check_true(report_exit_code(report_tally(done, 2)) == 0, "pass and skip");
    check_true(report_exit_code(report_tally(done + 1, 1)) == 77, "nothing supported");
    check_true(report_exit_code(report_tally(done, 3)) == 3, "only inconclusive");
    check_true(report_exit_code(report_tally(done, 4)) == 1, "failed");
    const struct tally t = report_tally(done, 4);
    check_true(t.passed == 1 && t.failed == 2 && t.skipped == 1 && t.inconclusive == 1, "inconclusive counts as failed");
}

/* --- candidates --- */

static enum candidate_outcome run_shell(const char *script, struct candidate_answer *answer)
{
    char command[1024], out[PATH_LENGTH], why[WHY_LENGTH];
    snprintf(command, sizeof command, "sh -c '%s' it", script);
    path_join(out, folder, "out");
    folder_remove(out);
    folder_make(out, why);
    const struct candidate c = { .command = command, .seconds = 0.5, .bytes = 1 << 20 };
    candidate_run(&c, folder, out, answer);
    return answer->outcome;
}

static void candidates_may_do_anything(void)
{
    struct candidate_answer a;
    check_true(run_shell("test -d \"$1\" && echo x >\"$2\"/file", &a) == CANDIDATE_OK, "two folders are given");
    check_true(run_shell("exit 77", &a) == CANDIDATE_UNSUPPORTED, "77");
    check_true(run_shell("echo first; echo the reason >&2; exit 3", &a) == CANDIDATE_FAILED && a.detail == 3, "exit code 3");
    check_true(strstr(a.message, "exit code 3: the reason") != NULL, a.message);
    check_true(run_shell("kill -SEGV $$", &a) == CANDIDATE_CRASHED && a.detail == SIGSEGV, a.message);
    check_true(run_shell("exit 0; nonsense", &a) == CANDIDATE_OK, "nothing written is for the check to see");
    check_true(run_shell("sleep 20", &a) == CANDIDATE_HUNG && a.seconds < 5 && strstr(a.message, "after 0.5 s"), a.message);
    check_true(run_shell("head -c 4000000 /dev/zero >\"$2\"/flood; sleep 1", &a) == CANDIDATE_FLOODED
                   || a.outcome == CANDIDATE_HUNG, "one large file");
    check_true(run_shell("for k in 1 2 3 4; do head -c 500000 /dev/zero >\"$2\"/$k; done; sleep 0.45; sleep 9", &a)
                   == CANDIDATE_FLOODED, "many small files");
}

/* A candidate that is a script around the program under test: what became of that program is said, not only an exit code. */
static void what_became_of_a_wrapped_program_is_said(void)
{
    struct candidate_answer a;
    check_true(run_shell("head -c 4000000 /dev/zero >\"$2\"/flood; exit $?", &a) == CANDIDATE_FLOODED, "ended by the limit of a file, which a shell makes exit code 153");
    check_true(run_shell("trap \"\" XFSZ; head -c 4000000 /dev/zero >\"$2\"/flood", &a) == CANDIDATE_FLOODED, "stopped at the limit by an error in writing");
    check_true(run_shell("sh -c \"kill -SEGV \\$\\$\"; exit $?", &a) == CANDIDATE_FAILED && strstr(a.message, "ended by signal 11"), a.message);
    check_true(run_shell("echo Error: no file; echo version 1; exit 1", &a) == CANDIDATE_FAILED && strstr(a.message, "exit code 1: Error: no file"), a.message);
    check_true(strstr(a.message, "out.log)") != NULL, "where the rest of what it said is");
    check_true(run_shell("echo no error here; echo the reason; exit 77", &a) == CANDIDATE_UNSUPPORTED && strstr(a.message, "77): the reason"), a.message);
}

static void a_script_is_part_of_the_hash(void)
{
    char path[PATH_LENGTH], command[PATH_LENGTH + 8], before[17], after[17];
    const struct candidate c = { .command = command };
    path_join(path, folder, "adapter.txt");
    snprintf(command, sizeof command, "sh -e %s", path);
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen(path, "w");
        fputs(k ? "exit 1" : "exit 0", file);
        fclose(file);
        check_true(candidate_hash(&c, k ? after : before), "there is a program");
    }
    check_true(strcmp(before, after) != 0, "another script, another hash");
}

static void helpers_of_a_candidate_die_with_it(void)
{
    struct candidate_answer a;
    char path[PATH_LENGTH];
    path_join(path, folder, "out/pid");
    check_true(run_shell("sleep 30 & echo $! >\"$2\"/pid; exit 0", &a) == CANDIDATE_OK, a.message);
    FILE *file = fopen(path, "r");
    int pid = 0;
    check_true(file && fscanf(file, "%d", &pid) == 1 && pid > 1, "the helper told its number");
    if (file)
        fclose(file);
    /* it may stay as a zombie until init collects it, so ask its state, not its existence */
    snprintf(path, sizeof path, "/proc/%d/stat", pid);
    char state = '?';
    for (int k = 0; k < 50 && state != 'Z'; k++) {
        file = fopen(path, "r");
        if (!file || fscanf(file, "%*d (%*[^)]) %c", &state) != 1)
            state = 'Z'; /* gone altogether */
        if (file)
            fclose(file);
        nanosleep(&(struct timespec){ .tv_nsec = 20000000 }, NULL);
    }
    check_true(state == 'Z', "the helper is gone");
}

static void what_is_no_answer_is_recorded(void)
{
    json_t *needs = json_array();
    const struct gate_case one = { .name = "case", .about = "about", .needs = needs };
    struct candidate c = { .command = "sh -c 'exit 77' it", .seconds = 5, .bytes = 1 << 20 };
    struct check_run run = { .gate_case = &one, .candidate = &c, .attempt = 1 };
    snprintf(run.work, sizeof run.work, "%s", folder);
    char out[PATH_LENGTH], path[PATH_LENGTH];
    json_t *scene = json_object();
    const struct state_row row = { .id = 1, .species = 1 };
    const struct question q = { .protocol = "forces", .scene = scene, .state = &row, .states = 1 };
    check_true(!check_ask(&run, "a question, asked", &q, out) && results_verdict(&run.results) == VERDICT_SKIP, "77 is a skip");
    path_join(path, folder, "a-question--asked/case/states.csv");
    check_true(access(path, R_OK) == 0 && table_has(path, "wz"), "the case folder is written, its name without blanks");
    c.command = "sh -c 'kill -ABRT $$' it";
    check_true(!check_ask(&run, "again", &q, out) && results_verdict(&run.results) == VERDICT_FAIL, "a crash is a failure");
    check_true(strstr(results_worst(&run.results)->sentence, "signal 6") != NULL, "and named");
    json_decref(scene);
    json_decref(needs);
    results_free(&run.results);
}

/* --- reports and the program --- */

static void junit_is_valid_whatever_was_said(void)
{
    json_t *words = json_array();
    const struct gate_case one = { .name = "case", .about = "about <all> & \"more\"", .layer = LAYER_PAIR, .needs = words,
                                   .flags = words };
    struct finished_case done[3] = { { .gate_case = &one }, { .gate_case = &one }, { .gate_case = &one } };
    struct check_run run = { 0 };
    check_garbage(&run, "]]> <tag attribute=\"x\"> & \x01\x1b[31m control characters");
    done[0] = (struct finished_case){ .gate_case = &one, .results = run.results, .verdict = VERDICT_FAIL };
    done[1].verdict = VERDICT_SKIP;
    struct provenance p = { .gate_version = "1", .candidate = "a & b", .level = "A", .precision = "double", .date = "2026-01-01" };
    char path[PATH_LENGTH], why[WHY_LENGTH] = "", command[2 * PATH_LENGTH];
    path_join(path, folder, "junit.xml");
    check_true(report_junit(path, &p, done, 3, why), why);
    snprintf(command, sizeof command, "xmllint --noout --nonet --dtdvalid validation/junit.dtd %s", path);
    check_true(system(command) == 0, "xmllint accepts it (needs libxml2-utils)");
    path_join(path, folder, "index.html");
    check_true(report_html(path, &p, done, 3, "validation/flags.json", why), why);
    results_free(&done[0].results);
    json_decref(words);
}

static int gate(const char *arguments, char last_line[256])
{
    char program[PATH_LENGTH], command[3 * PATH_LENGTH], line[4096];
    const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    program[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(program, '/'); /* build/unit-tests and build/gate are neighbours */
    if (slash)
        *slash = '\0';
    snprintf(command, sizeof command, "%s/gate %s --work %s/work --report %s/report 2>&1", program, arguments, folder, folder);
    FILE *pipe = popen(command, "r");
    last_line[0] = '\0';
    while (pipe && fgets(line, sizeof line, pipe))
        snprintf(last_line, 256, "%.255s", line);
    const int status = pipe ? pclose(pipe) : -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void the_program_from_outside(void)
{
    char last[256];
    check_close(gate("walk", last), 2, 0, "unknown command");
    check_close(gate("run", last), 2, 0, "no candidate");
    check_close(gate("run --candidate true --tier slow", last), 2, 0, "unknown tier");
    check_true(strstr(last, "there is no tier 'slow'") != NULL, last);
    check_close(gate("run --candidate true --jobs 0", last), 2, 0, "no jobs");
    check_close(gate("run --candidate true --case no-such-case", last), 2, 0, "unknown case");
    check_close(gate("run --candidate \" \"", last), 2, 0, "a candidate without a name");
    check_close(gate("run --candidate true --needs frictoin", last), 2, 0, "unknown physics");
    check_true(strstr(last, "some name") && strstr(last, "friction-laws"), last);
    check_close(gate("run --candidate /no/such/program --layer pair", last), 2, 0, "unknown program");
    check_close(gate("run --candidate \"sh -c 'exit 77'\" --layer 1 --case drag,units-drag", last), 77, 0, "nothing supported");
    check_true(strcmp(last, "0 passed, 0 failed, 2 skipped\n") == 0, last);
    check_close(gate("run --candidate true --layer pair --case drag", last), 1, 0, "nothing written");
    check_true(strcmp(last, "0 passed, 1 failed, 0 skipped\n") == 0, last);
    check_close(gate("run --candidate true --case drag --patience 0", last), 2, 0, "no patience");
    check_close(gate("list --tier full", last), 0, 0, "list");
}

static void the_suite_is_whole(void)
{
    struct suite_of_cases suite;
    char why[WHY_LENGTH] = "";
    json_t *flags = json_load_file("validation/flags.json", JSON_REJECT_DUPLICATES, NULL);
    check_true(json_is_object(flags) && cases_load("validation/cases", &suite, why), why);
    for (size_t k = 0; k < suite.count; k++) {
        const struct gate_case *c = &suite.item[k];
        size_t f;
        json_t *flag;
        check_true(check_find(c->check) != NULL, c->check);
        check_true(isnan(c->tolerance) || strlen(c->reason) > 20, c->name);
        json_array_foreach(c->flags, f, flag)
            check_true(json_object_get(flags, json_string_value(flag)) != NULL, json_string_value(flag));
    }
    cases_free(&suite);
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
    { "alarms need two stages", alarms_need_two_stages },
    { "deterministic and interval verdicts", deterministic_and_interval_verdicts },
    { "results survive JSON", results_survive_json },
    { "exit codes", exit_codes },
    { "candidates may do anything", candidates_may_do_anything },
    { "what became of a wrapped program is said", what_became_of_a_wrapped_program_is_said },
    { "a script is part of the hash", a_script_is_part_of_the_hash },
    { "helpers of a candidate die with it", helpers_of_a_candidate_die_with_it },
    { "what is no answer is recorded", what_is_no_answer_is_recorded },
    { "JUnit is valid whatever was said", junit_is_valid_whatever_was_said },
    { "the program from outside", the_program_from_outside },
    { "the suite is whole", the_suite_is_whole },
    { "work folder removed", last },
    { NULL, NULL },
};

const struct suite gate_suite = { "gate", tests };
