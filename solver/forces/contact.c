/*
 * Linear-spring contact with tangential history and Coulomb cap
 *
 *     F_i = -k_n delta n + f_t,     F_j = -F_i,     f_t = -k_t xi_t,     |f_t| <= mu k_n delta
 *     T_i = l_i n x f_t,            T_j = l_j n x f_t                  (the same sign on both)
 *
 *     delta  overlap a_i + a_j - r, > 0 in contact                [L]
 *     n      unit vector from i to j
 *     xi_t   displacement of the surface of i relative to that of j since they touched, kept in the tangent plane [L]
 *     l      lever arm: a (`radius`), or a r/(a_i + a_j) (`contact`): the two meet in the middle of the overlap  [L]
 *
 *     slip velocity  v = U_i - U_j + (l_i W_i + l_j W_j) x n,   xi_t grows by its tangential part times the drift's duration
 *
 * Source: Cundall & Strack (1979); Li (2026) eq 3.3, 3.4 with the signs that go with n from i to j: as printed there the
 * spring attracts. Order of the update as in LAMMPS gran/hooke/history: advance, project, cap; a capped displacement
 * is shortened too, so that a contact that slides back pushes back at once. The cap is the spring's alone.
 * With lever `radius` T_i + T_j + r x F_j = delta n x f_t is left over: angular momentum is kept to delta/r only.
 */
#include "forces/contact.h"
#include "forces/forces.h"

#include <stdlib.h>

static void contact_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                        struct stress *stress)
{
    const struct contact *law = (const struct contact *)self;
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        if (pair->gap >= 0.0) {
            if (pair->history)
                *pair->history = vec(0, 0, 0);                      /* parted: the contact forgets */
            continue;
        }
        const vec3 push = scaled(pair->normal, law->normal_stiffness * pair->gap);
        pair_push(p, pair, push);
        if (stress)
            stress_add_pair(stress, self->origin[0], pair, push);
        if (!self->keeps_history)
            continue;

        const double a_i = radius_of(p, pair->i), a_j = radius_of(p, pair->j), k_t = law->tangential_stiffness;
        const double arm = law->lever_at_contact ? pair->distance / (a_i + a_j) : 1.0;
        contact_advance(pair, arm * a_i, arm * a_j, now);
        const double size = norm(*pair->history), cap = law->friction * law->normal_stiffness * -pair->gap;
        if (k_t * size > cap)
            *pair->history = scaled(*pair->history, cap / (k_t * size));
        const vec3 rub = scaled(*pair->history, -k_t);
        const vec3 turn = cross(pair->normal, rub);
        pair_push(p, pair, rub);
        pair_turn(p, pair, scaled(turn, arm * a_i), scaled(turn, arm * a_j));
        if (stress)
            stress_add_pair(stress, self->origin[1], pair, rub);
    }
}

void contact_respond(const struct force *self, const struct particles *p, int a, int b, double gap, struct response *r)
{
    const struct contact *law = (const struct contact *)self;
    (void)p, (void)a, (void)b;
    if (gap >= 0.0)
        return;
    r->normal_stiffness += law->normal_stiffness;
    r->tangential_stiffness += law->tangential_stiffness;
}

void contact_read(struct contact *law, struct settings *s, struct error *e)
{
    static const char *const levers[] = { "radius", "contact", NULL };
    law->base = (struct force){ .name = "contact", .origin_name = { "contact_normal" }, .kind = POTENTIAL, .range_factor = 1.0,
                                .add = contact_add, .respond = contact_respond };
    law->normal_stiffness = settings_positive(s, "normal_stiffness", e);
    law->friction = settings_at_least(s, "friction", 0.0, e);
    settings_has(s, "tangential_stiffness"), settings_has(s, "lever");      /* allowed without friction, so that it can be swept to 0 */
    if (law->friction > 0.0) {
        law->tangential_stiffness = settings_positive(s, "tangential_stiffness", e);
        law->lever_at_contact = settings_choice(s, "lever", levers, e) == 1;
        law->base.origin_name[1] = "contact_tangential";
        law->base.keeps_history = law->base.rotates = true;
    }
}

/* "contact": { "normal_stiffness": 1e4, "tangential_stiffness": 2857, "friction": 0.5, "lever": "radius" } */
struct force *contact_new(struct settings *s, const struct suspension *in, struct error *e)
{
    if (settings_has(s, "normal_damping") || settings_has(s, "restitution") || settings_has(s, "law"))
        return contact_laws_new(s, in, e);
    struct contact *law = calloc(1, sizeof *law);
    if (!law)
        return error_out_of_memory(e), NULL;
    contact_read(law, s, e);
    return &law->base;
}
