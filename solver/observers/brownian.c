#include "observers/brownian.h"

double brownian_depth(const struct suspension *s)
{
    struct response r = { 0 };
    const struct force *contact = suspension_force(s, "contact");
    if (contact && contact->respond)
        contact->respond(contact, &s->particles, 0, 0, -1e-300, &r);
    return r.normal_stiffness > 0.0 ? sqrt(M_PI * s->kT / (2.0 * r.normal_stiffness)) : 0.0;
}

mat3 brownian_stress_of(const struct snapshot *at, const struct suspension *s, double fraction, double depth)
{
    mat3 sum = { { { 0.0 } } };
    for (int k = 0; k < at->search.near.count; k++) {
        const struct pair *pair = &at->search.near.pair[k];
        const struct species *one = &at->particles.kind[at->particles.species[pair->i]], *other = &at->particles.kind[at->particles.species[pair->j]];
        if (one->driven && other->driven)               /* no pair: nothing could come of it */
            continue;
        const double end[2] = { radius_of(&at->particles, pair->i), radius_of(&at->particles, pair->j) };
        for (int side = 0; side < 2; side++)
            if (pair->gap < fraction * end[side])
                mat3_add_outer(&sum, -s->kT / s->box.volume * end[side] / (fraction * end[side] + depth), pair->normal, pair->normal);
    }
    return sum;
}

bool brownian_snapshot(struct snapshot *at, const struct suspension *s, struct error *e)
{
    double largest = 0.0;
    for (int k = 0; k < s->particles.species_count; k++)
        largest = fmax(largest, s->particles.kind[k].radius);
    return snapshot_take(at, s, 0.0, brownian_wide * largest, e);
}
