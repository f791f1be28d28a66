/*
 * Layer 2: the noise of a pair that meets through several faces
 *
 * Two spheres half a cell apart, in a cell so short that each feels the other on both sides, through films of the same width. Both films resist
 * a motion along the line, so both have their own noise, and for sphere 1
 *
 *     <F_x^2> = (2 kT/dt) R_xx ,   <T_y^2> = (2 kT/dt) R_yy of spins          R the candidate's own, all films together
 *
 * and likewise along y and z, for a code may look at one edge of the cell only. Half a cell apart along two axes there are four films, through
 * images that differ in both counts of cells; on which side of sphere 1 sphere 2 lies decides about the signs of these. In a leaning cell a
 * vector of the lattice may be short though no edge is.
 *
 * One set of random numbers for two films would double the first (equal pushes add up) and change the second. A ratio near 1 is asked for, by
 * an interval of four standard errors.
 */
#include "noise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Two spheres at x in the cell of `scene`, which is given up; three diagonal entries of R that are looked at, with a name each. */
struct films { const char *place, *how_many; double x[2][3]; struct { size_t at; const char *name; } watched[3]; };

static void judge_films(struct check_run *run, const struct films *t, json_t *turned)
{
    static const char *const lubrication[1] = { "lubrication" };
    struct model m;
    struct frozen f = { .count = 2, .sizes = 1 };
    const size_t draws = (size_t)scene_number(run->gate_case->parameters, "draws", 0);
    char out[PATH_LENGTH], name[96];
    if (!model_read(run, turned, &m)) {
        json_decref(turned);
        return;
    }
    f.size[0] = f.radius[0] = f.radius[1] = m.radius[0];
    f.species[0] = f.species[1] = 1;
    memcpy(f.x, t->x, sizeof t->x);
    json_t *scene = frozen_scene(run, &f);
    scene_set(scene, "box", json_incref(scene_get(turned, "box")));
    json_decref(turned);
    const double kT = scene_number(scene, "fluid.kT", NAN), dt = scene_number(scene, "dynamics.verlet.dt", NAN);
    double *R[1] = { calloc(144, sizeof(double)) }, *draw = NULL;
    struct state_row row[2];
    for (size_t i = 0; i < 2; i++) {
        row[i] = (struct state_row){ .id = (int)i + 1, .species = 1 };
        memcpy(row[i].x, f.x[i], sizeof row[i].x);
    }
    const struct question q = { .protocol = "noise", .scene = scene, .state = row, .states = 2, .draws = draws };
    snprintf(name, sizeof name, "columns-of-R-%s", t->place);
    const bool measured = measure_resistance(run, name, scene, &f, 1, lubrication, R);
    snprintf(name, sizeof name, "draws-%s", t->place);
    if (measured && check_ask(run, name, &q, out))
        draw = noise_draws(run, out, "noise_lubrication_noise.npy", draws, &f, sqrt(2.0 * kT / dt));
    for (size_t k = 0; k < 3 && draw; k++) {
        const size_t at = t->watched[k].at;
        double sum = 0.0, squares = 0.0;
        for (size_t d = 0; d < draws; d++) {
            const double z = draw[12 * d + at] * draw[12 * d + at] / R[0][13 * at];
            sum += z;
            squares += z * z;
        }
        const double mean = sum / (double)draws, error = sqrt((squares / (double)draws - mean * mean) / (double)draws);
        snprintf(name, sizeof name, "%s: %s", t->place, t->watched[k].name);
        check_interval(run, INVARIANT, name, mean, error, 1.0, 0.2, "%s films between the same spheres, %s: the variance of the %s is %.4g times what "
                       "the candidate's own resistance asks for; some draw the same random numbers, or one draws none", t->how_many, t->place,
                       t->watched[k].name, mean);
    }
    free(R[0]);
    free(draw);
    json_decref(scene);
}

/* Where sphere 2 lies: half a cell along `axis`, and along the next axis by `other` cells: none, a half, or a half to the other side. */
static void try_place(struct check_run *run, int axis, double other)
{
    const size_t first = (size_t)axis, second = (size_t)(axis + 1) % 3;
    struct films t = { .how_many = other == 0.0 ? "two" : "four", .watched = { { first, "force along the line" }, { second, "force across it" },
                                                                               { 3 + second, "torque across it" } } };
    char place[32];
    json_t *scene = json_deep_copy(run->gate_case->scene), *lengths = json_array();
    const double edge = scene_number(run->gate_case->parameters, "edge", NAN) / (other == 0.0 ? 1.0 : sqrt(2.0));
    for (size_t k = 0; k < 3; k++) {
        const bool is_short = k == first || (k == second && other != 0.0);
        const double length = is_short ? edge : json_number_value(json_array_get(scene_get(scene, "box.lengths"), k));
        json_array_append_new(lengths, json_real(length));
        t.x[0][k] = (k == second && other < 0.0 ? 0.71 : 0.21) * length;
        t.x[1][k] = t.x[0][k] + (k == first ? 0.5 : k == second ? other : 0.0) * length;
    }
    scene_set(scene, "box.lengths", lengths);
    snprintf(place, sizeof place, other == 0.0 ? "%c" : other > 0.0 ? "%c%c" : "%c%c-mirrored", "xyz"[first], "xyz"[second]);
    t.place = place;
    judge_films(run, &t, scene);
}

/* A cell all of whose edges and widths are long, but not the difference of two edges: images one apart along both are neighbours. */
static void try_lean(struct check_run *run)
{
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct model m;
    if (!model_read(run, scene, &m)) {
        json_decref(scene);
        return;
    }
    const double a = m.radius[0], up = a * sqrt(gsl_pow_2(scene_number(run->gate_case->parameters, "edge", NAN) / (2.0 * a)) - 2.0);
    struct films t = { .place = "lean", .how_many = "two", .watched = { { 0, "force along x" }, { 2, "force along z" }, { 5, "torque about z" } },
                       .x = { { 5.0 * a, 5.0 * a, a }, { 6.0 * a, 4.0 * a, a + up } } };
    json_object_del(scene_get(scene, "box"), "lengths");
    scene_set(scene, "box.cell", json_pack("[[fff][fff][fff]]", 6.0 * a, 4.0 * a, 0.0, 4.0 * a, 6.0 * a, 0.0, 0.0, 0.0, 8.0 * a));
    judge_films(run, &t, scene);
}

/* Two spheres far from each other that face their own images along x: a film that resists spins only, and makes noise only for them. */
static void try_own(struct check_run *run)
{
    json_t *scene = json_deep_copy(run->gate_case->scene), *lengths = json_deep_copy(scene_get(scene, "box.lengths"));
    const double edge = 0.5 * scene_number(run->gate_case->parameters, "edge", NAN);
    struct films t = { .place = "own", .how_many = "own", .watched = { { 4, "torque about y" }, { 5, "torque about z" }, { 10, "torque on the second" } },
                       .x = { { 0.3, 1.0, 1.0 }, { 0.9, 5.5, 5.0 } } };
    json_array_set_new(lengths, 0, json_real(edge));
    scene_set(scene, "box.lengths", lengths);
    judge_films(run, &t, scene);
}

void check_noise_images(struct check_run *run)
{
    for (int axis = 0; axis < 3; axis++)
        for (int other = -1; other <= 1; other++)
            try_place(run, axis, 0.5 * other);
    try_lean(run);
    try_own(run);
}
