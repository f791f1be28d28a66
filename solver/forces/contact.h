/* Contact: what the plain law and the one with dashpots and other friction laws (contact_laws.c) share. */
#ifndef FORCES_CONTACT_H
#define FORCES_CONTACT_H

#include "core/settings.h"
#include "core/suspension.h"

struct contact {
    struct force base;
    double normal_stiffness, tangential_stiffness;      /* k_n, k_t [M/T^2] */
    double friction;                                    /* mu */
    bool lever_at_contact;
};

void contact_read(struct contact *law, struct settings *s, struct error *e);
void contact_respond(const struct force *self, const struct particles *p, int a, int b, double gap, struct response *r);

/* Velocity of the surface of i against that of j; its tangential part is the slip. */
static inline vec3 contact_velocity(const struct pair *pair, const vec3 *velocity, const vec3 *spin, double l_i, double l_j)
{
    const vec3 spins = plus(scaled(spin[pair->i], l_i), scaled(spin[pair->j], l_j));
    return plus(minus(minus(velocity[pair->i], velocity[pair->j]), pair->image_velocity), cross(spins, pair->normal));
}

/* The history advanced by the drift just made and turned into the present tangent plane. */
static inline void contact_advance(const struct pair *pair, double l_i, double l_j, const struct moment *now)
{
    vec3 s = *pair->history;
    if (now->drift_time > 0.0)
        s = plus(s, scaled(contact_velocity(pair, now->drift_velocity, now->drift_spin, l_i, l_j), now->drift_time));
    *pair->history = across(s, pair->normal);
}

#endif
