/* Scenes: what is refused and how, how a crowd starts, what a run writes, and that looking changes nothing. */
#include "suite.h"

#include "describe.h"
#include "evaluate.h"
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char base[] =
    "{ \"about\": \"test\", \"seed\": 7, \"fluid\": { \"viscosity\": 0.1, \"kT\": 0.017 },\n"
    "  \"box\": { \"lengths\": [12.0, 11.0, 13.0], \"periodic\": [true, true, true] },\n"
    "  \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -0.9 } ],\n"
    "  \"species\": [ { \"name\": \"small\", \"radius\": 1.0, \"density\": 0.1 }, { \"name\": \"large\", \"radius\": 1.4, \"density\": 0.1 } ],\n"
    "  \"start\": { \"random\": { \"phi\": 0.45, \"count\": 60, \"volume_shares\": [0.5, 0.5] }, \"thermal\": true },\n"
    "  \"forces\": { \"contact\": { \"normal_stiffness\": 1e4, \"tangential_stiffness\": 2857.0, \"friction\": 0.5, \"lever\": \"contact\" },\n"
    "    \"drag\": { \"torque\": true }, \"drag_noise\": { \"distribution\": \"gaussian\" },\n"
    "    \"lubrication\": { \"inner_gap\": 1e-3, \"outer_gap\": 0.05, \"rotation_correction\": \"exact\" },\n"
    "    \"lubrication_noise\": { \"distribution\": \"uniform\" } },\n"
    "  \"dynamics\": { \"verlet\": { \"dt\": 5e-5, \"rotation\": \"auto\" } }, \"run\": { \"steps\": 400 },\n"
    "  \"output\": { \"stress\": { \"every\": 50 }, \"states\": { \"every\": 200, \"turn\": true }, \"dump\": { \"every\": 200 } } }\n";

static char folder[] = "/tmp/shear-scene-XXXXXX", scene_path[64];

static void write_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    check_true(out != NULL, path);
    if (out) {
        fputs(text, out);
        fclose(out);
    }
}

static void make_folder(void)
{
    if (!*scene_path) {
        check_true(mkdtemp(folder) != NULL, "temporary folder");
        snprintf(scene_path, sizeof scene_path, "%s/scene.json", folder);
    }
    write_text(scene_path, base);
}

static char *in_folder(const char *name)
{
    static char path[4][200];
    static int next;
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static char *contents(const char *path)
{
    FILE *in = fopen(path, "r");
    char *text = calloc(1, 4000000);
    if (in) {
        const size_t got = fread(text, 1, 3999999, in);
        text[got] = 0;
        fclose(in);
    }
    return text;
}

/* Runs the base scene with replacements; the error's text is left in `e`. */
static bool run_with(const char *const *set, int count, const char *out, struct error *e)
{
    struct simulation *sim = calloc(1, sizeof *sim);
    const struct scene_options options = { .set = set, .set_count = count };
    bool good = scene_build(scene_path, &options, sim, e) && simulation_begin(sim, e);
    describe_provenance(sim, scene_path, &options);
    if (good && out)
        good = destination_make(&sim->destination, out, e) && simulation_run(sim, e);
    simulation_close(sim, e);
    free(sim);
    return good;
}

static void wrong_values_are_named(void)
{
    static const char *const wrong[][2] = {
        { "fluid.viscosity=-1", "fluid.viscosity is -1; it must be at least 0" },
        { "fluid.kT=\"hot\"", "fluid.kT is \"hot\"; it must be a number" },
        { "fluid.viscosity=0", "forces.drag needs fluid.viscosity above 0" },
        { "forces.lubrication.inner_gap=0", "forces.lubrication.inner_gap is 0; it must be above 0" },
        { "forces.lubrication.outer_gap=1e-4", "must be above inner_gap" },
        { "forces.lubrication.outer_gap=1.5", "must be below 1" },
        { "forces.lubrication.rotation_correction=\"some\"", "it must be one of \"none\", \"exact\"" },
        { "forces.contact.friction=-0.1", "forces.contact.friction is -0.1" },
        { "forces.contact.leever=1", "forces.contact.leever is not a known key; the nearest is \"lever\"" },
        { "forces.drag.torque=1", "forces.drag.torque is 1; it must be true or false" },
        { "forces.glue={}", "forces.glue is not a known key" },
        { "forces.drag_noise.distribution=\"gauss\"", "forces.drag_noise.distribution" },
        { "box.lengths=[1,2]", "box.lengths" },
        { "box.periodic=[true,true]", "box.periodic" },
        { "box.periodic=[false,true,true]", "needs x periodic too" },
        { "box={\"cell\":[[12,0,0],[0,11,0],[0,3,13]],\"periodic\":[true,false,true]}", "vector 3, which is periodic, has a part along y" },
        { "shear[0].gradient=\"x\"", "must differ from the flow's axis" },
        { "shear[0].rate=null", "shear[0].rate is null" },
        { "species=[]", "must list 1 to" },
        { "species[1].radius=0", "species[1].radius is 0" },
        { "start.random.phi=0.8", "must be at most 0.74" },
        { "start.random.phi=0.7", "too dense for a random start" },
        { "start.random.volume_shares=[1]", "one entry per species" },
        { "start.random.volume_shares=[0,0]", "must not all be 0" },
        { "start={}", "start must have either file or random" },
        { "start={\"file\":\"nowhere.csv\"}", "nowhere.csv cannot be opened" },
        { "dynamics={}", "dynamics must name one equation of motion" },
        { "dynamics={\"euler\":{}}", "dynamics.euler is not a known key" },
        { "dynamics.verlet.rotation=\"off\"", "a force of this scene turns particles" },
        { "dynamics.verlet.dt=0", "dynamics.verlet.dt is 0" },
        { "dynamics.verlet.dt=0.01", "take dt at most" },
        { "dynamics={\"verlet\":{\"dt\":1e-5},\"split\":{\"dt\":1e-5}}", "it names several" },
        { "dynamics={\"split\":{\"dt\":1e-5,\"residual\":2}}", "residual is 2; it must be above 0 and at most 0.01" },
        { "dynamics={\"split\":{\"dt\":1e-5,\"residual\":0}}", "residual is 0" },
        { "species[1].name=\"small\"", "is the name of species 1 already" },
        { "species[1].name=\"a,b\"", "must have no comma" },
        { "species[1].name=\"two\\nlines\"", "must have no comma, quote or line break" },
        { "species[1].name=\"abcdefghijklmnopqrstuvwxyzabcdef\"", "at most 31 letters" },
        { "run={\"time\":1e20}", "more than 2^47" },
        { "run={}", "run.time is missing" },
        { "run.steps=1.5", "run.steps is 1.5; it must be a whole number" },
        { "run={\"strain\":-1}", "run.strain" },
        { "output.stress.every=0", "output.stress.every" },
        { "output.states={\"at\":[3,2]}", "ascending" },
        { "seed=-1", "seed is -1; it must be a whole number" },
        { "realisation=99999999999", "realisation" },
        { "dimensions=4", "dimensions is 4" },
        { "about=7", "about is 7; it must be a text" },
        { "colour=\"red\"", "colour is not a known key" },
        { "shear[3].rate=1", "the scene has no such place" },
        { "nothing", "must be path=value" },
    };
    make_folder();
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        struct error e = { 0 };
        const bool good = run_with(&wrong[k][0], 1, NULL, &e);
        char what[900];
        snprintf(what, sizeof what, "%s -> code %d, %s", wrong[k][0], e.code, e.text);
        check_true(!good && e.code == ERROR_INPUT && strstr(e.text, wrong[k][1]), what);
    }
}

static void flows_across_a_plane_are_refused(void)
{
    static const char *const axes[4][2] = { { "z", "x" }, { "y", "z" }, { "x", "z" }, { "z", "y" } };
    make_folder();
    for (int k = 0; k < 4; k++) {
        char shear[100];
        struct error e = { 0 };
        snprintf(shear, sizeof shear, "shear=[{\"flow\":\"%s\",\"gradient\":\"%s\",\"rate\":0.1}]", axes[k][0], axes[k][1]);
        const char *const set[] = { "dimensions=2", shear };
        check_true(!run_with(set, 2, NULL, &e) && e.code == ERROR_INPUT && strstr(e.text, "in two dimensions flows lie in the plane"), e.text);
    }
}

/* Nothing may leave the plane: neither a driven velocity nor a sphere of a file of states. */
static void what_leaves_a_plane_is_refused(void)
{
    static const char *const flat[] = { "dimensions=2", "shear=[]", "box.periodic=[true,true,false]" };
    static const char *const rows[] = { "1,1,1,1,0.5,0,0,0,0,0,0", "1,1,1,1,0,0,0,0.1,0,0,0", "1,1,1,1,0,0,0,0,0.1,0,0", "1,1,1,1,0,0,0,0,0,0.1,0", "1,1,1,1,0,0.1,0.1,0,0,0,0.1" };
    static const char *const motions[] = { "[0,0,1],\"spin\":[0,0,0]", "[0,0,0],\"spin\":[1,0,0]", "[0,0,0],\"spin\":[0,1,0]", "[1,1,0],\"spin\":[0,0,1]" };
    make_folder();
    for (int k = 0; k < 5; k++) {
        struct error e = { 0 };
        char text[200], start[300];
        snprintf(text, sizeof text, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n%s\n", rows[k]);
        write_text(in_folder("flat.csv"), text);
        snprintf(start, sizeof start, "start={\"file\":\"%s\"}", in_folder("flat.csv"));
        const char *const set[] = { flat[0], flat[1], flat[2], start };
        check_true(run_with(set, 4, NULL, &e) == (k == 4), e.text);
        check_true(k == 4 || (e.code == ERROR_INPUT && strstr(e.text, "in two dimensions they are 0")), e.text);
    }
    static const char *const others[][2] = { { "box={\"cell\":[[12,0,3],[0,11,0],[0,0,13]],\"periodic\":[true,true,true]}", "box.cell: the first two vectors have a part along z" },
                                             { "forces.applied={\"small\":{\"force\":[0,0,1]}}", "forces.applied.small must stay in the plane" } };
    for (int k = 0; k < 2; k++) {
        struct error e = { 0 };
        const char *const set[] = { flat[0], flat[1], others[k][0], "start.random.phi=0.02" };
        check_true(!run_with(set, 4, NULL, &e) && e.code == ERROR_INPUT && strstr(e.text, k ? "must stay in the plane" : others[k][1]), e.text);
    }
    for (int k = 0; k < 4; k++) {
        struct error e = { 0 };
        char motion[200];
        snprintf(motion, sizeof motion, "species[0].motion={\"velocity\":%s}", motions[k]);
        const char *const set[] = { flat[0], flat[1], flat[2], motion, "start.random.phi=0.02" };
        check_true(run_with(set, 5, NULL, &e) == (k == 3), e.text);
        check_true(k == 3 || (e.code == ERROR_INPUT && strstr(e.text, "must stay in the plane")), e.text);
    }
}

static void broken_files_are_located(void)
{
    struct error e = { 0 };
    struct simulation *sim = calloc(1, sizeof *sim);
    const struct scene_options options = { .set_count = 0 };
    make_folder();
    write_text(in_folder("broken.json"), "{ \"about\": \"x\",\n  \"seed\": }");
    check_true(!scene_build(in_folder("broken.json"), &options, sim, &e) && strstr(e.text, "broken.json:2:"), e.text);
    static const char *const tables[][2] = {
        { "id,species,x,y,z,ux,uy,uz,wx,wy\n", "column \"wz\" is missing" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0,0,zero,0,0,0,0,0,0\n", ":2: \"zero\" in column \"z\"" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0,0\n", "4 values where 11 are needed" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n2,1,0,0,0,0,0,0,0,0,0\n", "id 2 where 1 is due" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1.5,1,0,0,0,0,0,0,0,0,0\n", "id 1.5 where 1 is due" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,3,0,0,0,0,0,0,0,0,0\n", "species 3" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz,x\n1,1,0,0,0,0,0,0,0,0,0,9\n", "column \"x\" is there twice" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0,,0,0,0,0,0,0,0\n", ":2: \"\" in column \"y\"" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0,1e11,0,0,0,0,0,0,0\n", "more than 1e9 cells away" },
        { "state,id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,1,0,0,0,0,0,0,0,0,0\n", "state 1 where 0 is due" },
        { "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n", "no particles" },
    };
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
        static const char *const set[] = { "start={\"file\":\"states.csv\"}" };
        struct error wrong = { 0 };
        write_text(in_folder("states.csv"), tables[k][0]);
        check_true(!run_with(set, 1, NULL, &wrong) && wrong.code == ERROR_INPUT && strstr(wrong.text, tables[k][1]), wrong.text);
    }
    free(sim);
}

/* An empty cell is a cell: columns that nobody reads may have them, and those behind keep their places. */
static void empty_cells_shift_nothing(void)
{
    struct error e = { 0 };
    struct simulation *sim = calloc(1, sizeof *sim);
    static const char *const set[] = { "start={\"file\":\"states.csv\"}" };
    const struct scene_options options = { .set = set, .set_count = 1 };
    make_folder();
    write_text(in_folder("states.csv"), "id,species,note,x,y,z,ux,uy,uz,wx,wy,wz,extra\r\n1,1,,3,4,5,0.1,0,0,0,0,0.7,\r\n");
    check_true(scene_build(scene_path, &options, sim, &e), e.text);
    if (!error_raised(&e)) {
        const struct particles *p = &sim->suspension.particles;
        check_close(norm(minus(p->position[0], vec(3, 4, 5))), 0, 0, "place");
        check_close(p->velocity[0].x, 0.1, 0, "velocity");
        check_close(p->spin[0].z, 0.7, 0, "spin");
    }
    simulation_close(sim, &e);
    free(sim);
}

/* Numbers that leave are said where no pair force looks at them either. */
static void numbers_that_leave_are_said(void)
{
    struct error e = { 0 };
    static const char *const set[] = { "forces={\"applied\":{\"small\":{\"force\":[1e308,0,0],\"torque\":[0,0,0]}}}", "species[0].density=1e-8", "run.steps=9", "start.thermal=false",
                                       "dynamics.verlet.dt=1" };
    make_folder();
    check_true(!run_with(set, 5, in_folder("leaving"), &e) && e.code == ERROR_RUN && strstr(e.text, "left the numbers"), e.text);
}

static void random_start_does_not_overlap(void)
{
    struct error e = { 0 };
    struct simulation *sim = calloc(1, sizeof *sim);
    static const char *const set[] = { "start.random.count=400", "start.random.phi=0.6", "start.random.volume_shares=[0.3,0.7]" };
    const struct scene_options options = { .set = set, .set_count = 3 };
    make_folder();
    check_true(scene_build(scene_path, &options, sim, &e), e.text);
    const struct particles *p = &sim->suspension.particles;
    bool relisted;
    check_true(neighbours_find(&sim->suspension.neighbours, &sim->suspension.box, &sim->suspension.particles, &relisted, &e), e.text);
    double volume = 0.0, large = 0.0;
    for (int i = 0; i < p->count; i++) {
        volume += 4.0 / 3.0 * M_PI * pow(radius_of(p, i), 3);
        large += p->species[i] == 1 ? 4.0 / 3.0 * M_PI * pow(radius_of(p, i), 3) : 0.0;
    }
    check_close(volume / sim->suspension.box.volume, 0.6, 1e-12, "volume fraction, exact by scaling the cell");
    check_close(large / volume, 0.7, 0.01, "share of the large, to one particle");
    check_true(sim->suspension.neighbours.near.deepest <= 1.2e-4, "overlap at most 1e-4 of the mean radius");
    describe_scene(sim, &e);
    simulation_close(sim, &e);
    free(sim);
}

/* Same scene, same bits; another seed, others; and outputs on or off leave the run alone. */
static void looking_changes_nothing(void)
{
    struct error e = { 0 };
    static const char *const plain[] = { "output={\"states\":{\"at\":[400],\"turn\":true}}" }, *const other[] = { "seed=8" };
    make_folder();
    check_true(run_with(NULL, 0, in_folder("a"), &e) && run_with(NULL, 0, in_folder("b"), &e), e.text);
    check_true(run_with(plain, 1, in_folder("c"), &e) && run_with(other, 1, in_folder("d"), &e), e.text);
    char *a = contents(in_folder("a/trajectory.csv")), *b = contents(in_folder("b/trajectory.csv"));
    char *c = contents(in_folder("c/trajectory.csv")), *d = contents(in_folder("d/trajectory.csv"));
    check_true(strlen(a) > 10000 && strcmp(a, b) == 0, "the same scene twice: the same bytes");
    const char *last_a = strstr(a, "\n400,"), *last_c = strstr(c, "\n400,");
    check_true(last_a && last_c && strcmp(last_a, last_c) == 0, "with and without stress, dump and other output times");
    check_true(strcmp(a, d) != 0, "another seed");
    free(a), free(b), free(c), free(d);
    char *stress = contents(in_folder("a/stress.csv")), *dump = contents(in_folder("a/dump.lammpstrj"));
    check_true(strstr(stress, "# about: test") && strstr(stress, "step,time,strain,solvent,eta_r,kinetic_xx") &&
               strstr(stress, "lubrication_noise_zz\n") && strstr(stress, "\n400,"), "stress table");
    check_true(strncmp(dump, "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n60\nITEM: BOX BOUNDS xy xz yz pp pp pp\n", 75) == 0, "dump");
    free(stress), free(dump);
}

static void runs_that_cannot_write_say_so(void)
{
    struct error e = { 0 };
    make_folder();
    write_text(in_folder("file"), "in the way");
    check_true(!run_with(NULL, 0, in_folder("file"), &e) && e.code == ERROR_RUN && strstr(e.text, "cannot be written"), e.text);
}

/* A frame of the dump shows the cell of its moment: sheared for 0.02, x along y, at a rate of -0.9. */
static void pictures_show_the_sheared_cell(void)
{
    struct error e = { 0 };
    make_folder();
    check_true(run_with(NULL, 0, in_folder("pictures"), &e), e.text);
    char *dump = contents(in_folder("pictures/dump.lammpstrj"));
    const char *frame = strstr(dump, "ITEM: TIMESTEP\n400\n"), *bounds = frame ? strstr(frame, "BOX BOUNDS") : NULL;
    double row[3][3] = { { 0 } };
    check_true(bounds && sscanf(bounds, "BOX BOUNDS xy xz yz pp pp pp %lf %lf %lf %lf %lf %lf %lf %lf %lf", &row[0][0], &row[0][1], &row[0][2],
                                &row[1][0], &row[1][1], &row[1][2], &row[2][0], &row[2][1], &row[2][2]) == 9, "the cell of the last frame");
    const double height = row[1][1] - row[1][0], tilt = -0.9 * 0.02 * height;
    check_close(row[0][2], tilt, 1e-8, "the edge along y leans");
    check_close(row[0][0], tilt, 1e-8, "the corner that has moved");
    check_close(row[0][1], height * 12.0 / 11.0, 1e-7, "the corner that has not");
    check_close(row[1][2], 0, 0, "xz");
    check_close(row[2][2], 0, 0, "yz");
    free(dump);
}

/* Whatever line breaks a text has, it stays a comment above the header. */
static void texts_stay_comments(void)
{
    struct error e = { 0 };
    static const char *const set[] = { "about=\"one line\\nstep,time,strain\\r\\nand a third\"", "run.steps=0" };
    make_folder();
    check_true(run_with(set, 2, in_folder("texts"), &e), e.text);
    char *table = contents(in_folder("texts/stress.csv"));
    int headers = 0;
    for (char *line = strtok(table, "\n"); line && headers < 2; line = strtok(NULL, "\n"))
        if (*line != '#') {
            check_true(strncmp(line, headers ? "0," : "step,time,strain,", headers ? 2 : 17) == 0, line);
            headers++;
        }
    check_true(headers == 2, "a header and a row");
    free(table);
}

/* The three protocols of a case, through files, as the gate calls them. */
static void cases_are_answered(void)
{
    struct error e = { 0 };
    make_folder();
    mkdir(in_folder("case"), 0777);
    write_text(in_folder("case/scene.json"), base);
    write_text(in_folder("case/states.csv"), "state,id,species,x,y,z,ux,uy,uz,wx,wy,wz\n0,1,1,1,1,1,0.1,0,0,0,0,0\n0,2,2,3.399,1,1,0,0.2,0,0,0,0.1\n"
                                             "1,1,1,1,1,1,0,0,0,0,0,0\n");
    write_text(in_folder("case/contacts.csv"), "state,i,j,sx,sy,sz\n0,2,1,0,1e-5,0\n");
    write_text(in_folder("case/case.json"), "{\"protocol\":\"forces\",\"scene\":\"scene.json\",\"states\":\"states.csv\",\"contacts\":\"contacts.csv\"}");
    check_true(evaluate_case(in_folder("case"), in_folder("answer"), &e), e.text);
    char *forces = contents(in_folder("answer/forces.csv")), *stress = contents(in_folder("answer/stress.csv"));
    double f[6];
    const char *row = strstr(forces, "\n0,contact,1,");
    check_true(row && sscanf(row, "\n0,contact,1,%lf,%lf,%lf,%lf,%lf,%lf", f, f + 1, f + 2, f + 3, f + 4, f + 5) == 6, "row of the contact");
    check_close(f[0], -10.0, 1e-9, "spring of overlap 1e-3");
    check_close(f[1], 2857.0 * 1e-5, 1e-12, "history given for (2, 1) acts on 1 with the opposite sign");
    check_true(!strstr(forces, "noise") && strstr(forces, "\n1,total,1,") && strstr(stress, "\n1,"), "states and forces");
    free(forces), free(stress);

    write_text(in_folder("case/case.json"), "{\"protocol\":\"noise\",\"scene\":\"scene.json\",\"states\":\"states.csv\",\"draws\":50}");
    check_true(evaluate_case(in_folder("case"), in_folder("answer"), &e), e.text);
    FILE *npy = fopen(in_folder("answer/noise_lubrication_noise.npy"), "rb");
    check_true(npy != NULL, "noise file");
    if (npy) {
        char head[129] = "";
        double z[12];
        check_true(fread(head, 1, 128, npy) == 128 && strstr(head + 10, "'shape': (50, 2, 6)") && head[127] == '\n', "header of 128 bytes");
        check_true(fread(z, 8, 12, npy) == 12, "draws");
        check_close(z[0] + z[6], 0, 1e-12, "pair noise has no net force");
        fseek(npy, 0, SEEK_END);
        check_close((double)ftell(npy), 128 + 50 * 12 * 8, 0, "length");
        fclose(npy);
    }
    write_text(in_folder("case/case.json"), "{\"protocol\":\"run\",\"scene\":\"scene.json\"}");
    check_true(evaluate_case(in_folder("case"), in_folder("answer"), &e), e.text);
    check_true(access(in_folder("answer/trajectory.csv"), R_OK) == 0, "trajectory of a run");
    static const char *const arrays[] = { "{\"protocol\":\"steps\",\"scene\":\"scene.json\",\"states\":\"states.csv\",\"steps\":1}",
                                          "{\"protocol\":\"friction\",\"scene\":\"scene.json\",\"states\":\"states.csv\",\"draws\":1}" };
    for (int k = 0; k < 2; k++) {                                               /* the second state is smaller, then larger, than the first */
        for (int larger = 0; larger < 2; larger++) {
            struct error unlike = { 0 };
            char text[2000];
            snprintf(text, sizeof text, "%s", base);
            char *scheme = strstr(text, "\"verlet\"");
            check_true(scheme != NULL, "the scheme of the base scene");
            if (k == 1)                                                         /* friction is a step of its own there */
                memcpy(scheme, "\"split\" ", strlen("\"verlet\""));
            write_text(in_folder("case/scene.json"), text);
            write_text(in_folder("case/states.csv"), larger ? "state,id,species,x,y,z,ux,uy,uz,wx,wy,wz\n0,1,1,1,1,1,0,0,0,0,0,0\n1,1,1,1,1,1,0,0,0,0,0,0\n1,2,2,5,1,1,0,0,0,0,0,0\n"
                                                            : "state,id,species,x,y,z,ux,uy,uz,wx,wy,wz\n0,1,1,1,1,1,0,0,0,0,0,0\n0,2,2,5,1,1,0,0,0,0,0,0\n1,1,1,1,1,1,0,0,0,0,0,0\n");
            write_text(in_folder("case/case.json"), arrays[k]);
            check_true(!evaluate_case(in_folder("case"), in_folder("answer"), &unlike) && unlike.code == ERROR_INPUT &&
                       strstr(unlike.text, "particles where state 0 has"), unlike.text);
        }
    }
    struct error wrong = { 0 };
    write_text(in_folder("case/case.json"), "{\"protocol\":\"dance\",\"scene\":\"scene.json\"}");
    check_true(!evaluate_case(in_folder("case"), in_folder("answer"), &wrong) && strstr(wrong.text, "protocol is \"dance\""), wrong.text);
}

static const struct unit_test tests[] = {
    { "wrong values are named", wrong_values_are_named },
    { "flows across a plane are refused", flows_across_a_plane_are_refused },
    { "what leaves a plane is refused", what_leaves_a_plane_is_refused },
    { "broken files are located", broken_files_are_located },
    { "empty cells shift nothing", empty_cells_shift_nothing },
    { "numbers that leave are said", numbers_that_leave_are_said },
    { "a random start does not overlap", random_start_does_not_overlap },
    { "looking changes nothing", looking_changes_nothing },
    { "runs that cannot write say so", runs_that_cannot_write_say_so },
    { "pictures show the sheared cell", pictures_show_the_sheared_cell },
    { "texts stay comments", texts_stay_comments },
    { "cases are answered", cases_are_answered },
    { NULL, NULL }
};
const struct suite scene_suite = { "scene", tests };
