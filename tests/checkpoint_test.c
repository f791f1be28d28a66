/* A run that was split, stopped or killed goes on bit for bit; checkpoints that cannot be trusted are refused. */
#include "suite.h"

#include "scene.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Friction, lubrication, both noises, shear fast enough for a remap, angles turned through, every output. */
static const char scene[] =
    "{ \"about\": \"test\", \"seed\": 7, \"fluid\": { \"viscosity\": 0.1, \"kT\": 0.017 },\n"
    "  \"box\": { \"lengths\": [8.0, 7.0, 9.0], \"periodic\": [true, true, true] },\n"
    "  \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -9.0 } ],\n"
    "  \"species\": [ { \"name\": \"small\", \"radius\": 1.0, \"density\": 0.1 }, { \"name\": \"large\", \"radius\": 1.4, \"density\": 0.1 } ],\n"
    "  \"start\": { \"random\": { \"phi\": 0.45, \"count\": 30, \"volume_shares\": [0.5, 0.5] }, \"thermal\": true, \"time\": 0.057 },\n"
    "  \"forces\": { \"contact\": { \"normal_stiffness\": 1e4, \"tangential_stiffness\": 2857.0, \"friction\": 0.5, \"lever\": \"contact\" },\n"
    "    \"drag\": { \"torque\": true }, \"drag_noise\": { \"distribution\": \"gaussian\" },\n"
    "    \"lubrication\": { \"inner_gap\": 1e-3, \"outer_gap\": 0.05, \"rotation_correction\": \"exact\" },\n"
    "    \"lubrication_noise\": { \"distribution\": \"uniform\" } },\n"
    "  \"dynamics\": { \"verlet\": { \"dt\": 2e-5, \"rotation\": \"auto\" } }, \"run\": { \"steps\": 600 },\n"
    "  \"output\": { \"checkpoint\": { \"every\": 150 }, \"stress\": { \"every\": 7 }, \"states\": { \"every\": 40, \"turn\": true },\n"
    "    \"dump\": { \"every\": 50 }, \"viscosity\": { \"every\": 10 }, \"contacts\": { \"every\": 9 }, \"temperature\": { \"every\": 11 },\n"
    "    \"displacement\": { \"every\": 3, \"levels\": 4 }, \"velocity_correlation\": { \"every\": 2, \"levels\": 3 },\n"
    "    \"pair_distribution\": { \"every\": 20, \"range\": 5, \"bins\": 40, \"near\": { \"gap\": 0.1, \"bins\": 50 },\n"
    "      \"plane\": { \"range\": 3, \"half_width\": 0.6, \"bins\": 20 } },\n"
    "    \"brownian_stress\": { \"every\": 25 }, \"averages\": { \"every\": 5 } } }\n";

static const char *const files[] = { "stress.csv", "trajectory.csv", "dump.lammpstrj", "viscosity.csv", "contacts.csv", "temperature.csv",
                                     "displacement.csv", "velocity_correlation.csv", "pair_distribution.csv", "pair_plane.csv",
                                     "brownian_stress.csv", "averages.csv" };

static char folder[] = "/tmp/shear-checkpoint-XXXXXX", scene_path[64];

static char *in_folder(const char *name)
{
    static char path[4][200];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static void make_folder(void)
{
    if (*scene_path)
        return;
    check_true(mkdtemp(folder) != NULL, "temporary folder");
    snprintf(scene_path, sizeof scene_path, "%s/scene.json", folder);
    FILE *out = fopen(scene_path, "w");
    check_true(out && fputs(scene, out) >= 0 && fclose(out) == 0, "scene");
}

static int run_as(const struct scene_options *options, const char *out, struct error *e)
{
    struct simulation *sim = calloc(1, sizeof *sim);
    memset(e, 0, sizeof *e);
    if (scene_build(scene_path, options, sim, e) && simulation_begin(sim, e)) {
        sim->destination.resuming = options->resume;
        if (destination_make(&sim->destination, out, e))
            simulation_run(sim, e);
    }
    simulation_close(sim, e);
    free(sim);
    return e->code;
}

/* Runs the scene into `out` with one replacement (NULL: none), from the start or from the checkpoint there. */
static int run(const char *set, const char *out, bool resume, struct error *e)
{
    const struct scene_options options = { .set = &set, .set_count = set != NULL, .resume = resume };
    return run_as(&options, out, e);
}

static char *contents(const char *path, size_t *size)
{
    FILE *in = fopen(path, "rb");
    char *text = calloc(1, 4000001);
    *size = in ? fread(text, 1, 4000000, in) : 0;
    if (in)
        fclose(in);
    return text;
}

static void check_same_file(const char *a, const char *b, const char *file, const char *what)
{
    char path[300], text[400];
    size_t size_a, size_b;
    snprintf(path, sizeof path, "%s/%s", a, file);
    char *one = contents(path, &size_a);
    snprintf(path, sizeof path, "%s/%s", b, file);
    char *two = contents(path, &size_b);
    snprintf(text, sizeof text, "%s: %s byte for byte (%zu, %zu bytes)", what, file, size_a, size_b);
    check_true(size_a > 500 && size_a == size_b && memcmp(one, two, size_a) == 0, text);
    free(one);
    free(two);
}

static void check_same(const char *a, const char *b, const char *what)
{
    for (size_t k = 0; k < sizeof files / sizeof *files; k++)
        check_same_file(a, b, files[k], what);
}

/* The undisturbed run, made once. */
static const char *whole(void)
{
    static char path[200];
    struct error e;
    if (!*path) {
        make_folder();
        snprintf(path, sizeof path, "%s", in_folder("whole"));
        check_true(run(NULL, path, false, &e) == 0, e.text);
    }
    return path;
}

static void split_runs_are_the_whole(void)
{
    static const int at[] = { 1, 37, 150, 401, 599 };
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        char set[40], out[40];
        struct error e;
        whole();
        snprintf(set, sizeof set, "run.steps=%d", at[k]);
        snprintf(out, sizeof out, "split-%d", at[k]);
        check_true(run(set, in_folder(out), false, &e) == 0, e.text);
        check_true(run(NULL, in_folder(out), true, &e) == 0, e.text);
        check_same(whole(), in_folder(out), set);
    }
}

/* Also in a cell that has remapped, with lists made anew: the run must have seen them for the test to mean anything. */
static void the_run_has_remaps_and_lists(void)
{
    struct error e = { 0 };
    struct simulation *sim = calloc(1, sizeof *sim);
    make_folder();
    static const char *const none[] = { "output={}" };
    const struct scene_options quiet = { .set = none, .set_count = 1 };
    check_true(scene_build(scene_path, &quiet, sim, &e) && simulation_begin(sim, &e), e.text);
    const int before = sim->suspension.box.lattice[0][1];
    sim->last_step = 600;
    check_true(simulation_run(sim, &e), e.text);
    check_true(sim->suspension.neighbours.made > 5, "several lists");
    check_true(sim->suspension.box.lattice[0][1] != before, "a remap");
    int rubbing = 0;
    for (int k = 0; k < sim->suspension.neighbours.count; k++)
        rubbing += norm(sim->suspension.neighbours.history[k]) > 0.0;
    check_true(rubbing > 3, "frictional contacts");
    simulation_close(sim, &e);
    free(sim);
}

/* A table that was cut short, or emptied, is no table to go on with: refused twice in the same words, and every table stays as it was. */
static void short_tables_are_refused(void)
{
    struct error e;
    whole();
    check_true(run("run.steps=300", in_folder("short"), false, &e) == 0, e.text);
    for (int emptied = 0; emptied < 2; emptied++) {
        char table[200], other[200];
        size_t length, before, after;
        snprintf(table, sizeof table, "%s/short/%s", folder, emptied ? "stress.csv" : "trajectory.csv");
        snprintf(other, sizeof other, "%s/short/viscosity.csv", folder);
        char *text = contents(table, &length), *kept = contents(other, &before);
        check_true(truncate(table, emptied ? 0 : (off_t)length - 60) == 0, "cut short");
        for (int twice = 0; twice < 2; twice++) {
            size_t size;
            check_true(run(NULL, in_folder("short"), true, &e) == ERROR_INPUT && strstr(e.text, "is shorter than the"), e.text);
            free(contents(table, &size));
            check_close((double)size, emptied ? 0 : (double)length - 60, 0, "left as it was");
            char *same = contents(other, &after);
            check_true(before == after && memcmp(same, kept, before) == 0, "another table left as it was");
            free(same);
        }
        FILE *out = fopen(table, "wb");
        check_true(out && fwrite(text, 1, length, out) == length && fclose(out) == 0, "put back");
        free(text);
        free(kept);
    }
    check_true(run(NULL, in_folder("short"), true, &e) == 0, e.text);
    check_same(whole(), in_folder("short"), "after all");
}

/* A tether holds where the run began, whatever has become of the file that said so. */
static void anchors_are_kept(void)
{
    static const char *const set[] = { "start={\"file\":\"start.csv\"}", "shear=[]", "forces={\"tether\":{\"small\":{\"stiffness\":2}}}", "output={\"states\":{\"every\":50},\"checkpoint\":{\"every\":50}}",
                                       "dynamics.verlet.dt=1e-3", "fluid={}", "run.steps=100" };
    const struct scene_options all = { .set = set, .set_count = 6 }, part = { .set = set, .set_count = 7 }, rest = { .set = set, .set_count = 6, .resume = true };
    struct error e;
    make_folder();
    for (int moved = 0; moved < 2; moved++) {
        FILE *out = fopen(in_folder("start.csv"), "w");
        fprintf(out, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,%d,1,1,0.5,0,0,0,0,0\n", moved ? 3 : 1);
        fclose(out);
        if (!moved)
            check_true(run_as(&all, in_folder("held"), &e) == 0 && run_as(&part, in_folder("held-split"), &e) == 0, e.text);
    }
    check_true(run_as(&rest, in_folder("held-split"), &e) == 0, e.text);
    check_same_file(in_folder("held"), in_folder("held-split"), "trajectory.csv", "the start has been moved in between");
}

/* One flow along two gradients, one oscillating, one that jumps: the box's state follows from the time alone. */
static void staged_runs_go_on(void)
{
    static const char *const set[] = {
        "shear=[]", "start.time=0",
        "stages=[{\"duration\":0.005,\"shear\":[{\"flow\":\"x\",\"gradient\":\"y\",\"rate\":-30},{\"flow\":\"x\",\"gradient\":\"z\","
        "\"rate\":{\"mean\":5,\"amplitude\":20,\"angular_frequency\":700,\"phase\":0.4}}]},"
        "{\"strain\":0.4,\"shear\":[{\"flow\":\"x\",\"gradient\":\"y\",\"rate\":30}]}]",
        "run.steps=210" };
    struct error e;
    const struct scene_options first = { .set = set, .set_count = 3 }, part = { .set = set, .set_count = 4 };
    const struct scene_options rest = { .set = set, .set_count = 3, .resume = true };
    make_folder();
    check_true(run_as(&first, in_folder("staged"), &e) == 0, e.text);
    check_true(run_as(&part, in_folder("staged-split"), &e) == 0 && run_as(&rest, in_folder("staged-split"), &e) == 0, e.text);
    check_same(in_folder("staged"), in_folder("staged-split"), "stages");
}

/* At rest there is one more observer; the split comes in its correlation's middle, where every ring buffer is partly filled. */
static void runs_at_rest_go_on(void)
{
    static const char *const set[] = { "shear=[]", "output.green_kubo={\"every\":3,\"levels\":4}", "run.steps=307" };
    struct error e;
    const struct scene_options first = { .set = set, .set_count = 2 }, part = { .set = set, .set_count = 3 };
    const struct scene_options rest = { .set = set, .set_count = 2, .resume = true };
    make_folder();
    check_true(run_as(&first, in_folder("at-rest"), &e) == 0, e.text);
    check_true(run_as(&part, in_folder("at-rest-split"), &e) == 0 && run_as(&rest, in_folder("at-rest-split"), &e) == 0, e.text);
    check_same(in_folder("at-rest"), in_folder("at-rest-split"), "at rest");
    check_same_file(in_folder("at-rest"), in_folder("at-rest-split"), "green_kubo.csv", "at rest");
}

static void other_integrators_go_on(void)
{
    static const char *const dynamics[] = { "dynamics={\"split\":{\"dt\":2e-5}}", "dynamics={\"split\":{\"dt\":2e-5,\"friction\":\"sweeps\"}}",
                                            "dynamics={\"predicted_verlet\":{\"dt\":2e-5}}" };
    char whole[40], halves[40];
    struct error e;
    make_folder();
    for (int k = 0; k < 3; k++) {
        const char *const set[] = { dynamics[k], "run.steps=300" }, *const cut[] = { dynamics[k], "run.steps=157" };
        const struct scene_options all = { .set = set, .set_count = 2 }, part = { .set = cut, .set_count = 2 };
        const struct scene_options rest = { .set = set, .set_count = 2, .resume = true };
        snprintf(whole, sizeof whole, "dynamics-%d", k);
        snprintf(halves, sizeof halves, "dynamics-%d-split", k);
        check_true(run_as(&all, in_folder(whole), &e) == 0, e.text);
        check_true(run_as(&part, in_folder(halves), &e) == 0 && run_as(&rest, in_folder(halves), &e) == 0, e.text);
        check_same(in_folder(whole), in_folder(halves), dynamics[k]);
    }
}

/* Without forces between pairs particles are put back into the cell every hundredth step only; a checkpoint just before must not do it. */
static void runs_without_pairs_go_on(void)
{
    static const char *const set[] = { "forces={\"drag\":{\"torque\":true},\"drag_noise\":{\"distribution\":\"gaussian\"}}",
                                       "dynamics={\"verlet\":{\"dt\":2e-2}}", "output={\"checkpoint\":{\"every\":1000},\"states\":{\"every\":5}}", "shear=[]", "fluid.kT=5", "run.steps=200" };
    const char *cut[] = { set[0], set[1], set[2], set[3], set[4], "run.steps=98" };
    struct error e;
    const struct scene_options all = { .set = set, .set_count = 6 }, part = { .set = cut, .set_count = 6 }, rest = { .set = set, .set_count = 6, .resume = true };
    make_folder();
    check_true(run_as(&all, in_folder("alone"), &e) == 0, e.text);
    check_true(run_as(&part, in_folder("alone-split"), &e) == 0 && run_as(&rest, in_folder("alone-split"), &e) == 0, e.text);
    check_same_file(in_folder("alone"), in_folder("alone-split"), "trajectory.csv", "without pairs");
}

static void interrupted_runs_go_on(void)
{
    struct error e;
    whole();
    checkpoint_watch();
    raise(SIGTERM);
    check_true(run(NULL, in_folder("stopped"), false, &e) == ERROR_INTERRUPTED && strstr(e.text, "after step 1"), e.text);
    checkpoint_watch();
    raise(SIGINT);
    check_true(run(NULL, in_folder("stopped"), true, &e) == ERROR_INTERRUPTED && strstr(e.text, "after step 2"), e.text);
    check_true(run(NULL, in_folder("stopped"), true, &e) == 0, e.text);
    check_same(whole(), in_folder("stopped"), "stopped twice");
}

static void wait_for(long microseconds)
{
    nanosleep(&(struct timespec){ .tv_nsec = 1000 * microseconds }, NULL);
}

/* Killed at any moment, while tables grow and checkpoints are written: the last one stands, and the run goes on from it. */
static void killed_runs_go_on(void)
{
    whole();
    for (int round = 0; round < 4; round++) {
        struct error e;
        char out[40];
        snprintf(out, sizeof out, "killed-%d", round);
        fflush(stdout);
        const pid_t child = fork();
        if (child == 0) {
            run("output.checkpoint.every=1", in_folder(out), false, &e);
            _exit(0);
        }
        char path[300];
        snprintf(path, sizeof path, "%s/checkpoint.bin", in_folder(out));
        for (int k = 0; k < 2000 && access(path, R_OK) != 0; k++)
            wait_for(1000);
        wait_for(3000 + 17001 * round);
        kill(child, SIGKILL);
        waitpid(child, NULL, 0);
        check_true(run(NULL, in_folder(out), true, &e) == 0, e.text);
        check_same(whole(), in_folder(out), out);
    }
}

static void refuse(const char *bytes, size_t size, const char *set, const char *expected)
{
    struct error e;
    size_t before, after;
    FILE *out = fopen(in_folder("split-37/checkpoint.bin"), "wb");
    check_true(out && fwrite(bytes, 1, size, out) == size && fclose(out) == 0, "written");
    char *table = contents(in_folder("split-37/stress.csv"), &before);
    char *later;
    check_true(run(set, in_folder("split-37"), true, &e) != 0 && strstr(e.text, expected), e.text);
    later = contents(in_folder("split-37/stress.csv"), &after);
    check_true(before == after && memcmp(table, later, before) == 0, "a refused checkpoint leaves the tables alone");
    free(table);
    free(later);
}

static void doubtful_checkpoints_are_refused(void)
{
    struct error e;
    size_t size;
    whole();
    check_true(run("run.steps=37", in_folder("split-37"), false, &e) == 0, e.text);
    char *good = contents(in_folder("split-37/checkpoint.bin"), &size);
    refuse(good, size, "fluid.kT=0.018", "belongs to another scene");
    refuse(good, size / 2, NULL, "damaged or cut short");
    refuse(good, size - 1, NULL, "damaged or cut short");
    refuse(good, 20, NULL, "cut short");
    refuse(good, 3, NULL, "no checkpoint of shear");
    for (size_t at = 40; at < size; at += 997) {                    /* one flipped bit anywhere */
        good[at] ^= 4;
        refuse(good, size, NULL, "damaged or cut short");
        good[at] ^= 4;
    }
    good[16] ^= 2;
    refuse(good, size, NULL, "has format version 3");
    good[16] ^= 2;
    char swapped = good[20];
    good[20] = good[23], good[23] = swapped;
    refuse(good, size, NULL, "other byte order");
    check_true(run(NULL, in_folder("nothing"), true, &e) == ERROR_INPUT && strstr(e.text, "nothing to resume"), e.text);
    free(good);

    check_true(run("run.steps=37", in_folder("split-37"), false, &e) == 0, e.text);
    check_true(truncate(in_folder("split-37/stress.csv"), 100) == 0, "table cut");
    check_true(run(NULL, in_folder("split-37"), true, &e) == ERROR_INPUT && strstr(e.text, "is shorter than"), e.text);
    mkdir(in_folder("blocked"), 0777);
    mkdir(in_folder("blocked/checkpoint.bin"), 0777);
    check_true(run(NULL, in_folder("blocked"), false, &e) == ERROR_RUN && strstr(e.text, "no plain file"), e.text);
}

static const struct unit_test tests[] = {
    { "the run has remaps, lists and frictional contacts", the_run_has_remaps_and_lists },
    { "a run split in two is the whole run", split_runs_are_the_whole },
    { "short tables are refused", short_tables_are_refused },
    { "anchors are kept", anchors_are_kept },
    { "a run in stages goes on", staged_runs_go_on },
    { "a run at rest goes on", runs_at_rest_go_on },
    { "runs of the other integrators go on", other_integrators_go_on },
    { "a run without pairs goes on", runs_without_pairs_go_on },
    { "interrupted runs go on", interrupted_runs_go_on },
    { "killed runs go on", killed_runs_go_on },
    { "doubtful checkpoints are refused", doubtful_checkpoints_are_refused },
    { NULL, NULL }
};
const struct suite checkpoint_suite = { "checkpoint", tests };
