/*
 * Layer 6: two dimensions
 *
 * Spheres with their centres in a plane, sheared in it (dimensions 2). With everything on that acts, noise too, nothing may leave the plane:
 *
 *     z = 0 ,   u_z = 0 ,   w_x = w_y = 0          exactly, at every step
 *
 * Without noise the plane is a symmetry of three dimensions too: the same spheres in a scene of three dimensions take the same path, to
 * rounding. So 2D needs no reference: it is the 3D code with the motions taken away that symmetry would not make.
 */
#include "two_bodies.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Spheres of both species by turns on a square lattice with a little disorder, moving with the flow and at random, in the plane. */
static struct state_row *start_flat(struct check_run *run, const struct model *m, size_t across, double kT)
{
    struct state_row *row = calloc(across * across, sizeof *row);
    gsl_rng *random = pair_random(run);
    for (size_t i = 0; row && i < across * across; i++) {
        const size_t place[2] = { i % across, i / across };
        const int species = (int)((place[0] + place[1]) % 2);
        const double a = m->radius[species], mass = 4.0 / 3.0 * M_PI * m->density[species] * a * a * a;
        row[i] = (struct state_row){ .id = (int)i + 1, .species = species + 1 };
        for (int k = 0; k < 2; k++) {
            row[i].x[k] = ((double)place[k] + 0.5 + 0.02 * gsl_ran_gaussian(random, 1.0)) * m->cell[k][k] / (double)across;
            row[i].u[k] = gsl_ran_gaussian(random, sqrt(kT / mass));
        }
        row[i].u[0] += m->gradient[0][1] * row[i].x[1];
        row[i].w[2] = -0.5 * m->gradient[0][1] + gsl_ran_gaussian(random, sqrt(kT / (0.4 * mass * a * a)));
    }
    gsl_rng_free(random);
    return row;
}

static void judge_plane(struct check_run *run, const struct track *t)
{
    double most = 0.0, motion = 0.0;
    size_t who = 0;
    for (size_t k = 0; k < t->steps * t->count; k++) {
        const struct track_point *p = &t->point[k];
        const double off[4] = { p->x[2], p->u[2], isfinite(p->w[0]) ? p->w[0] : 0.0, isfinite(p->w[1]) ? p->w[1] : 0.0 };
        motion = fmax(motion, fabs(p->u[1]));
        for (int c = 0; c < 4; c++)
            if (!(fabs(off[c]) <= most)) {
                most = fabs(off[c]);
                who = k % t->count;
            }
    }
    check_error(run, INVARIANT, "nothing leaves the plane", most, 0.0, motion > 0.0 ? most : NAN, 0.0,
                "in two dimensions sphere %zu leaves the plane: z, u_z, w_x or w_y is %.3g and not exactly 0", who + 1, most);
}

void check_flat(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t across = (size_t)scene_number(parameters, "across", 0), count = across * across;
    const int steps = (int)scene_number(parameters, "steps", 0);
    json_t *scene = json_deep_copy(run->gate_case->scene), *calm = json_deep_copy(run->gate_case->scene), *solid;
    const double kT = scene_number(scene, "fluid.kT", NAN);
    struct model m;
    struct track noisy, flat, full;
    int at[32];
    for (int k = 0; k < 32; k++)
        at[k] = steps / 32 * (k + 1);
    if (!model_read(run, scene, &m))
        return;
    struct state_row *row = start_flat(run, &m, across, kT);
    scene_set(calm, "fluid.kT", json_real(0.0));
    solid = json_deep_copy(calm);
    scene_set(solid, "dimensions", json_integer(3));
    if (row && track_ask(run, "with-noise", scene, row, count, at, 32, &noisy)) {
        judge_plane(run, &noisy);
        track_free(&noisy);
    }
    if (row && track_ask(run, "two-dimensions", calm, row, count, at, 32, &flat)) {
        if (track_ask(run, "three-dimensions", solid, row, count, at, 32, &full)) {
            struct worst w = WORST_NONE;
            for (size_t k = 0; k < 32 * count; k++)
                worst_see_vector(&w, flat.point[k].x, full.point[k].x, 9, 1.0, k % count);
            check_error(run, INVARIANT, "the path of three dimensions", w.measured, w.expected, w.error, run->gate_case->tolerance,
                        "without noise spheres in a plane move otherwise in two dimensions than in three: sphere %zu has %s", w.at + 1, compare(&w));
            track_free(&full);
        }
        track_free(&flat);
    }
    free(row);
    json_decref(scene);
    json_decref(calm);
    json_decref(solid);
}
