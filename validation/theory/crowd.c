/*
 * Lubrication stress of many spheres in a periodic sheared cell, by brute force
 *
 *     sum over pairs and images of  F_i (x) (x_j + p A + q B + s C - x_i) ,    image velocity U_j + G (p A + q B + s C)
 *
 *     A, B, C cell vectors [L], G velocity gradient [1/T], p, q, s whole numbers; sum in [M L^2/T^2], not divided by the volume
 *
 * Every ordered pair with every image within range is visited and counts half, self-images included: nothing is skipped that a
 * neighbour search could miss. Source: Lees & Edwards (1972) for the image velocity; the pair: resistance.c. Second origin: in
 * tests/theory_test.c the same crowd described by another cell of the same lattice (B + A for B) gives the same sum.
 */
#include "theory.h"

#include <math.h>
#include <string.h>

/* Rows of the inverse cell: fractional coordinate k of x is inverse[k] . x ; 1/|inverse[k]| is the width across face k. */
static void invert_cell(const double cell[3][3], double inverse[3][3])
{
    double volume = 0.0;
    for (int k = 0; k < 3; k++) {
        const double *b = cell[(k + 1) % 3], *c = cell[(k + 2) % 3];
        for (int l = 0; l < 3; l++)
            inverse[k][l] = b[(l + 1) % 3] * c[(l + 2) % 3] - b[(l + 2) % 3] * c[(l + 1) % 3];
    }
    for (int l = 0; l < 3; l++)
        volume += cell[0][l] * inverse[0][l];
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            inverse[k][l] /= volume;
}

void theory_crowd_stress(const struct theory_lubrication *law, int count, const struct theory_sphere *s,
                         const double cell[3][3], const double G[3][3], double stress[3][3])
{
    double inverse[3][3], width_inverse[3];
    invert_cell(cell, inverse);
    for (int k = 0; k < 3; k++)
        width_inverse[k] = hypot(hypot(inverse[k][0], inverse[k][1]), inverse[k][2]);
    memset(stress, 0, 9 * sizeof(double));

    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            const double range = (s[i].radius + s[j].radius) * (1.0 + 0.5 * law->outer_gap) * (1.0 + 1e-12);
            int first[3], last[3];
            for (int k = 0; k < 3; k++) {   /* image numbers that bring j within range of i across the faces of kind k */
                double fraction = 0.0;
                for (int l = 0; l < 3; l++)
                    fraction += inverse[k][l] * (s[j].x[l] - s[i].x[l]);
                first[k] = (int)ceil(-range * width_inverse[k] - fraction);
                last[k] = (int)floor(range * width_inverse[k] - fraction);
            }
            for (int p = first[0]; p <= last[0]; p++)
                for (int q = first[1]; q <= last[1]; q++)
                    for (int t = first[2]; t <= last[2]; t++) {
                        if (i == j && p == 0 && q == 0 && t == 0)
                            continue;
                        struct theory_sphere pair_of[2] = { s[i], s[j] };
                        double shift[3];
                        for (int l = 0; l < 3; l++) {
                            shift[l] = p * cell[0][l] + q * cell[1][l] + t * cell[2][l];
                            pair_of[1].x[l] += shift[l];
                        }
                        for (int l = 0; l < 3; l++)
                            pair_of[1].u[l] += G[l][0] * shift[0] + G[l][1] * shift[1] + G[l][2] * shift[2];
                        double squared = 0.0;
                        for (int l = 0; l < 3; l++)
                            squared += (pair_of[1].x[l] - s[i].x[l]) * (pair_of[1].x[l] - s[i].x[l]);
                        if (squared > range * range)
                            continue;
                        struct theory_pair pair;
                        theory_lubrication_pair(law, pair_of, &pair);
                        for (int k = 0; k < 3; k++)
                            for (int l = 0; l < 3; l++)
                                stress[k][l] += 0.5 * pair.stress[k][l];
                    }
        }
}
