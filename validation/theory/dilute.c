/*
 * Second-order viscosity that the model's own lubrication stress gives to spheres placed at random
 *
 *     sigma = (n^2/2) int d^3r  F(r) (x) r ,      n = 3 phi/(4 pi a^3) ,    g(r) = 1 for r >= 2 a
 *     sym sigma_xy = c phi^2 eta rate
 *
 * with F the lubrication force on the sphere at the origin when both spheres move with the undisturbed flow (velocity G x, spin
 * half the vorticity). This is no theory of real suspensions (Batchelor & Green 1972 found 7.6 with all of hydrodynamics and
 * the true pair distribution); it is what the truncated model must add up to, factor for factor.
 *
 * Source: pair average of the Irving-Kirkwood stress. Done here by quadrature over gap (adaptive, in ln xi) and direction
 * (product rule: the integrand is a polynomial of degree 4 in the direction, so 3 Gauss points in cos theta and 6 angles are
 * exact). Second origin: the closed angular average V sigma_xy/(eta rate) = r^2 (X_A/15 + Y_A/10), in tests/theory_test.c.
 */
#include "theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <math.h>

#define PI 3.14159265358979323846

/* Symmetric xy stress of one pair of unit spheres at this gap in unit shear, summed over all directions of r (weight 4 pi). */
static double over_directions(const struct theory_lubrication *law, double xi)
{
    const double cosine[3] = { -sqrt(0.6), 0.0, sqrt(0.6) }, weight[3] = { 5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0 };
    const int angles = 6;
    const double r = 2.0 + xi;
    double sum = 0.0;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < angles; k++) {
            const double sine = sqrt(1.0 - cosine[c] * cosine[c]), angle = 2.0 * PI * (k + 0.5) / angles;
            struct theory_sphere s[2] = { { .radius = 1.0, .w = { 0.0, 0.0, -0.5 } }, { .radius = 1.0, .w = { 0.0, 0.0, -0.5 } } };
            s[1].x[0] = r * sine * cos(angle);
            s[1].x[1] = r * sine * sin(angle);
            s[1].x[2] = r * cosine[c];
            s[1].u[0] = s[1].x[1];
            struct theory_pair pair;
            theory_lubrication_pair(law, s, &pair);
            sum += weight[c] * 2.0 * PI / angles * 0.5 * (pair.stress[0][1] + pair.stress[1][0]);
        }
    return sum;
}

static double shell(double log_gap, void *p)
{
    const double xi = exp(log_gap), r = 2.0 + xi;
    return r * r * over_directions(p, xi) * xi;
}

static double frozen_shell(double xi, void *p)
{
    const double r = 2.0 + xi;
    return r * r * over_directions(p, xi);
}

double theory_phi2_coefficient(double inner_gap, double outer_gap, double *error_estimate)
{
    /* One part in 1e12 beyond the cut-off so that rounding of 2 + xi does not drop the last point. */
    struct theory_lubrication law = { 1.0, inner_gap, outer_gap * (1.0 + 1e-12), false };
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(200);
    double frozen = NAN, outside = NAN, frozen_error = 0.0, outside_error = 0.0;
    /* "Cannot do better than rounding" is good enough here and must not end the program. */
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    if (space) {
        gsl_function f = { frozen_shell, &law };
        const int first = gsl_integration_qag(&f, 0.0, inner_gap, 0.0, 1e-13, 200, GSL_INTEG_GAUSS31, space, &frozen, &frozen_error);
        f.function = shell;
        const int second = gsl_integration_qag(&f, log(inner_gap), log(outer_gap), 0.0, 1e-13, 200, GSL_INTEG_GAUSS31, space,
                                               &outside, &outside_error);
        if ((first && first != GSL_EROUND) || (second && second != GSL_EROUND))
            frozen = NAN;
        gsl_integration_workspace_free(space);
    }
    gsl_set_error_handler(handler);
    const double density = 3.0 / (4.0 * PI);
    if (error_estimate)
        *error_estimate = 0.5 * density * density * (frozen_error + outside_error);
    return 0.5 * density * density * (frozen + outside);
}
