/*
 * Two spheres under lubrication, contact, drag and constant forces and torques, as functions of time
 *
 *     m_a dU_a/dt = F_a ,   I_a dW_a/dt = T_a ,   dx_a/dt = U_a ,   m = (4/3) pi rho a^3 ,   I = (2/5) m a^2
 *
 * with the forces of resistance.c, contact.c and drag.c. The friction of a contact has a memory s [L], the displacement of the surface
 * of 1 against that of 2, which moves in the tangent plane (the continuous form of "add, project, cut"):
 *
 *     sticking:  ds/dt = v_t - (s.dn/dt) n ,           v_t tangential part of  U_1 - U_2 + (l_1 W_1 + l_2 W_2) x n
 *     sliding:   the same, but |s| = mu k_n delta/k_t: the component of v_t along s is replaced by d|s|/dt if that is smaller
 *
 * Solved by the Runge-Kutta pair of order 8(9) of Prince & Dormand (GSL) with step control. The forces jump at the outer gap
 * and have corners at the inner gap, at contact and where sliding begins; the control then shortens the step until what is
 * missed is below the tolerance, which costs a few dozen steps each time and needs no events.
 *
 * For a pair that only squeezes its gap, without drag, m_eff dv/dt = - X_A(h) v with v = - dh/dt has the integral
 *
 *     v(h) = v(h_0) - (1/m_eff) int_h^h0 X_A dh' ,   1/m_eff = 1/m_1 + 1/m_2
 *
 * with X_A = A/xi + B ln(1/xi), xi = 2 h/(a_1 + a_2), frozen below the inner gap. With drag zeta_a and constant forces F_a along the line
 * of centres n too, the two momentum balances, each divided by its zeta_a, have as their difference the integral
 *
 *     h - h_0 + S/zeta + [(m_2/zeta_2) dU_2 - (m_1/zeta_1) dU_1].n = V t ,   V = (F_2/zeta_2 - F_1/zeta_1).n ,   1/zeta = 1/zeta_1 + 1/zeta_2
 *
 * S the integral of X_A from h_0 to h, dU what the velocities have changed by. Without inertia, the bracket, it is h(t) of the overdamped
 * approach, solved for t; without the 1 beside X_A/zeta >> 1 and the logarithm, h = h_0 exp(V zeta t/(A (a_1 + a_2)/2)).
 * Source: Newton's second law; Li (2026) eq 3.8.
 * Second origins (tests/theory_pair_test.c): the closed form against the solution in time; linear momentum, and the energy that
 * friction takes; a sphere alone (free_sphere.c); the quadrature of X_A.
 */
#include "theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/* x, u, w of each sphere, then s. */
enum { PER_SPHERE = 9, HISTORY = 18, VARIABLES = 21 };

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void pack(const struct theory_pair_state *p, double y[VARIABLES])
{
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 2; a++) {
            y[PER_SPHERE * a + k] = p->s[a].x[k];
            y[PER_SPHERE * a + 3 + k] = p->s[a].u[k];
            y[PER_SPHERE * a + 6 + k] = p->s[a].w[k];
        }
        y[HISTORY + k] = p->history[k];
    }
}

static void unpack(const struct theory_motion *m, const double y[VARIABLES], struct theory_pair_state *p)
{
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 2; a++) {
            p->s[a].radius = m->radius[a];
            p->s[a].x[k] = y[PER_SPHERE * a + k];
            p->s[a].u[k] = y[PER_SPHERE * a + 3 + k];
            p->s[a].w[k] = y[PER_SPHERE * a + 6 + k];
        }
        p->history[k] = y[HISTORY + k];
    }
}

/* ds/dt of a contact of overlap > 0. */
static void slip(const struct theory_motion *m, const struct theory_pair_state *p, const double n[3], double distance, double out[3])
{
    const struct theory_contact *law = m->contact;
    const struct theory_sphere *one = &p->s[0], *two = &p->s[1];
    const double touching = one->radius + two->radius, shrink = law->lever_at_contact ? distance / touching : 1.0;
    double v[3], turning[3], apart[3];
    for (int k = 0; k < 3; k++) {
        turning[k] = shrink * (one->radius * one->w[k] + two->radius * two->w[k]);
        apart[k] = two->u[k] - one->u[k];
    }
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, q = (k + 2) % 3;
        v[k] = -apart[k] + turning[l] * n[q] - turning[q] * n[l];
    }
    const double along_n = dot(v, n), opening = dot(apart, n), ratio = law->friction * law->normal_stiffness / law->tangential_stiffness;
    for (int k = 0; k < 3; k++)
        v[k] -= along_n * n[k];

    const double size = sqrt(dot(p->history, p->history)), most = ratio * (touching - distance), speed = sqrt(dot(v, v));
    if (size >= most && speed > 0.0) {     /* at the cap: s may not grow faster than the cap does */
        double e[3];
        for (int k = 0; k < 3; k++)
            e[k] = size > 0.0 ? p->history[k] / size : v[k] / speed;
        const double excess = dot(v, e) + ratio * opening;      /* the cap grows by - ratio x opening */
        for (int k = 0; k < 3; k++)
            v[k] -= fmax(excess, 0.0) * e[k];
    }
    double turn = 0.0;      /* s.dn/dt: s stays in the plane that turns with n */
    for (int k = 0; k < 3; k++)
        turn += p->history[k] * (apart[k] - opening * n[k]) / distance;
    for (int k = 0; k < 3; k++)
        out[k] = v[k] - turn * n[k];
}

static int derivative(double t, const double y[], double dydt[], void *model)
{
    (void)t;
    const struct theory_motion *m = model;
    struct theory_pair_state p;
    struct theory_pair lubrication, contact;
    memset(&lubrication, 0, sizeof lubrication);
    memset(&contact, 0, sizeof contact);
    unpack(m, y, &p);
    double n[3];
    for (int k = 0; k < 3; k++)
        n[k] = p.s[1].x[k] - p.s[0].x[k];
    const double distance = sqrt(dot(n, n));
    for (int k = 0; k < 3; k++)
        n[k] /= distance;
    if (m->lubrication)
        theory_lubrication_pair(m->lubrication, p.s, &lubrication);
    if (m->contact)
        theory_contact_pair(m->contact, p.s, p.history, &contact);
    memset(&dydt[HISTORY], 0, 3 * sizeof *dydt);
    if (m->contact && m->contact->friction > 0.0 && distance < m->radius[0] + m->radius[1])
        slip(m, &p, n, distance, &dydt[HISTORY]);

    for (int a = 0; a < 2; a++) {
        double force[3] = { 0.0 }, torque[3] = { 0.0 }, stresslet[3][3];
        if (m->drag)
            theory_drag(m->viscosity, m->drag_torque, m->gradient, &p.s[a], force, torque, stresslet);
        const double mass = theory_sphere_mass(m, a), inertia = 0.4 * mass * m->radius[a] * m->radius[a];
        double *d = &dydt[PER_SPHERE * a];
        for (int k = 0; k < 3; k++) {
            d[k] = p.s[a].u[k];
            d[3 + k] = (force[k] + lubrication.force[a][k] + contact.force[a][k] + m->applied[a][k]) / mass;
            d[6 + k] = (torque[k] + lubrication.torque[a][k] + contact.torque[a][k] + m->applied_torque[a][k]) / inertia;
        }
    }
    return GSL_SUCCESS;
}

double theory_sphere_mass(const struct theory_motion *m, int which)
{
    return 4.0 / 3.0 * PI * m->density[which] * pow(m->radius[which], 3);
}

bool theory_pair_motion(const struct theory_motion *model, double duration, double tolerance, struct theory_pair_state *p)
{
    /* absolute tolerances in the units of the pair: size, speed and spin it has or may reach */
    const double size = model->radius[0] + model->radius[1];
    double speed = 0.0, y[VARIABLES], t = 0.0, step = 1e-4 * duration, scale[VARIABLES];
    for (int k = 0; k < 9; k++)
        speed = fmax(speed, size * fabs(model->gradient[k / 3][k % 3]));
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++)
            speed = fmax(speed, fmax(fabs(p->s[a].u[k]), size * fabs(p->s[a].w[k])));
    for (int a = 0; a < 2; a++) {       /* from rest: what the forces make of it alone */
        const double mass = theory_sphere_mass(model, a), relaxation = mass / (6.0 * PI * model->viscosity * model->radius[a]);
        for (int k = 0; k < 3; k++)
            speed = fmax(speed, fabs(model->applied[a][k]) / mass * (model->drag ? fmin(duration, relaxation) : duration));
    }
    for (int v = 0; v < VARIABLES; v++)
        scale[v] = v >= HISTORY ? 1e-2 * size : v % PER_SPHERE < 3 ? size : v % PER_SPHERE < 6 ? speed : speed / size;
    pack(p, y);

    struct theory_motion copy = *model;
    gsl_odeiv2_system system = { derivative, NULL, VARIABLES, &copy };
    gsl_odeiv2_step *stepper = gsl_odeiv2_step_alloc(gsl_odeiv2_step_rk8pd, VARIABLES);
    gsl_odeiv2_control *control = gsl_odeiv2_control_scaled_new(tolerance, 0.0, 1.0, 0.0, scale, VARIABLES);
    gsl_odeiv2_evolve *evolve = gsl_odeiv2_evolve_alloc(VARIABLES);
    bool good = stepper && control && evolve;
    for (long steps = 0; good && t < duration; steps++)
        good = steps < 2000000 && gsl_odeiv2_evolve_apply(evolve, control, stepper, &system, &t, duration, &step, y) == GSL_SUCCESS;
    gsl_odeiv2_evolve_free(evolve);
    gsl_odeiv2_control_free(control);
    gsl_odeiv2_step_free(stepper);
    unpack(model, y, p);
    return good;
}

/* int_0^h X_A dh of X_A = A/xi + B ln(1/xi), from the value at two gaps, so that the coefficients have one home (resistance.c). */
double theory_squeeze_integral(const struct theory_lubrication *law, double a1, double a2, double from, double to)
{
    const double mean = 0.5 * (a1 + a2), cut = law->inner_gap;
    double c[THEORY_SCALARS], low, high;
    const double x1 = law->inner_gap, x2 = 0.5 * (law->inner_gap + law->outer_gap);
    theory_scalars(law, a1, a2, 2.0 * mean + mean * x1, c);
    low = c[THEORY_XA];
    theory_scalars(law, a1, a2, 2.0 * mean + mean * x2, c);
    high = c[THEORY_XA];
    /* low = A/x1 - B ln x1, high = A/x2 - B ln x2 */
    const double determinant = -log(x2) / x1 + log(x1) / x2;
    const double A = (-log(x2) * low + log(x1) * high) / determinant, B = (high / x1 - low / x2) / determinant;

    double part[2];
    for (int k = 0; k < 2; k++) {
        const double xi = (k ? to : from) / mean, above = fmin(fmax(xi, cut), law->outer_gap);
        part[k] = mean * (low * fmin(xi, cut) + A * log(above / cut) - B * (above * (log(above) - 1.0) - cut * (log(cut) - 1.0)));
    }
    return part[1] - part[0];
}
