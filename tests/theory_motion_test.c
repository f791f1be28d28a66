/*
 * The closed forms of validation/theory for one sphere, for an average over pairs and for a crowd, against their second
 * origins: quadrature, another derivation, another description of the same lattice.
 */
#include "suite.h"
#include "theory/theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>

static const double rounding = 1e-13;   /* a few dozen double operations, each wrong by 1.1e-16 */

static void drag_power_and_einstein_slope(void)
{
    const double G[3][3] = { { 0.0, -0.4, 0.0 }, { 0.0, 0.0, 0.0 }, { 0.0, 0.3, 0.0 } };
    const struct theory_sphere s = { .radius = 1.3, .x = { 1.0, 2.0, -1.0 }, .u = { 0.1, -0.7, 0.2 }, .w = { 0.3, 0.2, -0.5 } };
    double force[3], torque[3], stresslet[3][3], power = 0.0;
    theory_drag(0.7, true, G, &s, force, torque, stresslet);
    const double volume = 4.0 / 3.0 * M_PI * pow(1.3, 3);
    check_relative(stresslet[0][1] / volume, 2.5 * 0.7 * -0.4, rounding, "Einstein, xy");
    check_relative(stresslet[1][2] / volume, 2.5 * 0.7 * 0.3, rounding, "Einstein, yz");
    check_close(torque[0], 8.0 * M_PI * 0.7 * pow(1.3, 3) * (0.15 - 0.3), 1e-12, "spin x follows +dU_z/dy / 2");
    check_close(torque[2], 8.0 * M_PI * 0.7 * pow(1.3, 3) * (0.2 + 0.5), 1e-12, "spin z follows -dU_x/dy / 2");
    check_close(force[0], 6.0 * M_PI * 0.7 * 1.3 * (-0.8 - 0.1), 1e-12, "drag towards the flow");
    const double rest[3][3] = { { 0.0 } };
    theory_drag(0.7, false, rest, &s, force, torque, stresslet);
    for (int k = 0; k < 3; k++) {
        power -= force[k] * s.u[k];
        check_true(torque[k] == 0.0, "no torque where it is switched off");
    }
    check_relative(power, 6.0 * M_PI * 0.7 * 1.3 * (0.1 * 0.1 + 0.7 * 0.7 + 0.2 * 0.2), rounding, "power");
}

struct sphere_in_bath { double kT, mass, friction, until; };

static double velocity_part(double t, void *p)
{
    const struct sphere_in_bath *b = p;
    return 2.0 * (b->until - t) * theory_langevin_vacf(b->kT, b->mass, b->friction, t);
}

/* 2 int (t - t') <u u(t')> dt' by quadrature to 1e-12; and Li's eq 4.2, (2/27 pi)(tau_I/tau_B)(4.5 s - 1 + e^(-4.5 s)) a^2. */
static void langevin_agrees_with_quadrature_and_with_li(void)
{
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(100);
    const double a = 1.3, rho = 0.9, eta = 0.7, kT = 0.31, mass = 4.0 / 3.0 * M_PI * rho * a * a * a, friction = 6.0 * M_PI * eta * a;
    for (double t = 1e-5; t < 1e3; t *= 3.7) {
        struct sphere_in_bath bath = { kT, mass, friction, t };
        gsl_function f = { velocity_part, &bath };
        double quadrature = 0.0, error;
        /* in pieces: beyond a few relaxation times the exponential hides in a corner of the interval */
        for (double from = 0.0, to = fmin(t, 1.0); from < t; from = to, to = fmin(t, 3.0 * to)) {
            double part;
            gsl_integration_qag(&f, from, to, 0.0, 1e-12, 100, GSL_INTEG_GAUSS31, space, &part, &error);
            quadrature += part;
        }
        check_relative(theory_langevin_msd(kT, mass, friction, t), quadrature, 1e-11, "quadrature");
        const double tau_I = rho * a * a / eta, tau_B = eta * a * a * a / kT, s = 4.5 * t / tau_I;
        if (s > 0.1)   /* the printed form cancels below: 1e-16/s^2 */
            check_relative(theory_langevin_msd(kT, mass, friction, t), 2.0 / (27.0 * M_PI) * tau_I / tau_B * (s - 1.0 + exp(-s)) * a * a,
                           1e-12, "Li eq 4.2");
    }
    gsl_integration_workspace_free(space);
}

/*
 * Exact Ornstein-Uhlenbeck steps of (x, u) in the small-step limit by moments: d<x x'> follows from d<x u'>. The covariance of
 * displacements at two times is int_0^s int_0^t <u u> and must be positive definite.
 */
static void langevin_covariance_is_consistent(void)
{
    const double kT = 0.31, mass = 2.0, friction = 5.0, tau = mass / friction;
    for (double s = 0.01; s < 20.0; s *= 2.3)
        for (double t = s; t < 40.0; t *= 1.9) {
            const double c = theory_langevin_msd_covariance(kT, mass, friction, s, t);
            /* the double integral done by hand: (kT/m) tau [ 2 s - tau (1 - e^-s - e^-t + e^-(t-s)) ], times in tau */
            const double by_hand = kT / mass * tau * (2.0 * s - tau * (1.0 - exp(-s / tau) - exp(-t / tau) + exp(-(t - s) / tau)));
            check_relative(c, by_hand, 1e-12 + 1e-14 * pow(tau / s, 2), "double integral of the velocity correlation"); /* cancels */
            check_true(c * c <= theory_langevin_msd(kT, mass, friction, s) * theory_langevin_msd(kT, mass, friction, t) * (1 + 1e-12),
                       "Cauchy-Schwarz");
        }
}

/* Simple shear x along y by hand: y relaxes, x follows the velocity at the place where y has got to. */
static void free_sphere_agrees_with_simple_shear_by_hand(void)
{
    const double rate = -1.7, tau = 0.48, spin_tau = 0.144, v = 3.1, G[3][3] = { { 0.0, rate, 0.0 }, { 0.0 }, { 0.0 } };
    const struct theory_sphere start = { .radius = 1.3, .x = { 1.1, 2.3, -0.7 }, .u = { 0.4, v, -0.9 }, .w = { 0.3, -0.2, 0.0 } };
    struct theory_sphere now;
    for (double t = 0.01; t < 5.0; t *= 2.1) {
        theory_free_sphere(G, tau, spin_tau, t, &start, &now);
        const double s = t / tau, e = exp(-s), far = start.x[1] + v * tau, a = start.u[0] - rate * far;
        check_close(now.x[1], far - v * tau * e, 1e-12, "y");
        check_close(now.u[0], rate * far + (a - rate * v * t) * e, 1e-12, "velocity along the flow");
        check_close(now.x[0], start.x[0] + rate * far * t + a * tau * (1.0 - e) - rate * v * tau * tau * (1.0 - e * (1.0 + s)), 1e-11,
                    "x");    /* terms of size 30 */
        check_close(now.x[2], -0.7 - 0.9 * tau * (1.0 - e), 1e-12, "z");
        check_close(now.w[2], -0.5 * rate * (1.0 - exp(-t / spin_tau)), 1e-13, "spin from rest");
        check_close(now.w[0], 0.3 * exp(-t / spin_tau), 1e-13, "spin across the vorticity dies out");
    }
}

static double closed_average(double log_gap, void *p)
{
    const double xi = exp(log_gap), r = 2.0 + xi;
    double q[THEORY_SCALARS];
    theory_scalars(p, 1.0, 1.0, r, q);
    return pow(r, 4) * (q[THEORY_XA] / 15.0 + q[THEORY_YA] / 10.0) * xi;
}

static double closed_average_frozen(double xi, void *p)
{
    const double r = 2.0 + xi;
    double q[THEORY_SCALARS];
    theory_scalars(p, 1.0, 1.0, r, q);
    return pow(r, 4) * (q[THEORY_XA] / 15.0 + q[THEORY_YA] / 10.0);
}

/* c = 9/(8 pi) int r^4 (X_A/15 + Y_A/10) dr, the angular average done by hand. */
static void phi2_coefficient_agrees_with_the_closed_average(void)
{
    gsl_error_handler_t *handler = gsl_set_error_handler_off();   /* a quadrature at the limit of rounding is what we want */
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(100);
    const double outer[2] = { 0.05, 0.1 }, inner[2] = { 1e-3, 1e-4 };
    for (int k = 0; k < 2; k++) {
        struct theory_lubrication law = { 1.0, inner[k], outer[k] * (1.0 + 1e-12), false };
        gsl_function f = { closed_average_frozen, &law };
        double frozen, outside, error, estimate;
        gsl_integration_qag(&f, 0.0, inner[k], 0.0, 1e-13, 100, GSL_INTEG_GAUSS31, space, &frozen, &error);
        f.function = closed_average;
        gsl_integration_qag(&f, log(inner[k]), log(outer[k]), 0.0, 1e-13, 100, GSL_INTEG_GAUSS31, space, &outside, &error);
        const double c = theory_phi2_coefficient(inner[k], outer[k], &estimate);
        check_relative(c, 9.0 / (8.0 * M_PI) * (frozen + outside), 1e-11, "closed angular average");
        check_true(estimate < 1e-9, "error estimate");
    }
    check_close(theory_phi2_coefficient(1e-3, 0.05, NULL), 9.7, 0.05, "about 9.7 for gaps 1e-3 to 0.05");
    gsl_integration_workspace_free(space);
    gsl_set_error_handler(handler);

    /* V sigma_xy/(eta rate) of one isotropic pair of unit spheres: table with two decimals */
    const double gap[3] = { 1e-3, 1e-2, 0.05 }, value[3] = { 1274.40, 138.03, 33.92 };
    const struct theory_lubrication law = { 1.0, 1e-3, 0.0500001, false };
    for (int k = 0; k < 3; k++) {
        double q[THEORY_SCALARS];
        theory_scalars(&law, 1.0, 1.0, 2.0 + gap[k], q);
        check_close(pow(2.0 + gap[k], 2) * (q[THEORY_XA] / 15.0 + q[THEORY_YA] / 10.0), value[k], 0.006, "isotropic pair");
    }
}

/* The same lattice told with other cell vectors, and particles moved to other images (with the velocity of that image). */
static void crowd_does_not_care_how_the_lattice_is_told(void)
{
    enum { COUNT = 60 };
    const double G[3][3] = { { 0.0, -0.4, 0.0 }, { 0.0, 0.0, 0.0 }, { 0.0, 0.7, 0.0 } };
    const double cell[3][3] = { { 7.1, 0.0, 0.0 }, { 2.2, 9.3, 0.0 }, { 0.0, -1.1, 8.7 } };
    double sheared[3][3], one[3][3], two[3][3];
    const struct theory_lubrication law = { 0.7, 1e-3, 0.05, false };
    struct theory_sphere s[COUNT];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int i = 0; i < COUNT; i++) {
        s[i].radius = i % 2 ? 0.9 : 1.3;
        for (int k = 0; k < 3; k++)
            s[i].x[k] = gsl_rng_uniform(rng) * 9.0;
        for (int k = 0; k < 3; k++) {
            s[i].u[k] = gsl_ran_gaussian(rng, 1.0);
            s[i].w[k] = gsl_ran_gaussian(rng, 1.0);
        }
    }
    theory_crowd_stress(&law, COUNT, s, cell, G, one);
    for (int k = 0; k < 3; k++) {
        sheared[0][k] = cell[0][k];
        sheared[1][k] = cell[1][k] - cell[0][k];
        sheared[2][k] = cell[2][k] + 2.0 * cell[1][k];
    }
    for (int i = 0; i < COUNT; i += 3)
        for (int k = 0; k < 3; k++) {
            s[i].x[k] += cell[2][k] - 2.0 * cell[1][k];
            for (int l = 0; l < 3; l++)
                s[i].u[k] += G[k][l] * (cell[2][l] - 2.0 * cell[1][l]);
        }
    theory_crowd_stress(&law, COUNT, s, (const double (*)[3])sheared, G, two);
    double size = 0.0;
    for (int k = 0; k < 9; k++)
        size = fmax(size, fabs(one[k / 3][k % 3]));
    for (int k = 0; k < 9; k++)   /* a pair at xi = 1e-3 amplifies the rounding of its gap a thousand times */
        check_close(two[k / 3][k % 3], one[k / 3][k % 3], 1e-11 * size, "crowd stress");
    check_true(size > 0.0, "some pairs interact");
    gsl_rng_free(rng);
}

/* Streamlines in any history of the rates, steady shear by the matrix exponential, and a spin that lags behind an oscillation. */
static void driven_sphere_by_closed_forms(void)
{
    const struct theory_stage stage[3] = {
        { 0.8, 2, { { 0, 1, 0.3, 0.0, 1.1, 2.7, 0.4 }, { 2, 1, -0.7, 0.5, 0.0, 1.0, 0.0 } } }, { 0.5, 0, { { 0 } } }, { 2.0, 1, { { 0, 1, -1.3, 0, 0, 1, 0 } } } };
    const bool periodic[3] = { false, false, false }, open[3] = { false, true, false };
    const double G0 = 0.3 + 1.1 * sin(0.4), tau = 0.31, spin_tau = 0.1;
    const double S = 0.3 * 0.8 + 1.1 / 2.7 * (cos(0.4) - cos(2.7 * 0.8 + 0.4)) - 1.3 * 0.6, Sz = -0.7 * 0.8 + 0.25 * 0.64;
    const struct theory_sphere with = { .radius = 1, .x = { 1, 2, 3 }, .u = { 2 * G0, 0, -1.4 } };
    struct theory_sphere now, other, far;
    check_true(theory_driven_sphere(stage, 3, periodic, tau, spin_tau, 1.9, &with, &now), "reaches its end");
    check_close(now.x[0], 1 + 2 * S, 1e-11, "streamline along x");
    check_close(now.x[2], 3 + 2 * Sz, 1e-11, "streamline along z");
    check_close(now.u[0], -1.3 * 2, 1e-11, "moves with the flow of the moment");
    /* an open axis: nothing carries it along, at rest it relaxes */
    check_true(theory_driven_sphere(stage, 1, open, tau, spin_tau, 0.8, &with, &now) && theory_driven_sphere(stage, 1, open, tau, spin_tau, 3.8, &with, &far), "end");
    check_close(far.u[2], now.u[2] * exp(-3.0 / tau), 1e-11, "a stop of the flow leaves its velocity to the drag");
    const double G[3][3] = { { 0, -1.3, 0 } };
    const struct theory_sphere thrown = { .radius = 1, .x = { 1, 2, 3 }, .u = { 3, -2, 1 }, .w = { 1, -1, 2 } };
    theory_free_sphere(G, tau, spin_tau, 1.7, &thrown, &other);
    check_true(theory_driven_sphere(&stage[2], 1, open, tau, spin_tau, 1.7, &thrown, &now), "end");
    for (int k = 0; k < 3; k++) {
        check_close(now.x[k], other.x[k], 1e-10, "steady: place");
        check_close(now.u[k], other.u[k], 1e-10, "steady: velocity");
        check_close(now.w[k], other.w[k], 1e-10, "steady: spin");
    }
    /* w' = (- sin(f t)/2 - w)/T goes over to - sin(f t - atan(f T))/(2 sqrt(1 + f^2 T^2)) */
    const struct theory_stage swing = { 60.0, 1, { { 0, 1, 0.0, 0.0, 1.0, 4.0, 0.0 } } };
    check_true(theory_driven_sphere(&swing, 1, periodic, tau, spin_tau, 5.0, &with, &now), "end");
    check_close(now.w[2], -0.5 * sin(20.0 - atan(0.4)) / sqrt(1.16), 1e-11, "phase lag of the spin");
    double way, flow[3][3];
    theory_driven_flow(stage, 3, 1.9, flow, &way);
    const double back = (M_PI + asin(0.3 / 1.1) - 0.4) / 2.7, there = 0.3 * back + 1.1 / 2.7 * (cos(0.4) - cos(2.7 * back + 0.4));
    const double whole = 0.3 * 0.8 + 1.1 / 2.7 * (cos(0.4) - cos(2.7 * 0.8 + 0.4));
    check_close(way, (back < 0.8 ? 2 * there - whole : whole) + 1.3 * 0.6, 1e-6, "way travelled");
    check_close(flow[0][1], -1.3, 0, "flow of the moment");
}

static const struct unit_test tests[] = {
    { "drag: power and Einstein's slope", drag_power_and_einstein_slope },
    { "Langevin agrees with quadrature and with Li", langevin_agrees_with_quadrature_and_with_li },
    { "Langevin covariance is consistent", langevin_covariance_is_consistent },
    { "a free sphere agrees with simple shear by hand", free_sphere_agrees_with_simple_shear_by_hand },
    { "phi^2 coefficient agrees with the closed average", phi2_coefficient_agrees_with_the_closed_average },
    { "a crowd does not care how its lattice is told", crowd_does_not_care_how_the_lattice_is_told },
    { "a sphere in driven flows agrees with closed forms", driven_sphere_by_closed_forms },
    { NULL, NULL }
};

const struct suite theory_motion_suite = { "theory-motion", tests };
