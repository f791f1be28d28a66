/*
 * Exponential repulsion of two spheres
 *
 *     V = A exp(-h/kappa)   (form `energy`)      or      V = F_0 kappa exp(-h/kappa)   (form `force`),     F_1 = dV/dh n
 *
 *     kappa = c (a_1 + a_2)  range [L];  A [M L^2/T^2];  F_0 [M L/T^2];  felt while h <= cutoff kappa
 *
 * Source: Li (2026) eq 4.4, whose n must be read from j to i for it to repel. Second origin: the difference quotient of V, in
 * tests/collision_test.c.
 */
#include "theory.h"

#include <math.h>
#include <string.h>

double theory_repulsion_energy(const struct theory_repulsion *law, double a1, double a2, double gap)
{
    const double kappa = law->kappa_factor * (a1 + a2);
    return (law->by_energy ? law->strength : law->strength * kappa) * exp(-gap / kappa);
}

void theory_repulsion_pair(const struct theory_repulsion *law, const struct theory_sphere s[2], struct theory_pair *out)
{
    double r[3], distance = 0.0;
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 3; k++) {
        r[k] = s[1].x[k] - s[0].x[k];
        distance = hypot(distance, r[k]);
    }
    const double sizes = s[0].radius + s[1].radius, kappa = law->kappa_factor * sizes, gap = distance - sizes;
    if (gap > law->cutoff * kappa)
        return;
    const double force = theory_repulsion_energy(law, s[0].radius, s[1].radius, gap) / kappa;
    for (int k = 0; k < 3; k++) {
        out->force[0][k] = -force * r[k] / distance;
        out->force[1][k] = force * r[k] / distance;
        for (int l = 0; l < 3; l++)
            out->stress[k][l] = -force * r[k] * r[l] / distance;
    }
}
