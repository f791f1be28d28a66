/*
 * The engine (tools/engine/) against shear, pathwise: the same scene on 1, 2 and 4 ranks, across a remap, with noise, stopped and
 * resumed on other numbers of ranks; what it refuses. `make engine` does the same for 1000 spheres, and to broken engines.
 */
#include "refuse.h"
#include "scenes.h"

#include <jansson.h>
#include <string.h>
#include <sys/wait.h>

/* Friction, lubrication, both noises, pressed together and sheared fast: the cell is remapped near step 250 (by the engine at 277). */
static const char scene[] =
    "{ \"about\": \"test\", \"seed\": 7, \"fluid\": { \"viscosity\": 0.1, \"kT\": 0.017 },\n"
    "  \"box\": { \"lengths\": [8.0, 7.0, 9.0], \"periodic\": [true, true, true] },\n"
    "  \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -9.0 } ],\n"
    "  \"species\": [ { \"name\": \"small\", \"radius\": 1.0, \"density\": 0.1 }, { \"name\": \"large\", \"radius\": 1.4, \"density\": 0.1 } ],\n"
    "  \"start\": { \"random\": { \"phi\": 0.5, \"count\": 60, \"volume_shares\": [0.5, 0.5] }, \"thermal\": true, \"time\": 0.059 },\n"
    "  \"forces\": { \"contact\": { \"normal_stiffness\": 1e4, \"tangential_stiffness\": 2857.0, \"friction\": 0.5, \"lever\": \"contact\" },\n"
    "    \"tether\": { \"large\": { \"stiffness\": 1.0 } }, \"drag\": { \"torque\": true }, \"drag_noise\": { \"distribution\": \"gaussian\" },\n"
    "    \"lubrication\": { \"inner_gap\": 1e-3, \"outer_gap\": 0.05, \"rotation_correction\": \"exact\" },\n"
    "    \"lubrication_noise\": { \"distribution\": \"uniform\" } },\n"
    "  \"dynamics\": { \"verlet\": { \"dt\": 2e-5, \"rotation\": \"auto\" } }, \"run\": { \"steps\": 400 },\n"
    "  \"output\": { \"checkpoint\": { \"every\": 1000 }, \"stress\": { \"every\": 50 }, \"states\": { \"every\": 100, \"turn\": true },\n"
    "    \"viscosity\": { \"every\": 50 }, \"contacts\": { \"every\": 50 }, \"temperature\": { \"every\": 40 },\n"
    "    \"displacement\": { \"every\": 20, \"levels\": 3 } } }\n";

static const char *const tables[] = { "stress.csv", "trajectory.csv", "viscosity.csv", "contacts.csv", "temperature.csv", "displacement.csv" };

static char folder[] = "/tmp/shear-engine-XXXXXX";

/* Runs a command line in which %P is the folder of the programs and %W the folder of this test; its exit code, its words in `said`. */
static int command(const char *line, char said[2000])
{
    char program[300], whole[2000] = "", *end = whole;
    const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    program[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(program, '/');
    if (slash)
        *slash = '\0';
    for (const char *c = line; *c && end < whole + sizeof whole - 320; c++) {
        if (*c == '%' && (c[1] == 'P' || c[1] == 'W'))
            end += sprintf(end, "%s", *++c == 'P' ? program : folder);
        else
            *end++ = *c;
    }
    strcpy(end, " 2>&1");
    FILE *pipe = popen(whole, "r");
    const size_t got = pipe ? fread(said, 1, 1999, pipe) : 0;
    said[got] = '\0';
    const int status = pipe ? pclose(pipe) : -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

#define MPIRUN "ASAN_OPTIONS=detect_leaks=0 mpirun --allow-run-as-root --oversubscribe --mca mpi_yield_when_idle 1 "

static void work_folder(void)
{
    char path[100], said[2000];
    check_true(mkdtemp(folder) != NULL, "temporary folder");
    snprintf(path, sizeof path, "%s/scene.json", folder);
    FILE *out = fopen(path, "w");
    check_true(out && fputs(scene, out) >= 0 && fclose(out) == 0, "scene");
    check_close(command("%P/shear %W/scene.json -o %W/shear", said), 0, 0, said);
}

/* Largest difference of a column over the largest value in it, the worst of all columns; infinite where the tables are not alike. */
static double difference(const char *name, const char *of)
{
    enum { COLUMNS = 200 };
    char path[2][200], line[2][8000];
    double most[COLUMNS] = { 0.0 }, off[COLUMNS] = { 0.0 }, worst = 0.0;
    FILE *in[2];
    int columns = 0, rows = 0;
    snprintf(path[0], sizeof path[0], "%s/shear/%s", folder, name);
    snprintf(path[1], sizeof path[1], "%s/%s/%s", folder, of, name);
    for (int k = 0; k < 2; k++)
        in[k] = fopen(path[k], "r");
    for (bool more = in[0] && in[1]; more;) {
        for (int k = 0; k < 2; k++)
            do
                *line[k] = '\0';
            while ((more = fgets(line[k], sizeof line[k], in[k]) != NULL) && *line[k] == '#');
        char *a = line[0], *b = line[1];
        const bool header = strchr("0123456789-", *a) == NULL;
        if (header && strcmp(a, b) != 0)
            worst = INFINITY;
        for (columns = 0; !header && *a && *a != '\n' && columns < COLUMNS; columns++) {
            char *after_a, *after_b;
            const double x = strtod(a, &after_a), y = strtod(b, &after_b);
            if (isfinite(x) || isfinite(y)) {
                most[columns] = fmax(most[columns], fabs(x));
                off[columns] = fabs(x - y) <= off[columns] ? off[columns] : fabs(x - y);
            }
            if (after_a == a || after_b == b || *after_a != *after_b) {
                worst = INFINITY;
                break;
            }
            a = after_a + (*after_a == ',');
            b = after_b + (*after_b == ',');
            rows++;
        }
    }
    for (int k = 0; k < COLUMNS; k++)
        worst = off[k] / fmax(most[k], 1e-300) <= worst ? worst : off[k] / fmax(most[k], 1e-300);
    for (int k = 0; k < 2; k++)
        if (in[k])
            fclose(in[k]);
    return rows > 0 ? worst : INFINITY;
}

/* Rounding differs (wrapping, order of sums) and grows with the collisions: 1e-13 to 1e-11 were measured, a fault gives 1e-6 and more. */
static void same_as_shear(const char *of)
{
    char line[400], said[2000];
    snprintf(line, sizeof line, "%%P/compare-checkpoints %%W/shear/checkpoint.bin %%W/%s/checkpoint.bin 1e-10 1e-10", of);
    check_close(command(line, said), 0, 0, said);
    for (size_t k = 0; k < sizeof tables / sizeof *tables; k++)
        check_close(difference(tables[k], of), 0.0, 1e-9, tables[k]);
}

static void ranks_are_the_same(void)
{
    char said[2000];
    check_close(command(MPIRUN "-np 1 %P/shear-lammps %W/scene.json -o %W/one", said), 0, 0, said);
    same_as_shear("one");
    check_close(command("test $(grep -c 'Created triclinic box' %W/one/lammps.log) = 2", said), 0, 0, "dealt out twice: the cell was remapped");
    check_close(command(MPIRUN "-np 4 %P/shear-lammps %W/scene.json -o %W/four", said), 0, 0, said);
    same_as_shear("four");
}

/* A leaning cell in two flows, driven spheres: what LAMMPS's own tilts and masses must get right. */
static void other_cells_and_motions(void)
{
    const char set[] = " --set run.steps=200 --set 'box={\"cell\": [[8, 0, 0], [2, 7, 0], [1, -2, 9]], \"periodic\": [true, true, true]}'"
                       " --set 'shear=[{\"flow\": \"x\", \"gradient\": \"y\", \"rate\": -9}, {\"flow\": \"x\", \"gradient\": \"z\", \"rate\": 4}]'"
                       " --set 'species[1].motion={\"velocity\": [1, 0.5, 0.2], \"spin\": [0, 0, 1]}'";
    char line[1000], said[2000];
    snprintf(line, sizeof line, "%%P/shear %%W/scene.json -o %%W/shear-2%s", set);
    check_close(command(line, said), 0, 0, said);
    snprintf(line, sizeof line, MPIRUN "-np 2 %%P/shear-lammps %%W/scene.json -o %%W/engine-2%s", set);
    check_close(command(line, said), 0, 0, said);
    check_close(command("%P/compare-checkpoints %W/shear-2/checkpoint.bin %W/engine-2/checkpoint.bin 1e-10 1e-10", said), 0, 0, said);
}

static void goes_on_from_a_checkpoint(void)
{
    char said[2000];
    check_close(command(MPIRUN "-np 2 %P/shear-lammps %W/scene.json -o %W/two --set run.steps=130", said), 0, 0, said);
    check_close(command("%P/shear %W/scene.json -o %W/two --set run.steps=170 --resume", said), 0, 0, said);
    check_close(command(MPIRUN "-np 2 %P/shear-lammps %W/scene.json -o %W/two --resume", said), 0, 0, said);
    same_as_shear("two");
}

/* One key of the scene in place of another, and the words that refuse it. */
static void refused(const char *from, const char *to, const char *words)
{
    struct error e = { 0 };
    char text[4000];
    const char *at = strstr(scene, from);
    check_true(at != NULL, from);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - scene), scene, to, at + strlen(from));
    struct simulation *sim = scene_from(text, "", &e);
    check_true(!error_raised(&e), e.text);
    check_true(!engine_can(sim, &e) && e.code == ERROR_INPUT && strstr(e.text, words), e.text);
    drop(sim);
}

static void refuses_what_it_cannot(void)
{
    const char shear[] = "\"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -9.0 } ]";
    struct error e = { 0 };
    struct simulation *sim = scene_from(scene, "", &e);
    check_true(engine_can(sim, &e), "the scene itself");
    drop(sim);
    refused("\"verlet\":", "\"split\":", "velocity Verlet alone");
    refused("\"verlet\":", "\"predicted_verlet\":", "velocity Verlet alone");
    refused("[true, true, true]", "[true, true, false]", "periodic cells only");
    refused("\"lengths\": [8.0, 7.0, 9.0]", "\"cell\": [[8, 1, 0], [0, 7, 0], [0, 0, 9]]", "A along x");
    refused(shear, "\"shear\": [ { \"flow\": \"y\", \"gradient\": \"x\", \"rate\": 1 } ]", "name the axes so");
    refused(shear, "\"stages\": [ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 1 } ] } ]", "steady shear only");
    refused("\"count\": 60", "\"count\": 8", "two faces at once");
}

static void says_so_from_outside(void)
{
    char said[2000];
    check_close(command(MPIRUN "-np 2 %P/shear-lammps %W/scene.json -o %W/no --set dynamics.verlet.dt=1", said), 2, 0, "a step above the limit");
    check_true(strstr(said, "shear-lammps: dynamics.verlet.dt is 1;") != NULL, said);
    check_close(command("ASAN_OPTIONS=detect_leaks=0 %P/shear-lammps %W/scene.json --skin 0", said), 2, 0, "skin");
    check_true(strstr(said, "--skin is 0; it must be a number above 0") != NULL, said);
    check_close(command("rm -r %W", said), 0, 0, said);
}

static const struct unit_test tests[] = {
    { "work folder, and the run of shear", work_folder },
    { "the paths of shear on 1 and 4 ranks, across a remap, noisy", ranks_are_the_same },
    { "a leaning cell, two flows, driven spheres", other_cells_and_motions },
    { "from 2 ranks to shear to 2 ranks by checkpoints", goes_on_from_a_checkpoint },
    { "refuses what it cannot", refuses_what_it_cannot },
    { "says so from outside", says_so_from_outside },
    { NULL, NULL },
};

const struct suite engine_suite = { "engine", tests };
