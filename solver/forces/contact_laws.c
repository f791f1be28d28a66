/*
 * Contact with a dashpot and with other friction laws
 *
 *     N = k_n delta + zeta_n v_n,      F_i = -N n + f_t,      F_j = -F_i
 *     f_t = -(k_t xi_t + zeta_t v_t),  |f_t| <= cap(load),    T_i = l_i n x f_t,   T_j = l_j n x f_t
 *
 *     delta, xi_t, n, l    as in contact.c
 *     v_n        closing velocity (U_i - U_j) . n                                             [L/T]
 *     v_t        slip velocity, the tangential part of U_i - U_j + (l_i W_i + l_j W_j) x n    [L/T]
 *     zeta_n, zeta_t    dashpots m_eff gamma, see core/dashpot.h                           [M/T]
 *     cap        a friction law of friction.h at the normal load
 *
 * `tension`: with `allow` N may pull at the end of a contact, as in the linear law as written; with `clip` N is never below 0.
 * `cap`, the load that friction feels: `spring` k_n delta; `damped` max(N, 0); `absolute` |N|, which is LAMMPS's gran/hooke/history.
 * A sliding contact keeps the displacement that makes spring and dashpot together equal the cap (LAMMPS's rule too).
 * A dashpot takes energy and gives no noise back, so with kT > 0 it would cool the particles: refused.
 *
 * Source: Cundall & Strack (1979); LAMMPS gran/hooke/history; friction laws: Seto et al. (2013), Mari et al. (2014).
 */
#include "core/dashpot.h"
#include "forces/contact.h"
#include "forces/forces.h"
#include "forces/friction.h"

#include <stdlib.h>

enum load { LOAD_SPRING, LOAD_DAMPED, LOAD_ABSOLUTE };

struct contact_laws {
    struct contact plain;
    struct friction_rule friction;
    enum load load;
    bool clip;
    struct dashpot dashpot[MAX_SPECIES][MAX_SPECIES];
};

static double load_of(const struct contact_laws *law, double spring, double push)
{
    return law->load == LOAD_SPRING ? spring : law->load == LOAD_DAMPED ? fmax(push, 0.0) : fabs(push);
}

/* Tangential force on i; the history is advanced, and shortened where the contact slides. */
static vec3 rub_of(const struct contact_laws *law, const struct particles *p, const struct pair *pair, double l_i, double l_j,
                   double load, const struct moment *now)
{
    const int a = p->species[pair->i], b = p->species[pair->j];
    const struct grip grip = law->friction.law(&law->friction, load, a, b);
    if (!grip.lives)
        return *pair->history = vec(0, 0, 0);
    contact_advance(pair, l_i, l_j, now);
    const vec3 slip = across(contact_velocity(pair, p->velocity, p->spin, l_i, l_j), pair->normal);
    const vec3 damping = scaled(slip, law->dashpot[a][b].tangential);
    const double k_t = law->plain.tangential_stiffness;
    const vec3 rub = minus(scaled(*pair->history, -k_t), damping);
    const double size = norm(rub);
    if (size <= grip.cap)
        return rub;
    const vec3 capped = scaled(rub, grip.cap / size);
    *pair->history = scaled(plus(capped, damping), -1.0 / k_t);
    return capped;
}

static void contact_laws_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                             struct stress *stress)
{
    const struct contact_laws *law = (const struct contact_laws *)self;
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        const int i = pair->i, j = pair->j;
        const vec3 n = pair->normal;
        if (pair->gap >= 0.0) {
            if (pair->history)
                *pair->history = vec(0, 0, 0);                      /* parted: the contact forgets */
            continue;
        }
        const double closing = dot(minus(minus(p->velocity[i], p->velocity[j]), pair->image_velocity), n);
        const double spring = law->plain.normal_stiffness * -pair->gap;
        const double damped = spring + law->dashpot[p->species[i]][p->species[j]].normal * closing;
        const double push = law->clip ? fmax(damped, 0.0) : damped;
        pair_push(p, pair, scaled(n, -push));
        if (stress)
            stress_add_pair(stress, self->origin[0], pair, scaled(n, -push));
        if (!self->keeps_history)
            continue;

        const double a_i = radius_of(p, i), a_j = radius_of(p, j);
        const double arm = law->plain.lever_at_contact ? pair->distance / (a_i + a_j) : 1.0;
        const vec3 rub = rub_of(law, p, pair, arm * a_i, arm * a_j, load_of(law, spring, push), now);
        const vec3 turn = cross(n, rub);
        pair_push(p, pair, rub);
        pair_turn(p, pair, scaled(turn, arm * a_i), scaled(turn, arm * a_j));
        if (stress)
            stress_add_pair(stress, self->origin[1], pair, rub);
    }
}

static void contact_laws_respond(const struct force *self, const struct particles *p, int a, int b, double gap, struct response *r)
{
    const struct contact_laws *law = (const struct contact_laws *)self;
    contact_respond(self, p, a, b, gap, r);
    if (gap >= 0.0)
        return;
    r->normal_dashpot += law->dashpot[a][b].normal;
    r->tangential_dashpot += law->dashpot[a][b].tangential;
}

/* Either a rate of damping, or a restitution coefficient from which the rate of each pair of species follows. */
static void read_dashpots(struct contact_laws *law, const struct suspension *in, struct settings *s, struct error *e)
{
    static const char *const tensions[] = { "allow", "clip", NULL }, *const loads[] = { "spring", "damped", "absolute", NULL };
    const struct particles *p = &in->particles;
    const bool by_restitution = settings_has(s, "restitution");
    if (by_restitution && settings_has(s, "normal_damping"))
        settings_refuse(s, "restitution", e, "must not stand beside normal_damping: each says the other");
    law->clip = settings_choice(s, "tension", tensions, e) == 1;
    const double given = by_restitution ? settings_positive(s, "restitution", e) : settings_at_least(s, "normal_damping", 0.0, e);
    double gamma_t = 0.0;
    if (by_restitution && given > 1.0)
        settings_refuse(s, "restitution", e, "must be above 0 and at most 1");
    if (law->plain.friction > 0.0) {
        gamma_t = settings_at_least(s, "tangential_damping", 0.0, e);
        law->load = (enum load)settings_choice(s, "cap", loads, e);
    } else {
        settings_has(s, "tangential_damping");                      /* allowed, so that friction can be swept to 0 */
        settings_has(s, "cap");
    }
    if (error_raised(e))
        return;
    const double ratio = by_restitution ? damping_ratio_of_restitution(given, law->clip) : 0.0;
    bool damps = false;
    for (int a = 0; a < p->species_count; a++)
        for (int b = 0; b < p->species_count; b++) {
            const double m_eff = effective_mass(p->kind[a].mass, p->kind[b].mass);
            if (isinf(m_eff))
                continue;                                           /* two driven species: no pair */
            const double gamma_n = by_restitution ? 2.0 * ratio * sqrt(law->plain.normal_stiffness / m_eff) : given;
            law->dashpot[a][b] = dashpot_of(m_eff, gamma_n, gamma_t);
            damps = damps || gamma_n > 0.0 || gamma_t > 0.0;
        }
    if (damps && in->kT > 0.0)
        settings_refuse(s, "", e, "has a dashpot, which at fluid.kT = %g would cool the particles, for it has no noise of its own: "
                        "take restitution 1 (no damping) and let lubrication damp, or set kT to 0", in->kT);
}

/*
 * "contact": { ..., "restitution": 0.7, "tangential_damping": 0, "tension": "allow", "cap": "spring" }
 *            { ..., "law": "critical", "critical_load": 1.5 }
 */
struct force *contact_laws_new(struct settings *s, const struct suspension *in, struct error *e)
{
    struct contact_laws *law = calloc(1, sizeof *law);
    if (!law)
        return error_out_of_memory(e), NULL;
    contact_read(&law->plain, s, e);
    law->plain.base.add = contact_laws_add;
    law->plain.base.respond = contact_laws_respond;
    friction_read(&law->friction, law->plain.friction, &in->particles, s, e);
    if (settings_has(s, "normal_damping") || settings_has(s, "restitution"))
        read_dashpots(law, in, s, e);
    return &law->plain.base;
}
