/*
 * Stress that encounters of two equal spheres give to a dilute suspension in steady shear
 *
 *     sigma = (n^2/2) int dy dz |rate y| int dt F(r) (x) r ,    n = 3 phi/(4 pi a^3)         c = sigma/(eta rate phi^2)
 *
 * Pairs come from far upstream, where the spheres move with the flow at their places y, z relative to each other, uniformly many;
 * |rate y| dy dz is what passes per time. Nothing acts between them beyond the outer gap (contact alone: beyond touch), so the integral ends
 * at that distance R, and encounters are those with y^2 + z^2 < R^2. In the steady state every pair has come from infinity and goes
 * there again; pairs that orbit each other for ever would have to be there from the start, and if the model captures any, c does not
 * exist: that is reported. Not in here: a far field, three spheres at once.
 *
 *     m dv/dt = - 2 F - 6 pi eta a (v - G r) ,   dr/dt = v ,   I dW/dt = T + 8 pi eta a^3 (Omega - W)
 *     F = (X_A N + Y_A (1 - N)) v + 2 B W x n - k_n delta n ,   T = B v x n - (C_11 + C_12)(1 - N) W
 *
 *     r, v    place and velocity of 2 relative to 1       [L, L/T]           W   spin, the same of both by symmetry       [1/T]
 *     F, T    force and torque on 1                       [M L/T^2, M L^2/T^2]
 *
 * The symmetric pair in its own centre of mass: 9 numbers and the 6 integrals asked for, Runge-Kutta of order 8. The plane of impact
 * is covered in polar coordinates by Gauss points.
 *
 * Source: pair average over incident streamlines, Batchelor & Green (1972), J. Fluid Mech. 56, 401, section 5, for the flux; Li (2026)
 * eq 3.3 to 3.18 for the forces. Second origins (tests/theory_pair_test.c): single encounters by pair_motion.c, which solves both spheres
 * in the laboratory; other numbers of Gauss points.
 */
#include "theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>

#define PI 3.14159265358979323846

enum { R, V = 3, W = 6, CONTACT = 9, LUBRICATION = 12, VARIABLES = 15 };

struct encounter { const struct theory_motion *m; double mass, drag, turn, rate; };

static int derivative(double t, const double y[], double dydt[], void *model)
{
    (void)t;
    const struct encounter *e = model;
    const double a = e->m->radius[0], *v = y + V, *w = y + W, distance = sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]);
    const double n[3] = { y[0] / distance, y[1] / distance, y[2] / distance }, along = v[0] * n[0] + v[1] * n[1] + v[2] * n[2];
    const double spin = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
    double c[THEORY_SCALARS] = { 0.0 }, push = 0.0, squeezed[3];
    if (e->m->lubrication)
        theory_scalars(e->m->lubrication, a, a, distance, c);
    if (e->m->contact)
        push = e->m->contact->normal_stiffness * fmax(2.0 * a - distance, 0.0);
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, q = (k + 2) % 3;
        const double flow = k == 0 ? e->rate * y[1] : 0.0, half_vorticity = k == 2 ? -0.5 * e->rate : 0.0;
        squeezed[k] = c[THEORY_XA] * along * n[k] + c[THEORY_YA] * (v[k] - along * n[k]) + 2.0 * c[THEORY_B1] * (w[l] * n[q] - w[q] * n[l]);
        const double torque = c[THEORY_B1] * (v[l] * n[q] - v[q] * n[l]) - (c[THEORY_C11] + c[THEORY_C12]) * (w[k] - spin * n[k]);
        dydt[k] = v[k];
        dydt[V + k] = (-2.0 * (squeezed[k] - push * n[k]) - e->drag * (v[k] - flow)) / e->mass;
        dydt[W + k] = (torque + e->turn * (half_vorticity - w[k])) / (0.4 * e->mass * a * a);
    }
    for (int part = 0; part < 2; part++) {
        double f[3];
        for (int k = 0; k < 3; k++)
            f[k] = part ? squeezed[k] : -push * n[k];
        double *s = dydt + CONTACT + 3 * part;
        s[0] = 0.5 * (f[0] * y[1] + f[1] * y[0]);
        s[1] = f[0] * y[0] - f[1] * y[1];
        s[2] = f[1] * y[1] - f[2] * y[2];
    }
    return GSL_SUCCESS;
}

bool theory_encounter(const struct theory_motion *m, double y0, double z0, double tolerance, double impulse[2][3], double end[3])
{
    const double a = m->radius[0], reach = 2.0 * a + (m->lubrication ? a * m->lubrication->outer_gap : 0.0), rate = fabs(m->gradient[0][1]);
    struct encounter e = { m, theory_sphere_mass(m, 0), 6.0 * PI * m->viscosity * a, 8.0 * PI * m->viscosity * a * a * a, m->gradient[0][1] };
    double y[VARIABLES] = { 0.0 }, t = 0.0, step = 1e-4 / rate, scale[VARIABLES];
    y[0] = -sqrt(fmax(reach * reach - y0 * y0 - z0 * z0, 0.0)) - 1e-6 * a;
    y[1] = y0;
    y[2] = z0;
    y[V] = e.rate * y0;
    y[W + 2] = -0.5 * e.rate;
    for (int v = 0; v < VARIABLES; v++)
        scale[v] = v < V ? a : v < W ? a * rate : v < CONTACT ? rate : e.drag * a * a;
    gsl_odeiv2_system system = { derivative, NULL, VARIABLES, &e };
    gsl_odeiv2_step *stepper = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, VARIABLES);
    gsl_odeiv2_control *control = gsl_odeiv2_control_scaled_new(tolerance, 0.0, 1.0, 0.0, scale, VARIABLES);
    gsl_odeiv2_evolve *evolve = gsl_odeiv2_evolve_alloc(VARIABLES);
    bool good = stepper && control && evolve, gone = false;
    const double most = (400.0 + 20.0 * reach / y0) / rate;       /* whoever is still there orbits */
    while (good && !gone && t < most) {
        good = gsl_odeiv2_evolve_apply(evolve, control, stepper, &system, &t, most, &step, y) == GSL_SUCCESS;
        gone = y[0] > 0.0 && y[1] > 0.0 && sqrt(y[0] * y[0] + y[1] * y[1] + y[2] * y[2]) > reach * (1.0 + 1e-9);
    }
    gsl_odeiv2_evolve_free(evolve);
    gsl_odeiv2_control_free(control);
    gsl_odeiv2_step_free(stepper);
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < 3; k++)
            impulse[part][k] = y[CONTACT + 3 * part + k];
    for (int k = 0; end && k < 3; k++)
        end[k] = y[k];
    return good && gone;
}

bool theory_sheared_pairs(const struct theory_motion *m, size_t radial, size_t angular, double coefficient[2][3])
{
    const double a = m->radius[0], reach = 2.0 * a + (m->lubrication ? a * m->lubrication->outer_gap : 0.0);
    const double density = 3.0 / (4.0 * PI * a * a * a);
    gsl_integration_glfixed_table *outward = gsl_integration_glfixed_table_alloc(radial), *around = gsl_integration_glfixed_table_alloc(angular);
    bool good = outward && around;
    for (int k = 0; k < 6; k++)
        coefficient[k / 3][k % 3] = 0.0;
    for (size_t i = 0; good && i < radial * angular; i++) {
        double b, angle, wb, wa, impulse[2][3];
        gsl_integration_glfixed_point(0.0, reach, i / angular, &b, &wb, outward);
        gsl_integration_glfixed_point(0.0, 0.5 * PI, i % angular, &angle, &wa, around);
        good = theory_encounter(m, b * cos(angle), b * sin(angle), 1e-9, impulse, NULL);
        /* n^2/2, both signs of y and of z; |rate y| dy dz over eta rate: the rate drops out */
        const double weight = 0.5 * density * density * 4.0 * wb * wa * b * b * cos(angle) / m->viscosity;
        for (int k = 0; k < 6; k++)
            coefficient[k / 3][k % 3] += weight * impulse[k / 3][k % 3];
    }
    gsl_integration_glfixed_table_free(outward);
    gsl_integration_glfixed_table_free(around);
    return good;
}
