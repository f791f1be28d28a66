#include "sheared_point.h"

#include <math.h>
#include <stdio.h>
#include <sys/resource.h>

double point_number(const struct check_run *run, const json_t *point, const char *key, double otherwise)
{
    return scene_number(point, key, scene_number(run->gate_case->parameters, key, otherwise));
}

static json_t *scene_of(const struct check_run *run, const json_t *point)
{
    json_t *scene = json_deep_copy(run->gate_case->scene), *value, *species;
    const char *path;
    size_t k;
    json_object_foreach (json_object_get(point, "set"), path, value)
        scene_set(scene, path, json_deep_copy(value));
    if ((value = json_object_get(point, "rate")))
        scene_set(json_array_get(json_object_get(scene, "shear"), 0), "rate", json_deep_copy(value));
    if ((value = json_object_get(point, "density")))
        json_array_foreach (json_object_get(scene, "species"), k, species)
            scene_set(species, "density", json_deep_copy(value));
    return scene;
}

/* The whole length of the run and what it writes: in steps, for a candidate may not know strain. */
static void set_output(const struct check_run *run, const json_t *point, const struct dense_start *s, const struct flow *flow)
{
    const char *scheme = json_object_iter_key(json_object_iter(json_object_get(s->scene, "dynamics")));
    char path[64];
    snprintf(path, sizeof path, "dynamics.%s.dt", scheme ? scheme : "");
    const double dt = scene_number(s->scene, path, NAN), per_strain = 1 / (fabs(s->rate) * dt), snapshots = point_number(run, point, "snapshots", 0);
    scene_set(s->scene, "run", json_pack("{sI}", "steps", (json_int_t)ceil(flow->strain * per_strain)));
    scene_set(s->scene, "output.stress.every", json_integer((json_int_t)point_number(run, point, "every", 20)));
    if (snapshots > 0)
        scene_set(s->scene, "output.states.every", json_integer((json_int_t)((flow->strain - flow->discard) * per_strain / snapshots)));
}

bool point_start(struct check_run *run, const json_t *point, int k, struct dense_start *s, struct flow *flow)
{
    json_t *scene = scene_of(run, point), *parameters = json_copy(run->gate_case->parameters), *own = json_deep_copy(point);
    json_object_update(parameters, own);
    const bool started = dense_start_in(run, scene, parameters, run->seed * 1000 + (unsigned)k, s);
    json_decref(own);
    json_decref(parameters);
    json_decref(scene);
    if (!started)
        return false;
    *flow = (struct flow){ .discard = point_number(run, point, "discard", 1.5), .strain = point_number(run, point, "strain", 4),
                           .viscosity = s->viscosity, .rate = s->rate };
    scene_set(s->scene, "seed", json_integer(run->seed));
    scene_set(s->scene, "realisation", json_integer(k));
    set_output(run, point, s, flow);
    return true;
}

double children_seconds(void)
{
    struct rusage used;
    getrusage(RUSAGE_CHILDREN, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + 1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}
