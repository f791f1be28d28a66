/*
 * A sphere without noise in simple shears whose rates change with time, one stage after the other
 *
 *     dx/dt = U ,   dU/dt = (G(t) x - U)/tau + a(t) ,   dW/dt = (curl(G(t) x)/2 - W)/tau_spin
 *     rate(s) = mean + slope s + amplitude sin(frequency s + phase) ,    s since the stage began
 *
 * a = (dG/dt) x along gradient axes that are periodic: the images of a sphere take part in the acceleration of the flow and the liquid, of the
 * sphere's own density, carries it along. With c = U - G x that is dc/dt = - c/tau - G c: who starts with the flow stays with it, at
 *
 *     x(t) = x(0) + S(t) x(0) ,   S the integral of G                       for any history of the rates
 *
 * Along an open axis there is no such force, and c changes by - (dG/dt) x too, by - dG x where a rate jumps.
 * No axis may be both a flow and a gradient axis, so G^2 = 0 and S is known in closed form.
 *
 * Solved stage by stage by Runge-Kutta of order 8 in (x, c, W). Source: Newton and Stokes. Second origins (tests/theory_motion_test.c): the
 * closed form of the streamline, the matrix exponential for steady shear, the phase lag of a spin in oscillating shear by hand.
 */
#include "theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <string.h>

struct driven { const struct theory_stage *stage; const bool *open; double tau, spin_tau; };

static void rates(const struct theory_stage *stage, double s, double G[3][3], double change[3][3])
{
    memset(G, 0, 9 * sizeof(double));
    memset(change, 0, 9 * sizeof(double));
    for (size_t k = 0; stage && k < stage->shears; k++) {
        const struct theory_rate *r = &stage->shear[k];
        G[r->flow][r->gradient] += r->mean + r->slope * s + r->amplitude * sin(r->frequency * s + r->phase);
        change[r->flow][r->gradient] += r->slope + r->amplitude * r->frequency * cos(r->frequency * s + r->phase);
    }
}

static int derivative(double s, const double y[], double dydt[], void *model)
{
    const struct driven *d = model;
    const double *x = y, *c = y + 3, *w = y + 6;
    double G[3][3], change[3][3];
    rates(d->stage, s, G, change);
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        double flow = 0.0, carried = 0.0, left = 0.0;
        for (int l = 0; l < 3; l++) {
            flow += G[k][l] * x[l];
            carried += G[k][l] * c[l];
            left += d->open[l] ? change[k][l] * x[l] : 0.0;
        }
        dydt[k] = c[k] + flow;
        dydt[3 + k] = -c[k] / d->tau - carried - left;
        dydt[6 + k] = (0.5 * (G[b][a] - G[a][b]) - w[k]) / d->spin_tau;
    }
    return GSL_SUCCESS;
}

/* From one set of rates to another in no time: the sphere keeps its velocity, unless its images are carried along. */
static void jump(const bool open[3], double before[3][3], double after[3][3], double y[9])
{
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            y[3 + k] -= open[l] ? (after[k][l] - before[k][l]) * y[l] : 0.0;
}

bool theory_driven_sphere(const struct theory_stage *stage, size_t stages, const bool open[3], double relaxation, double spin_relaxation, double t,
                          const struct theory_sphere *start, struct theory_sphere *now)
{
    static const struct theory_stage rest = { .duration = INFINITY };
    double y[9], G[3][3], change[3][3];
    bool good = true;
    rates(stages ? stage : &rest, 0.0, G, change);
    for (int k = 0; k < 3; k++) {
        y[k] = start->x[k];
        y[3 + k] = start->u[k];
        y[6 + k] = start->w[k];
        for (int l = 0; l < 3; l++)
            y[3 + k] -= G[k][l] * start->x[l];
    }
    for (size_t n = 0; good && n <= stages && t > 0.0; n++) {
        const struct theory_stage *at = n < stages ? &stage[n] : &rest;
        double s = 0.0, end = fmin(t, at->duration), step = 1e-3 * end, before[3][3];
        memcpy(before, G, sizeof before);
        rates(at, 0.0, G, change);
        jump(open, before, G, y);
        struct driven d = { at, open, relaxation, spin_relaxation };
        gsl_odeiv2_system system = { derivative, NULL, 9, &d };
        gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, step, 1e-13, 1e-13);
        good = driver && gsl_odeiv2_driver_apply(driver, &s, end, y) == GSL_SUCCESS;
        gsl_odeiv2_driver_free(driver);
        rates(at, end, G, change);
        t -= end;
    }
    now->radius = start->radius;
    for (int k = 0; k < 3; k++) {
        now->x[k] = y[k];
        now->u[k] = y[3 + k];
        now->w[k] = y[6 + k];
        for (int l = 0; l < 3; l++)
            now->u[k] += G[k][l] * y[l];
    }
    return good;
}

void theory_driven_flow(const struct theory_stage *stage, size_t stages, double t, double G[3][3], double *travelled)
{
    double change[3][3];
    rates(NULL, 0.0, G, change);
    *travelled = 0.0;
    for (size_t n = 0; n < stages && t >= 0.0; t -= stage[n++].duration) {
        const struct theory_stage *at = &stage[n];
        const double end = fmin(t, at->duration);
        const int pieces = 4096;         /* Simpson; |rate| has corners, where it is off by the square of a piece */
        for (int k = 0; at->shears > 0 && k <= pieces; k++) {
            double now[3][3];
            const struct theory_stage first = { .shears = 1, .shear = { at->shear[0] } };
            rates(&first, end * k / pieces, now, change);
            const double rate = fabs(now[at->shear[0].flow][at->shear[0].gradient]);
            *travelled += end / pieces / 3.0 * rate * (k == 0 || k == pieces ? 1.0 : k % 2 ? 4.0 : 2.0);
        }
        if (t < at->duration)
            rates(at, t, G, change);
    }
}
