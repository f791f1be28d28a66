/*
 * Layer 3: a sphere on a harmonic tether, without noise
 *
 *     x(t) = x(0) + U(0) sin(w t)/w,   U(t) = U(0) cos(w t),   w = sqrt(k/m),   k by species; without a tether it flies on
 *
 * The swing is as wide as the cell, so that spheres cross its faces, and the tether must not notice; nor a shear of the cell, with no liquid
 * to carry them; nor hundreds of cells, of which some code counts no more than 127. A scheme of second order is
 * wrong by (w dt)^2/24 of its phase and (w dt)^2/8 of its swing; allowed is (w dt)^2/6 of (phase + 1).
 */
#include "single.h"

#include <stdio.h>

enum { SPHERES = 6 };

static double stiffness_of(const json_t *scene, size_t kind)
{
    const json_t *species = json_array_get(scene_get(scene, "species"), kind);
    return scene_number(json_object_get(scene_get(scene, "forces.tether"), json_string_value(json_object_get(species, "name"))), "stiffness", 0);
}

static void try_variant(struct check_run *run, const json_t *variant)
{
    const char *label = json_string_value(json_object_get(variant, "name"));
    json_t *scene = variant_scene(run->gate_case, variant);
    const double dt = scene_number(scene, "dynamics.verlet.dt", NAN);
    struct model m;
    struct track track;
    struct state_row start[SPHERES];
    struct worst place = WORST_NONE, velocity = WORST_NONE;
    double list[16];
    int at[16];
    size_t steps;
    char what[96];
    if (!model_read(run, scene, &m)) {
        json_decref(scene);
        return;
    }
    gsl_rng *random = pair_random(run);
    for (int i = 0; i < SPHERES; i++) {
        start[i] = (struct state_row){ .id = i + 1, .species = 1 + i % (int)m.species };
        for (int k = 0; k < 3; k++)
            start[i].x[k] = gsl_rng_uniform(random) * m.cell[k][k];
        random_vector(random, scene_number(variant, "speed", NAN), start[i].u);
    }
    gsl_rng_free(random);
    parameter_list(run->gate_case->parameters, "at", list, &steps, 16);
    for (size_t k = 0; k < steps; k++)
        at[k] = (int)list[k];
    const bool good = track_ask(run, label, scene, start, SPHERES, at, steps, &track);
    for (size_t s = 0; good && s < steps; s++)
        for (size_t i = 0; i < SPHERES; i++) {
            const size_t kind = i % m.species;
            const double w = sqrt(stiffness_of(scene, kind) / (4.0 / 3.0 * M_PI * m.density[kind] * pow(m.radius[kind], 3))), t = at[s] * dt;
            const double late = w * w * dt * dt / 6.0 * (w * t + 1.0) + check_rounding(run, 1e-11), speed = norm(start[i].u);
            for (int k = 0; k < 3; k++) {
                const double swing = w > 0 ? sin(w * t) / w : t;
                worst_see(&place, track_at(&track, s, i)->x[k], start[i].x[k] + swing * start[i].u[k], late * speed * (w > 0 ? 1 / w : t), i);
                worst_see(&velocity, track_at(&track, s, i)->u[k], cos(w * t) * start[i].u[k], late * speed, i);
            }
        }
    json_decref(scene);
    if (!good)
        return;
    track_free(&track);
    snprintf(what, sizeof what, "%s: place", label);
    check_error(run, MODEL, what, place.measured, place.expected, place.error, run->gate_case->tolerance,
                "%s: sphere %zu swings about its start by U sin(w t)/w, or flies on, unwrapped; its place is %s", label, place.at + 1, compare(&place));
    snprintf(what, sizeof what, "%s: velocity", label);
    check_error(run, MODEL, what, velocity.measured, velocity.expected, velocity.error, run->gate_case->tolerance,
                "%s: sphere %zu swings with U cos(w t), or flies on; its velocity is %s", label, velocity.at + 1, compare(&velocity));
}

void check_tether(struct check_run *run)
{
    size_t k;
    json_t *variant;
    json_array_foreach(json_object_get(run->gate_case->parameters, "variants"), k, variant)
        try_variant(run, variant);
}
