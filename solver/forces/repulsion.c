/*
 * Exponential repulsion of two surfaces
 *
 *     F_i = -f exp(-h/kappa) n,     F_j = -F_i,     kappa = c (a_i + a_j)
 *
 *     f      strength: A/kappa for the form `energy`, where the pair's potential is A exp(-h/kappa); F_0 for the form `force`
 *     A      energy at touch, one for all pairs          [M L^2/T^2]
 *     F_0    force at touch, one for all pairs           [M L/T^2]
 *     h      surface gap; in overlap the law goes on and grows          [L]
 *     kappa  range, c = kappa_factor                     [L]
 *
 * Felt up to h = cutoff * kappa (kept there exactly) and not shifted: what is cut off is exp(-cutoff) of the force at touch.
 * The two forms differ for unequal sizes only: with `energy` small spheres push harder, with `force` all push alike.
 * Source: `energy`: Li (2026) eq 4.4 with the sign that goes with n from i to j (as printed it attracts);
 * `force`: Mari et al. (2014), the electrostatic repulsion of models of shear thickening.
 */
#include "forces/forces.h"

#include <stdlib.h>

struct repulsion {
    struct force base;
    bool by_energy;
    double strength;                    /* A or F_0 */
    double kappa_factor;                /* c */
    double cutoff;                      /* in kappa */
};

static double force_at(const struct repulsion *law, double kappa, double gap)
{
    return (law->by_energy ? law->strength / kappa : law->strength) * exp(-gap / kappa);
}

static void repulsion_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now,
                          struct stress *stress)
{
    const struct repulsion *law = (const struct repulsion *)self;
    (void)now;
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        const double kappa = law->kappa_factor * (pair->distance - pair->gap);
        if (pair->gap > law->cutoff * kappa)
            continue;
        const vec3 push = scaled(pair->normal, -force_at(law, kappa, pair->gap));
        pair_push(p, pair, push);
        if (stress)
            stress_add_pair(stress, self->origin[0], pair, push);
    }
}

static void repulsion_respond(const struct force *self, const struct particles *p, int a, int b, double gap, struct response *r)
{
    const struct repulsion *law = (const struct repulsion *)self;
    const double kappa = law->kappa_factor * (p->kind[a].radius + p->kind[b].radius);
    if (gap <= law->cutoff * kappa)
        r->normal_stiffness += force_at(law, kappa, gap) / kappa;
}

/* "repulsion": { "form": "energy", "energy": 0.17, "kappa_factor": 0.01, "cutoff": 14 } */
struct force *repulsion_new(struct settings *s, const struct suspension *in, struct error *e)
{
    static const char *const forms[] = { "energy", "force", NULL };
    struct repulsion *law = calloc(1, sizeof *law);
    (void)in;
    if (!law)
        return error_out_of_memory(e), NULL;
    law->base = (struct force){ .name = "repulsion", .origin_name = { "repulsion" }, .kind = POTENTIAL, .add = repulsion_add, .respond = repulsion_respond };
    law->by_energy = settings_choice(s, "form", forms, e) == 0;
    law->strength = settings_at_least(s, law->by_energy ? "energy" : "force", 0.0, e);
    law->kappa_factor = settings_positive(s, "kappa_factor", e);
    law->cutoff = settings_positive(s, "cutoff", e);
    law->base.range_factor = (1.0 + law->cutoff * law->kappa_factor) * (1.0 + 1e-12);  /* rounding must not end it before the cut-off does */
    return &law->base;
}
