/*
 * Two spheres exactly: twin multipoles, and whether what is put near contact is their limit
 *
 * Jeffrey & Onishi (1984), J. Fluid Mech. 139, 261: velocities expanded in solid harmonics about both centres; the coefficients P, V, Q (degree n,
 * powers p and q of a_1/r and a_2/r) follow from each other (sections 3, 4, 7; the transverse Q as corrected by Ichiki). With x = 2/s, s = 2 r/(a_1 + a_2),
 *
 *     X^A_11 = sum_even F_m x^m,   -X^A_12 = sum_odd F_m x^m,   F_m = (1 + lambda)^-m sum_q P_1(m-q)q lambda^q            [6 pi eta a_1]
 *     Y^A likewise from the transverse recursion;   Y^B_11 = sum_odd 2 F_m, F of Q                                         [4 pi eta a_1^2]
 *     Y^C_11 = sum_even F_m, Y^C_12 = lambda sum_odd F_m, F of Q in the recursion that starts from rotation                [8 pi eta a_1^3]
 *
 * g1/xi + g2 ln(1/xi) near contact (x -> 1) means F_m -> g1 + 2 g2/m, and what remains beside it tends to the constant
 *
 *     A = F_0 - g1/4 + sum_even>0 (F_m - g1 - 2 g2/m)     or     A = g1/4 + 2 g2 ln 2 + sum_odd (F_m - g1 - 2 g2/m)
 *
 * The F_m approach this with a slowly decaying ripple (other singularities of x near the unit circle), so g1, g2 and A are read off the second half of the
 * terms by least squares, and good to a few per mille: this confirms that the scalars are the limit of the exact solution; their digits come from near_field.c.
 */
#include "audit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ORDER = 90, SIZE = ORDER + 2 };

struct multipoles { quad (*P)[SIZE][SIZE], (*V)[SIZE][SIZE], (*Q)[SIZE][SIZE], choose[2 * SIZE][SIZE]; };

static quad at(quad (*A)[SIZE][SIZE], int n, int p, int q)
{
    return p < 0 || q < 0 || n < 1 || n >= SIZE || p >= SIZE ? 0 : A[n][p][q];
}

/* Axisymmetric: sphere 1 moves along the line of centres. */
static void axisymmetric(struct multipoles *m, int n, int p, int q)
{
    quad P = 0, V = 0;
    for (int s = 1; s <= q; s++) {
        const quad c = m->choose[n + s][n], N = n, S = s;
        P += c * (N * (2 * N + 1) * (2 * N * S - N - S + 2) / (2 * (N + 1) * (2 * S - 1) * (N + S)) * at(m->P, s, q - s, p - n + 1)
                  - N * (2 * N - 1) / (2 * (N + 1)) * at(m->P, s, q - s, p - n - 1)
                  - N * (4 * N * N - 1) / (2 * (N + 1) * (2 * S + 1)) * at(m->V, s, q - s - 2, p - n + 1));
        V -= 2 * N / ((N + 1) * (2 * N + 3)) * c * at(m->P, s, q - s, p - n - 1);
    }
    m->P[n][p][q] = P;
    m->V[n][p][q] = P + V;
}

/* Across the line of centres; rotation obeys the same rules from another start. */
static void transverse(struct multipoles *m, int n, int p, int q)
{
    quad P = 0, V = 0, Q = 0;
    for (int s = 1; s <= q; s++) {
        const quad c = m->choose[n + s][n + 1], N = n, S = s;
        P += c * ((2 * N + 1) / (2 * (N + 1)) * (3 * (N + S) - (N * S + 1) * (2 * N * S - S - N + 2)) / (S * (N + S) * (2 * S - 1)) * at(m->P, s, q - s, p - n + 1)
                  + N * (2 * N - 1) / (2 * (N + 1)) * at(m->P, s, q - s, p - n - 1)
                  + N * (4 * N * N - 1) / (2 * (N + 1) * (2 * S + 1)) * at(m->V, s, q - s - 2, p - n + 1)
                  - 2 * (4 * N * N - 1) / (3 * (N + 1)) * at(m->Q, s, q - s - 1, p - n + 1));
        V += 2 * N / ((N + 1) * (2 * N + 3)) * c * at(m->P, s, q - s, p - n - 1);
        Q += c * (S / (N + 1) * at(m->Q, s, q - s - 1, p - n) - 3 / (2 * N * S * (N + 1)) * at(m->P, s, q - s, p - n));
    }
    m->P[n][p][q] = P;
    m->V[n][p][q] = P + V;
    m->Q[n][p][q] = Q;
}

enum { MOVES_ALONG, MOVES_ACROSS, TURNS };

static void run(struct multipoles *m, int start)
{
    memset(m->P, 0, sizeof(quad) * SIZE * SIZE * SIZE);
    memset(m->V, 0, sizeof(quad) * SIZE * SIZE * SIZE);
    memset(m->Q, 0, sizeof(quad) * SIZE * SIZE * SIZE);
    if (start == TURNS)
        m->Q[1][0][0] = 1;
    else
        m->P[1][0][0] = m->V[1][0][0] = 1;
    for (int sum = 1; sum <= ORDER; sum++)
        for (int q = 0; q <= sum; q++)
            for (int n = 1; n <= sum - q + 1; n++)
                (start == MOVES_ALONG ? axisymmetric : transverse)(m, n, sum - q, q);
}

static void terms(quad (*A)[SIZE][SIZE], quad lambda, quad factor_of_odd, quad F[ORDER + 1])
{
    for (int k = 0; k <= ORDER; k++) {
        quad sum = 0;
        for (int q = k; q >= 0; q--)
            sum = sum * lambda + A[1][k - q][q];
        F[k] = sum * (k % 2 ? factor_of_odd : 1) / powq(1 + lambda, k);
    }
}

/* What the tail says of g1 and g2, each with the other given, and the constant beside them. */
struct limit { quad g1, g2, A; };

static struct limit limit_of(const quad F[ORDER + 1], int parity, quad g1, quad g2)
{
    struct limit l = { 0, 0, 0 };
    quad sum = parity ? g1 / 4 + 2 * g2 * logq(2) : F[0] - g1 / 4;
    quad ones = 0, inverse = 0, square = 0, value = 0, mixed = 0, sums = 0, sums_mixed = 0;     /* straight lines in 1/m by least squares */
    for (int m = parity ? 1 : 2; m <= ORDER; m += 2) {
        sum += F[m] - g1 - 2 * g2 / m;
        if (m <= ORDER / 2)
            continue;
        const quad slope = (F[m] - g1) * m / 2;         /* g2 + c/m */
        ones += 1;
        inverse += (quad)1 / m;
        square += (quad)1 / ((quad)m * m);
        value += slope;
        mixed += slope / m;
        l.g1 += F[m] - 2 * g2 / m;
        sums += sum;
        sums_mixed += sum / m;
    }
    l.g1 /= ones;
    l.A = (sums * square - sums_mixed * inverse) / (ones * square - inverse * inverse);
    l.g2 = (value * square - mixed * inverse) / (ones * square - inverse * inverse);
    return l;
}

/* Coefficients of 1/xi and ln(1/xi) in the theory's own scalars, from their values at two gaps. */
static void theory_coefficients(double lambda, double g1[THEORY_SCALARS], double g2[THEORY_SCALARS])
{
    const struct theory_lubrication law = { 1.0, 1e-6, 1.0, false };
    double one[THEORY_SCALARS], two[THEORY_SCALARS];
    const double x = 0.01, y = 0.04, det = -log(y) / x + log(x) / y;
    theory_scalars(&law, 1.0, lambda, (1.0 + lambda) * (1.0 + 0.5 * x), one);
    theory_scalars(&law, 1.0, lambda, (1.0 + lambda) * (1.0 + 0.5 * y), two);
    for (int q = 0; q < THEORY_SCALARS; q++) {
        const double unit = q <= THEORY_YA ? 6.0 * M_PI : q <= THEORY_B2 ? 4.0 * M_PI : 8.0 * M_PI;
        g1[q] = (-log(y) * one[q] + log(x) * two[q]) / det / unit;
        g2[q] = (two[q] / x - one[q] / y) / det / unit;
    }
}

void audit_two_spheres(void)
{
    /* constants of equal spheres as Jeffrey & Onishi (1984) print them, four digits */
    static const struct { const char *name; int scalar, parity; double sign, printed; } function[] = {
        { "X_11", THEORY_XA, 0, 1, 0.9954 },  { "X_12", THEORY_XA, 1, -1, -0.3502 }, { "Y_11", THEORY_YA, 0, 1, 0.9983 },
        { "Y_12", THEORY_YA, 1, -1, -0.2737 }, { "B_11", THEORY_B1, 1, 1, 0.2390 },  { "C_11", THEORY_C11, 0, 1, 0.7028 },
        { "C_12", THEORY_C12, 1, 1, -0.0274 } };
    static const double lambdas[3] = { 1.0, 1.4, 0.2 };
    struct multipoles *m = calloc(1, sizeof *m);
    static quad F[3][7][ORDER + 1];
    m->P = calloc(SIZE, sizeof *m->P);
    m->V = calloc(SIZE, sizeof *m->V);
    m->Q = calloc(SIZE, sizeof *m->Q);
    for (int n = 0; n < 2 * SIZE; n++)
        for (int k = 0; k < SIZE; k++)
            m->choose[n][k] = k == 0 ? 1 : n == 0 ? 0 : m->choose[n - 1][k] + m->choose[n - 1][k - 1];
    run(m, MOVES_ALONG);        /* the coefficients know nothing of lambda: one run serves all */
    for (int l = 0; l < 3; l++)
        terms(m->P, lambdas[l], 1, F[l][0]);
    run(m, MOVES_ACROSS);
    for (int l = 0; l < 3; l++) {
        terms(m->P, lambdas[l], 1, F[l][2]);
        terms(m->Q, lambdas[l], 2, F[l][4]);
    }
    run(m, TURNS);
    for (int l = 0; l < 3; l++)
        terms(m->Q, lambdas[l], lambdas[l], F[l][5]);
    for (int part = 0; part < 4; part++) {
        static const char *const name[] = { "coefficient of 1/xi against the exact series", "coefficients of ln(1/xi) against the exact series",
                                            "exact less near-field: published constants", "exact less near-field: stays bounded" };
        static const double allowed[] = { 1e-3, 3e-2, 1e-3, 0.3 };
        static const char *const reason[] = { "ripple of the series' terms", "ripple of the series' terms, times m/2 of them", "ripple of the partial sums; the table prints 4 digits",
                                              "of xi ln(1/xi) times 4, what the next terms of the expansion come to" };
        audit_quantity(name[part], "twin multipoles, 90 orders", allowed[part], reason[part], "");
        for (int l = 0; l < 3; l++) {
            double g1[THEORY_SCALARS], g2[THEORY_SCALARS];
            theory_coefficients(lambdas[l], g1, g2);
            for (int f = 0; f < 7; f++) {
                const int q = function[f].scalar;
                const quad *series = F[l][f == 1 ? 0 : f == 3 ? 2 : f == 6 ? 5 : f];
                const struct limit at_contact = limit_of(series, function[f].parity, g1[q], g2[q]);
                if (part == 0 && q == THEORY_XA)
                    audit_see(g1[q], at_contact.g1, 1.0, function[f].name);
                if (part == 1)
                    audit_see(g2[q], at_contact.g2, fmax(fabs(g2[q]), 0.1), function[f].name);
                if (part == 2 && l == 0)
                    audit_see(function[f].printed, function[f].sign * at_contact.A, 1.0, function[f].name);
                for (int k = 0; part == 3 && k < 3; k++) {      /* summed as it stands, where 90 orders are enough or nearly so */
                    const quad xi = k == 0 ? (quad)0.2 : k == 1 ? (quad)0.1 : (quad)0.05, x = 1 / (1 + xi / 2);
                    quad exact = 0, power = 1, rest;
                    for (int n = 0; n <= ORDER; n++, power *= x)
                        exact += n % 2 == function[f].parity ? power * (series[n] - (n ? g1[q] + 2 * (quad)g2[q] / n : 0)) : 0;
                    rest = exact + (function[f].parity ? g1[q] * x / (1 - x * x) + g2[q] * logq((1 + x) / (1 - x)) : g1[q] * x * x / (1 - x * x) - g2[q] * logq(1 - x * x));
                    audit_see((double)at_contact.A, rest - g1[q] / xi + g2[q] * logq(xi), (double)(-4 * xi * logq(xi)), function[f].name);
                }
            }
        }
    }
    free(m->P);
    free(m->V);
    free(m->Q);
    free(m);
}
