/*
 * Constant forces and torques from outside, one of each per species
 *
 *     F_i = F(species)  [M L/T^2],     T_i = T(species)  [M L^2/T^2]
 *
 * Weight, a magnet's pull, a motor. No stress is booked: such a force has no partner inside the cell. What the pairs pass on
 * of it is in their stress; a torque so passed on makes the stress of contact and lubrication unsymmetric.
 */
#include "forces/forces.h"

#include <stdlib.h>

struct applied { struct force base; vec3 force[MAX_SPECIES], torque[MAX_SPECIES]; };

static void applied_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                        struct stress *stress)
{
    const struct applied *law = (const struct applied *)self;
    (void)near, (void)now, (void)stress;
    for (int i = 0; i < p->count; i++)
        p->force[i] = plus(p->force[i], law->force[p->species[i]]);
    for (int i = 0; self->rotates && i < p->count; i++)
        p->torque[i] = plus(p->torque[i], law->torque[p->species[i]]);
}

static bool read_vector(struct settings *s, const char *key, vec3 *to, struct error *e)
{
    double v[3] = { 0.0 };
    if (!settings_has(s, key))
        return false;
    if (settings_numbers(s, key, v, 3, e) != 3)
        settings_refuse(s, key, e, "must be three numbers");
    *to = vec(v[0], v[1], v[2]);
    return true;
}

/* "applied": { "small": { "force": [0, 0, -0.2], "torque": [0, 0.1, 0] } }, by the names of species */
struct force *applied_new(struct settings *s, const struct suspension *in, struct error *e)
{
    const struct particles *p = &in->particles;
    struct applied *law = calloc(1, sizeof *law);
    if (!law)
        return error_out_of_memory(e), NULL;
    law->base = (struct force){ .name = "applied", .kind = POTENTIAL, .add = applied_add };
    for (int a = 0; a < p->species_count; a++) {
        struct settings own = settings_child(s, p->kind[a].name, e);
        if (!own.node)
            continue;
        const bool pushed = read_vector(&own, "force", &law->force[a], e), turned = read_vector(&own, "torque", &law->torque[a], e);
        if (!pushed && !turned)
            settings_refuse(s, p->kind[a].name, e, "must have force, torque or both");
        if (!error_raised(e) && in->dimensions == 2 && (law->force[a].z != 0.0 || law->torque[a].x != 0.0 || law->torque[a].y != 0.0))
            settings_refuse(s, p->kind[a].name, e, "must stay in the plane: in two dimensions force[2], torque[0] and torque[1] are 0");
        law->base.rotates = law->base.rotates || turned;
        settings_done(&own, e);
    }
    return &law->base;
}
