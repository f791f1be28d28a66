/*
 * Resistance of two spheres near contact, from lubrication theory in the gap (not from multipoles)
 *
 * Gap along z between sphere 1 below and sphere 2 above, distance r from the line of centres, H(r) = h + g r^2, g = (1/a_1 + 1/a_2)/2.
 *
 * Squeezing, velocity V of approach. Mass conservation gives the flux r V/2 through every r, whatever the form of the gap, so
 *
 *     leading order   dp/dr = -6 eta V r/H^3,   F = 2 pi int p r dr = -pi int (dp/dr) r^2 dr     ->  coefficient of 1/h  (Reynolds 1886)
 *     next order      far out, r^2 >> h/g, everything is a power of r times a polynomial in z/r^2:
 *                     u_r = (1/r) f + r^1 u ... , p = p_0 + (eta/r^2)(G + w),  and F = 2 pi eta G int dr/r  ->  coefficient of ln(1/h)
 *
 *     f = -(3/g^3)(s + b/2)(s - a/2),  s = z/r^2, a = 1/a_2, b = 1/a_1           flux r V/2, no slip
 *     w = 2 s f'                                                               dw_z/dz from continuity: p varies across the gap
 *     u'' = -2 G - 2 w - 2 s w' - D f                                          radial momentum; D f from d^2/dr^2 + (1/r) d/dr - 1/r^2
 *     u(a/2) = -(a^3/8) f'(a/2), u(-b/2) = (b^3/8) f'(-b/2), int u ds = 0       no slip on the spheres (fourth order of their form), flux: fixes G
 *
 * The normal force is 2 pi int G r dr: on a wall without slip the viscous stresses add up to what w adds to the pressure, and cancel it.
 *
 * Sliding and rolling. Surfaces move with s_1 = U_1 + a_1 W_1, s_2 = U_2 - a_2 W_2 along x (spins about y); Reynolds's equation
 *
 *     div(H^3 grad p) = 12 eta K x,   K = g (s_1 + s_2) - U_1/a_1 - U_2/a_2,   far out p = -(6/5)(eta K/g^3) x/r^4
 *
 * and the tractions integrate to  (force, torque) = pi [...] int dr/r:
 *
 *     F_1 = -F_2 : C (g - 1/a_1) + 2 eta (s_2 - s_1)/g ;   T_1/a_1 : C g + 2 eta (s_2 - s_1)/g ;   T_2/a_2 : -C g + 2 eta (s_2 - s_1)/g ;   C = -(6/5) eta K/g^3
 *
 * int dr/r over the region where this holds, from r^2 = h/g to r of the spheres' size, is ln(1/h)/2 and a constant, which the model drops.
 */
#include "audit.h"

#include <string.h>

/* --- polynomials of degree below 8 --- */

enum { TERMS = 8 };
struct polynomial { quad c[TERMS]; };

static struct polynomial slope_of(struct polynomial p)
{
    struct polynomial d = { { 0 } };
    for (int k = 1; k < TERMS; k++)
        d.c[k - 1] = k * p.c[k];
    return d;
}

static struct polynomial times_s(struct polynomial p)
{
    struct polynomial q = { { 0 } };
    for (int k = 1; k < TERMS; k++)
        q.c[k] = p.c[k - 1];
    return q;
}

static struct polynomial primitive_of(struct polynomial p)
{
    struct polynomial q = { { 0 } };
    for (int k = 1; k < TERMS; k++)
        q.c[k] = p.c[k - 1] / k;
    return q;
}

static struct polynomial mixed(quad one, struct polynomial p, quad two, struct polynomial q)
{
    struct polynomial m;
    for (int k = 0; k < TERMS; k++)
        m.c[k] = one * p.c[k] + two * q.c[k];
    return m;
}

static quad at(struct polynomial p, quad s)
{
    quad value = 0;
    for (int k = TERMS - 1; k >= 0; k--)
        value = value * s + p.c[k];
    return value;
}

/* What d/dr makes of r^m f(z/r^2), as the factor of r^(m-1). */
static struct polynomial radial_slope(int m, struct polynomial f)
{
    return mixed(m, f, -2, times_s(slope_of(f)));
}

/* --- squeezing --- */

/* The flux that remains when G is guessed; it is linear in G. */
static quad flux_left(quad G, quad g, quad upper, quad lower)
{
    const quad top = upper / 2, bottom = -lower / 2;
    struct polynomial f = { { -3 / (g * g * g) * (-bottom) * (-top), -3 / (g * g * g) * (-bottom - top), -3 / (g * g * g) } };
    const struct polynomial f1 = radial_slope(-1, f), f2 = radial_slope(-2, f1), df = slope_of(f);
    const struct polynomial Df = mixed(1, mixed(1, f2, 1, f1), -1, f), w = mixed(2, times_s(df), 0, f);
    struct polynomial bend = mixed(-1, mixed(2, w, 2, times_s(slope_of(w))), -1, Df);
    bend.c[0] -= 2 * G;
    struct polynomial u = primitive_of(primitive_of(bend));
    const quad want_top = -upper * upper * upper / 8 * at(df, top), want_bottom = lower * lower * lower / 8 * at(df, bottom);
    const quad tilt = ((want_top - at(u, top)) - (want_bottom - at(u, bottom))) / (top - bottom);
    u.c[0] += want_top - at(u, top) - tilt * top;
    u.c[1] += tilt;
    const struct polynomial U = primitive_of(u);
    return at(U, top) - at(U, bottom);
}

static quad reynolds(quad t, const void *with)
{
    /* -(dp/dr) r^2 with h = g = 1 and r = t/(1 - t), over eta V */
    (void)with;
    const quad r = t / (1 - t), H = 1 + r * r;
    return 6 * r * r * r / (H * H * H) / ((1 - t) * (1 - t));
}

/* --- sliding and rolling: force and torques per ln(1/h) for one motion --- */

static void shearing(quad eta, quad a1, quad a2, quad U1, quad U2, quad W1, quad W2, quad *force1, quad *torque1, quad *torque2)
{
    const quad g = (1 / a1 + 1 / a2) / 2, s1 = U1 + a1 * W1, s2 = U2 - a2 * W2;
    const quad K = g * (s1 + s2) - U1 / a1 - U2 / a2, C = -(quad)6 / 5 * eta * K / (g * g * g), drag = 2 * eta * (s2 - s1) / g;
    const quad half_pi = PIQ / 2;
    *force1 = half_pi * (C * (g - 1 / a1) + drag);
    *torque1 = half_pi * a1 * (C * g + drag);
    *torque2 = half_pi * a2 * (-C * g + drag);
}

void near_field_coefficients(quad eta, quad a1, quad a2, quad inverse[THEORY_SCALARS], quad logarithm[THEORY_SCALARS])
{
    static quad reynolds_integral = 0;
    static struct { quad eta, a1, a2, inverse[THEORY_SCALARS], logarithm[THEORY_SCALARS]; } last;       /* trajectories ask for one pair again and again */
    if (reynolds_integral == 0)
        reynolds_integral = integral(reynolds, 0, 0, 1);
    if (last.eta == eta && last.a1 == a1 && last.a2 == a2) {
        memcpy(inverse, last.inverse, sizeof last.inverse);
        memcpy(logarithm, last.logarithm, sizeof last.logarithm);
        return;
    }
    const quad g = (1 / a1 + 1 / a2) / 2, mean = (a1 + a2) / 2;
    const quad still = flux_left(0, g, 1 / a2, 1 / a1), slope = flux_left(1, g, 1 / a2, 1 / a1) - still;
    for (int q = 0; q < THEORY_SCALARS; q++)
        inverse[q] = 0;
    /* with r^2 = (h/g) R^2 the integral is (1/(g^2 h)) times that for h = g = 1; h = xi mean */
    inverse[THEORY_XA] = PIQ * eta * reynolds_integral / (g * g * mean);
    logarithm[THEORY_XA] = PIQ * eta * (-still / slope);

    /* F_1 = Y_A (U_2 - U_1) + B_1 W_1 + B_2 W_2 along x; T_1 = -B_1 (U_2 - U_1) - C_11 W_1 - C_12 W_2 about y, n = z */
    quad force, torque1, torque2;
    shearing(eta, a1, a2, 0, 1, 0, 0, &force, &torque1, &torque2);
    logarithm[THEORY_YA] = force;
    shearing(eta, a1, a2, 0, 0, 1, 0, &force, &torque1, &torque2);
    logarithm[THEORY_B1] = force;
    logarithm[THEORY_C11] = -torque1;
    logarithm[THEORY_C12] = -torque2;
    shearing(eta, a1, a2, 0, 0, 0, 1, &force, &torque1, &torque2);
    logarithm[THEORY_B2] = force;
    logarithm[THEORY_C22] = -torque2;
    last.eta = eta;
    last.a1 = a1;
    last.a2 = a2;
    memcpy(last.inverse, inverse, sizeof last.inverse);
    memcpy(last.logarithm, logarithm, sizeof last.logarithm);
}

void near_field_scalars(quad eta, quad inner, quad outer, bool exact, quad a1, quad a2, quad distance, quad scalar[THEORY_SCALARS])
{
    quad inverse[THEORY_SCALARS], logarithm[THEORY_SCALARS];
    const quad sum = a1 + a2, gap = (distance - sum) / (sum / 2), turn = exact ? distance / sum : 1;
    near_field_coefficients(eta, a1, a2, inverse, logarithm);
    for (int q = 0; q < THEORY_SCALARS; q++) {
        const quad xi = gap < inner ? inner : gap;
        scalar[q] = gap > outer ? 0 : inverse[q] / xi - logarithm[q] * logq(xi);
        for (int power = q < THEORY_B1 ? 0 : q < THEORY_C11 ? 1 : 2; power > 0; power--)     /* a spin counts `turn` times */
            scalar[q] *= turn;
    }
}
