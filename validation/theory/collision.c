/*
 * Collisions of two spheres with a linear, damped contact
 *
 * Head-on: m d'' + zeta d' + k d = 0 for the overlap d, d(0) = 0, d'(0) = v. With w = sqrt(k/m), b = zeta/(2 m w):
 *
 *     tension allowed   parts at d = 0:               t = pi/(w sqrt(1 - b^2)),                    e = exp(-b w t)
 *     tension clipped   free from k d + zeta d' = 0:  t = 2 acos(b)/(w sqrt(1 - b^2)) on,          e = exp(-b w t)
 *
 * Duration is told by the straight line of the free flight afterwards: the time at which it passes d = 0. When tension is clipped the
 * flight starts inside the overlap, and that time is later than t by d/|d'| = zeta/k.
 *
 * Gross sliding (the tangential force is at its cap throughout, the normal does not turn): impulse J_t = mu J, J the time integral of
 * the load. In units of m v:
 *
 *     load            tension allowed         tension clipped
 *     k d             1 + e                   1 + e_c - 2 b^2 e_c      the spring still presses while the spheres fly apart
 *     max(N, 0)       1 + e_c                 1 + e_c
 *     |N|             1 + 2 e_c - e           1 + e_c
 *
 * e_c the clipped ratio. Each is Newton's law integrated: N = -m d'' and k d = -m d'' - zeta d'.
 * Source: Schwager & Poeschel, Granular Matter 9 (2007) 465; sliding: Walton & Braun (1986). Sticking: the equations of motion by a
 * Runge-Kutta method of order 8. Second origin: the same integration for head-on impacts, tests/collision_test.c.
 */
#include "theory.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <string.h>

void theory_head_on(const struct theory_contact *law, double *restitution, double *duration)
{
    const double m = theory_reduced_mass(law), w = sqrt(law->normal_stiffness / m), zeta = theory_normal_dashpot(law);
    const double b = zeta / (2.0 * m * w), wd = w * sqrt(fabs(1.0 - b * b));
    *restitution = theory_restitution(b, law->clip);
    if (!law->clip)
        *duration = M_PI / wd;
    else
        *duration = (b < 1.0 ? 2.0 * acos(b) : 2.0 * acosh(b)) / wd + zeta / law->normal_stiffness;
}

double theory_sliding_impulse(const struct theory_contact *law)
{
    const double m = theory_reduced_mass(law), b = 0.5 * theory_normal_dashpot(law) / sqrt(law->normal_stiffness * m);
    const double e = theory_restitution(b, false), e_c = theory_restitution(b, true);
    if (law->load == THEORY_LOAD_SPRING)
        return m * (law->clip ? 1.0 + e_c - 2.0 * b * b * e_c : 1.0 + e);
    return m * (law->load == THEORY_LOAD_ABSOLUTE && !law->clip ? 1.0 + 2.0 * e_c - e : 1.0 + e_c);
}

/* y: x_1 u_1 w_1 x_2 u_2 w_2 and the history s, each of three. */
enum { X = 0, U = 3, W = 6, SPHERE = 9, HISTORY = 18, STATE = 21 };

static void spheres_of(const struct theory_collision *c, const double y[], struct theory_sphere s[2])
{
    for (int a = 0; a < 2; a++) {
        s[a].radius = c->start[a].radius;
        memcpy(s[a].x, y + SPHERE * a + X, sizeof s[a].x);
        memcpy(s[a].u, y + SPHERE * a + U, sizeof s[a].u);
        memcpy(s[a].w, y + SPHERE * a + W, sizeof s[a].w);
    }
}

static double overlap_of(const struct theory_collision *c, const double y[])
{
    return c->start[0].radius + c->start[1].radius - hypot(hypot(y[SPHERE] - y[0], y[SPHERE + 1] - y[1]), y[SPHERE + 2] - y[2]);
}

/* s moves with the slip in the tangent plane and turns with it: ds/dt = c_t - (s . dn/dt) n keeps s . n at zero. */
static int motion(double t, const double y[], double rate[], void *p)
{
    struct theory_collision *c = p;
    struct theory_sphere s[2];
    struct theory_pair f;
    (void)t;
    spheres_of(c, y, s);
    theory_contact_laws_pair(c->law, s, y + HISTORY, &f);
    double n[3], dn[3], slip[3], distance = 0.0, opening = 0.0, along = 0.0, turn = 0.0;
    for (int k = 0; k < 3; k++) {
        n[k] = s[1].x[k] - s[0].x[k];
        distance = hypot(distance, n[k]);
    }
    const double reach = c->law->lever_at_contact ? distance / (s[0].radius + s[1].radius) : 1.0;
    for (int k = 0; k < 3; k++) {
        n[k] /= distance;
        opening += n[k] * (s[1].u[k] - s[0].u[k]);
    }
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        const double wl = reach * (s[0].radius * s[0].w[l] + s[1].radius * s[1].w[l]), wm = reach * (s[0].radius * s[0].w[m] + s[1].radius * s[1].w[m]);
        dn[k] = (s[1].u[k] - s[0].u[k] - opening * n[k]) / distance;
        slip[k] = s[0].u[k] - s[1].u[k] + opening * n[k] + wl * n[m] - wm * n[l];
        turn += y[HISTORY + k] * dn[k];
    }
    for (int k = 0; k < 3; k++)
        along += slip[k] * n[k];
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) {
            const double mass = c->law->mass[a], inertia = 0.4 * mass * s[a].radius * s[a].radius;
            rate[SPHERE * a + X + k] = s[a].u[k];
            rate[SPHERE * a + U + k] = f.force[a][k] / mass;
            rate[SPHERE * a + W + k] = f.torque[a][k] / inertia;
        }
    /* Without friction there is no history; it begins at zero, for a load that falls below the critical one does not come back here. */
    const bool grips = theory_contact_grips(c->law, overlap_of(c, y), opening);
    for (int k = 0; k < 3; k++)
        rate[HISTORY + k] = grips ? slip[k] - along * n[k] - turn * n[k] : 0.0;
    return GSL_SUCCESS;
}

static bool advance(gsl_odeiv2_driver *d, double y[], double from, double to)
{
    gsl_odeiv2_driver_reset(d);
    return to <= from || gsl_odeiv2_driver_apply(d, &from, to, y) == GSL_SUCCESS;
}

/* Contact from time 0 until the overlap is gone, then free flight. The end is found by halving the interval in which it lies. */
bool theory_collide(struct theory_collision *c, double t, struct theory_sphere now[2])
{
    enum { WINDOWS = 64 };
    double y[STATE] = { 0.0 }, before[STATE], time = 0.0;
    for (int a = 0; a < 2; a++) {
        memcpy(y + SPHERE * a + X, c->start[a].x, 3 * sizeof *y);
        memcpy(y + SPHERE * a + U, c->start[a].u, 3 * sizeof *y);
        memcpy(y + SPHERE * a + W, c->start[a].w, 3 * sizeof *y);
    }
    gsl_odeiv2_system system = { motion, NULL, STATE, c };
    gsl_odeiv2_driver *d = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-4 * t, 1e-13, 1e-13);
    bool good = d != NULL, touching = true;
    for (int w = 1; w <= WINDOWS && good && touching; w++) {
        const double until = t * w / WINDOWS;
        memcpy(before, y, sizeof y);
        good = advance(d, y, time, until);
        touching = overlap_of(c, y) > 0.0;
        if (touching)
            time = until;
    }
    if (good && !touching) {
        double low = 0.0, high = t / WINDOWS;
        for (int k = 0; k < 50 && good; k++) {
            const double middle = 0.5 * (low + high);
            memcpy(y, before, sizeof y);
            good = advance(d, y, 0.0, middle);
            *(overlap_of(c, y) > 0.0 ? &low : &high) = middle;
        }
        time += high;
    }
    spheres_of(c, y, now);
    for (int a = 0; a < 2 && !touching; a++)
        for (int k = 0; k < 3; k++)
            now[a].x[k] += (t - time) * now[a].u[k];
    if (d)
        gsl_odeiv2_driver_free(d);
    return good;
}
