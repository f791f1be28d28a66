/*
 * Structural Brownian stress of a configuration
 *
 *     Sigma = -(kT/V) sum over i of  a_i/D_i  sum over j of n n      over pairs of gap below f a_i, overlapping ones included
 *
 * the stress that thermal agitation would exert through the pairs that are near contact; an estimate from where particles are,
 * never added to the total. Source: Li (2026) eq 3.54, D_i = f a_i (`raw`). In a soft contact particles also fill the thermal depth
 * of the overlap, so D_i = f a_i + sqrt(pi kT/(2 k_n)) (otherwise). Both ends of a pair count; the ideal part -n kT I is left out.
 * As f -> 0, equal hard spheres, -tr/3 is the pressure of the virial, (2 pi/3) n^2 kT (2a)^3 g(2a).
 */
#ifndef OBSERVERS_BROWNIAN_H
#define OBSERVERS_BROWNIAN_H

#include "observers/snapshot.h"

static const double brownian_wide = 0.05, brownian_thin = 0.02;        /* f: that of the source, and one to extrapolate from */

double brownian_depth(const struct suspension *s);                      /* sqrt(pi kT/(2 k_n)), 0 without a contact force [L] */
mat3 brownian_stress_of(const struct snapshot *at, const struct suspension *s, double fraction, double depth);
/* A snapshot with all the pairs that the above may need. */
bool brownian_snapshot(struct snapshot *at, const struct suspension *s, struct error *e);

#endif
