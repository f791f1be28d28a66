/* Every observer against an answer known beforehand, and that none of them changes the run. */
#include "suite.h"

#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/shear-observers-XXXXXX";

static char *in_folder(const char *name)
{
    static char path[4][200];
    static int next;
    static bool made;
    if (!made)
        check_true(made = mkdtemp(folder) != NULL, "temporary folder");
    next = (next + 1) % 4;
    snprintf(path[next], sizeof path[next], "%s/%s", folder, name);
    return path[next];
}

static void write_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    check_true(out && fputs(text, out) >= 0 && fclose(out) == 0, path);
}

/* Runs a scene given as text into the folder. */
static bool run(const char *scene, struct error *e)
{
    struct simulation *sim = calloc(1, sizeof *sim);
    const struct scene_options options = { .set_count = 0 };
    memset(e, 0, sizeof *e);
    write_text(in_folder("scene.json"), scene);
    const bool good = scene_build(in_folder("scene.json"), &options, sim, e) && simulation_begin(sim, e) &&
                      destination_make(&sim->destination, folder, e) && simulation_run(sim, e);
    simulation_close(sim, e);
    free(sim);
    return good && !error_raised(e);
}

/* One number of a table: the row whose first cells are `key`, the column of that name. NaN if it is not there. */
static double cell_of(const char *file, const char *key, const char *column)
{
    FILE *in = fopen(in_folder(file), "r");
    char line[8000];
    int wanted = -1;
    double value = NAN;
    while (in && fgets(line, sizeof line, in)) {
        if (wanted < 0) {
            char *rest = line, *name;
            for (int k = 0; (name = strtok_r(rest, ",\n", &rest)); k++)
                if (strcmp(name, column) == 0)
                    wanted = k;
            continue;
        }
        if (strncmp(line, key, strlen(key)) != 0 || line[strlen(key)] != ',')
            continue;
        char *rest = line, *text = NULL;
        for (int k = 0; k <= wanted; k++)
            text = strtok_r(rest, ",\n", &rest);
        value = text ? strtod(text, NULL) : NAN;
    }
    if (in)
        fclose(in);
    return value;
}

#define PARTS "\"species\": [ { \"name\": \"a\", \"radius\": 1.3, \"density\": 0.4 } ], \"box\": { \"lengths\": [7.1, 9.3, 8.7], \"periodic\": [true, true, true] },\n"

/* Four touching spheres in a ring and one apart, at rest: everything that is instantaneous is countable by hand. */
static void instants_by_hand(void)
{
    struct error e;
    write_text(in_folder("ring.csv"), "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,1,1,1,0.3,0,0,0,0,0.5\n2,1,3.5,1,1,0,0,0,0,0,-0.25\n3,1,3.5,3.5,1,0,0,0,0,0,0\n"
                                      "4,1,1,3.5,1,0,0,0,0,0,0\n5,1,2,6.2,5.35,0,0.4,0,0,0,0\n");
    check_true(run("{ \"about\": \"test\", \"seed\": 1, \"fluid\": { \"viscosity\": 0.7, \"kT\": 0.31 }, " PARTS
                   "\"start\": { \"file\": \"ring.csv\" }, \"forces\": { \"contact\": { \"normal_stiffness\": 50, \"tangential_stiffness\": 10, \"friction\": 0.5, "
                   "\"lever\": \"radius\" } },\n \"dynamics\": { \"verlet\": { \"dt\": 0.001 } }, \"run\": { \"steps\": 0 },\n"
                   "\"output\": { \"contacts\": { \"every\": 1 }, \"temperature\": { \"every\": 1 }, \"viscosity\": { \"every\": 1 }, \"brownian_stress\": { \"every\": 1 },\n"
                   "\"green_kubo\": { \"every\": 1, \"levels\": 2 }, \"pair_distribution\": { \"every\": 1, \"range\": 3, \"bins\": 6, \"near\": { \"gap\": 0.2, \"bins\": 2 },\n"
                   "\"plane\": { \"range\": 3, \"half_width\": 0.5, \"bins\": 3 } }, \"averages\": { \"every\": 1 } } }", &e), e.text);
    const double m = 4.0 / 3.0 * M_PI * 0.4 * pow(1.3, 3), I = 0.4 * m * 1.69, V = 7.1 * 9.3 * 8.7;
    check_close(cell_of("contacts.csv", "0", "contacts"), 8.0 / 5, 1e-14, "four contacts of five spheres");
    check_close(cell_of("contacts.csv", "0", "backbone"), 2, 1e-14, "the ring holds itself with friction");
    check_close(cell_of("contacts.csv", "0", "rattlers"), 1, 0, "the fifth rattles");
    check_close(cell_of("temperature.csv", "0", "T_x"), m * 0.09 / 5, 1e-14, "temperature along x");
    check_close(cell_of("temperature.csv", "0", "T"), m * (0.09 + 0.16) / 15, 1e-14, "temperature");
    check_close(cell_of("temperature.csv", "0", "W_z"), I * 0.3125 / 5, 1e-14, "temperature of the spin");
    check_close(cell_of("temperature.csv", "0", "W_a"), I * 0.3125 / 15, 1e-14, "of a species");
    /* Pressure of four springs of overlap 0.1: r F/(3 V) each. */
    check_close(cell_of("viscosity.csv", "0", "pressure"), 4 * 2.5 * 5.0 / (3 * V), 1e-13, "pressure");
    check_close(cell_of("viscosity.csv", "0", "N2"), -2 * 2.5 * 5.0 / V, 1e-13, "N2 = sigma_yy - sigma_zz");
    check_close(cell_of("averages.csv", "pressure", "mean"), 4 * 2.5 * 5.0 / (3 * V), 1e-9, "the mean of one sample");
    check_close(cell_of("averages.csv", "contacts", "mean"), 1.6, 1e-9, "contacts");
    /* Two pairs along x, two ends each: -(kT/V) 4 a/D. */
    const double depth = sqrt(M_PI * 0.31 / 100.0);
    check_close(cell_of("brownian_stress.csv", "0", "wide_xx"), -0.31 / V * 4 * 1.3 / (0.065 + depth), 1e-13, "soft shell");
    check_close(cell_of("brownian_stress.csv", "0", "raw_yy"), -0.31 / V * 4 / 0.05, 1e-13, "as printed");
    check_close(cell_of("brownian_stress.csv", "0", "wide_zz"), 0, 1e-14, "none along z");
    check_true(isfinite(cell_of("green_kubo.csv", "0", "eta")), "green_kubo.csv");
    check_close(cell_of("pair_distribution.csv", "far,1,1,2.5", "count"), 4, 0, "distance 2.5 in the bin that begins there");
    check_close(cell_of("pair_distribution.csv", "near,1,1,-0.20000000000000001", "count"), 4, 0, "gap -0.1 in the fine bin below 0");
    check_close(cell_of("pair_plane.csv", "2,0", "count"), 2, 0, "to the right: two pairs; their other ends lie to the left");
}

/* Centres that lie in a plane: g = 1 for an ideal gas in rings and in squares; the viscosity is that of the one plane. */
static void ideal_gas_in_a_plane(void)
{
    struct error e;
    FILE *gas = fopen(in_folder("gas.csv"), "w");
    uint32_t state = 12345;
    fputs("id,species,x,y,z,ux,uy,uz,wx,wy,wz\n", gas);
    for (int i = 1; i <= 400; i++) {
        double at[2];
        for (int k = 0; k < 2; k++) {
            state = state * 1664525u + 1013904223u;
            at[k] = 20.0 * (double)(state >> 8) / 16777216.0;
        }
        fprintf(gas, "%d,1,%.6f,%.6f,0,0,0,0,0,0,0\n", i, at[0], at[1]);
    }
    fclose(gas);
    check_true(run("{ \"about\": \"test\", \"dimensions\": 2, \"seed\": 1, \"fluid\": { \"viscosity\": 0.7, \"kT\": 0.31 }, \"start\": { \"file\": \"gas.csv\" },\n"
                   "\"species\": [ { \"name\": \"a\", \"radius\": 0.001, \"density\": 1 } ], \"box\": { \"lengths\": [20, 20, 4], \"periodic\": [true, true, true] },\n"
                   "\"forces\": {}, \"dynamics\": { \"verlet\": { \"dt\": 0.001, \"rotation\": \"off\" } }, \"run\": { \"steps\": 0 },\n"
                   "\"output\": { \"pair_distribution\": { \"every\": 1, \"range\": 6, \"bins\": 2, \"plane\": { \"range\": 4, \"half_width\": 0.5, \"bins\": 2 } } } }", &e), e.text);
    /* 79800 pairs, of which pi 9/400 in the first ring: 5640, and pi 27/400: 16920 in the second; g to 5/sqrt(5640). */
    check_close(cell_of("pair_distribution.csv", "far,1,1,0", "g"), 1, 0.07, "first ring");
    check_close(cell_of("pair_distribution.csv", "far,1,1,3", "g"), 1, 0.07, "second ring");
    check_close(cell_of("pair_plane.csv", "2,2", "g"), 1, 0.07, "a square of the plane");
    write_text(in_folder("flat.csv"), "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,1,1,0,0,0,0,0,0,0\n2,1,2.57,3.09,0,0,0,0,0,0,0\n");
    check_true(run("{ \"about\": \"test\", \"dimensions\": 2, \"seed\": 1, \"fluid\": { \"viscosity\": 0.7, \"kT\": 0.31 }, " PARTS "\"start\": { \"file\": \"flat.csv\" },\n"
                   "\"forces\": { \"contact\": { \"normal_stiffness\": 50, \"friction\": 0 } }, \"dynamics\": { \"verlet\": { \"dt\": 0.001 } }, \"run\": { \"steps\": 1 },\n"
                   "\"output\": { \"green_kubo\": { \"every\": 1, \"levels\": 1 } } }", &e), e.text);
    const double C = cell_of("green_kubo.csv", "0", "C_xy");
    check_true(C > 0, "a stress along xy");
    check_relative(cell_of("green_kubo.csv", "0.001", "eta"), 7.1 * 9.3 * 8.7 / 0.31 * 0.5 * (C + cell_of("green_kubo.csv", "0.001", "C_xy")) * 0.001, 1e-12, "trapezoid over xy alone");
}

/* Discs without friction hold each other by three contacts: a honeycomb has no rattler in two dimensions. */
static void a_honeycomb_holds_itself(void)
{
    const double d = 2.5;           /* 0.1 less than two radii */
    const double place[4][2] = { { 0, 0 }, { 0, d }, { d * sqrt(3) / 2, 1.5 * d }, { d * sqrt(3) / 2, 2.5 * d } };
    struct error e;
    char scene[1200];
    FILE *out = fopen(in_folder("comb.csv"), "w");
    fputs("id,species,x,y,z,ux,uy,uz,wx,wy,wz\n", out);
    for (int i = 0; i < 16; i++)
        fprintf(out, "%d,1,%.17g,%.17g,0,0,0,0,0,0,0\n", i + 1, place[i % 4][0] + i / 4 % 2 * d * sqrt(3), place[i % 4][1] + i / 8 * 3 * d);
    fclose(out);
    snprintf(scene, sizeof scene, "{ \"about\": \"test\", \"dimensions\": 2, \"start\": { \"file\": \"comb.csv\" }, \"box\": { \"lengths\": [%.17g, %.17g, 9], \"periodic\": [true, true, true] },\n"
             "\"species\": [ { \"name\": \"a\", \"radius\": 1.3, \"density\": 0.4 } ], \"forces\": { \"contact\": { \"normal_stiffness\": 50, \"friction\": 0 } },\n"
             "\"dynamics\": { \"verlet\": { \"dt\": 0.001 } }, \"run\": { \"steps\": 0 }, \"output\": { \"contacts\": { \"every\": 1 } } }", 2 * d * sqrt(3), 6 * d);
    check_true(run(scene, &e), e.text);
    check_close(cell_of("contacts.csv", "0", "contacts"), 3, 1e-14, "three contacts each");
    check_close(cell_of("contacts.csv", "0", "rattlers"), 0, 0, "nobody rattles");
}

/* Two shears of one rate: both tables speak of the plane that comes first, x along y before x along z. One contact, along x and y. */
static void tables_agree_about_the_plane(void)
{
    struct error e;
    write_text(in_folder("two.csv"), "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,1,1,1,0,0,0,0,0,0\n2,1,2.5,3,1,0,0,0,0,0,0\n");
    check_true(run("{ \"about\": \"test\", \"seed\": 1, \"fluid\": { \"viscosity\": 0.7 }, " PARTS "\"start\": { \"file\": \"two.csv\" },\n"
                   "\"shear\": [ { \"flow\": \"x\", \"gradient\": \"z\", \"rate\": 0.5 }, { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 0.5 } ],\n"
                   "\"forces\": { \"contact\": { \"normal_stiffness\": 50, \"friction\": 0 } }, \"dynamics\": { \"verlet\": { \"dt\": 0.001 } }, \"run\": { \"steps\": 0 },\n"
                   "\"output\": { \"stress\": { \"every\": 1 }, \"viscosity\": { \"every\": 1 } } }", &e), e.text);
    /* Overlap 0.1, force 5 along (0.6, 0.8): sigma_xy = -5 * 2.5 * 0.6 * 0.8/V. */
    const double eta_r = 1 - 5 * 2.5 * 0.6 * 0.8 / (7.1 * 9.3 * 8.7 * 0.7 * 0.5);
    check_close(cell_of("stress.csv", "0", "eta_r"), eta_r, 1e-8, "stress.csv");
    check_close(cell_of("viscosity.csv", "0", "eta_r"), eta_r, 1e-13, "viscosity.csv");
}

/* An ideal gas: g = 1 everywhere, also beyond half of a small cell, and with images counted. */
static void ideal_gas_has_g_of_one(void)
{
    struct error e;
    double sum = 0.0, pairs = 0.0;
    const char *scene = "{ \"about\": \"test\", \"seed\": 5, \"fluid\": { \"viscosity\": 1, \"kT\": 1 }, \"box\": { \"lengths\": [4, 4, 4], \"periodic\": [true, true, true] },\n"
        "\"species\": [ { \"name\": \"a\", \"radius\": 0.001, \"density\": 1e6 }, { \"name\": \"b\", \"radius\": 0.002, \"density\": 1e6 } ],\n"
        "\"start\": { \"random\": { \"phi\": 1e-8, \"count\": 60, \"volume_shares\": [0.2, 0.8] } }, \"forces\": {}, \"dynamics\": { \"verlet\": { \"dt\": 0.05 } },\n"
        "\"run\": { \"steps\": 0 }, \"output\": { \"pair_distribution\": { \"every\": 1, \"range\": %g, \"bins\": 2 } } }";
    /* The random start scales the cell to phi: its edge follows from the solid volume. */
    const double edge = cbrt(4.0 / 3.0 * M_PI * (40 * 1e-9 + 20 * 8e-9) / 1e-8);
    for (int seed = 0; seed < 30; seed++) {
        char text[2000], seeded[2100];
        snprintf(text, sizeof text, scene, 0.8 * edge);
        snprintf(seeded, sizeof seeded, "{ \"realisation\": %d, %s", seed, text + 1);
        check_true(run(seeded, &e), e.text);
        char key[100];
        for (int a = 1; a <= 2; a++)
            for (int b = a; b <= 2; b++) {
                snprintf(key, sizeof key, "far,%d,%d,0", a, b);
                const double count = cell_of("pair_distribution.csv", key, "count"), g = cell_of("pair_distribution.csv", key, "g");
                sum += count;
                pairs += g > 0 ? count / g : 0.0;
            }
        if (error_raised(&e))
            break;
    }
    /* Pairs over all images inside 0.4 edges; each realisation is independent, counts are nearly Poisson. */
    check_true(sum > 10000, "pairs counted");
    check_close(sum / pairs, 1.0, 5.0 / sqrt(sum), "g of an ideal gas");
}

/* Free Brownian spheres: Langevin's displacement and velocity correlation, of translation and rotation. */
static void free_spheres_diffuse(void)
{
    struct error e;
    check_true(run("{ \"about\": \"test\", \"seed\": 9, \"fluid\": { \"viscosity\": 0.7, \"kT\": 0.31 }, " PARTS
                   "\"start\": { \"random\": { \"phi\": 1e-4, \"count\": 400, \"volume_shares\": [1] }, \"thermal\": true },\n"
                   "\"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -0.4 } ],\n"
                   "\"forces\": { \"drag\": { \"torque\": true }, \"drag_noise\": { \"distribution\": \"gaussian\" } }, \"dynamics\": { \"verlet\": { \"dt\": 0.005 } },\n"
                   "\"run\": { \"steps\": 3000 }, \"output\": { \"displacement\": { \"every\": 5, \"levels\": 5 }, \"velocity_correlation\": { \"every\": 5, \"levels\": 2 },\n"
                   "\"averages\": { \"every\": 5 } } }", &e), e.text);
    const double a = 1.3, m = 4.0 / 3.0 * M_PI * 0.4 * a * a * a, drag = 6 * M_PI * 0.7 * a, T = m / drag, D = 0.31 / drag;
    const double Dr = 0.31 / (8 * M_PI * 0.7 * a * a * a), Tr = 0.4 * m * a * a / (8 * M_PI * 0.7 * a * a * a);
    const double lag[] = { 0.025, 0.2, 3.2 };
    for (int k = 0; k < 3; k++) {
        char key[64];
        snprintf(key, sizeof key, "%.17g", (lag[k] / 0.025) * 5 * 0.005);
        const double t = lag[k], samples = 400 * 15.0 / (2 * t + 2 * T);
        const double expected = 2 * D * (t - T * (1 - exp(-t / T))), turned = 2 * Dr * (t - Tr * (1 - exp(-t / Tr)));
        check_relative(cell_of("displacement.csv", key, "msd_z"), expected, 5 * sqrt(2 / samples), "Langevin, across the shear");
        check_relative(cell_of("displacement.csv", key, "turn_x"), turned, 5 * sqrt(2 / samples) + 0.06, "rotation: dt is 6 % of its time");
        if (t < 3)
            check_close(cell_of("velocity_correlation.csv", key, "c_z"), 0.31 / m * exp(-t / T), 5 * 0.31 / m / sqrt(samples), "velocities forget in m/drag");
    }
    check_close(cell_of("velocity_correlation.csv", "0", "w_y"), 0.31 / (0.4 * m * a * a), 0.05 * 0.31 / (0.4 * m * a * a), "equipartition of spins");
    check_close(cell_of("averages.csv", "T", "mean"), 0.31, 5 * cell_of("averages.csv", "T", "error"), "temperature within five of its errors");
    /* <c^2> forgets in T/2 = 0.1: 3 x 400 x 15/0.2 independent values of relative variance 2; few blocks know their error to a third. */
    check_relative(cell_of("averages.csv", "T", "error"), 0.31 * sqrt(2 / (1200 * 15 / (T))), 0.5, "error bar");
    check_relative(cell_of("averages.csv", "eta_r", "mean"), 1 + 2.5e-4, 1e-9, "Einstein");
}

static void wrong_observers_are_named(void)
{
    static const char *const wrong[][2] = {
        { "\"contacts\": { \"every\": 1 }", "output.contacts needs a force between pairs" },
        { "\"brownian_stress\": { \"every\": 1 }", "output.brownian_stress needs fluid.kT above 0" },
        { "\"green_kubo\": { \"every\": 1, \"levels\": 3 }", "output.green_kubo needs a scene at rest" },
        { "\"displacement\": { \"every\": 1, \"levels\": 0 }", "output.displacement.levels is 0" },
        { "\"velocity_correlation\": { \"every\": 1 }", "output.velocity_correlation.levels is missing" },
        { "\"pair_distribution\": { \"every\": 1, \"range\": 0, \"bins\": 3 }", "output.pair_distribution.range is 0" },
        { "\"pair_distribution\": { \"every\": 1, \"range\": 1, \"bins\": 3, \"near\": { \"gap\": 1 } }", "output.pair_distribution.near.bins is missing" },
        { "\"temperature\": { \"each\": 1 }", "output.temperature.every is missing" },
        { "\"averages\": { \"every\": 1, \"blocks\": 3 }", "output.averages.blocks is not a known key" },
        { "\"viscosity\": { \"every\": -1 }", "output.viscosity.every is -1" },
        { "\"checkpoint\": { \"every\": 0 }", "output.checkpoint.every is 0" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char scene[2000];
        struct error e;
        snprintf(scene, sizeof scene, "{ \"about\": \"test\", \"seed\": 9, " PARTS "\"start\": { \"random\": { \"phi\": 0.1, \"count\": 4, \"volume_shares\": [1] } },\n"
                 "\"dynamics\": { \"verlet\": { \"dt\": 0.005 } }, \"run\": { \"steps\": 3 }, \"output\": { %s } }", wrong[k][0]);
        check_true(!run(scene, &e) && e.code == ERROR_INPUT && strstr(e.text, wrong[k][1]), e.text);
    }
}

/* Two driven ones are no pair, so that walls listed first have no range among themselves; the spheres beside them have. */
static void contacts_beside_walls_listed_first(void)
{
    struct error e;
    check_true(run("{ \"about\": \"test\", \"seed\": 9, \"box\": { \"lengths\": [8, 8, 8], \"periodic\": [true, true, true] },\n"
                   "\"species\": [ { \"name\": \"wall\", \"radius\": 1, \"density\": 1, \"motion\": \"held\" }, { \"name\": \"free\", \"radius\": 1, \"density\": 1 } ],\n"
                   "\"forces\": { \"contact\": { \"normal_stiffness\": 100, \"friction\": 0 } },\n"
                   "\"start\": { \"random\": { \"phi\": 0.1, \"count\": 8, \"volume_shares\": [0.5, 0.5] } },\n"
                   "\"dynamics\": { \"verlet\": { \"dt\": 0.005 } }, \"run\": { \"steps\": 3 }, \"output\": { \"contacts\": { \"every\": 1 } } }", &e), e.text);
}

/* Two held spheres are no pair: they add nothing to the structural Brownian stress, one held and one free add all. */
static void held_spheres_have_no_brownian_stress(void)
{
    struct error e;
    write_text(in_folder("held.csv"), "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,1,1,1,0,0,0,0,0,0\n2,1,3,1,1,0,0,0,0,0,0\n3,2,3,3,1,0,0,0,0,0,0\n");
    check_true(run("{ \"about\": \"test\", \"seed\": 9, \"fluid\": { \"kT\": 1 }, \"box\": { \"lengths\": [8, 8, 8], \"periodic\": [true, true, true] },\n"
                   "\"species\": [ { \"name\": \"wall\", \"radius\": 1, \"density\": 1, \"motion\": \"held\" }, { \"name\": \"free\", \"radius\": 1, \"density\": 1 } ],\n"
                   "\"forces\": { \"contact\": { \"normal_stiffness\": 100, \"friction\": 0 } }, \"start\": { \"file\": \"held.csv\" },\n"
                   "\"dynamics\": { \"verlet\": { \"dt\": 0.005 } }, \"run\": { \"steps\": 0 }, \"output\": { \"brownian_stress\": { \"every\": 1 } } }", &e), e.text);
    check_close(cell_of("brownian_stress.csv", "0", "raw_xx"), 0, 0, "two held spheres along x");
    check_close(cell_of("brownian_stress.csv", "0", "raw_yy"), -1.0 / 512 * 2 / 0.05, 1e-14, "a held and a free one along y");
}

static const struct unit_test tests[] = {
    { "instants by hand", instants_by_hand },
    { "a honeycomb holds itself", a_honeycomb_holds_itself },
    { "two shears of one rate", tables_agree_about_the_plane },
    { "an ideal gas in a plane", ideal_gas_in_a_plane },
    { "an ideal gas has g of one", ideal_gas_has_g_of_one },
    { "free spheres diffuse", free_spheres_diffuse },
    { "contacts beside walls that are listed first", contacts_beside_walls_listed_first },
    { "held spheres have no Brownian stress", held_spheres_have_no_brownian_stress },
    { "wrong observers are named", wrong_observers_are_named },
    { NULL, NULL }
};
const struct suite observers_suite = { "observers", tests };
