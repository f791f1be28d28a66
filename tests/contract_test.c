/*
 * The contract of docs/adapter.md: capabilities and what they rule out, questions and answers in plain text, what is said of answers that are no answers,
 * one start for all questions.
 */
#include "level_b.h"
#include "plain.h"
#include "precision.h"
#include "suite.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static char folder[] = "/tmp/gate-contract-XXXXXX";

static const char *written(const char *name, const char *content)
{
    static char path[PATH_LENGTH];
    path_join(path, folder, name);
    FILE *file = fopen(path, "w");
    fputs(content, file);
    fclose(file);
    return path;
}

static char *content_of(const char *name)
{
    static char text[65536];
    char path[PATH_LENGTH];
    path_join(path, folder, name);
    FILE *file = fopen(path, "r");
    text[0] = '\0';
    if (file) {
        text[fread(text, 1, sizeof text - 1, file)] = '\0';
        fclose(file);
    }
    return text;
}

/* --- capabilities --- */

static void refused(const char *content, const char *complaint)
{
    struct capabilities c;
    char why[WHY_LENGTH] = "accepted";
    const bool accepted = capabilities_read(written("c.json", content), &c, why);
    check_true(!accepted && strstr(why, complaint) != NULL, why);
    if (accepted)
        capabilities_free(&c);
}

static void wrong_capabilities_are_named(void)
{
    refused("[]", "must be a JSON object");
    refused("{\"contract\": \"1.0\",}", "c.json:1:");
    refused("{\"level\": \"A\"}", "\"contract\" must be \"1.0\"");
    refused("{\"contract\": \"0.9\"}", "\"contract\" must be \"1.0\"");
    refused("{\"contract\": \"1.0\", \"levle\": \"A\"}", "unknown key \"levle\"; did you mean \"level\"?");
    refused("{\"contract\": \"1.0\", \"level\": \"D\"}", "level: \"D\" is not known");
    refused("{\"contract\": \"1.0\", \"physics\": [\"lubricaton\"]}", "\"lubricaton\" is not known; did you mean \"lubrication\"?");
    refused("{\"contract\": \"1.0\", \"physics\": \"drag\"}", "physics must be a list");
    refused("{\"contract\": \"1.0\", \"precision\": \"half\"}", "precision: \"half\" is not known");
    refused("{\"contract\": \"1.0\", \"precision\": {\"digits\": 2}}", "n from 3 to 17");
    refused("{\"contract\": \"1.0\", \"run_all\": 1}", "run_all must be true or false");
    refused("{\"contract\": \"1.0\", \"model\": {\"levre\": \"radius\"}}", "model: unknown key \"levre\"; did you mean \"lever\"?");
    refused("{\"contract\": \"1.0\", \"model\": {\"lever\": \"radii\"}}", "lever: \"radii\" is not known; did you mean \"radius\"?");
}

static void capabilities_rule_out_questions(void)
{
    struct capabilities c;
    char why[WHY_LENGTH] = "";
    const char *file = written("c.json", "{\"contract\": \"1.0\", \"name\": \"x\", \"level\": \"B\", \"precision\": \"float\", \"physics\": [\"contact\", \"drag\", "
                                         "\"shear\"], \"model\": {\"lever\": \"contact\", \"integrator\": \"euler\"}}");
    check_true(capabilities_read(file, &c, why), why);
    check_true(c.level == LEVEL_B && c.integrator == INTEGRATOR_EULER && c.given && strcmp(c.precision, "float") == 0, "what was declared");
    check_close(c.roundoff, 5.96e-8, 1e-10, "roundoff of a float");
    json_t *scene = json_pack("{s[{sf}] s{s{sf}s{sb}}}", "species", "radius", 1.0, "forces", "contact", "normal_stiffness", 1.0, "drag", "torque", 0);
    check_true(!capabilities_lack(&c, "forces", scene, false, why), why);
    check_true(capabilities_lack(&c, "forces", scene, true, why) && strstr(why, "\"histories\""), why);
    scene_set(scene, "forces.contact.friction", json_real(0.5));
    check_true(capabilities_lack(&c, "forces", scene, false, why) && strstr(why, "\"friction\""), why);
    scene_set(scene, "forces.contact.friction", json_real(0));
    json_array_append_new(scene_get(scene, "species"), json_pack("{sf}", "radius", 2.0));
    check_true(capabilities_lack(&c, "forces", scene, false, why) && strstr(why, "\"unequal\""), why);
    json_array_remove(scene_get(scene, "species"), 1);
    scene_set(scene, "forces.lubrication", json_object());
    check_true(capabilities_lack(&c, "forces", scene, false, why) && strstr(why, "\"lubrication\""), why);
    json_object_del(scene_get(scene, "forces"), "lubrication");
    scene_set(scene, "forces.contact.lever", json_string("radius"));
    check_true(capabilities_lack(&c, "forces", scene, false, why) && strstr(why, "declares \"contact\""), why);
    capabilities_into_scene(&c, scene);
    check_true(!capabilities_lack(&c, "forces", scene, false, why), "the declared lever is put into the scene");
    json_decref(scene);
    capabilities_free(&c);
}

static void capabilities_stand_beside_the_program(void)
{
    char program[PATH_LENGTH], command[2 * PATH_LENGTH], found[PATH_LENGTH], why[WHY_LENGTH];
    struct capabilities c;
    snprintf(program, sizeof program, "%s", written("adapter.py", "#\n"));
    snprintf(command, sizeof command, "python3 %s --fast", program);
    check_true(!capabilities_beside(command, found), "there is none yet");
    written("adapter.py.capabilities.json", "{\"contract\": \"1.0\", \"level\": \"B\"}");
    check_true(capabilities_beside(command, found) && strstr(found, "adapter.py.capabilities.json"), "beside the script, not beside python3");
    check_true(capabilities_choose(NULL, command, "C", &c, why) && c.level == LEVEL_C, "a level below the declared one may be asked");
    check_true(!capabilities_choose(NULL, command, "A", &c, why) && strstr(why, "declares level B"), why);
    check_true(capabilities_choose(NULL, "true", NULL, &c, why) && c.level == LEVEL_A && !c.given, "without a file: everything");
}

/* --- plain text --- */

static void a_question_in_plain_text(void)
{
    char why[WHY_LENGTH];
    json_t *scene = json_loads("{\"about\": \"a / slash\", \"fluid\": {\"viscosity\": 0.7}, \"box\": {\"lengths\": [7, 9, 8.5], \"periodic\": [true, true, false]}, "
                               "\"shear\": [{\"flow\": \"x\", \"gradient\": \"y\", \"rate\": -0.5}], \"start\": {\"time\": 2}, "
                               "\"forces\": {\"drag_noise\": {}, \"drag\": {\"torque\": true}}}", 0, NULL);
    json_t *question = json_pack("{sssi}", "protocol", "noise", "draws", 20);
    const struct state_row row = { .state = 0, .id = 1, .species = 2, .x = { 1.5, 2, -3 }, .u = { 0, 0.1, 0 } };
    const struct contact_row contact = { .state = 0, .i = 1, .j = 2, .s = { 0.25, 0, 0 } };
    check_true(plain_write_case(folder, question, scene, why) && plain_write_states(folder, &row, 1, why) && plain_write_contacts(folder, &contact, 1, why), why);
    const char *text = content_of("case.txt");
    static const char *const lines[] = { "case.protocol noise\n", "case.draws 20\n", "scene.about \"a / slash\"\n", "scene.box.lengths.count 3\n",
                                         "scene.box.lengths.3 8.5\n", "scene.box.periodic.3 false\n", "scene.shear.1.rate -0.5\n", "forces.count 2\n",
                                         "forces.1 drag\n", "forces.2 drag_noise\n", "cell.2.1 -9\n", "gradient.1.2 -0.5\n", "volume 535.5\n" };
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++)
        check_true(strstr(text, lines[k]) != NULL, lines[k]);
    check_true(strcmp(content_of("states.txt"), "1\n0 1 2 1.5 2 -3 0 0.10000000000000001 0 0 0 0\n") == 0, content_of("states.txt"));
    check_true(strcmp(content_of("contacts.txt"), "1\n0 1 2 0.25 0 0\n") == 0, content_of("contacts.txt"));
    json_decref(scene);
    json_decref(question);
}

static bool made(const char *name, const char *content, const char *protocol, char why[WHY_LENGTH])
{
    static const char *const results[] = { "forces.csv", "stress.csv", "trajectory.csv", "noise_drag_noise.npy" };
    const struct plain_shape shape = { .protocol = protocol, .particles = 2 };
    char path[PATH_LENGTH];
    for (int k = 0; k < 4; k++) {
        path_join(path, folder, results[k]);
        remove(path);
    }
    snprintf(path, sizeof path, "%s", written(name, content));
    const bool good = plain_answers(folder, &shape, why);
    remove(path);
    return good;
}

static void answers_in_plain_text(void)
{
    char why[WHY_LENGTH] = "", path[PATH_LENGTH];
    struct forces f;
    check_true(made("forces.txt", "# as Fortran may write it\n 0 drag 1 1.5D-03 0.0 1.5-103\n   3*1.0d0\n 0 'drag' 2 -1.0 0 0 0 0 0 # two\n", "forces", why), why);
    path_join(path, folder, "forces.csv");
    check_true(forces_read(path, 1, 2, "drag", &f, why), why);
    check_true(forces_at(&f, 0, "drag", 1)[0] == 1.5e-3 && forces_at(&f, 0, "drag", 1)[2] == 1.5e-103 && forces_at(&f, 0, "drag", 1)[5] == 1 && forces_at(&f, 0, "drag", 2)[0] == -1, "numbers");
    forces_free(&f);
    check_true(!made("forces.txt", "0 drag 1 1 2 3 4 5 6\n0 drag 2 1 2 3", "forces", why) && strstr(why, "forces.txt:2: the last row has 6 values; rows have 9"), why);
    check_true(!made("forces.txt", "0 drag 1 1 2 ***** 4 5 6\n", "forces", why) && strstr(why, "forces.txt:1: column 'fz' holds '*****'"), why);
    check_true(!made("forces.txt", "0 drag 1 1 2 NaN 4 5 6\n", "forces", why) && strstr(why, "'NaN', not a finite number"), why);

    double *value;
    check_true(made("stress.txt", "0 drag 1 2 3 4 5 6 7 8 9\n0 kinetic 9*0\n1 drag 9*2\n1 kinetic 9*1\n", "forces", why), why);
    path_join(path, folder, "stress.csv");
    check_true(stress_read(path, 2, "drag", &value, why) && value[1] == 2 && value[9] == 2, why);
    free(value);
    check_true(!made("stress.txt", "0 drag 9*1\n0 kinetic 9*0\n1 drag 9*2\n", "forces", why) && strstr(why, "no row for state 1, origin 'kinetic'"), why);
    check_true(!made("stress.txt", "0 drag 9*1\n0 drag 9*0\n", "forces", why) && strstr(why, "two rows"), why);
    check_true(made("stress.txt", "0 0. 0. drag 9*1\n10 0.1 0.05 drag 9*3\n", "run", why), why);
    check_true(table_has(path, "strain") && table_has(path, "drag_zz"), "a table of a run");

    size_t shape[3] = { 0, 2, 6 };
    check_true(made("noise_drag_noise.txt", "1 2 3 4 5 6  7 8 9 10 11 12\n12*0.5\n", "noise", why), why);
    path_join(path, folder, "noise_drag_noise.npy");
    check_true(npy_read(path, 3, shape, &value, why) && shape[0] == 2 && value[11] == 12 && value[12] == 0.5, why);
    free(value);
    check_true(!made("noise_drag_noise.txt", "1 2 3 4 5 6 7\n", "noise", why) && strstr(why, "holds 7 numbers, no multiple of 6 for each of 2 particles"), why);
    check_true(made("trajectory.txt", "0 0 1 0 0 0 0 0 0 0 0 0 1\n", "run", why), why);
    path_join(path, folder, "trajectory.csv");
    check_true(table_has(path, "species") && !table_has(path, "turn_x"), "a trajectory");
}

/* --- what is no answer --- */

static const struct state_row two[] = { { .state = 0, .id = 1, .species = 1 }, { .state = 0, .id = 2, .species = 1, .x = { 3, 0, 0 } } };

/* What the gate says where a candidate does this; the question is for `forces` of two particles. */
static const char *said_of(const char *script)
{
    static char sentence[3 * WHY_LENGTH];
    json_t *needs = json_array(), *scene = json_object();
    const struct gate_case one = { .name = "case", .about = "about", .needs = needs };
    char command[2048], out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH] = "";
    snprintf(command, sizeof command, "sh -c '%s' it", script);
    const struct candidate c = { .command = command, .seconds = strncmp(script, "sleep", 5) == 0 ? 0.5 : 30, .bytes = 1 << 20 };    /* machines are busy */
    struct check_run run = { .gate_case = &one, .candidate = &c, .attempt = 1 };
    path_join(run.work, folder, "asked");
    folder_remove(run.work);
    const struct question q = { .protocol = "forces", .scene = scene, .state = two, .states = 2 };
    struct forces f;
    snprintf(sentence, sizeof sentence, "nothing");
    if (check_ask(&run, "pair", &q, out)) {
        path_join(path, out, "forces.csv");
        if (!forces_read(path, 1, 2, "drag", &f, why))
            snprintf(sentence, sizeof sentence, "%s", why);
        else
            forces_free(&f);
    } else
        snprintf(sentence, sizeof sentence, "%s", run.results.item[0].sentence);
    results_free(&run.results);
    json_decref(scene);
    json_decref(needs);
    return sentence;
}

static void says(const char *script, const char *expected)
{
    const char *sentence = said_of(script);
    check_true(strstr(sentence, expected) != NULL, sentence);
}

#define HEADER "echo state,force,id,fx,fy,fz,tx,ty,tz >\"$2\"/forces.csv; "
#define ROW1 "echo 0,drag,1,1,2,3,4,5,6 >>\"$2\"/forces.csv; "
#define ROW2 "echo 0,drag,2,1,2,3,4,5,6 >>\"$2\"/forces.csv; "

static void what_is_missing_is_said(void)
{
    says("exit 0", "forces.csv (or forces.txt) is missing; the output folder is empty");
    says("echo >\"$2\"/force.dat", "forces.csv (or forces.txt) is missing; the output folder holds only force.dat");
    says(HEADER ROW1 ROW2, "nothing");
    says(": >\"$2\"/forces.csv", "is empty: no header line");
    says("echo state,force,id,fx,fy >\"$2\"/forces.csv", ":1: column 'fz' is missing from the header");
    says(HEADER ROW1, "no row for state 0, force 'drag', id 2");
    says(HEADER "echo 0,contact,1,1,2,3,4,5,6 >>\"$2\"/forces.csv", "no rows for force 'drag'");
    says(HEADER ROW1 ROW1, "state 0, force 'drag', id 1 has two rows");
    says(HEADER ROW1 "echo 0,drag,3,1,2,3,4,5,6 >>\"$2\"/forces.csv", "state 0 has no particle with id 3; ids run from 1 to 2");
    says(HEADER ROW1 "echo 1,drag,2,1,2,3,4,5,6 >>\"$2\"/forces.csv", "state 1 does not exist; states run from 0 to 0");
    says(HEADER ROW1 "echo 0,drag,2,1,2,nan,4,5,6 >>\"$2\"/forces.csv", ":3: column 'fz' holds 'nan', not a finite number");
    says(HEADER ROW1 "echo 0,drag,2,1,2,abc,4,5,6 >>\"$2\"/forces.csv", ":3: column 'fz' holds 'abc', not a finite number");
    says(HEADER ROW1 "echo 0,drag,2,1,2 >>\"$2\"/forces.csv", ":3: fewer columns than the header, which has 9");
    says("head -c 100 /dev/zero >\"$2\"/forces.csv", "is not a text file");
    says("echo 0 drag 1 1 2 3 4 5 6 0 drag 2 6*0. >\"$2\"/forces.txt", "nothing");
    says("echo 0 drag 1 1 2 3 4 5 >\"$2\"/forces.txt", "the last row has 8 values; rows have 9");
}

static void misbehaviour_is_a_verdict(void)
{
    says("sleep 9", "candidate hung: it was killed after 0.5 s");
    says("kill -SEGV $$", "candidate crashed with signal 11");
    says("echo no input >&2; exit 4", "candidate ended with exit code 4: no input");
    says("for k in 1 2 3; do head -c 700000 /dev/zero >\"$2\"/$k; done; sleep 9", "candidate wrote more than 1 MB");
    says("head -c 3000000 /dev/urandom; sleep 3", "candidate wrote more than 1 MB");
    says("head -c 100000 /dev/urandom; " HEADER ROW1 ROW2, "nothing");     /* garbage on stdout alone harms nobody */
    says("echo I have no torque; exit 77", "does not support this (exit code 77): I have no torque");
    json_t *needs = json_array(), *scene = json_object();
    const struct gate_case one = { .name = "case", .about = "about", .needs = needs };
    const struct candidate c = { .command = written("not-executable", "x"), .seconds = 30, .bytes = 1 << 20 };
    struct check_run run = { .gate_case = &one, .candidate = &c, .attempt = 1 };
    char out[PATH_LENGTH], hex[17];
    path_join(run.work, folder, "asked-once");
    const struct question q = { .protocol = "forces", .scene = scene, .state = two, .states = 2 };
    check_true(!candidate_hash(&c, hex), "a file that cannot be executed is no program");
    check_true(!check_ask(&run, "pair", &q, out) && run.results.count == 1, "it gives no answer");
    check_true(strstr(run.results.item[0].sentence, "exit code 126") != NULL, run.results.item[0].sentence);
    check_true(!check_ask(&run, "pair", &q, out) && run.results.count == 2 && strstr(run.results.item[1].sentence, "two questions are called pair"),
               "a second question by the same name, whose answer would be mixed with the first one's, is refused");
    results_free(&run.results);
    json_decref(scene);
    json_decref(needs);
}

/* --- run-all --- */

static const char server_script[] =
    "#!/bin/sh\n"
    "[ \"$1\" = run-all ] || exit 3\n"
    "echo started >>\"$0.starts\"\n"
    "while IFS=\"$(printf '\\t')\" read -r question answer; do\n"
    "    case $(cat \"$question/mode\") in\n"
    "    answer) echo talk to the log; echo done >\"$answer/file\"; echo 0 ;;\n"
    "    skip) echo the reason >&2; echo 77 ;;\n"
    "    fail) echo 5 ;;\n"
    "    crash) kill -SEGV $$ ;;\n"
    "    hang) sleep 30 ;;\n"
    "    end) exit 0 ;;\n"
    "    flood) yes nonsense ;;\n"
    "    disk) head -c 3000000 /dev/zero >\"$answer/1\"; head -c 3000000 /dev/zero >\"$answer/2\"; echo 0 ;;\n"
    "    esac\n"
    "done\n";

static enum candidate_outcome ask_server(const struct candidate *c, const char *mode, struct candidate_answer *a)
{
    char question[PATH_LENGTH], answer[PATH_LENGTH], why[WHY_LENGTH];
    path_join(question, folder, "q");
    path_join(answer, folder, "a");
    folder_remove(answer);
    folder_make(question, why);
    folder_make(answer, why);
    written("q/mode", mode);
    candidate_run(c, question, answer, a);
    return a->outcome;
}

static int starts(void)
{
    int lines = 0;
    for (const char *at = content_of("server.starts"); *at; at++)
        lines += *at == '\n';
    return lines;
}

static void one_start_serves_all(void)
{
    char program[PATH_LENGTH], log[PATH_LENGTH];
    snprintf(program, sizeof program, "%s", written("server", server_script));
    chmod(program, 0755);
    path_join(log, folder, "server.log");
    struct candidate_server server;
    const struct candidate c = { .command = program, .seconds = 60, .bytes = 1 << 20, .server = &server };
    struct candidate hasty = c;
    hasty.seconds = 2;
    struct candidate_answer a;
    candidate_server_start(&server, &c, log);
    check_true(ask_server(&c, "answer", &a) == CANDIDATE_OK && strcmp(content_of("a/file"), "done\n") == 0, a.message);
    check_true(strstr(a.said, "talk to the log") != NULL, "what is no number is for the log");
    check_true(ask_server(&c, "skip", &a) == CANDIDATE_UNSUPPORTED && strstr(a.message, "the reason"), a.message);
    check_true(ask_server(&c, "fail", &a) == CANDIDATE_FAILED && a.detail == 5, a.message);
    check_close(starts(), 1, 0, "one start so far");
    check_true(ask_server(&c, "crash", &a) == CANDIDATE_CRASHED && a.detail == SIGSEGV, a.message);
    check_true(ask_server(&c, "answer", &a) == CANDIDATE_OK, a.message);
    check_close(starts(), 2, 0, "started anew after a crash");
    check_true(ask_server(&hasty, "hang", &a) == CANDIDATE_HUNG && a.seconds < 20, a.message);
    check_true(ask_server(&c, "end", &a) == CANDIDATE_FAILED && strstr(a.message, "ended before it answered"), a.message);
    check_true(ask_server(&c, "flood", &a) == CANDIDATE_FLOODED, a.message);
    check_true(ask_server(&c, "answer", &a) == CANDIDATE_OK, a.message);
    check_close(starts(), 5, 0, "and after every other end");
    check_true(ask_server(&c, "disk", &a) != CANDIDATE_CRASHED, a.message);
    candidate_server_stop(&server);
    const struct candidate lost = { .command = "/no/such/program", .seconds = 30, .bytes = 1 << 20, .server = &server };
    candidate_server_start(&server, &lost, log);
    check_true(ask_server(&lost, "answer", &a) == CANDIDATE_FAILED && a.detail == 127, a.message);
    candidate_server_stop(&server);
}

/* --- precision, level B --- */

static void precision_widens_by_the_condition(void)
{
    json_t *scene = json_loads("{\"box\": {\"lengths\": [10, 10, 10], \"periodic\": [true, true, true]}, \"species\": [{\"radius\": 1.0}], \"dynamics\": "
                               "{\"verlet\": {\"dt\": 0.1}}, \"forces\": {\"lubrication\": {\"inner_gap\": 1e-4, \"outer_gap\": 0.1}}}", 0, NULL);
    struct state_row row[] = { { .id = 1, .species = 1 }, { .id = 2, .species = 1, .x = { -7.99, 0, 0 } } };     /* a gap of 0.01, through the face */
    check_close(question_condition(scene, row, 2), 8.99 / 0.01, 1e-9, "(|x| + a)/h of the nearest image");
    row[1].x[0] = -7;
    check_close(question_condition(scene, row, 2), 1, 0, "nobody within reach");
    row[1].x[0] = 2;
    check_close(question_condition(scene, row, 2), 3 / 1e-4, 1e-6, "the inner gap ends it");
    const struct capabilities digits = { .roundoff = 5e-7, .precision = "7 digits" };
    const struct candidate c = { .capabilities = &digits };
    struct check_run run = { .candidate = &c };
    row[1].x[0] = 2.01;
    const struct question q = { .protocol = "forces", .scene = scene, .state = row, .states = 2 };
    precision_allow(&run, &q);
    check_relative(run.allowance, 4 * 301 * 5e-7, 1e-9, "4 C eps");
    check_true(check_error(&run, MODEL, "a", 1, 1, 5e-4, 1e-10, "-")->verdict == VERDICT_PASS, "within it");
    check_true(check_error(&run, MODEL, "b", 1, 1, 7e-4, 1e-10, "-")->verdict == VERDICT_FAIL, "beyond it");
    check_true(check_error(&run, MODEL, "c", 1, 1, NAN, 1e-10, "-")->verdict == VERDICT_FAIL, "no number");
    run.allowance = 0.2;
    check_true(check_error(&run, MODEL, "d", 1, 1, 0.005, 1e-10, "-")->verdict == VERDICT_PASS, "never more than one per cent");
    check_true(check_error(&run, MODEL, "e", 1, 1, 0.05, 1e-10, "-")->verdict == VERDICT_SKIP, "in between nothing can be said");
    check_true(check_error(&run, MODEL, "f", 1, 1, 0.5, 1e-10, "-")->verdict == VERDICT_FAIL, "but this is wrong at any precision");
    results_free(&run.results);
    json_decref(scene);
}

static void steps_are_read_whole(void)
{
    char why[WHY_LENGTH] = "";
    double(*v)[6];
    const struct question q = { .steps = 1, .state = two, .states = 2 };
    const char *header = "state,step,id,ux,uy,uz,wx,wy,wz\n", *rows = "0,0,1,0,0,0,0,0,0\n0,0,2,0,0,0,0,0,0\n0,1,1,1,2,3,4,5,6\n";
    char text[1000];
    snprintf(text, sizeof text, "%s%s0,1,2,0,0,0,0,0,7\n0,2,2,9,9,9,9,9,9\n", header, rows);
    written("trajectory.csv", text);
    char path[PATH_LENGTH];
    path_join(path, folder, "velocities.npy");
    remove(path);
    check_true(steps_read(folder, &q, 1, 2, &v, why), why);
    check_true(v[2][4] == 5 && v[3][5] == 7, "numbers; further steps are ignored");
    check_true(steps_start(folder, &q, 1, 2, (const double(*)[6])v, 0, why), why);
    v[1][2] = 1e-3;
    check_true(!steps_start(folder, &q, 1, 2, (const double(*)[6])v, 0, why) && strstr(why, "state 0, step 0, id 2 does not have the velocity"), why);
    check_true(strstr(why, "too few digits") != NULL, "and why that may be");
    free(v);
    snprintf(text, sizeof text, "%s%s", header, rows);
    written("trajectory.csv", text);
    check_true(!steps_read(folder, &q, 1, 2, &v, why) && strstr(why, "no row for state 0, step 1, id 2"), why);
    snprintf(text, sizeof text, "%s%s0,1,3,0,0,0,0,0,7\n", header, rows);
    written("trajectory.csv", text);
    check_true(!steps_read(folder, &q, 1, 2, &v, why) && strstr(why, "a particle with id 3; ids run from 1 to 2"), why);
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
    { "wrong capabilities are named", wrong_capabilities_are_named },
    { "capabilities rule out questions", capabilities_rule_out_questions },
    { "capabilities stand beside the program", capabilities_stand_beside_the_program },
    { "a question in plain text", a_question_in_plain_text },
    { "answers in plain text", answers_in_plain_text },
    { "what is missing is said", what_is_missing_is_said },
    { "misbehaviour is a verdict", misbehaviour_is_a_verdict },
    { "one start serves all (run-all)", one_start_serves_all },
    { "precision widens by the condition", precision_widens_by_the_condition },
    { "steps are read whole", steps_are_read_whole },
    { "work folder removed", last },
    { NULL, NULL },
};

const struct suite contract_suite = { "contract", tests };
