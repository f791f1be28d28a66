/*
 * Resistance scalars of two close spheres, in the variables of Jeffrey & Onishi (1984)
 *
 *     F_a = - sum_b ( A_ab U_b + Bt_ab W_b ) ,    T_a = - sum_b ( B_ab U_b + C_ab W_b ) ,    a, b = 1, 2
 *
 *     A_ab = 3 pi eta (a_a + a_b)    [ X^A_ab d d + Y^A_ab (1 - d d) ]
 *     B_ab =   pi eta (a_a + a_b)^2    Y^B_ab  eps.d                       (eps.d)_ij = eps_ijk d_k ,   Bt_ab = B_ba^T
 *     C_ab =   pi eta (a_a + a_b)^3  [ X^C_ab d d + Y^C_ab (1 - d d) ]
 *
 *     lambda = a_2 / a_1              size ratio                                    [1]
 *     xi = 2 h / (a_1 + a_2)          gap over mean radius, h surface gap           [1]
 *     d                               unit vector from 1 to 2                       [1]
 *     eta                             viscosity                                     [M/(L T)]
 *
 * near contact, L = ln(1/xi), and dropped beyond these terms (the model of Li 2026, eq 3.8 to 3.18, X^C = 0):
 *
 *     X^A_11 = g1 / xi + g2 L      X^A_12 = - 2/(1 + lambda) X^A_11        g1 = 2 lambda^2 / (1 + lambda)^3
 *     Y^A_11 = g2' L               Y^A_12 = - 2/(1 + lambda) Y^A_11        g2, g2', g2'', g2''', g4: below
 *     Y^B_11 = g2'' L              Y^B_12 = - 4/(1 + lambda)^2 Y^B_11
 *     Y^C_11 = g2''' L             Y^C_12 = g4 L
 *
 * The functions of sphere 2 follow from exchange of labels: Q_22(lambda) = Q_11(1/lambda), and for Y^B with a minus sign.
 *
 * Source: Jeffrey & Onishi, J. Fluid Mech. 139 (1984) 261, eqs 1.6 to 1.8 (form), 3.17 to 3.19, 4.15 to 4.17, 5.5 to 5.7,
 * 7.10 to 7.12 (near field), with the corrections of Townsend (2018), arXiv:1802.08226.
 * Second origins, compared in tests/theory_test.c: the bispherical series of Brenner (1961) and Stimson & Jeffery (1926) for
 * equal spheres; the sphere at a wall (lambda to infinity) of Brenner (1961) and Goldman, Cox & Brenner (1967); the identities
 * that rigid rotation of a touching pair implies; Reynolds's 6 pi eta (a_1 a_2/(a_1 + a_2))^2 / h.
 */
#include "theory.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

const char *const theory_scalar_name[THEORY_SCALARS] = { "X_A", "Y_A", "B_1", "B_2", "C_11", "C_12", "C_22" };

/* Dimensionless functions X^A_11, Y^A_11, Y^B_11, Y^C_11, Y^C_12 of one size ratio at gap xi; those of sphere 2: 1/lambda. */
struct near_field { double xa11, ya11, yb11, yc11, yc12; };

static struct near_field near_field(double lambda, double xi)
{
    const double k = 1.0 + lambda, k3 = k * k * k, log_gap = -log(xi);
    const double g1 = 2.0 * lambda * lambda / k3;
    const double xa_g2 = lambda * (1.0 + 7.0 * lambda + lambda * lambda) / (5.0 * k3);
    const double ya_g2 = 4.0 * lambda * (2.0 + lambda + 2.0 * lambda * lambda) / (15.0 * k3);
    const double yb_g2 = -lambda * (4.0 + lambda) / (5.0 * k * k);
    const double yc_g2 = 2.0 * lambda / (5.0 * k);
    const double yc_g4 = 4.0 * lambda * lambda / (5.0 * k3 * k);
    return (struct near_field){ .xa11 = g1 / xi + xa_g2 * log_gap, .ya11 = ya_g2 * log_gap, .yb11 = yb_g2 * log_gap,
                                .yc11 = yc_g2 * log_gap, .yc12 = yc_g4 * log_gap };
}

/* All functions of the pair with their dimensions: index [a][b], a, b = 0, 1. */
struct pair_functions { double xa[2][2], ya[2][2], yb[2][2], yc[2][2]; };

static struct pair_functions pair_functions(const struct theory_lubrication *law, double a1, double a2, double distance)
{
    struct pair_functions f;
    memset(&f, 0, sizeof f);
    const double touching = a1 + a2, gap = 2.0 * (distance - touching) / touching;
    if (gap > law->outer_gap)
        return f;
    const double xi = gap < law->inner_gap ? law->inner_gap : gap;   /* frozen below the inner gap and in overlap */

    const double lambda = a2 / a1, k = 1.0 + lambda, k_swapped = 1.0 + 1.0 / lambda;
    const struct near_field one = near_field(lambda, xi), two = near_field(1.0 / lambda, xi);

    f.xa[0][0] = one.xa11;
    f.xa[1][1] = two.xa11;
    f.xa[0][1] = f.xa[1][0] = -2.0 / k * one.xa11;
    f.ya[0][0] = one.ya11;
    f.ya[1][1] = two.ya11;
    f.ya[0][1] = f.ya[1][0] = -2.0 / k * one.ya11;
    f.yb[0][0] = one.yb11;
    f.yb[0][1] = -4.0 / (k * k) * one.yb11;
    f.yb[1][1] = -two.yb11;
    f.yb[1][0] = 4.0 / (k_swapped * k_swapped) * two.yb11;
    f.yc[0][0] = one.yc11;
    f.yc[1][1] = two.yc11;
    f.yc[0][1] = f.yc[1][0] = one.yc12;

    /* rotation made exact: the congruence by diag(1, s) that lets a rigidly turning pair feel nothing at distance r */
    const double s = law->exact_rotation ? distance / touching : 1.0;
    const double radius[2] = { a1, a2 };
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++) {
            const double sum = radius[a] + radius[b];
            f.xa[a][b] *= 3.0 * PI * law->viscosity * sum;
            f.ya[a][b] *= 3.0 * PI * law->viscosity * sum;
            f.yb[a][b] *= PI * law->viscosity * sum * sum * s;
            f.yc[a][b] *= PI * law->viscosity * sum * sum * sum * s * s;
        }
    return f;
}

void theory_scalars(const struct theory_lubrication *law, double a1, double a2, double distance, double scalar[THEORY_SCALARS])
{
    const struct pair_functions f = pair_functions(law, a1, a2, distance);
    scalar[THEORY_XA] = f.xa[0][0];
    scalar[THEORY_YA] = f.ya[0][0];
    scalar[THEORY_B1] = f.yb[0][0];
    scalar[THEORY_B2] = f.yb[1][0];
    scalar[THEORY_C11] = f.yc[0][0];
    scalar[THEORY_C12] = f.yc[0][1];
    scalar[THEORY_C22] = f.yc[1][1];
}

/* eps_ijk d_k, the matrix that takes U to U x d. */
static double cross_matrix(const double d[3], int i, int j)
{
    if (i == j)
        return 0.0;
    const int k = 3 - i - j;
    return (j - i == 1 || j - i == -2 ? 1.0 : -1.0) * d[k];
}

void theory_pair_resistance(const struct theory_lubrication *law, double a1, double a2, const double r[3], double R[144])
{
    const double distance = sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
    const double d[3] = { r[0] / distance, r[1] / distance, r[2] / distance };
    const struct pair_functions f = pair_functions(law, a1, a2, distance);

    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++) {
                    const double along = d[i] * d[j], across = (i == j) - along;
                    const int force = 3 * a + i, torque = 6 + 3 * a + i, velocity = 3 * b + j, spin = 6 + 3 * b + j;
                    R[12 * force + velocity] = f.xa[a][b] * along + f.ya[a][b] * across;
                    R[12 * torque + velocity] = f.yb[a][b] * cross_matrix(d, i, j);
                    R[12 * force + spin] = f.yb[b][a] * cross_matrix(d, j, i);
                    R[12 * torque + spin] = f.yc[a][b] * across;
                }
}

void theory_lubrication_pair(const struct theory_lubrication *law, const struct theory_sphere s[2], struct theory_pair *out)
{
    double r[3], motion[12], R[144], load[12];
    for (int k = 0; k < 3; k++) {
        r[k] = s[1].x[k] - s[0].x[k];
        motion[k] = s[0].u[k];
        motion[3 + k] = s[1].u[k];
        motion[6 + k] = s[0].w[k];
        motion[9 + k] = s[1].w[k];
    }
    /* A common velocity exerts nothing; taking it out first spares the digits that a large one would cost. */
    for (int k = 0; k < 3; k++) {
        const double mean = 0.5 * (s[0].u[k] + s[1].u[k]);
        motion[k] -= mean;
        motion[3 + k] -= mean;
    }
    theory_pair_resistance(law, s[0].radius, s[1].radius, r, R);
    for (int row = 0; row < 12; row++) {
        load[row] = 0.0;
        for (int column = 0; column < 12; column++)
            load[row] -= R[12 * row + column] * motion[column];
    }
    for (int k = 0; k < 3; k++) {
        out->force[0][k] = load[k];
        out->force[1][k] = load[3 + k];
        out->torque[0][k] = load[6 + k];
        out->torque[1][k] = load[9 + k];
        for (int l = 0; l < 3; l++)
            out->stress[k][l] = load[k] * r[l];
    }
}

/*
 * T_1 + T_2 + r x F_2 = h n x F_2: the truncated couplings balance angular momentum with the arms a_1 + a_2 of the touching
 * pair, while the forces act over r = a_1 + a_2 + h. A property of the model, not a fault. Source: physics of the truncation,
 * from B_1 + B_2 = -(a_1 + a_2) Y_A and C_11 + C_12 = -(a_1 + a_2) B_1; second origin: the sum itself, in the tests.
 */
void theory_lubrication_torque_residual(const struct theory_lubrication *law, const struct theory_sphere s[2], double residual[3])
{
    struct theory_pair pair;
    double r[3], distance = 0.0;
    theory_lubrication_pair(law, s, &pair);
    for (int k = 0; k < 3; k++) {
        r[k] = s[1].x[k] - s[0].x[k];
        distance += r[k] * r[k];
    }
    distance = sqrt(distance);
    const double fraction = law->exact_rotation ? 0.0 : (distance - s[0].radius - s[1].radius) / distance;
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        residual[k] = fraction * (r[l] * pair.force[1][m] - r[m] * pair.force[1][l]);
    }
}
