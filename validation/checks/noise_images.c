/*
 * Layer 2: the noise of a pair that meets through several faces
 *
 * Two spheres half a cell apart, in a cell so short that each feels the other on both sides, through films of the same width. Both films resist
 * a motion along the line, so both have their own noise, and for sphere 1
 *
 *     <F_x^2> = (2 kT/dt) R_xx ,   <T_y^2> = (2 kT/dt) R_yy of spins          R the candidate's own, all films together
 *
 * and likewise along y and z, for a code may look at one edge of the cell only. Half a cell apart along two axes there are four films, through
 * images that differ in both counts of cells; on which side of sphere 1 sphere 2 lies decides about the signs of these.
 *
 * One set of random numbers for two films would double the first (equal pushes add up) and change the second. A ratio near 1 is asked for, by
 * an interval of four standard errors.
 */
#include "noise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where sphere 2 lies: half a cell along `axis`, and along the next axis by `other` cells: none, a half, or a half to the other side. */
static void try_place(struct check_run *run, int axis, double other)
{
    static const char *const lubrication[1] = { "lubrication" };
    const size_t first = (size_t)axis, second = (size_t)(axis + 1) % 3;
    const struct { size_t at; const char *name; } watched[3] = { { first, "force along the line" }, { second, "force across it" },
                                                                 { 3 + second, "torque across it" } };
    struct model m;
    struct frozen f = { .count = 2, .sizes = 1 };
    const size_t draws = (size_t)scene_number(run->gate_case->parameters, "draws", 0);
    char out[PATH_LENGTH], name[96], place[32];
    json_t *turned = json_deep_copy(run->gate_case->scene), *lengths = json_array();
    const double edge = scene_number(run->gate_case->parameters, "edge", NAN) / (other == 0.0 ? 1.0 : sqrt(2.0));
    for (size_t k = 0; k < 3; k++)
        json_array_append_new(lengths, k == first || (k == second && other != 0.0) ? json_real(edge)
                                                                                   : json_incref(json_array_get(scene_get(turned, "box.lengths"), k)));
    scene_set(turned, "box.lengths", lengths);
    if (!model_read(run, turned, &m)) {
        json_decref(turned);
        return;
    }
    f.size[0] = f.radius[0] = f.radius[1] = m.radius[0];
    f.species[0] = f.species[1] = 1;
    for (size_t k = 0; k < 3; k++) {
        f.x[0][k] = (k == second && other < 0.0 ? 0.71 : 0.21) * m.cell[k][k];
        f.x[1][k] = f.x[0][k] + (k == first ? 0.5 : k == second ? other : 0.0) * m.cell[k][k];
    }
    snprintf(place, sizeof place, other == 0.0 ? "%c" : other > 0.0 ? "%c%c" : "%c%c-mirrored", "xyz"[first], "xyz"[second]);
    json_t *scene = frozen_scene(run, &f);
    scene_set(scene, "box.lengths", json_deep_copy(lengths));
    const double kT = scene_number(scene, "fluid.kT", NAN), dt = scene_number(scene, "dynamics.verlet.dt", NAN);
    double *R[1] = { calloc(144, sizeof(double)) }, *draw = NULL;
    struct state_row row[2];
    for (size_t i = 0; i < 2; i++) {
        row[i] = (struct state_row){ .id = (int)i + 1, .species = 1 };
        memcpy(row[i].x, f.x[i], sizeof row[i].x);
    }
    const struct question q = { .protocol = "noise", .scene = scene, .state = row, .states = 2, .draws = draws };
    snprintf(name, sizeof name, "columns-of-R-%s", place);
    const bool measured = measure_resistance(run, name, scene, &f, 1, lubrication, R);
    snprintf(name, sizeof name, "draws-%s", place);
    if (measured && check_ask(run, name, &q, out))
        draw = noise_draws(run, out, "noise_lubrication_noise.npy", draws, &f, sqrt(2.0 * kT / dt));
    for (size_t k = 0; k < 3 && draw; k++) {
        double sum = 0.0, squares = 0.0;
        for (size_t t = 0; t < draws; t++) {
            const double z = draw[12 * t + watched[k].at] * draw[12 * t + watched[k].at] / R[0][13 * watched[k].at];
            sum += z;
            squares += z * z;
        }
        const double mean = sum / (double)draws, error = sqrt((squares / (double)draws - mean * mean) / (double)draws);
        snprintf(name, sizeof name, "%s: %s", place, watched[k].name);
        check_interval(run, INVARIANT, name, mean, error, 1.0, 0.2, "%s films between the same spheres, across %s: the variance of the %s is %.4g times what "
                       "the candidate's own resistance asks for; some draw the same random numbers, or one draws none", other == 0.0 ? "two" : "four", place,
                       watched[k].name, mean);
    }
    free(R[0]);
    free(draw);
    json_decref(scene);
    json_decref(turned);
}

void check_noise_images(struct check_run *run)
{
    for (int axis = 0; axis < 3; axis++)
        for (int other = -1; other <= 1; other++)
            try_place(run, axis, 0.5 * other);
}
