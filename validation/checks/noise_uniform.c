/*
 * Layer 2: uniform random numbers of the right width
 *
 * Drag noise of distribution `uniform` has the variance of the Gaussian one, 2 kT/dt times the drag, so each number is uniform on
 *
 *     (-1, 1) sqrt(3) g ,   g^2 = (2 kT/dt) 6 pi eta a   or   (2 kT/dt) 8 pi eta a^3
 *
 * (a uniform number on (-1/2, 1/2) has the variance 1/12; "sqrt(12) too much" was once reported as a bug and is none). The ends say both
 * mean and variance, and thousands of draws come so near to them that no statistics are needed: the chance that none of n draws
 * falls within a share s of an end is (1 - s/2)^n, below 1e-15 for the numbers of the case.
 */
#include "noise.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Where the drag has no torque its noise has none. */
static void judge_no_torque(struct check_run *run, const double *draw, size_t draws, int part)
{
    double largest = 0.0;
    char name[64];
    for (size_t t = 0; t < draws; t++)
        for (int c = 0; c < 3; c++)
            largest = fmax(largest, fabs(draw[12 * t + (size_t)(3 * part + c)]));
    snprintf(name, sizeof name, "no torque on sphere %d", part / 2 + 1);
    check_error(run, INVARIANT, name, largest, 0.0, largest, run->gate_case->tolerance, "%s: noise turns it by up to %.4g, in units of the root of 2 kT/dt, "
                "though the drag, whose fluctuation it is, has no torque", name, largest);
}

void check_uniform(struct check_run *run)
{
    struct model m;
    struct state_row row[2] = { { .id = 1, .species = 1 }, { .id = 2, .species = 2 } };
    struct frozen f = { .count = 2 };
    json_t *scene = json_deep_copy(run->gate_case->scene);
    const size_t draws = (size_t)scene_number(run->gate_case->parameters, "draws", 0);
    const double kT = scene_number(scene, "fluid.kT", NAN), dt = scene_number(scene, "dynamics.verlet.dt", NAN);
    char out[PATH_LENGTH];
    double *draw = NULL;
    if (!model_read(run, scene, &m))
        return;
    row[1].x[0] = 0.5 * m.cell[0][0];
    scene_set(scene, "seed", json_integer(run->seed));
    const struct question q = { .protocol = "noise", .scene = scene, .state = row, .states = 2, .draws = draws };
    if (check_ask(run, "draws", &q, out))
        draw = noise_draws(run, out, "noise_drag_noise.npy", draws, &f, sqrt(2.0 * kT / dt));
    for (int part = 0; part < 4 && draw; part++) {
        if (part % 2 && !m.drag_torque) {
            judge_no_torque(run, draw, draws, part);
            continue;
        }
        const double a = m.radius[part / 2], friction = part % 2 ? 8.0 * M_PI * m.viscosity * a * a * a : 6.0 * M_PI * m.viscosity * a;
        double low = INFINITY, high = -INFINITY;
        for (size_t t = 0; t < draws; t++)
            for (int c = 0; c < 3; c++) {
                const double z = draw[12 * t + (size_t)(3 * part + c)] / sqrt(3.0 * friction);
                low = fmin(low, z);
                high = fmax(high, z);
            }
        char name[64];
        snprintf(name, sizeof name, "uniform %s of sphere %d", part % 2 ? "torque" : "force", part / 2 + 1);
        check_error(run, INVARIANT, name, high, 1.0, fmax(fabs(high - 1.0), fabs(low + 1.0)), run->gate_case->tolerance,
                    "%s: reaches from %.4g to %.4g; with the variance of (2 kT/dt) times the drag uniform numbers reach from -1 to 1 (in units of sqrt 3 "
                    "standard deviations)", name, low, high);
    }
    free(draw);
    json_decref(scene);
}
