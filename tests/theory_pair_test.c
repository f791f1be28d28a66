/* The motion of two spheres (validation/theory/pair_motion.c) against conservation laws, closed forms and limits. */
#include "suite.h"
#include "theory/theory.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static const struct theory_lubrication law = { 0.7, 2e-3, 0.4, false };

static double squeeze_of(double h, void *radii)
{
    double c[THEORY_SCALARS];
    const double *a = radii;
    theory_scalars(&law, a[0], a[1], a[0] + a[1] + h, c);
    return c[THEORY_XA];
}

static void squeeze_integral_is_the_quadrature(void)
{
    double a[2] = { 1.3, 1.82 }, error, pieces[3];
    const double points[4] = { -0.01, 1e-3 * (a[0] + a[1]), 0.1, 0.15 * (a[0] + a[1]) };   /* overlap, inner gap, outside it */
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(200);
    gsl_function f = { squeeze_of, a };
    for (int k = 0; k < 3; k++) {
        gsl_integration_qag(&f, points[k], points[k + 1], 0.0, 1e-12, 200, GSL_INTEG_GAUSS61, space, &pieces[k], &error);
        check_relative(theory_squeeze_integral(&law, a[0], a[1], points[k], points[k + 1]), pieces[k], 1e-11, "integral of X_A");
    }
    check_relative(theory_squeeze_integral(&law, a[0], a[1], points[0], points[3]), pieces[0] + pieces[1] + pieces[2], 1e-11, "over all");
    gsl_integration_workspace_free(space);
}

static struct theory_motion two_spheres(void)
{
    return (struct theory_motion){ .radius = { 1.3, 1.82 }, .density = { 0.9, 0.6 }, .lubrication = &law, .viscosity = 0.7 };
}

/* Head-on: v(h) of the closed form, and the momentum of both, along a direction that is no axis. */
static void squeezing_in_time_is_the_closed_form(void)
{
    const struct theory_motion m = two_spheres();
    const double n[3] = { 2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0 }, m1 = theory_sphere_mass(&m, 0), m2 = theory_sphere_mass(&m, 1), h0 = 0.5;
    const double effective = m1 * m2 / (m1 + m2), v0 = theory_squeeze_integral(&law, 1.3, 1.82, 0.02, h0) / effective;
    struct theory_pair_state p = { .s = { { .radius = 1.3 }, { .radius = 1.82 } } };
    for (int k = 0; k < 3; k++) {
        p.s[1].x[k] = (3.12 + h0) * n[k];
        p.s[1].u[k] = -v0 * n[k];
    }
    double last = h0;
    for (int step = 0; step < 6; step++) {
        check_true(theory_pair_motion(&m, 0.07, 1e-12, &p), "reaches its end");
        double h = -3.12, v = 0.0, distance = 0.0;
        for (int k = 0; k < 3; k++) {
            distance += gsl_pow_2(p.s[1].x[k] - p.s[0].x[k]);
            v -= (p.s[1].u[k] - p.s[0].u[k]) * n[k];
            check_close(m1 * p.s[0].u[k] + m2 * p.s[1].u[k], -m2 * v0 * n[k], 1e-10 * m2 * v0, "momentum");
        }
        h += sqrt(distance);
        check_close(v, v0 - theory_squeeze_integral(&law, 1.3, 1.82, h, h0) / effective, 1e-10 * v0, "approach speed at this gap");
        check_true(h < last && h > 0.02, "it approaches and never passes the gap where it must stop");
        last = h;
    }
}

/* Far apart each is a sphere of its own in the flow; a constant force gives the terminal velocity. */
static void far_apart_each_is_free(void)
{
    struct theory_motion m = two_spheres();
    m.drag = m.drag_torque = true;
    m.gradient[2][0] = -1.1;
    struct theory_pair_state p = { .s = { { .radius = 1.3, .x = { 1, 2, 3 }, .u = { 3, -2, 1 }, .w = { 1, 1, -2 } },
                                          { .radius = 1.82, .x = { 40, 1, 2 } } } };
    const double mass = theory_sphere_mass(&m, 0), friction = 6 * M_PI * 0.7 * 1.3, spin = 8 * M_PI * 0.7 * pow(1.3, 3);
    struct theory_sphere now;
    theory_free_sphere((const double (*)[3])m.gradient, mass / friction, 0.4 * mass * 1.69 / spin, 0.9, &p.s[0], &now);
    check_true(theory_pair_motion(&m, 0.9, 1e-12, &p), "reaches its end");
    for (int k = 0; k < 3; k++) {
        check_close(p.s[0].x[k], now.x[k], 1e-9, "place of a free sphere");
        check_close(p.s[0].u[k], now.u[k], 1e-9, "velocity of a free sphere");
        check_close(p.s[0].w[k], now.w[k], 1e-9, "spin of a free sphere");
    }
    memset(m.gradient, 0, sizeof m.gradient);
    m.applied[1][1] = 0.3;
    check_true(theory_pair_motion(&m, 60.0, 1e-12, &p), "reaches its end");
    check_relative(p.s[1].u[1], 0.3 / (6 * M_PI * 0.7 * 1.82), 1e-9, "terminal velocity");
}

/*
 * Sliding head on and sidewise without drag: energy (with the springs') never grows, angular momentum about the common centre is
 * kept with the lever at the contact, and while it slides the displacement sits on its cap.
 */
static void friction_keeps_momenta_and_takes_energy(void)
{
    struct theory_motion m = two_spheres();
    const struct theory_contact contact = { .normal_stiffness = 2000.0, .tangential_stiffness = 600.0, .friction = 0.3, .lever_at_contact = true };
    m.lubrication = NULL;
    m.contact = &contact;
    struct theory_pair_state p = { .s = { { .radius = 1.3, .u = { 0.2, 0.5, 0 }, .w = { 0.3, -0.2, 0.6 } },
                                          { .radius = 1.82, .x = { 3.121, 0.0, 0.0 }, .u = { -1.1, 0, 0.4 }, .w = { 0, 0.4, 0.5 } } } };
    double last = INFINITY, turning[3] = { 0 };
    bool touched = false, slid = false;
    for (int step = 0; step < 40; step++) {
        double energy = 0.0, spin[3] = { 0 };
        for (int a = 0; a < 2; a++) {
            const double mass = theory_sphere_mass(&m, a), inertia = 0.4 * mass * gsl_pow_2(m.radius[a]);
            for (int k = 0; k < 3; k++) {
                const int l = (k + 1) % 3, q = (k + 2) % 3;
                energy += 0.5 * mass * gsl_pow_2(p.s[a].u[k]) + 0.5 * inertia * gsl_pow_2(p.s[a].w[k]);
                spin[k] += mass * (p.s[a].x[l] * p.s[a].u[q] - p.s[a].x[q] * p.s[a].u[l]) + inertia * p.s[a].w[k];
            }
        }
        double distance = 0.0, size = 0.0;
        for (int k = 0; k < 3; k++) {
            distance += gsl_pow_2(p.s[1].x[k] - p.s[0].x[k]);
            size += gsl_pow_2(p.history[k]);
            if (step > 0)
                check_close(spin[k], turning[k], 1e-9, "angular momentum");
            turning[k] = spin[k];
        }
        const double overlap = fmax(3.12 - sqrt(distance), 0.0), cap = 0.3 * 2000.0 / 600.0 * overlap;
        size = sqrt(size);
        energy += 0.5 * 2000.0 * overlap * overlap + 0.5 * 600.0 * gsl_pow_2(fmin(size, cap));
        check_true(energy <= last * (1 + 1e-10), "energy does not grow");
        check_true(size <= cap + 1e-9, "the displacement is cut");
        touched = touched || overlap > 1e-3;
        slid = slid || (overlap > 1e-3 && size > 0.999 * cap);
        last = energy;
        check_true(theory_pair_motion(&m, 0.01, 1e-12, &p), "reaches its end");
    }
    check_true(touched && slid, "the pair has touched and slid");
}

/* One encounter by the equations of both spheres in the laboratory, in short steps, its stress by trapezoids. */
static void encounters_of_the_symmetric_pair(void)
{
    const struct theory_lubrication near = { 0.7, 0.1, 0.3, false };
    const struct theory_contact contact = { .normal_stiffness = 2000.0 };
    struct theory_motion m = { .radius = { 1.3, 1.3 }, .density = { 0.05, 0.05 }, .lubrication = &near, .contact = &contact, .drag = true,
                               .drag_torque = true, .viscosity = 0.7 };
    m.gradient[0][1] = 1.3;
    const double y0 = 0.6, z0 = 0.4, reach = 2.3 * 1.3, step = 2e-3;
    double impulse[2][3], end[3], sum[2][3] = { { 0 } };
    check_true(theory_encounter(&m, y0, z0, 1e-10, impulse, end), "it leaves");
    const double r[3] = { -sqrt(reach * reach - y0 * y0 - z0 * z0) * (1 - 1e-12), y0, z0 };
    struct theory_pair_state p = { .s = { { .radius = 1.3, .w = { 0, 0, -0.65 } }, { .radius = 1.3, .w = { 0, 0, -0.65 } } } };
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++)
            p.s[a].x[k] = (a ? 0.5 : -0.5) * r[k];
    for (int a = 0; a < 2; a++)
        p.s[a].u[0] = 1.3 * p.s[a].x[1];
    for (int n = 0; n < 3500; n++) {
        struct theory_pair part[2];
        const double none[3] = { 0 };
        theory_contact_pair(&contact, p.s, none, &part[0]);
        theory_lubrication_pair(&near, p.s, &part[1]);
        for (int k = 0; k < 2; k++) {
            sum[k][0] += (n ? 1.0 : 0.5) * step * 0.5 * (part[k].stress[0][1] + part[k].stress[1][0]);
            sum[k][1] += (n ? 1.0 : 0.5) * step * (part[k].stress[0][0] - part[k].stress[1][1]);
            sum[k][2] += (n ? 1.0 : 0.5) * step * (part[k].stress[1][1] - part[k].stress[2][2]);
        }
        check_true(theory_pair_motion(&m, step, 1e-8, &p), "reaches its end");
    }
    check_true(p.s[1].x[0] - p.s[0].x[0] > end[0], "they have parted");
    for (int k = 0; k < 6; k++)
        check_close(sum[k / 3][k % 3], impulse[k / 3][k % 3], 3e-4 * fabs(impulse[k / 3][0]) + 2e-3, "time integral of the stress");
    double few[2][3], more[2][3];
    m.lubrication = NULL;
    check_true(theory_sheared_pairs(&m, 6, 4, few) && theory_sheared_pairs(&m, 10, 6, more), "all leave");
    check_relative(few[0][0], more[0][0], 1e-3, "Gauss points");
}

/* Virial coefficients 4, 10 (exact) and 18.365 (which the formula rounds to 18); the diameter by the midpoint rule. */
static void hard_spheres_have_their_virials(void)
{
    const double phi = 1e-3, z = theory_carnahan_starling(phi);
    check_close(z, 1.0 + 4.0 * phi + 10.0 * phi * phi + 18.0 * phi * phi * phi, 30.0 * pow(phi, 4), "virial series");
    double sigma = 0.0;
    const double kT = 0.31, k_n = 400.0, step = 1e-4;
    for (double r = 0.5 * step; r < 2.6; r += step)
        sigma += step * (1.0 - exp(-0.5 * k_n * (2.6 - r) * (2.6 - r) / kT));
    check_close(theory_thermal_diameter(1.3, k_n, kT), sigma, 1e-7, "thermal diameter");
    /* mixtures: one size said twice is one size; at low density 1 + sum x_i x_j n (2 pi/3) sigma_ij^3 */
    const double twice[2] = { 0.03, 0.05 }, same[2] = { 2.0, 2.0 }, sparse[2] = { 1e-6, 3e-6 }, d[2] = { 2.0, 2.8 };
    check_relative(theory_mixture_pressure(2, twice, same), theory_carnahan_starling(0.08 * M_PI / 6.0 * 8.0), 1e-14, "one size twice");
    double second = 0.0;
    for (int k = 0; k < 4; k++)
        second += sparse[k / 2] * sparse[k % 2] / 4e-6 * 2.0 * M_PI / 3.0 * gsl_pow_3(0.5 * (d[k / 2] + d[k % 2]));
    check_relative(theory_mixture_pressure(2, sparse, d) - 1.0, second, 2e-4, "second virial coefficient of a mixture");
}

/*
 * Two unequal spheres across a face, near enough for the larger one's shell only; and points placed at random without regard to
 * each other, which fill a sphere of radius 2a + fa round each by their density.
 */
static void structural_stress_counts_shells(void)
{
    const double x[2][3] = { { 0.3, 4.0, 5.0 }, { 9.2 - 2.46 + 0.3, 4.0, 5.0 } }, radius[2] = { 1.0, 1.4 }, kT = 0.31, d = 0.01, edge = 9.2;
    double S[6], sum = 0.0;
    theory_structural_stress(2, x, radius, edge, kT, 0.05, d, S);
    check_relative(S[0], -kT * 1.4 / (0.07 + d) / (edge * edge * edge), 1e-12, "the larger one's shell");
    check_true(S[1] == 0.0 && S[2] == 0.0 && S[3] == 0.0 && S[4] == 0.0 && S[5] == 0.0, "along the line of centres");
    enum { SPHERES = 40, ROUNDS = 400 };
    double at[SPHERES][3], equal[SPHERES];
    uint64_t state = 88172645463325252u;
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < SPHERES; i++) {
            equal[i] = 1.3;
            for (int c = 0; c < 3; c++) {
                state ^= state << 13, state ^= state >> 7, state ^= state << 17;
                at[i][c] = edge * (double)(state >> 11) / 9007199254740992.0;
            }
        }
        theory_structural_stress(SPHERES, (const double (*)[3])at, equal, edge, kT, 0.05, d, S);
        sum -= (S[0] + S[1] + S[2]) / 3.0 / ROUNDS;
    }
    const double V = edge * edge * edge, R = 2.6 + 0.05 * 1.3, share = 4.0 / 3.0 * 3.14159265358979 * R * R * R / V;
    const double weight = kT / V * 1.3 / (0.05 * 1.3 + d) / 3.0, pairs = SPHERES * (SPHERES - 1.0);
    check_close(sum, weight * pairs * share, 5.0 * weight * sqrt(2.0 * pairs * share * (1.0 - share) / ROUNDS), "random points: 5 standard errors");
}

static const struct unit_test tests[] = {
    { "integral of the squeezing resistance: closed form and quadrature", squeeze_integral_is_the_quadrature },
    { "head-on approach: closed form, momentum", squeezing_in_time_is_the_closed_form },
    { "two spheres far apart are free", far_apart_each_is_free },
    { "oblique collision: momenta, energy, cap", friction_keeps_momenta_and_takes_energy },
    { "one encounter in shear: the symmetric pair, and both spheres", encounters_of_the_symmetric_pair },
    { "structural stress: shells of unequal radii, random points", structural_stress_counts_shells },
    { "hard spheres: virial coefficients, thermal diameter", hard_spheres_have_their_virials },
    { NULL, NULL },
};

const struct suite theory_pair_suite = { "theory-pair", tests };
