/*
 * The stress that thermal agitation exerts through pairs near contact, from where the spheres are (Li 2026, eq 3.54)
 *
 *     Sigma = -(kT/V) sum over i  a_i/(f a_i + d)  sum over j with gap below f a_i  n n            ideal part left out
 *
 * f a_i the width of the shell and d the depth to which kT presses two spheres into each other, sqrt(pi kT/(2 k_n)): the shell
 * of the source has f = 0.05, d = 0, which counts a soft contact's overlaps but not their room. The limit f -> 0 for equal hard spheres is the
 * virial: -tr/3 = (2 pi/3) n^2 kT (2a)^3 g(2a), the pressure beyond n kT. All pairs, nearest images in a cube. Second origin
 * (tests/theory_pair_test.c): points placed at random, whose shells fill by their density.
 */
#include "theory.h"

#include <math.h>
#include <string.h>

void theory_structural_stress(int count, const double (*x)[3], const double *radius, double edge, double kT, double fraction, double depth,
                              double stress[6])
{
    static const int component[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 } };
    memset(stress, 0, 6 * sizeof *stress);
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            double r[3], square = 0.0;
            for (int c = 0; c < 3; c++) {
                r[c] = x[j][c] - x[i][c];
                r[c] -= edge * nearbyint(r[c] / edge);
                square += r[c] * r[c];
            }
            if (j == i || sqrt(square) - radius[i] - radius[j] >= fraction * radius[i])
                continue;
            const double weight = kT * radius[i] / (fraction * radius[i] + depth) / (edge * edge * edge);
            for (int k = 0; k < 6; k++)
                stress[k] -= weight * r[component[k][0]] * r[component[k][1]] / square;
        }
}
