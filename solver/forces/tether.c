/*
 * Harmonic tether to the place where a particle started
 *
 *     F_i = -k (x_i - x_i(0))          x unwrapped: the tether does not jump when the particle crosses a face
 *
 *     k    stiffness, one per species         [M/T^2]
 *     x(0) its place at the start, fixed in the laboratory: in a flow the particle strains at it          [L]
 *
 * An optical trap. It does not turn particles. No stress is booked: the other end is outside the cell.
 * In a frozen state every particle is where it started, and the force is zero.
 */
#include "forces/forces.h"

#include <stdlib.h>

struct tether { struct force base; double stiffness[MAX_SPECIES]; };

static void tether_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                       struct stress *stress)
{
    const struct tether *law = (const struct tether *)self;
    (void)near, (void)stress;
    for (int i = 0; i < p->count; i++) {
        const vec3 place = plus(p->position[i], box_unwrapped(now->box, p->image[i]));
        p->force[i] = minus(p->force[i], scaled(minus(place, p->anchor[i]), law->stiffness[p->species[i]]));
    }
}

static double tether_stiffness(const struct force *self, const struct particles *p, int a)
{
    (void)p;
    return ((const struct tether *)self)->stiffness[a];
}

/* "tether": { "small": { "stiffness": 3.0 } }, by the names of species */
struct force *tether_new(struct settings *s, const struct suspension *in, struct error *e)
{
    const struct particles *p = &in->particles;
    struct tether *law = calloc(1, sizeof *law);
    if (!law)
        return error_out_of_memory(e), NULL;
    law->base = (struct force){ .name = "tether", .keeps_anchor = true, .kind = POTENTIAL, .add = tether_add, .stiffness_alone = tether_stiffness };
    for (int a = 0; a < p->species_count; a++) {
        struct settings own = settings_child(s, p->kind[a].name, e);
        if (!own.node)
            continue;
        law->stiffness[a] = settings_positive(&own, "stiffness", e);
        settings_done(&own, e);
    }
    return &law->base;
}
