/*
 * Layer 3: a thermal start
 *
 *     <m c_k^2> = <I w_k^2> = kT ,   c = U - U_inf(x) ,   w = W - Omega_inf           k = x, y, z, each species
 *
 * `start.thermal` adds Maxwell's velocities and spins to those of the file, which here are the flow's own. Looked at before anything has moved:
 * thousands of spheres in shear, temperature and sizes far from 1, where a missing root or mass is an obvious factor. Numbers of different spheres,
 * axes, and of velocity and spin are independent: their mean products vanish. So does the product of a velocity and the noise of the first step,
 * c(dt) - c(0) (1 - gamma dt): who draws both from one stream starts with spheres that are kicked onward.
 */
#include "single.h"

#include <stdlib.h>
#include <string.h>

/* Mean of numbers that should have this mean, with its standard error from their own scatter. */
struct average { double sum, squares, n; };

static void average_see(struct average *a, double x)
{
    a->sum += x;
    a->squares += x * x;
    a->n += 1.0;
}

static void judge(struct check_run *run, const char *what, const struct average *a, double expected, double margin, const char *meaning)
{
    const double mean = a->sum / a->n, error = sqrt((a->squares / a->n - mean * mean) / a->n);
    check_interval(run, INVARIANT, what, mean, error, expected, margin, "%s: %s is %.4g and not %.4g", what, meaning, mean, expected);
}

void check_thermal(struct check_run *run)
{
    const size_t count = (size_t)scene_number(run->gate_case->parameters, "spheres", 0);
    json_t *scene = json_deep_copy(run->gate_case->scene);
    const double kT = scene_number(scene, "fluid.kT", NAN), dt = scene_number(scene, "dynamics.verlet.dt", NAN);
    struct model m;
    struct track track;
    const int at[2] = { 0, 1 };
    if (!model_read(run, scene, &m))
        return;
    struct state_row *row = calloc(count, sizeof *row);
    gsl_rng *random = pair_random(run);
    double spin[3];
    for (int k = 0; k < 3; k++)
        spin[k] = 0.5 * (m.gradient[(k + 2) % 3][(k + 1) % 3] - m.gradient[(k + 1) % 3][(k + 2) % 3]);
    for (size_t i = 0; row && i < count; i++) {
        row[i] = (struct state_row){ .id = (int)i + 1, .species = (int)(i % 2) + 1 };
        for (int k = 0; k < 3; k++)
            row[i].x[k] = gsl_rng_uniform(random) * m.cell[k][k];
        apply(m.gradient, row[i].x, row[i].u);
        memcpy(row[i].w, spin, sizeof spin);
    }
    gsl_rng_free(random);
    scene_set(scene, "start.thermal", json_true());
    scene_set(scene, "seed", json_integer(run->seed));
    if (row && track_ask(run, "start", scene, row, count, at, 2, &track)) {
        struct average T[2] = { { 0 } }, W[2] = { { 0 } }, neighbours = { 0 }, axes = { 0 }, both = { 0 }, kicks = { 0 };
        double before[6] = { 0 };
        for (size_t i = 0; i < count; i++) {
            const struct track_point *p = track_at(&track, 0, i);
            const int species = row[i].species - 1;
            const double a = m.radius[species], mass = 4.0 / 3.0 * M_PI * m.density[species] * a * a * a, inertia = 0.4 * mass * a * a;
            double z[6];
            for (int k = 0; k < 3; k++) {
                z[k] = (p->u[k] - row[i].u[k]) * sqrt(mass / kT);
                z[3 + k] = (p->w[k] - row[i].w[k]) * sqrt(inertia / kT);
                average_see(&T[species], z[k] * z[k]);
                average_see(&W[species], z[3 + k] * z[3 + k]);
            }
            for (int k = 0; k < 6 && i > 0; k++)
                average_see(&neighbours, z[k] * before[k]);
            for (int k = 0; k < 3; k++) {
                average_see(&axes, z[k] * z[(k + 1) % 3]);
                average_see(&axes, z[3 + k] * z[3 + (k + 1) % 3]);
                average_see(&both, z[k] * z[3 + k]);
            }
            memcpy(before, z, sizeof z);
            const struct track_point *next = track_at(&track, 1, i);
            const double friction[2] = { 6 * M_PI * m.viscosity * a / mass, 8 * M_PI * m.viscosity * a * a * a / inertia };
            double flow[3];
            apply(m.gradient, next->x, flow);
            for (int k = 0; k < 6; k++) {
                const double after = k < 3 ? (next->u[k] - flow[k]) * sqrt(mass / kT) : (next->w[k - 3] - row[i].w[k - 3]) * sqrt(inertia / kT);
                average_see(&kicks, z[k] * (after - z[k] * (1.0 - friction[k / 3] * dt)) / sqrt(2.0 * friction[k / 3] * dt));
            }
        }
        judge(run, "small: translation", &T[0], 1.0, 0.1, "the kinetic temperature over kT");
        judge(run, "large: translation", &T[1], 1.0, 0.1, "the kinetic temperature over kT");
        judge(run, "small: rotation", &W[0], 1.0, 0.1, "the kinetic temperature over kT");
        judge(run, "large: rotation", &W[1], 1.0, 0.1, "the kinetic temperature over kT");
        judge(run, "different spheres", &neighbours, 0.0, 0.06, "the correlation of sphere i with sphere i + 1");
        judge(run, "different axes", &axes, 0.0, 0.06, "the correlation of one axis with the next");
        judge(run, "start and first kick", &kicks, 0.0, 0.06, "the correlation of a velocity or spin with the noise of the first step");
        judge(run, "velocity and spin", &both, 0.0, 0.06, "the correlation of velocity and spin");
        track_free(&track);
    }
    free(row);
    json_decref(scene);
}
