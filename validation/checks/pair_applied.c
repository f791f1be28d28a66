/* Constant forces and torques by species on frozen spheres, wherever they are and however they move; nothing for those not named. */
#include "pair_checks.h"

void scene_applied(const json_t *scene, size_t kind, double load[6])
{
    const json_t *species = json_array_get(scene_get(scene, "species"), kind);
    const json_t *own = json_object_get(scene_get(scene, "forces.applied"), json_string_value(json_object_get(species, "name")));
    for (size_t k = 0; k < 6; k++)
        load[k] = json_number_value(json_array_get(json_object_get(own, k < 3 ? "force" : "torque"), k % 3));
}

void pair_applied(struct check_run *run)
{
    const json_t *scene = run->gate_case->scene;
    struct model m;
    struct pair_book book = { 0 };
    struct pair_answer answer = { 0 };
    if (!model_read(run, scene, &m))
        return;
    gsl_rng *random = pair_random(run);
    for (size_t a = 0; a < m.species; a++)
        for (size_t b = 0; b < m.species; b++) {
            const struct pair_state p = random_pair(random, m.radius[a], m.radius[b], 0.7);
            book_add(&book, &p);
        }
    gsl_rng_free(random);
    if (book_ask(run, "pairs", run->gate_case->scene, &book, "applied,total", &answer)) {
        struct worst force = WORST_NONE, torque = WORST_NONE, total = WORST_NONE;
        for (size_t k = 0; k < book.count; k++)
            for (int side = 0; side < 2; side++) {
                double expected[6];
                const double *own = forces_at(&answer.forces, k, "applied", 1 + side);
                scene_applied(scene, side ? k % m.species : k / m.species, expected);
                worst_see_vector(&force, own, expected, 3, 1, k);
                worst_see_vector(&torque, own + 3, expected + 3, 3, 1, k);
                worst_see_vector(&total, forces_at(&answer.forces, k, "total", 1 + side), own, 6, 1, k);
            }
        const double tolerance = run->gate_case->tolerance;
        check_error(run, MODEL, "force", force.measured, force.expected, force.error, tolerance, "the force of its species is %s; worst at %s",
                    compare(&force), describe(&book.item[force.at], force.at));
        check_error(run, MODEL, "torque", torque.measured, torque.expected, torque.error, tolerance,
                    "the torque of its species is %s; worst at %s", compare(&torque), describe(&book.item[torque.at], torque.at));
        check_error(run, INVARIANT, "total = sum of parts", total.measured, total.expected, total.error, tolerance,
                    "`total` is not the applied force: %s", compare(&total));
    }
    forces_free(&answer.forces);
    book_free(&book);
}
