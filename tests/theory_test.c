/*
 * The closed forms of validation/theory for a pair (lubrication, contact) against their second origins: published numbers,
 * limits, identities. Those for one sphere, an average or a crowd: theory_motion_test.c.
 *
 * Where nothing else is said the tolerance is 1e-13 relative: a few dozen double operations, each wrong by 1.1e-16.
 */
#include "suite.h"
#include "theory/theory.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <string.h>

static const double rounding = 1e-13;
static const struct theory_lubrication plain = { 0.7, 1e-3, 0.05, false }, exact = { 0.7, 1e-3, 0.05, true };
static const double ratios[] = { 0.2, 1.0 / 1.4, 1.0, 1.4, 5.0, 7.0 };
static const double gaps[] = { -0.1, -1e-3, 0.0, 5e-4, 1e-3, 3e-3, 1e-2, 2e-2, 0.0499 };
enum { RATIOS = sizeof ratios / sizeof *ratios, GAPS = sizeof gaps / sizeof *gaps };

static double distance_at(double a1, double a2, double xi)
{
    return (a1 + a2) * (1.0 + 0.5 * xi);
}

static void random_vector(gsl_rng *rng, double size, double v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = size * gsl_ran_gaussian(rng, 1.0);
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        out[k] = a[l] * b[m] - a[m] * b[l];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* A pair with everything random but radii and gap; sphere 1 has radius 1.3. */
static void random_pair(gsl_rng *rng, double ratio, double xi, struct theory_sphere s[2])
{
    double direction[3];
    gsl_ran_dir_3d(rng, direction, direction + 1, direction + 2);
    for (int a = 0; a < 2; a++) {
        s[a].radius = a == 0 ? 1.3 : 1.3 * ratio;
        random_vector(rng, 1.0, s[a].x);
        random_vector(rng, 0.8, s[a].u);
        random_vector(rng, 0.6, s[a].w);
    }
    const double r = distance_at(s[0].radius, s[1].radius, xi);
    for (int k = 0; k < 3; k++)
        s[1].x[k] = s[0].x[k] + r * direction[k];
}

/* Table of reference values at eta = 0.1, a_1 = 1, eight printed digits, computed elsewhere from the vector form of the model. */
static void scalars_agree_with_the_reference_table(void)
{
    static const struct { double ratio, xi, value[THEORY_SCALARS]; } row[] = {
        { 1.0, 1e-3, { 474.16858, 2.1701353, -2.1701353, -2.1701353, 3.4722165, 0.86805413, 3.4722165 } },
        { 1.0, 1e-2, { 49.077012, 1.4467569, -1.4467569, -1.4467569, 2.314811, 0.57870275, 2.314811 } },
        { 1.0, 0.0499, { 10.715049, 0.941766, -0.941766, -0.941766, 1.5068256, 0.3767064, 1.5068256 } },
        { 1.4, 1e-3, { 537.8723, 2.5740216, -2.2786421, -3.8990098, 4.0509193, 1.4178217, 7.9398018 } },
        { 1.4, 1e-2, { 55.694186, 1.7160144, -1.5190947, -2.5993399, 2.7006128, 0.9452145, 5.2932012 } },
        { 5.0, 1e-2, { 46.08468, 3.0542645, -1.4467569, -16.87883, 3.8580184, 4.8225229, 96.450459 } },
        { 7.0, 1e-2, { 38.429078, 3.3863153, -1.3925035, -25.698019, 4.0509193, 7.0891087, 198.49504 } },
        { 0.2, 1e-2, { 9.2169361, 0.61085291, -0.67515321, -0.057870275, 0.77160367, 0.038580184, 0.030864147 } },
    };
    const struct theory_lubrication law = { 0.1, 1e-3, 0.05, false };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        double scalar[THEORY_SCALARS];
        theory_scalars(&law, 1.0, row[k].ratio, distance_at(1.0, row[k].ratio, row[k].xi), scalar);
        for (int q = 0; q < THEORY_SCALARS; q++)   /* 8 digits printed: half a unit in the last is at most 5e-8 */
            check_relative(scalar[q], row[k].value[q], 6e-8, theory_scalar_name[q]);
    }
}

/* Reynolds: squeezing costs 6 pi eta R^2/h with R = a_1 a_2/(a_1 + a_2); the rest of X_A is a factor xi ln(1/xi) smaller. */
static void squeeze_tends_to_reynolds(void)
{
    const struct theory_lubrication law = { 0.7, 1e-12, 0.05, false };
    for (int k = 0; k < RATIOS; k++) {
        const double a1 = 1.3, a2 = 1.3 * ratios[k], xi = 1e-9, reduced = a1 * a2 / (a1 + a2), r = distance_at(a1, a2, xi);
        double scalar[THEORY_SCALARS];
        theory_scalars(&law, a1, a2, r, scalar);
        /* 1e-9 ln(1e9) times g2/g1 <= 20 is 4e-7; the rounding of h = r - a_1 - a_2 is 1e-16/1e-9 = 1e-7 on top */
        check_relative(scalar[THEORY_XA], 6.0 * M_PI * 0.7 * reduced * reduced / (0.5 * xi * (a1 + a2)), 2e-6, "Reynolds");
    }
}

/*
 * A sphere at a wall (ratio to infinity), friction per ln(a/h): Brenner (1961): a/h + (1/5) ln; Goldman, Cox & Brenner (1967):
 * translation 8/15 (of 6 pi eta a), force from rotation 2/15 (of 6 pi eta a^2), rotation 2/5 (of 8 pi eta a^3).
 */
static void scalars_tend_to_a_wall(void)
{
    const double a1 = 1.3, ratio = 1e7, eta = 0.7;
    const struct theory_lubrication law = { eta, 1e-16, 1.0, false };
    double at[2][THEORY_SCALARS];
    const double h[2] = { 1e-3 * a1, 1e-2 * a1 };
    for (int k = 0; k < 2; k++)
        theory_scalars(&law, a1, a1 * ratio, a1 + a1 * ratio + h[k], at[k]);
    const double decade = log(10.0);
    /* corrections are of order 1/ratio = 1e-7, and h = r - a_1 - a_2 loses 1e7 * 1e-16/1e-3 = 1e-6 to rounding */
    check_relative((at[0][THEORY_YA] - at[1][THEORY_YA]) / (6.0 * M_PI * eta * a1), 8.0 / 15.0 * decade, 1e-5, "sliding at a wall");
    check_relative((at[0][THEORY_B1] - at[1][THEORY_B1]) / (6.0 * M_PI * eta * a1 * a1), -2.0 / 15.0 * decade, 1e-5,
                   "rolling at a wall");
    check_relative((at[0][THEORY_C11] - at[1][THEORY_C11]) / (8.0 * M_PI * eta * a1 * a1 * a1), 2.0 / 5.0 * decade, 1e-5,
                   "turning at a wall");
    const double squeeze = (at[0][THEORY_XA] - at[1][THEORY_XA]) / (6.0 * M_PI * eta * a1);
    check_close(squeeze - 900.0, 0.2 * decade, 2e-2, "logarithm of squeezing against a wall"); /* 900 known to 1e-5 of 900 */
}

/* Equal spheres, exact: 2 (X11A +- X12A) by the bispherical series of Brenner (1961) and Stimson & Jeffery (1926), over 6 pi eta a. */
static double bispherical(double xi, bool approaching)
{
    const double al = acosh(1.0 + 0.5 * xi);
    double sum = 0.0;
    for (int n = 1; (n + 0.5) * al < 300.0; n++) {
        const double k = 2.0 * n + 1.0, weight = n * (n + 1.0) / ((2.0 * n - 1.0) * (2.0 * n + 3.0));
        if (approaching) {
            const double c = cosh((n + 0.5) * al);
            sum += weight * ((4.0 * c * c + k * k * pow(sinh(al), 2)) / (2.0 * sinh(k * al) - k * sinh(2.0 * al)) - 1.0);
        } else {
            const double s = sinh((n + 0.5) * al);
            sum += weight * (1.0 - (4.0 * s * s - k * k * pow(sinh(al), 2)) / (2.0 * sinh(k * al) + k * sinh(2.0 * al)));
        }
    }
    return 4.0 / 3.0 * sinh(al) * sum;
}

/*
 * The exact squeeze minus the model tends to a constant (X11A: 0.9953, X12A: -0.3502, from the twin-multipole series): the two
 * singular terms are then right in sign and size. What is left is g3 xi ln(1/xi) < 3e-4 at xi = 1e-3; the constants are known
 * to 3e-4.
 */
static void squeeze_agrees_with_the_exact_series(void)
{
    const struct theory_lubrication law = { 1.0, 1e-9, 1.0, false };
    for (double xi = 1e-4; xi < 2e-3; xi *= 10.0) {
        double scalar[THEORY_SCALARS];
        theory_scalars(&law, 1.0, 1.0, 2.0 + xi, scalar);
        const double apart = bispherical(xi, true), together = bispherical(xi, false);
        const double model = scalar[THEORY_XA] / (6.0 * M_PI);
        check_close(0.5 * (apart + together) - model, 0.9953, 1e-3, "constant of X11A");
        check_close(0.5 * (together - apart) + model, -0.3502, 1e-3, "constant of X12A");
    }
    check_close(bispherical(1e-3, true), 504.4546, 1e-4, "the series itself, against a table with 4 decimals");
}

/* What a rigidly rolling pair at contact implies; exact for every ratio and gap. */
static void scalars_obey_the_identities(void)
{
    for (int k = 0; k < RATIOS; k++)
        for (int g = 0; g < GAPS; g++) {
            const double a1 = 1.3, a2 = 1.3 * ratios[k], sum = a1 + a2;
            double q[THEORY_SCALARS];
            theory_scalars(&plain, a1, a2, distance_at(a1, a2, gaps[g]), q);
            check_relative(q[THEORY_B1] + q[THEORY_B2], -sum * q[THEORY_YA], rounding, "B_1 + B_2");
            check_relative(q[THEORY_C11] + q[THEORY_C12], -sum * q[THEORY_B1], rounding, "C_11 + C_12");
            check_relative(q[THEORY_C22] + q[THEORY_C12], -sum * q[THEORY_B2], rounding, "C_22 + C_21");
        }
}

static void scalars_freeze_and_vanish_at_the_cut_offs(void)
{
    double frozen[THEORY_SCALARS], other[THEORY_SCALARS];
    theory_scalars(&plain, 1.3, 1.82, distance_at(1.3, 1.82, 1e-3), frozen);
    const double below[] = { 9e-4, 0.0, -1e-3, -0.3 };
    for (int k = 0; k < 4; k++) {
        theory_scalars(&plain, 1.3, 1.82, distance_at(1.3, 1.82, below[k]), other);
        for (int q = 0; q < THEORY_SCALARS; q++)   /* at xi_min itself the gap carries the rounding of r: 2e-16/1e-3 */
            check_relative(other[q], frozen[q], 1e-12, "frozen below the inner gap");
    }
    theory_scalars(&plain, 1.3, 1.82, distance_at(1.3, 1.82, 0.05 * (1.0 - 1e-9)), other);
    check_true(other[THEORY_XA] > 0.0, "just inside the outer gap the pair interacts");
    theory_scalars(&plain, 1.3, 1.82, distance_at(1.3, 1.82, 0.05 * (1.0 + 1e-9)), other);
    for (int q = 0; q < THEORY_SCALARS; q++)
        check_true(other[q] == 0.0, "just outside the outer gap it does not");
}

static void resistance_is_symmetric_positive_and_of_rank_5(void)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(12);
    gsl_vector *eigenvalue = gsl_vector_alloc(12);
    for (int k = 0; k < RATIOS; k++)
        for (int g = 0; g < 2 * GAPS; g++) {
            struct theory_sphere s[2];
            random_pair(rng, ratios[k], gaps[g / 2], s);
            double r[3], R[144], largest = 0.0, asymmetry = 0.0;
            for (int l = 0; l < 3; l++)
                r[l] = s[1].x[l] - s[0].x[l];
            theory_pair_resistance(g % 2 ? &exact : &plain, s[0].radius, s[1].radius, r, R);
            for (int i = 0; i < 12; i++)
                for (int j = 0; j < 12; j++) {
                    largest = fmax(largest, fabs(R[12 * i + j]));
                    asymmetry = fmax(asymmetry, fabs(R[12 * i + j] - R[12 * j + i]));
                }
            check_close(asymmetry / largest, 0.0, rounding, "symmetry");
            gsl_matrix_view view = gsl_matrix_view_array(R, 12, 12);
            gsl_eigen_symm(&view.matrix, eigenvalue, space);
            int rank = 0;
            for (int i = 0; i < 12; i++) {
                const double share = gsl_vector_get(eigenvalue, (size_t)i) / gsl_vector_max(eigenvalue);
                check_true(share > -rounding, "no negative eigenvalue");
                /* the smallest true one, the sliding of a ratio 7 pair at the inner gap, is above 1e-5 of the largest */
                rank += share > 1e-10;
            }
            check_true(rank == 5, "rank 5: one squeeze, two ways of sliding, two of rolling");
        }
    gsl_vector_free(eigenvalue);
    gsl_eigen_symm_free(space);
    gsl_rng_free(rng);
}

/* Worked pair in the vector form of the model, 12 decimals, recomputed in 30-digit arithmetic (mpmath). */
static void worked_pair_of_unequal_spheres(void)
{
    const struct theory_lubrication law = { 0.1, 1e-3, 0.05, false };
    const struct theory_sphere s[2] = {
        { .radius = 1.0, .w = { 0.1, 0.2, 0.3 } },
        { .radius = 1.4, .x = { 2.41, 0.0, 0.0 }, .u = { -0.1, 0.2, 0.3 }, .w = { -0.3, 0.1, 0.2 } } };
    const double force[3] = { -6.647314855714, -0.657430361404, 1.121258009619 };
    const double torque[2][3] = { { 0.0, -1.133540961211, -0.722939436562 }, { 0.0, -1.557478261874, -0.854893430808 } };
    struct theory_pair pair;
    theory_lubrication_pair(&law, s, &pair);
    for (int k = 0; k < 3; k++) {   /* 12 decimals printed */
        check_close(pair.force[0][k], force[k], 1e-12, "force on 1");
        check_close(pair.force[1][k], -force[k], 1e-12, "force on 2");
        check_close(pair.torque[0][k], torque[0][k], 1e-12, "torque on 1");
        check_close(pair.torque[1][k], torque[1][k], 1e-12, "torque on 2");
        check_close(pair.stress[k][0], force[k] * 2.41, 3e-12, "stress F_x r_x");
        check_close(pair.stress[k][1], 0.0, 1e-15, "no stress across the line of centres");
    }
}

/* Swapped labels, rigid motion, power, torque residual: for random pairs of every ratio and gap, both rotation options. */
static void pairs_obey_the_invariants(void)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < RATIOS; k++)
        for (int g = 0; g < 2 * GAPS; g++) {
            const struct theory_lubrication *law = g % 2 ? &exact : &plain;
            struct theory_sphere s[2], swapped[2];
            struct theory_pair pair, other;
            random_pair(rng, ratios[k], gaps[g / 2], s);
            theory_lubrication_pair(law, s, &pair);
            const double size = sqrt(dot(pair.force[0], pair.force[0]));
            const double turn = sqrt(dot(pair.torque[0], pair.torque[0]) + dot(pair.torque[1], pair.torque[1]));

            swapped[0] = s[1];
            swapped[1] = s[0];
            theory_lubrication_pair(law, swapped, &other);
            double power = 0.0, r[3], moment[3], residual[3];
            for (int l = 0; l < 3; l++) {
                check_close(pair.force[1][l], -pair.force[0][l], rounding * size, "third law");
                check_close(other.force[1][l], pair.force[0][l], 1e-12 * size, "swapped labels, force"); /* gap costs digits */
                check_close(other.torque[1][l], pair.torque[0][l], 1e-12 * turn, "swapped labels, torque");
                for (int a = 0; a < 2; a++)
                    power += pair.force[a][l] * s[a].u[l] + pair.torque[a][l] * s[a].w[l];
                r[l] = s[1].x[l] - s[0].x[l];
            }
            check_true(power < 0.0, "lubrication takes energy out");

            cross(r, pair.force[1], moment);
            theory_lubrication_torque_residual(law, s, residual);
            for (int l = 0; l < 3; l++)
                check_close(pair.torque[0][l] + pair.torque[1][l] + moment[l], residual[l], 1e-12 * (turn + size),
                            "torque balance up to the known residual");

            /* rigid rotation: a force Y_A h omega x n remains, none at all with the exact congruence */
            double omega[3], scalar[THEORY_SCALARS], n[3];
            random_vector(rng, 1.0, omega);
            const double distance = sqrt(dot(r, r));
            for (int l = 0; l < 3; l++)
                n[l] = r[l] / distance;
            for (int a = 0; a < 2; a++) {
                cross(omega, s[a].x, s[a].u);
                memcpy(s[a].w, omega, sizeof omega);
            }
            theory_lubrication_pair(law, s, &pair);
            theory_scalars(law, s[0].radius, s[1].radius, distance, scalar);
            cross(omega, n, moment);
            const double h = g % 2 ? 0.0 : distance - s[0].radius - s[1].radius;
            for (int l = 0; l < 3; l++)
                check_close(pair.force[0][l], scalar[THEORY_YA] * h * moment[l], 1e-12 * scalar[THEORY_XA] * distance,
                            "rigid rotation");
        }
    gsl_rng_free(rng);
}

static void worked_contact_of_equal_spheres(void)
{
    const struct theory_contact law = { .normal_stiffness = 1e4, .tangential_stiffness = 7000.0, .friction = 0.5, .lever_at_contact = false };
    const struct theory_sphere s[2] = { { .radius = 1.0 }, { .radius = 1.0, .x = { 1.99, 0.0, 0.0 } } };
    const double history[3] = { 0.0, 1e-4, 0.0 };
    struct theory_pair pair;
    theory_contact_pair(&law, s, history, &pair);
    /* the overlap 2 - 1.99 carries the rounding of 1.99: 2e-16 times k_n = 2e-12 */
    check_close(pair.force[0][0], -100.0, 1e-11, "spring");
    check_close(pair.force[0][1], -0.7, rounding, "tangential spring");
    check_close(pair.torque[0][2], -0.7, rounding, "torque on 1");
    check_close(pair.torque[1][2], -0.7, rounding, "torque on 2: the same sign");
    check_close(pair.stress[0][0], -199.0, 2e-11, "compression is negative");
    check_close(pair.stress[1][0], -0.7 * 1.99, rounding, "stress F_y r_x");
}

/* Forces and torques are minus the derivatives of k_n delta^2/2 + k_t s_t^2/2 for small motions (sticking). */
static void contact_forces_are_the_slope_of_an_energy(void)
{
    const struct theory_contact law = { .normal_stiffness = 900.0, .tangential_stiffness = 400.0, .friction = 1e3, .lever_at_contact = true };
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < RATIOS; k++) {
        struct theory_sphere s[2];
        struct theory_pair pair;
        double history[3], n[3], total = 0.0;
        random_pair(rng, ratios[k], -0.02, s);
        random_vector(rng, 0.01, history);
        theory_contact_pair(&law, s, history, &pair);
        for (int l = 0; l < 3; l++) {
            n[l] = s[1].x[l] - s[0].x[l];
            total += n[l] * n[l];
        }
        const double r = sqrt(total), overlap = s[0].radius + s[1].radius - r;
        for (int l = 0; l < 3; l++)
            n[l] /= r;
        const double along = dot(history, n);
        double plane[3], moment[3];
        for (int l = 0; l < 3; l++)
            plane[l] = history[l] - along * n[l];
        /* U_1 changes delta by n.U_1 dt and s by the tangential part of U_1 dt; W_1 changes s by l_1 W_1 x n dt */
        for (int l = 0; l < 3; l++)
            check_close(pair.force[0][l], -900.0 * overlap * n[l] - 400.0 * plane[l], 1e-11, "force");
        cross(n, plane, moment);
        for (int a = 0; a < 2; a++)
            for (int l = 0; l < 3; l++)
                check_close(pair.torque[a][l], -400.0 * s[a].radius * r / (s[0].radius + s[1].radius) * moment[l], 1e-11, "torque");
    }
    gsl_rng_free(rng);
}

static void contact_obeys_cap_and_torque_balance(void)
{
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int k = 0; k < 4 * RATIOS; k++) {
        const struct theory_contact law = { .normal_stiffness = 900.0, .tangential_stiffness = 300.0, .friction = k % 4 < 2 ? 0.5 : 0.0, .lever_at_contact = k % 2 == 1 };
        struct theory_sphere s[2];
        struct theory_pair pair;
        double history[3], residual[3], moment[3], r[3], scale = 0.0;
        random_pair(rng, ratios[k / 4], -0.01, s);
        random_vector(rng, 1.0, history);   /* far beyond the cap */
        theory_contact_pair(&law, s, history, &pair);
        for (int l = 0; l < 3; l++)
            r[l] = s[1].x[l] - s[0].x[l];
        const double distance = sqrt(dot(r, r)), overlap = s[0].radius + s[1].radius - distance;
        const double normal = dot(pair.force[0], r) / distance;
        const double tangential = sqrt(fmax(0.0, dot(pair.force[0], pair.force[0]) - normal * normal));
        check_relative(normal, -900.0 * overlap, 1e-11, "spring");   /* overlap = difference of lengths 100 times larger */
        check_close(tangential, law.friction * 900.0 * overlap, 1e-6 * 900.0 * overlap, "capped"); /* root of a difference */
        theory_contact_torque_residual(&law, s, history, residual);
        cross(r, pair.force[1], moment);
        for (int l = 0; l < 3; l++)
            scale += fabs(pair.torque[0][l]) + fabs(moment[l]);
        for (int l = 0; l < 3; l++) {
            check_close(pair.torque[0][l] + pair.torque[1][l] + moment[l], residual[l], 1e-13 * scale + 1e-13, "torque balance");
            if (law.friction == 0.0)
                check_true(pair.torque[0][l] == 0.0 && pair.torque[1][l] == 0.0, "no torque without friction");
        }
        random_pair(rng, ratios[k / 4], 1e-9, s);
        theory_contact_pair(&law, s, history, &pair);
        check_true(dot(pair.force[0], pair.force[0]) == 0.0, "no force apart");
    }
    gsl_rng_free(rng);
}

static const struct unit_test tests[] = {
    { "scalars agree with the reference table", scalars_agree_with_the_reference_table },
    { "squeeze tends to Reynolds", squeeze_tends_to_reynolds },
    { "scalars tend to those at a wall", scalars_tend_to_a_wall },
    { "squeeze agrees with the exact series", squeeze_agrees_with_the_exact_series },
    { "scalars obey the identities", scalars_obey_the_identities },
    { "scalars freeze and vanish at the cut-offs", scalars_freeze_and_vanish_at_the_cut_offs },
    { "resistance is symmetric, positive, of rank 5", resistance_is_symmetric_positive_and_of_rank_5 },
    { "worked pair of unequal spheres", worked_pair_of_unequal_spheres },
    { "pairs obey the invariants", pairs_obey_the_invariants },
    { "worked contact of equal spheres", worked_contact_of_equal_spheres },
    { "contact forces are the slope of an energy", contact_forces_are_the_slope_of_an_energy },
    { "contact obeys cap and torque balance", contact_obeys_cap_and_torque_balance },
    { NULL, NULL }
};

const struct suite theory_suite = { "theory", tests };
