/* A scene in other units of length, mass and time (pair.h): each of its numbers times the product of powers that its dimension says. */
#include "pair.h"

struct dimension { const char *key; int length, mass, time; };

double unit_of(const struct units *u, int length, int mass, int time)
{
    return pow(u->length, length) * pow(u->mass, mass) * pow(u->time, time);
}

/* A number, or a list of numbers or of lists. */
static json_t *scaled(const json_t *value, double by)
{
    size_t k;
    json_t *item, *list;
    if (json_is_number(value))
        return json_real(by * json_number_value(value));
    list = json_array();
    json_array_foreach((json_t *)value, k, item)
        json_array_append_new(list, scaled(item, by));
    return list;
}

static void scale_all(json_t *object, const struct units *u, const struct dimension *d, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (json_object_get(object, d[k].key))
            json_object_set_new(object, d[k].key, scaled(json_object_get(object, d[k].key), unit_of(u, d[k].length, d[k].mass, d[k].time)));
}

json_t *scene_in_units(const json_t *scene, const struct units *u)
{
    static const struct dimension fluid[] = { { "viscosity", -1, 1, -1 }, { "kT", 2, 1, -2 } }, box[] = { { "lengths", 1, 0, 0 }, { "cell", 1, 0, 0 } };
    static const struct dimension species[] = { { "radius", 1, 0, 0 }, { "density", -3, 1, 0 } }, rate[] = { { "rate", 0, 0, -1 } };
    static const struct dimension motion[] = { { "velocity", 1, 0, -1 }, { "spin", 0, 0, -1 } }, start[] = { { "time", 0, 0, 1 } }, step[] = { { "dt", 0, 0, 1 } };
    static const struct dimension contact[] = { { "normal_stiffness", 0, 1, -2 }, { "tangential_stiffness", 0, 1, -2 }, { "normal_damping", 0, 0, -1 },
                                                { "tangential_damping", 0, 0, -1 }, { "critical_load", 1, 1, -2 } };
    static const struct dimension repulsion[] = { { "energy", 2, 1, -2 }, { "force", 1, 1, -2 } };
    static const struct dimension applied[] = { { "force", 1, 1, -2 }, { "torque", 2, 1, -2 } }, tether[] = { { "stiffness", 0, 1, -2 } };
    json_t *other = json_deep_copy(scene), *item;
    const char *name;
    size_t k;
#define SCALE(object, list) scale_all(object, u, list, sizeof list / sizeof *list)
    SCALE(scene_get(other, "fluid"), fluid);
    SCALE(scene_get(other, "box"), box);
    SCALE(scene_get(other, "start"), start);
    SCALE(scene_get(other, "forces.contact"), contact);
    SCALE(scene_get(other, "forces.repulsion"), repulsion);
    json_array_foreach(scene_get(other, "shear"), k, item)
        SCALE(item, rate);
    json_array_foreach(scene_get(other, "species"), k, item)
    {
        SCALE(item, species);
        SCALE(json_object_get(item, "motion"), motion);
    }
    json_object_foreach(scene_get(other, "forces.applied"), name, item)
        SCALE(item, applied);
    json_object_foreach(scene_get(other, "forces.tether"), name, item)
        SCALE(item, tether);
    json_object_foreach(scene_get(other, "dynamics"), name, item)
        SCALE(item, step);
#undef SCALE
    return other;
}
