/*
 * Random spheres without overlap: the energy E = (1/2) sum over pairs of (overlap)^2 is brought to zero from uniformly random
 * centres by FIRE (Bitzek et al. 2006, Phys. Rev. Lett. 97, 170201): molecular dynamics that is turned towards the force,
 * speeds up while it goes downhill and stops dead when it goes uphill. The radii are taken 0.1 % too large meanwhile, so that
 * the descent, which reaches zero only in the limit, leaves the true spheres apart after a finite number of steps.
 *
 * All pairs are visited (a few hundred spheres: milliseconds per step); no cell list to get wrong.
 */
#include "packing.h"

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_DRAWS = 20 };

double packing_edge(const struct packing_species *species, int species_count, double phi)
{
    double volume = 0;
    for (int s = 0; s < species_count; s++)
        volume += 4 * M_PI / 3 * gsl_pow_3(species[s].radius) * species[s].count;
    return cbrt(volume / phi);
}

/* Vector between nearest images; sheared states are not needed, a packing is made in a cube. */
static double separation(const double *a, const double *b, double edge, double d[3])
{
    for (int k = 0; k < 3; k++) {
        d[k] = b[k] - a[k];
        d[k] -= edge * nearbyint(d[k] / edge);
    }
    return d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
}

/* Forces - dE/dx for the given radii; returns the largest overlap. */
static double push(const double *x, const double *radius, int count, double edge, double *force)
{
    double worst = 0, d[3];
    memset(force, 0, (size_t)count * 3 * sizeof *force);
    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++) {
            const double reach = radius[i] + radius[j], square = separation(x + 3 * i, x + 3 * j, edge, d);
            if (square >= reach * reach || square == 0)
                continue;
            const double r = sqrt(square), overlap = reach - r;
            worst = fmax(worst, overlap / reach);
            for (int k = 0; k < 3; k++) {
                force[3 * i + k] -= overlap * d[k] / r;
                force[3 * j + k] += overlap * d[k] / r;
            }
        }
    return worst;
}

static bool descend(double *x, const double *radius, int count, double edge, double *work)
{
    double *u = work, *force = work + 3 * count, dt = 0.3, turn = 0.1;
    int downhill = 0;
    memset(u, 0, (size_t)count * 3 * sizeof *u);
    for (int step = 0; step < 5000; step++) {
        if (push(x, radius, count, edge, force) < 5e-4)
            return true;
        double power = 0, uu = 0, ff = 0;
        for (int k = 0; k < 3 * count; k++) {
            power += force[k] * u[k];
            uu += u[k] * u[k];
            ff += force[k] * force[k];
        }
        if (power > 0) {
            if (++downhill > 5) {
                dt = fmin(1.1 * dt, 0.9);  /* unit masses and springs: a sphere with three contacts turns round in about 3 */
                turn *= 0.99;
            }
        } else {
            downhill = 0;
            dt *= 0.5;
            turn = 0.1;
        }
        for (int k = 0; k < 3 * count; k++) {
            u[k] = power > 0 ? (1 - turn) * u[k] + turn * sqrt(uu / ff) * force[k] : 0;
            u[k] += dt * force[k];
            x[k] += dt * u[k];
        }
    }
    return false;
}

double packing_overlap(const struct packing_species *species, double edge, const struct state_row *row, int count)
{
    double worst = -1, d[3];
    for (int i = 0; i < count; i++)
        for (int j = i + 1; j < count; j++) {
            const double reach = species[row[i].species - 1].radius + species[row[j].species - 1].radius;
            worst = fmax(worst, 1 - sqrt(separation(row[i].x, row[j].x, edge, d)) / reach);
        }
    return worst;
}

bool packing_make(const struct packing_species *species, int species_count, double edge, double rate, unsigned seed,
                  struct state_row *row, char why[WHY_LENGTH])
{
    int count = 0;
    for (int s = 0; s < species_count; s++)
        count += species[s].count;
    double *x = malloc((size_t)count * 10 * sizeof *x);
    if (!x) {
        snprintf(why, WHY_LENGTH, "out of memory");
        return false;
    }
    double *radius = x + 3 * count, *work = x + 4 * count;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(rng, seed);
    for (int s = 0, i = 0; s < species_count; s++)
        for (int n = 0; n < species[s].count; n++, i++) {
            row[i] = (struct state_row){ .id = i + 1, .species = s + 1 };
            radius[i] = 1.001 * species[s].radius;
        }
    bool good = false;
    for (int draw = 0; draw < MOST_DRAWS && !good; draw++) {    /* a few spheres among their own images may be stuck where a larger crowd gives way */
        for (int k = 0; k < 3 * count; k++)
            x[k] = edge * gsl_rng_uniform(rng);
        good = descend(x, radius, count, edge, work);
    }
    gsl_rng_free(rng);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < 3; k++)
            row[i].x[k] = x[3 * i + k] - edge * floor(x[3 * i + k] / edge);
        row[i].u[0] = rate * row[i].x[1];
        row[i].w[2] = -rate / 2;
    }
    const double left = packing_overlap(species, edge, row, count);
    free(x);
    if (!good || left > 0)
        snprintf(why, WHY_LENGTH, "no packing of %d spheres found in a cube of edge %g: overlap %.2g is left", count, edge, left);
    return good && left <= 0;
}
