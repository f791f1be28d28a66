/*
 * Noise from steps, and the reading of their answers. Very heavy spheres start at rest; only their drag and one noise act, and the drag of what the noise
 * gives them stays a millionth of it. In velocity Verlet u(n+1) - u(n) = dt/(2 m) (N(n) + N(n+1)) with the noises N of two successive evaluations:
 * neighbouring changes share one, but every other change is independent of the rest, has half the variance of N, and so is a draw once it is
 * multiplied by sqrt(2). A scheme that uses each noise once gives a draw a step.
 */
#include "level_b.h"

#include "geometry.h"
#include "plain.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Whether the start that the candidate tells is the start that it was given; spins are 0 where nothing turns spheres. */
static bool same_start(const double *told, const struct state_row *given, double roundoff)
{
    double size = 0;
    for (int k = 0; k < 3; k++)
        size = fmax(size, fmax(fabs(given->u[k]), fabs(given->w[k])));
    const int numbers = told[3] == 0 && told[4] == 0 && told[5] == 0 ? 3 : 6;
    for (int k = 0; k < numbers; k++)
        if (!(fabs(told[k] - (k < 3 ? given->u[k] : given->w[k - 3])) <= (1e-9 + 10 * roundoff) * size))
            return false;
    return true;
}

static bool read_binary(const char *path, const struct question *q, size_t states, size_t particles, double (**value)[6], char why[WHY_LENGTH])
{
    size_t shape[3] = { states * (q->steps + 1), particles, 6 };
    double *data;
    const bool good = npy_read(path, 3, shape, &data, why);
    *value = (double (*)[6])data;
    return good;
}

bool steps_read(const char *out, const struct question *q, size_t states, size_t particles, double (**value)[6], char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    struct table t;
    path_join(path, out, "velocities.npy");
    if (access(path, R_OK) == 0)
        return read_binary(path, q, states, particles, value, why);
    path_join(path, out, "trajectory.csv");
    if (!table_read(path, "state,step,id,ux,uy,uz,wx,wy,wz", &t, why))
        return false;
    const size_t all = states * (q->steps + 1) * particles;
    char *seen = calloc(all + 1, 1);
    *value = calloc(all + 1, sizeof **value);
    bool good = true;
    for (size_t r = 0; r < t.rows && good; r++) {
        const double state = table_at(&t, r, 0), step = table_at(&t, r, 1), id = table_at(&t, r, 2);
        if (step > (double)q->steps)
            continue;
        if (!(state >= 0 && state < (double)states && state == floor(state)))
            good = why_not(why, "%s: state %g does not exist; states run from 0 to %zu", path, state, states - 1);
        else if (!(step >= 0 && step == floor(step)))
            good = why_not(why, "%s: state %g has a step %g; steps are whole numbers from 0", path, state, step);
        else if (!(id >= 1 && id <= (double)particles && id == floor(id)))
            good = why_not(why, "%s: state %g, step %g has a particle with id %g; ids run from 1 to %zu", path, state, step, id, particles);
        if (!good)
            break;
        const size_t at = ((size_t)state * (q->steps + 1) + (size_t)step) * particles + (size_t)id - 1;
        if (seen[at]++)
            good = why_not(why, "%s: state %g, step %g, id %g has two rows", path, state, step, id);
        for (size_t k = 0; k < 6; k++)
            (*value)[at][k] = table_at(&t, r, 3 + k);
    }
    for (size_t at = 0; at < all && good; at++)
        good = seen[at] || why_not(why, "%s: no row for state %zu, step %zu, id %zu", path, at / particles / (q->steps + 1), at / particles % (q->steps + 1),
                                   at % particles + 1);
    free(seen);
    table_free(&t);
    if (!good) {
        free(*value);
        *value = NULL;
    }
    return good;
}

/* False where velocities of step 0 are others than those given. */
bool steps_start(const char *out, const struct question *q, size_t states, size_t particles, const double (*value)[6], double roundoff,
                 char why[WHY_LENGTH])
{
    for (size_t r = 0; r < states * particles; r++)
        if (!same_start(value[(r / particles * (q->steps + 1)) * particles + r % particles], &q->state[r], roundoff))
            return why_not(why, "%s: state %zu, step 0, id %zu does not have the velocity and spin that were given: another order of the particles, or too few "
                           "digits (17 keep a double; a program that has fewer says so in its capabilities, \"precision\")", out, r / particles, r % particles + 1);
    return true;
}

/*
 * The scene with this noise alone, the drag that belongs to it, and every density `times` as large. Of a flow only the cell of this moment is left: noise
 * does not depend on the flow, but over thousands of steps images would move away.
 */
static json_t *heavy_scene(const struct question *q, const char *noise, double times)
{
    const double dt = scene_number(q->scene, "dynamics.verlet.dt", NAN);
    const char *friction = strcmp(noise, "drag_noise") == 0 ? "drag" : "lubrication";
    json_t *scene = steps_scene(q->scene, dt), *forces = scene_get(q->scene, "forces"), *species;
    double cell[3][3], gradient[3][3];
    size_t k;
    if (scene_number(scene, "start.time", 0) != 0 && json_array_size(scene_get(scene, "shear")) > 0 && scene_cell(scene, cell, gradient)) {
        scene_set(scene, "box.cell", json_pack("[[fff][fff][fff]]", cell[0][0], cell[0][1], cell[0][2], cell[1][0], cell[1][1], cell[1][2], cell[2][0],
                                               cell[2][1], cell[2][2]));
        json_object_del(scene_get(scene, "box"), "lengths");
        scene_set(scene, "start.time", json_integer(0));
    }
    json_object_del(scene, "shear");
    scene_set(scene, "forces", json_pack("{sOsO}", friction, json_object_get(forces, friction), noise, json_object_get(forces, noise)));
    json_array_foreach(scene_get(scene, "species"), k, species)
        json_object_set_new(species, "density", json_real(times * scene_number(species, "density", NAN)));
    return scene;
}

/*
 * How much heavier: after n steps the spheres have sqrt(n) impulses sqrt(2 kT R dt) and have gone n^(3/2) of one; the drag of the former shall be a
 * millionth of a noise, the latter a millionth of the smallest gap that matters, a thousandth of a radius.
 */
static double heaviness(const struct question *q, double n)
{
    const double kT = scene_number(q->scene, "fluid.kT", 0), dt = scene_number(q->scene, "dynamics.verlet.dt", NAN);
    double *friction = calloc(2 * q->states + 1, sizeof *friction), times = 1;
    estimate_friction(q->scene, q->state, q->states, friction, friction + q->states);
    for (size_t r = 0; r < q->states; r++) {
        const double m = mass_of_row(q->scene, &q->state[r]), a = species_number(q->scene, q->state[r].species, "radius");
        times = fmax(times, fmax(sqrt(n) * friction[r] * dt / (1e-6 * m), pow(n, 1.5) * sqrt(2 * kT * friction[r] * dt) * dt / (1e-9 * a * m)));
    }
    free(friction);
    return times;
}

static bool one_noise(struct check_run *run, const char *name, const struct question *q, const char *noise, const char *answer)
{
    const bool shared = run->candidate->capabilities->integrator == INTEGRATOR_VERLET;
    const size_t every = shared ? 2 : 1, N = q->states, steps = every * q->draws;
    const double times = heaviness(q, (double)steps), dt = scene_number(q->scene, "dynamics.verlet.dt", NAN);
    char out[PATH_LENGTH], path[PATH_LENGTH], file[64], why[WHY_LENGTH];
    struct state_row *row = calloc(N, sizeof *row);
    json_t *scene = heavy_scene(q, noise, times);
    double (*v)[6] = NULL, *draw = NULL;
    memcpy(row, q->state, N * sizeof *row);
    for (size_t i = 0; i < N; i++)
        for (int k = 0; k < 3; k++)
            row[i].u[k] = row[i].w[k] = 0;
    const struct question asked = { .protocol = "steps", .scene = scene, .state = row, .states = N, .steps = steps };
    bool good = check_ask_part(run, name, noise, &asked, out);
    if (good && !(good = steps_read(out, &asked, 1, N, &v, why)))
        check_garbage(run, why);
    if (good) {
        draw = malloc(q->draws * N * 6 * sizeof *draw);
        for (size_t d = 0; d < q->draws; d++)
            for (size_t i = 0; i < N; i++) {
                const double m = times * mass_of_row(q->scene, &row[i]), I = 0.4 * m * pow(species_number(q->scene, row[i].species, "radius"), 2);
                for (size_t k = 0; k < 6; k++)
                    draw[(d * N + i) * 6 + k] = (shared ? sqrt(2) : 1) * (k < 3 ? m : I) / dt * (v[(every * d + 1) * N + i][k] - v[every * d * N + i][k]);
            }
        snprintf(file, sizeof file, "noise_%s.npy", noise);
        path_join(path, answer, file);
        if (!(good = npy_write(path, q->draws, N, draw, why)))
            check_garbage(run, why);
    }
    free(draw);
    free(v);
    free(row);
    json_decref(scene);
    return good;
}

bool level_b_noise(struct check_run *run, const char *name, const struct question *q, const char *out)
{
    static const char *const noises[] = { "drag_noise", "lubrication_noise" };
    if (isnan(scene_number(q->scene, "dynamics.verlet.dt", NAN))) {
        check_skip(run, name, "%s asks for the noise of another integrator than verlet, which steps do not show (level B)", name);
        return false;
    }
    const char *distribution = json_string_value(scene_get(q->scene, "forces.drag_noise.distribution"));
    if (run->candidate->capabilities->integrator == INTEGRATOR_VERLET && distribution && strcmp(distribution, "uniform") == 0) {
        check_skip(run, name, "%s asks how far uniform numbers reach; steps of velocity Verlet show the sum of two (level B)", name);
        return false;
    }
    for (int k = 0; k < 2; k++)
        if (scene_get(scene_get(q->scene, "forces"), noises[k]) && !one_noise(run, name, q, noises[k], out))
            return false;
    return true;
}
