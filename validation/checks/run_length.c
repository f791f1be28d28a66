/*
 * Layer 3: how long a run is
 *
 * `steps`, or a time (a duration, whenever the run began), or a strain (over the largest rate of steady shear), or until the last stage ends: a
 * duration is rounded up to whole steps. Read off the last row of stress.csv; the time of a row is that of the start and as many steps, its strain the
 * largest |rate| times the time since the start.
 */
#include "single.h"

#include <stdio.h>
#include <stdlib.h>

/* The largest |rate| of the shears, one by one. */
static double fastest(const json_t *scene)
{
    double rate = 0.0;
    size_t k;
    json_t *shear;
    json_array_foreach(scene_get(scene, "shear"), k, shear)
        rate = fmax(rate, fabs(scene_number(shear, "rate", 0.0)));
    return rate;
}

void check_run_length(struct check_run *run)
{
    size_t k;
    json_t *variant;
    json_array_foreach(json_object_get(run->gate_case->parameters, "runs"), k, variant)
    {
        json_t *scene = variant_scene(run->gate_case, variant);
        const char *name = json_string_value(json_object_get(variant, "name"));
        const double steps = scene_number(variant, "last", NAN), begin = scene_number(scene, "start.time", 0.0), dt = scene_number(scene, "dynamics.verlet.dt", NAN);
        char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH], what[96];
        struct state_row row = { .id = 1, .species = 1, .x = { 1.0, 2.0, 3.0 } };
        struct table t;
        if (json_object_get(variant, "stages"))
            scene_set(scene, "stages", json_incref(json_object_get(variant, "stages")));
        scene_set(scene, "start.file", json_string("states.csv"));
        scene_set(scene, "run", json_incref(json_object_get(variant, "run")));
        scene_set(scene, "output.stress", json_pack("{si}", "every", 1));
        const struct question q = { .protocol = "run", .scene = scene, .state = &row, .states = 1 };
        if (name && check_ask(run, name, &q, out)) {
            path_join(path, out, "stress.csv");
            if (table_read(path, "step,time,strain", &t, why)) {
                const double last = t.rows ? table_at(&t, t.rows - 1, 0) : NAN, time = t.rows ? table_at(&t, t.rows - 1, 1) : NAN;
                snprintf(what, sizeof what, "%s: steps", name);
                check_error(run, INVARIANT, what, last, steps, fabs(last - steps), 0.0, "%s: the run ends with step %g where %g is meant", name, last, steps);
                snprintf(what, sizeof what, "%s: time", name);
                check_error(run, INVARIANT, what, time, begin + last * dt, fabs(time - begin - last * dt) / dt, run->gate_case->tolerance,
                            "%s: the time of step %g is %g; from the start at %g as many steps lead to %g", name, last, time, begin, begin + last * dt);
                const double strain = t.rows ? table_at(&t, t.rows - 1, 2) : NAN, sheared = fastest(scene) * last * dt;
                snprintf(what, sizeof what, "%s: strain", name);
                if (!json_object_get(variant, "stages"))            /* those have a case of their own */
                    check_error(run, INVARIANT, what, strain, sheared, fabs(strain - sheared), run->gate_case->tolerance,
                                "%s: the strain of step %g is %g; the largest |rate| times the time since the start is %g", name, last, strain, sheared);
                table_free(&t);
            } else
                check_garbage(run, why);
        }
        json_decref(scene);
    }
}
