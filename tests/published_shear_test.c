/* What layer 7 reads from sheared runs, on tables written by hand: two spheres that meet across the sheared face, and two rows of stress. */
#include "checks/published_shear.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static char folder[] = "/tmp/published-shear-XXXXXX";

static void write_file(const char *name, const char *text)
{
    char path[PATH_LENGTH];
    path_join(path, folder, name);
    FILE *f = fopen(path, "w");
    check_true(f && fputs(text, f) >= 0 && fclose(f) == 0, "file written");
}

/*
 * Edge 10, rate 0.5, time 1: the image one cell up is displaced by 5. Sphere 2, one cell down and as unwrapped, touches sphere 1
 * but for a gap of 0.01 along (-1, 1)/sqrt(2), the compressive axis; at time 0, in the discarded part, they are far apart.
 */
static void pair_across_the_face(void)
{
    const double rate = 0.5, viscosity = 0.1, kT = 0.017, k_n = 1e4, s = 2.01 / sqrt(2.0);
    struct state_row row[2] = { { .id = 1, .species = 1 }, { .id = 2, .species = 1 } };
    struct dense_start start = { .row = row, .count = 2, .edge = 10, .viscosity = viscosity, .rate = rate };
    struct check_run run = { 0 };
    struct structure sum = { .snapshots = 0 };
    double value[POINT_QUANTITIES];
    char text[512];
    start.scene = json_pack("{s{sf} s[{sf}{sf}] s{s{sf}}}", "fluid", "kT", kT, "species", "radius", 1.0, "radius", 1.4,
                            "forces", "contact", "normal_stiffness", k_n);
    snprintf(text, sizeof text, "step,time,id,x,y,z\n0,0,1,5,9.5,5\n0,0,2,1,1,1\n8,1,2,%.17g,%.17g,5\n8,1,1,5,9.5,5\n",
             5 - s - 5, 9.5 + s - 10);
    check_true(mkdtemp(folder) != NULL, "folder made");
    write_file("trajectory.csv", text);
    check_true(structure_read(&run, folder, &start, 0.25, value, &sum), "snapshot read");
    check_close(sum.snapshots, 1, 0, "the start is discarded");
    check_close(value[ANISOTROPY], 1, 0, "the pair lies on the compressive side");
    check_true(isnan(value[ANISOTROPY_CONTACT]), "no pair touches");
    check_close(value[FABRIC], 1, 1e-12, "one direction");
    check_close(value[OVERLAP], 0, 0, "no overlap counts as none");
    const double depth = sqrt(M_PI * kT / 2 / k_n), unit = kT / 1000 / (viscosity * rate);
    check_relative(value[STRUCTURAL], unit * 0.5 * 2 / (0.05 + depth), 1e-12, "(kT/V) sum over both ends of n n/D, shell 0.05");
    check_relative(value[STRUCTURAL_THIN], unit * 0.5 * 2 / (0.02 + depth), 1e-12, "shell 0.02");
    check_relative(value[STRUCTURAL_ZERO] - value[STRUCTURAL_THIN], (value[STRUCTURAL_THIN] - value[STRUCTURAL]) * 2 / 3, 1e-9,
                   "a straight line to no shell");
    check_close(value[PEAK_11], 2.01, 1e-12, "the peak is where the pair is");
    check_relative(sum.g[100], 1000 / (4 * M_PI / 3 * (pow(2.02, 3) - pow(2.0, 3))), 1e-12, "one pair in a shell over an ideal gas's");
    check_relative(sum.ring[9] + sum.ring[21], STRUCTURE_ANGLES, 1e-12, "in the ring at 135 and 315 degrees");
    json_decref(start.scene);
}

static void stress_of_two_rows(void)
{
    const struct flow flow = { .viscosity = 0.1, .rate = -0.5, .discard = 1, .strain = 4 };
    struct flow_average a;
    struct check_run run = { 0 };
    write_file("stress.csv", "step,time,drag_xx,drag_xy,drag_yx,drag_yy,drag_zz,"
                             "contact_normal_xx,contact_normal_xy,contact_normal_yx,contact_normal_yy,contact_normal_zz\n"
                             "0,1,9,9,9,9,9,9,9,9,9,9\n1,3,0,-0.05,-0.05,0,0,-3,-0.1,-0.2,-2,-1\n");
    check_true(flow_read(&run, folder, "contact_normal,drag", &flow, &a), "table read");
    check_relative(a.mean[VISCOSITY], 1 + 1 + 3, 1e-14, "solvent, drag and contact, symmetric parts over viscosity x rate");
    check_relative(a.mean[CONTACT], 3, 1e-14, "contact");
    check_relative(a.mean[PRESSURE], 2 / 0.05, 1e-14, "pressure, tension positive");
    check_relative(a.mean[N1], -1 / 0.05, 1e-14, "N1");
    check_relative(a.mean[N2], -1 / 0.05, 1e-14, "N2");
    check_true(!flow_read(&run, folder, "contact_normal,kinetic", &flow, &a), "an origin that is missing is said");
    results_free(&run.results);
    check_true(folder_remove(folder), "folder removed");
}

const struct suite published_shear_suite = { "published_shear", (const struct unit_test[]){
    { "a pair across the sheared face", pair_across_the_face },
    { "stress of two rows", stress_of_two_rows },
    { 0 },
} };
