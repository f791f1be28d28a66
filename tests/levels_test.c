/*
 * The program `gate` from outside, on the solver itself: levels B and C, declared precision, conventions, answers made elsewhere. Every way must pass
 * a right candidate and fail a wrong one.
 */
#include "offline.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/gate-levels-XXXXXX", programs[PATH_LENGTH], said[65536];

/* Exit code of `gate ...`; what it printed is in `said`. %s in the arguments stands for the folder of the programs, then for the folder of the test. */
static int gate(const char *arguments)
{
    char command[8 * PATH_LENGTH];
    snprintf(command, sizeof command, "%s/gate %s --work %s/work --report %s/report 2>&1", programs, arguments, folder, folder);
    FILE *pipe = popen(command, "r");
    const size_t n = pipe ? fread(said, 1, sizeof said - 1, pipe) : 0;
    said[n] = '\0';
    const int status = pipe ? pclose(pipe) : -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* The candidate "WRAPPER SHEAR --evaluate" with these options. */
static int judge(const char *wrapper, const char *options)
{
    char arguments[6 * PATH_LENGTH];
    snprintf(arguments, sizeof arguments, "run --candidate \"%s%s/shear --evaluate\" %s", wrapper, programs, options);
    return gate(arguments);
}

static const char *capabilities(const char *content)
{
    static char option[2 * PATH_LENGTH];
    char path[PATH_LENGTH];
    path_join(path, folder, "capabilities.json");
    FILE *file = fopen(path, "w");
    fprintf(file, "{\"contract\": \"1.0\", %s}", content);
    fclose(file);
    snprintf(option, sizeof option, "--capabilities %s", path);
    return option;
}

static void expect(int code, int expected, const char *words)
{
    check_close(code, expected, 0, "exit code");
    check_true(strstr(said, words) != NULL, words);
    if (code != expected || !strstr(said, words))
        printf("%.3000s", said);
}

#define SOME "--case drag,contact-friction,crowd-dashpot,lubrication-forces,units-repulsion,applied "

static void level_b(void)
{
    expect(judge("", SOME "--level B"), 0, "6 passed, 0 failed, 0 skipped");
    check_true(strstr(said, "entry level B") != NULL, "the first line names the level");
    expect(judge("sh tests/altered.sh 's/.viscosity.: .*/\\\"viscosity\\\":0.71/' ", "--case drag --level B"), 1, "1 failed");
    expect(judge("sh tests/altered.sh 's/.inner_gap.: .*,/\\\"inner_gap\\\":0.0011,/' ", "--case lubrication-forces --level B"), 1, "force along n of lubrication");
    expect(judge("sh tests/altered.sh 's/.tangential_damping.: .*,/\\\"tangential_damping\\\":0,/' ", "--case crowd-dashpot --level B"), 1, "contact on sphere");
    expect(judge("", "--case contact-dashpot,friction-pairs --level B"), 77, "the force on held or driven spheres, which steps do not show (level B)");
}

static void level_c(void)
{
    expect(judge("", "--case drag,noise-pairs,tether --level C"), 0, "1 passed, 0 failed, 2 skipped");
    check_true(strstr(said, "asks for forces of given particles, which level C does not give") != NULL, "why it was skipped");
}

static void undeclared_physics_is_skipped(void)
{
    char options[4 * PATH_LENGTH];
    /* what is skipped is not even started: this candidate would fail */
    snprintf(options, sizeof options, "%s %s", SOME, capabilities("\"physics\": []"));
    expect(judge("false ", options), 77, "needs \"lubrication\", which the candidate does not declare");
    check_true(strstr(said, "0 passed, 0 failed, 6 skipped") != NULL, "all is counted as skipped");
    snprintf(options, sizeof options, "--case drag,lubrication-forces %s", capabilities("\"physics\": [\"drag\", \"drag-torque\", \"shear\", \"tilted\", \"unequal\"]"));
    expect(judge("", options), 0, "1 passed, 0 failed, 1 skipped");
    check_true(strstr(said, "needs \"superposed-shear\"") != NULL, "single questions of a case are skipped as well");
    check_true(strstr(said, "           2 of ") && strstr(said, " not judged\n"), "how many were not");
    check_true(strstr(said, "passed, but for what was not judged: drag (2 of ") != NULL, "and once more at the end");
    check_true(strstr(said, "x and z along y    ") == NULL, "a question that was not asked is not the worst of those that were");
    snprintf(options, sizeof options, "--case friction-plain %s", capabilities("\"physics\": [\"contact\", \"friction\", \"histories\", \"unequal\", \"stress\"]"));
    expect(judge("", options), 0, "1 passed, 0 failed, 0 skipped");
    snprintf(options, sizeof options, "--case drag %s", capabilities("\"physik\": []"));
    expect(judge("", options), 2, "unknown key \"physik\"; did you mean \"physics\"?");
}

static void few_digits(void)
{
    static const char cases[] = "--case contact-friction,lubrication-forces,lubrication-resistance,repulsion-energy", more[] = "--case noise-pairs,noise-range,tether,cut-off";
    char options[4 * PATH_LENGTH];
    snprintf(options, sizeof options, "%s %s", cases, capabilities("\"precision\": {\"digits\": 7}"));
    expect(judge("sh tests/rounded.sh 7 ", options), 0, "4 passed, 0 failed, 0 skipped");
    check_true(strstr(said, "7 digits precision") != NULL, "the first line names the precision");
    expect(judge("sh tests/rounded.sh 7 ", cases), 1, "0 passed, 4 failed");
    check_true(strstr(said, "an error of only ") != NULL, "what few digits look like");
    check_true(strstr(said, "of it too ") && !strstr(said, ", 1 of it"), "numbers that differ are printed so that they do");
    check_true(strstr(said, "[Coulomb cap]") != NULL, "the name of the quantity");
    check_true(strstr(said, " \n") == NULL, "no blank at the end of a line");
    expect(judge("sh tests/altered.sh 's/.inner_gap.: .*,/\\\"inner_gap\\\":0.0011,/' sh tests/rounded.sh 7 ", options), 1, "2 passed, 2 failed");
    snprintf(options, sizeof options, "%s %s", cases, capabilities("\"precision\": \"float\""));
    expect(judge("sh tests/rounded.sh 8 ", options), 0, "4 passed, 0 failed, 0 skipped");
    snprintf(options, sizeof options, "%s %s", more, capabilities("\"precision\": \"float\""));
    expect(judge("sh tests/rounded.sh 8 ", options), 0, "3 passed, 0 failed, 1 skipped");
    expect(judge("sh tests/altered.sh 's/.kT.: 0.31/\\\"kT\\\": 0.3/' sh tests/rounded.sh 8 ", options), 1, "1 passed, 2 failed, 1 skipped");
}

static void patience_is_a_factor(void)
{
    expect(gate("run --candidate \"sh -c 'sleep 30' it\" --case drag --patience 0.01"), 1, "killed after 0.2 s");
}

static void conventions_are_named(void)
{
    static const char lever[] = "sh tests/altered.sh 's/.lever.: .radius./\\\"lever\\\": \\\"contact\\\"/' ";
    static const char exact[] = "sh tests/altered.sh 's/.rotation_correction.: .none./\\\"rotation_correction\\\": \\\"exact\\\"/' ";
    char options[4 * PATH_LENGTH];
    expect(judge(lever, "--case contact-friction"), 1, "everything agrees with lever \"contact\"");
    snprintf(options, sizeof options, "--case contact-friction %s", capabilities("\"level\": \"A\""));
    expect(judge(lever, options), 0, "skip: everything agrees with lever \"contact\"");
    snprintf(options, sizeof options, "--case contact-friction %s", capabilities("\"model\": {\"lever\": \"contact\"}"));
    expect(judge(lever, options), 0, "1 passed");
    expect(judge(exact, "--case lubrication-forces,rigid-motion"), 1, "everything agrees with rotation_correction \"exact\"");
    snprintf(options, sizeof options, "--case lubrication-forces,rigid-motion %s", capabilities("\"model\": {\"rotation_correction\": \"exact\"}"));
    expect(judge(exact, options), 0, "2 passed");
    expect(judge("sh tests/altered.sh 's/.friction.: .*,/\\\"friction\\\":0.44,/' ", "--case contact-friction"), 1, "1 failed");
    check_true(strstr(said, "everything agrees") == NULL, "a mistake is no convention");
    /* Nor are noise that is too weak, whose p-values no second sample judges here, and whole answers of a program that ended with an error. */
    snprintf(options, sizeof options, "--case equipartition %s", capabilities("\"level\": \"A\""));
    expect(judge("sh tests/altered.sh 's/.kT.: .*/\\\"kT\\\": 2.6e-9/' ", options), 1, "its noise does not balance its");
    check_true(strstr(said, "everything agrees") == NULL, "too weak a noise is no convention");
    snprintf(options, sizeof options, "--case contact-friction %s", capabilities("\"level\": \"A\""));
    expect(judge("sh tests/ends_badly.sh ", options), 1, "ended with exit code 1");
    check_true(strstr(said, "everything agrees") == NULL, "no answer is no convention");
}

/* --- answers made elsewhere --- */

static int shell(const char *format, const char *a, const char *b)
{
    char command[8 * PATH_LENGTH];
    snprintf(command, sizeof command, format, a, b);
    return system(command);
}

static void export_run_judge(void)
{
    char arguments[2 * PATH_LENGTH], there[PATH_LENGTH];
    path_join(there, folder, "exported");
    snprintf(arguments, sizeof arguments, "export %s --case drag,metamorphic,noise-pairs", there);
    expect(gate(arguments), 0, "questions in");
    expect(gate(arguments), 2, "is not empty");
    snprintf(arguments, sizeof arguments, "judge %s", there);
    expect(gate(arguments), 3, "0 passed, 3 failed, 0 skipped");
    check_true(strstr(said, "to be answered before this can be judged") && strstr(said, "have no answer yet"), "what waits");
    int rounds = 0;
    do {
        check_close(shell("sh %s/run.sh %s/shear --evaluate >/dev/null", there, programs), 0, 0, "run.sh");
        rounds++;
    } while (gate(arguments) == 3 && rounds < 5);
    check_true(strstr(said, "3 passed, 0 failed, 0 skipped") != NULL, said);
    check_true(rounds <= 3, "few rounds: the second half of a split run starts where the first has ended");

    shell("cp -r %s/work %s/judged", folder, folder);
    expect(judge("", "--case drag,metamorphic,noise-pairs"), 0, "3 passed");
    static const char *const names[] = { "drag", "metamorphic", "noise-pairs" };
    for (int k = 0; k < 3; k++) {
        char one[PATH_LENGTH], other[PATH_LENGTH];
        snprintf(one, sizeof one, "%s/work/%s/results.json", folder, names[k]);
        snprintf(other, sizeof other, "%s/judged/%s/results.json", folder, names[k]);
        json_t *live = json_load_file(one, 0, NULL), *judged = json_load_file(other, 0, NULL);
        check_true(live && json_equal(json_object_get(live, "results"), json_object_get(judged, "results")), "the same results as those of `gate run`, to the last digit");
        json_decref(live);
        json_decref(judged);
    }
    shell("for e in %s/drag/*/exit; do echo 77 >$e; done; for e in %s/metamorphic/mirror*/exit; do echo 139 >$e; done", there, there);
    expect(gate(arguments), 1, "candidate crashed with signal 11");
    check_true(strstr(said, "1 passed, 1 failed, 1 skipped") != NULL, "what was not supported is skipped, a crash fails");
    snprintf(arguments, sizeof arguments, "judge %s --layer pair", there);
    expect(gate(arguments), 2, "was settled by `gate export`");

    /* Capabilities that stand beside the program are kept like those that are named: judge knows that nothing turns. */
    shell("printf '#!/bin/sh\nexec %s/shear --evaluate \"$@\"\n' >%s/beside", programs, folder);
    shell("chmod +x %s/beside %s", folder, "");
    shell("echo '{\"contract\": \"1.0\", \"physics\": [\"drag\", \"shear\", \"unequal\", \"stress\"]}' >%s/beside.capabilities.json %s", folder, "");
    snprintf(arguments, sizeof arguments, "export %s/plain --candidate %s/beside --case drag,contact-friction", folder, folder);
    expect(gate(arguments), 0, "1 questions in");
    shell("sh %s/plain/run.sh %s/beside >/dev/null", folder, folder);
    snprintf(arguments, sizeof arguments, "judge %s/plain", folder);
    expect(gate(arguments), 0, "1 passed, 0 failed, 1 skipped");
}

/* A check that always finds p = 1e-5 and 0.5 when asked again. */
static int asked;

static void doubtful(struct check_run *run)
{
    json_t *scene = json_pack("{si s{}}", "seed", (int)(run->seed % 1000), "forces");
    const struct state_row row = { .id = 1, .species = 1 };
    const struct question q = { .protocol = "forces", .scene = scene, .state = &row, .states = 1 };
    char out[PATH_LENGTH];
    asked++;
    if (check_ask(run, "first", &q, out) && check_ask(run, "second", &q, out))
        check_p(run, INVARIANT, "p", 1, 1, run->attempt == 1 ? 1e-5 : 0.5, 0.01, 0.05, "doubt");
    json_decref(scene);
}

/* The verdict; the number of questions that wait. */
static enum verdict judge_offline(const char *root, size_t *waiting, char *sentence)
{
    static const struct check check = { "doubtful", doubtful };
    json_t *needs = json_array();
    const struct gate_case one = { .name = "case", .about = "about", .needs = needs, .seed = 7, .p_values = 1 };
    const struct candidate nobody = { .command = "" };
    struct check_run run = { .gate_case = &one, .candidate = &nobody };
    char why[WHY_LENGTH];
    size_t all;
    path_join(run.work, folder, "offline-work");
    folder_remove(run.work);
    folder_make(run.work, why);
    offline_judge(&run, &check, 10, 0, root);
    check_true(offline_list(root, &all, waiting, why), why);
    const enum verdict v = results_verdict(&run.results);
    strcpy(sentence, results_worst(&run.results)->sentence);
    results_free(&run.results);
    json_decref(needs);
    return v;
}

static void a_first_alarm_is_inconclusive(void)
{
    char root[PATH_LENGTH], why[WHY_LENGTH], sentence[4 * WHY_LENGTH];
    size_t waiting;
    path_join(root, folder, "alarm");
    folder_make(root, why);
    check_true(judge_offline(root, &waiting, sentence) == VERDICT_INCONCLUSIVE && waiting == 2, "both questions of the first stage wait");
    check_close(shell("cd %s && sh run.sh sh -c 'echo x >\"$2\"/forces.csv' it >/dev/null%s", root, ""), 0, 0, "run.sh");
    check_true(judge_offline(root, &waiting, sentence) == VERDICT_INCONCLUSIVE && waiting == 2, "p = 1e-5: the second stage is written out, and waits");
    check_close(shell("cd %s && sh run.sh sh -c 'echo x >\"$2\"/forces.csv' it >/dev/null%s", root, ""), 0, 0, "run.sh");
    check_true(judge_offline(root, &waiting, sentence) == VERDICT_PASS && waiting == 0, "p = 0.5 in the second stage settles it");
}

static void first(void)
{
    const ssize_t n = readlink("/proc/self/exe", programs, sizeof programs - 1);
    programs[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(programs, '/'); /* build/unit-tests and build/gate are neighbours */
    if (slash)
        *slash = '\0';
    check_true(mkdtemp(folder) != NULL, "a folder to work in");
}

static void last(void)
{
    check_true(folder_remove(folder), "the folder is removed");
}

static const struct unit_test tests[] = {
    { "work folder", first },
    { "level B", level_b },
    { "level C", level_c },
    { "undeclared physics is skipped", undeclared_physics_is_skipped },
    { "few digits", few_digits },
    { "patience is a factor", patience_is_a_factor },
    { "conventions are named", conventions_are_named },
    { "export, run elsewhere, judge", export_run_judge },
    { "a first alarm is inconclusive", a_first_alarm_is_inconclusive },
    { "work folder removed", last },
    { NULL, NULL },
};

const struct suite levels_suite = { "levels", tests };
