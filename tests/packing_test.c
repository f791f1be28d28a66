/* The gate's own starting states: no overlap, the right volume fraction, a function of the seed, moving with the flow. */
#include "packing.h"
#include "suite.h"

#include <math.h>

static const struct packing_species mix[2] = { { 1.3, 45 }, { 1.82, 16 } };
enum { COUNT = 61 };

static void spheres_do_not_overlap(void)
{
    struct state_row row[COUNT];
    char why[WHY_LENGTH];
    const double edge = packing_edge(mix, 2, 0.55);
    double volume = 0;
    for (int s = 0; s < 2; s++)
        volume += mix[s].count * 4 * acos(-1) / 3 * pow(mix[s].radius, 3);
    check_relative(volume / pow(edge, 3), 0.55, 1e-14, "volume fraction");
    for (unsigned seed = 1; seed < 6; seed++) {
        check_true(packing_make(mix, 2, edge, -0.4, seed, row, why), "a packing is found");
        /* by its own loop, over all images */
        double least = 1;
        for (int i = 0; i < COUNT; i++)
            for (int j = 0; j < i; j++)
                for (int image = 0; image < 27; image++) {
                    const double dx = row[j].x[0] - row[i].x[0] + (image % 3 - 1) * edge;
                    const double dy = row[j].x[1] - row[i].x[1] + (image / 3 % 3 - 1) * edge;
                    const double dz = row[j].x[2] - row[i].x[2] + (image / 9 - 1) * edge;
                    const double reach = mix[row[i].species - 1].radius + mix[row[j].species - 1].radius;
                    least = fmin(least, sqrt(dx * dx + dy * dy + dz * dz) / reach - 1);
                }
        check_true(least >= 0, "no pair overlaps");
        check_close(packing_overlap(mix, edge, row, COUNT), -least, 1e-14, "reported overlap");
    }
}

static void spheres_follow_the_flow(void)
{
    struct state_row row[COUNT], again[COUNT], other[COUNT];
    char why[WHY_LENGTH];
    const double edge = packing_edge(mix, 2, 0.4);
    check_true(packing_make(mix, 2, edge, 0.3, 5, row, why) && packing_make(mix, 2, edge, 0.3, 5, again, why) &&
               packing_make(mix, 2, edge, 0.3, 6, other, why), "packings are found");
    int small = 0, same = 0;
    for (int i = 0; i < COUNT; i++) {
        small += row[i].species == 1;
        same += row[i].x[0] == other[i].x[0];
        check_true(row[i].x[0] == again[i].x[0] && row[i].x[2] == again[i].x[2], "the seed fixes the packing");
        check_true(row[i].x[1] >= 0 && row[i].x[1] < edge, "centres lie in the cell");
        check_close(row[i].u[0], 0.3 * row[i].x[1], 1e-15, "velocity of the flow");
        check_close(row[i].w[2], -0.15, 1e-15, "half the vorticity");
    }
    check_true(small == 45 && same == 0, "counts of the species; another seed is another packing");
}

static void too_dense_is_said(void)
{
    struct state_row row[COUNT];
    char why[WHY_LENGTH] = "";
    check_true(!packing_make(mix, 2, packing_edge(mix, 2, 0.8), 1, 1, row, why) && why[0], "phi 0.8 is refused with a reason");
}

const struct suite packing_suite = { "packing", (const struct unit_test[]){
    { "spheres do not overlap", spheres_do_not_overlap },
    { "spheres follow the flow", spheres_follow_the_flow },
    { "too dense is said", too_dense_is_said },
    { 0 },
} };
