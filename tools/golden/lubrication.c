/* Golden vectors of pair lubrication: its seven scalars, the whole resistance matrix, forces of moving pairs. */
#include "vectors.h"

#include <math.h>
#include <string.h>

static const char reason[] = "closed forms of 17-digit input; what remains is rounding of positions, magnified by the smallest gap (1e-3), and of the "
                             "sums, whose terms may cancel; errors are measured against the size of the terms (scale)";
static const char *const conventions[] = {
    "rotation-none", "the couplings as the source has them; a pair that turns rigidly about an axis across n feels Y_A h (omega x n)",
    "rotation-exact", "B_1, B_2 times s, C_11, C_12, C_22 times s^2, s = r/(a_1 + a_2): a pair that turns rigidly feels nothing",
    "frozen", "below the inner gap, or in overlap: the scalars are those of the inner gap", "beyond", "beyond the outer gap: nothing",
    "edge", "a billionth of itself inside or outside a cut-off", "exchanged", "the vector before with the labels exchanged", "rigid", "the pair moves as a rigid body",
    NULL };
static const double gaps[] = { -0.5, -0.1, -1e-3, 0.0, 4e-4, 0.000999999999, 0.001000000001, 3e-3, 0.01, 0.02, 0.04, 0.04999999995, 0.05000000005, 0.07 };
enum { GAPS = sizeof gaps / sizeof *gaps };

static struct theory_lubrication law_of(bool exact)
{
    return (struct theory_lubrication){ .viscosity = 0.7, .inner_gap = 1e-3, .outer_gap = 0.05, .exact_rotation = exact };
}

static void group(struct vector_file *f, const char *kind, bool exact)
{
    const struct theory_lubrication law = law_of(exact);
    struct fields model = { 0 };
    add_number(&model, "viscosity", law.viscosity);
    add_number(&model, "inner_gap", law.inner_gap);
    add_number(&model, "outer_gap", law.outer_gap);
    add_word(&model, "rotation_correction", exact ? "exact" : "none");
    file_group(f, kind, exact ? "couplings scaled so that rigid rotation costs nothing" : "couplings as the source has them", &model);
}

/* Words for a gap; the first is the convention. Vectors that do not depend on the convention are valid, not only acceptable. */
static const char *flags_of(double xi, bool exact, const char *more)
{
    static char text[120];
    const bool edge = xi == 0.000999999999 || xi == 0.001000000001 || xi == 0.04999999995 || xi == 0.05000000005;
    snprintf(text, sizeof text, "%s%s%s%s", exact ? "rotation-exact" : "rotation-none", xi > 0.05 ? " beyond" : xi < 1e-3 ? " frozen" : "",
             edge ? " edge" : "", more);
    return text;
}

static const char *comment_of(double ratio, double xi)
{
    static char text[80];
    snprintf(text, sizeof text, "size ratio %.6g, asked gap %.11g", ratio, xi);
    return text;
}

bool vectors_lubrication_scalars(const char *folder)
{
    struct vector_file f;
    if (!file_open(&f, folder, "lubrication-scalars",
                   "Seven scalars of the near-field resistance of two spheres (leading terms of Jeffrey & Onishi 1984): "
                   "F_1 = (X_A n n + Y_A (1 - n n)).(U_2 - U_1) + (B_1 W_1 + B_2 W_2) x n, T_1 = B_1 (U_2 - U_1) x n - (1 - n n).(C_11 W_1 + C_12 W_2), "
                   "T_2 = B_2 (U_2 - U_1) x n - (1 - n n).(C_12 W_1 + C_22 W_2)",
                   conventions, 1e-10, "closed forms; the gap is a difference of three numbers of 17 digits and 1e-3 of them, which costs three digits; errors are "
                   "measured against each scalar itself"))
        return false;
    for (int exact = 0; exact < 2; exact++) {
        const struct theory_lubrication law = law_of(exact);
        group(&f, "lubrication-scalars", exact);
        for (int r = 0; r < 6; r++)
            for (int g = 0; g < GAPS; g++) {
                const double radius[2] = { 1.3, 1.3 * ratios[r] }, distance = (radius[0] + radius[1]) * (1.0 + 0.5 * gaps[g]);
                double scalar[THEORY_SCALARS];
                struct vector v = { .comment = comment_of(ratios[r], gaps[g]), .result = gaps[g] > 0.05 ? "valid" : "acceptable",
                                    .flags = flags_of(gaps[g], exact, "") };
                theory_scalars(&law, radius[0], radius[1], distance, scalar);
                add_list(&v.input, "radius", radius, 2);
                add_number(&v.input, "distance", distance);
                add_number(&v.input, "gap", 2.0 * (distance - radius[0] - radius[1]) / (radius[0] + radius[1]));
                for (int q = 0; q < THEORY_SCALARS; q++)
                    add_number(&v.expected, theory_scalar_name[q], scalar[q]);
                file_vector(&f, &v);
            }
    }
    return file_close(&f);
}

/* Sizes of the terms of a moving pair. */
static void scales(struct vector *v, const struct theory_lubrication *law, const struct theory_sphere s[2])
{
    double c[THEORY_SCALARS], du = 0.0;
    const double sizes = s[0].radius + s[1].radius, distance = sizes * (1.0 + 0.5 * gap_of(s)), w1 = spin_of(&s[0]), w2 = spin_of(&s[1]);
    struct theory_lubrication wide = *law;
    wide.outer_gap *= 2.0;          /* beyond the cut-off too there is a size to compare with */
    theory_scalars(&wide, s[0].radius, s[1].radius, distance, c);
    for (int k = 0; k < 3; k++)
        du += (s[1].u[k] - s[0].u[k]) * (s[1].u[k] - s[0].u[k]);
    du = sqrt(du);
    v->force_scale = (c[THEORY_XA] + c[THEORY_YA]) * du + fabs(c[THEORY_B1]) * w1 + fabs(c[THEORY_B2]) * w2;
    v->torque_scale = (fabs(c[THEORY_B1]) + fabs(c[THEORY_B2])) * du + (c[THEORY_C11] + c[THEORY_C12]) * w1 + (c[THEORY_C22] + c[THEORY_C12]) * w2;
    v->stress_scale = v->force_scale * distance;
}

bool vectors_lubrication_resistance(const char *folder)
{
    struct vector_file f;
    if (!file_open(&f, folder, "lubrication-resistance",
                   "The 12 x 12 resistance matrix R of a pair, rows and columns in the order U_1 U_2 W_1 W_2: (F_1, F_2, T_1, T_2) = -R (U_1, U_2, W_1, W_2). "
                   "Column k is minus the forces and torques of unit velocity k. Symmetric, positive semidefinite, of rank 5",
                   conventions, 1e-10, reason))
        return false;
    static const double at[] = { -0.02, 1e-3, 4e-3, 0.03 };
    struct dice d = { 11 };
    for (int exact = 0; exact < 2; exact++) {
        const struct theory_lubrication law = law_of(exact);
        group(&f, "lubrication-resistance", exact);
        for (int r = 0; r < 6; r++)
            for (int g = exact; g < 4; g += 1 + exact) {
                struct theory_sphere s[2];
                double R[144], x[6];
                dice_pair(&d, ratios[r], at[g], s);
                for (int k = 0; k < 6; k++)
                    x[k] = s[k / 3].x[k % 3];
                const double between[3] = { x[3] - x[0], x[4] - x[1], x[5] - x[2] }, radius[2] = { s[0].radius, s[1].radius };
                theory_pair_resistance(&law, radius[0], radius[1], between, R);
                struct vector v = { .comment = comment_of(ratios[r], at[g]), .result = "acceptable", .flags = flags_of(at[g], exact, "") };
                add_number(&v.input, "gap", gap_of(s));
                add_list(&v.input, "radius", radius, 2);
                add_list(&v.input, "position", x, 6);
                add_list(&v.expected, "resistance", R, 144);
                double c[THEORY_SCALARS];
                theory_scalars(&law, radius[0], radius[1], (radius[0] + radius[1]) * (1.0 + 0.5 * gap_of(s)), c);
                v.force_scale = c[THEORY_XA];
                v.torque_scale = c[THEORY_C11] + c[THEORY_C22] + c[THEORY_YA] * (radius[0] + radius[1]);
                file_vector(&f, &v);
            }
    }
    return file_close(&f);
}

static void put_forces(struct vector_file *f, const struct theory_lubrication *law, const struct theory_sphere s[2], const char *comment,
                       const char *flags, bool valid)
{
    struct theory_pair p;
    struct vector v = { .comment = comment, .result = valid ? "valid" : "acceptable", .flags = flags };
    theory_lubrication_pair(law, s, &p);
    add_pair(&v.input, s);
    add_pair_answer(&v.expected, &p);
    scales(&v, law, s);
    file_vector(f, &v);
}

/* The pair turns as one rigid body about an axis across n, and moves along. */
static void make_rigid(struct dice *d, struct theory_sphere s[2])
{
    double spin[3], speed[3];
    dice_vector(d, 0.7, spin);
    dice_vector(d, 0.9, speed);
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            s[side].u[k] = speed[k] + spin[l] * s[side].x[m] - spin[m] * s[side].x[l];
            s[side].w[k] = spin[k];
        }
}

bool vectors_lubrication_forces(const char *folder)
{
    struct vector_file f;
    if (!file_open(&f, folder, "lubrication-forces",
                   "Lubrication force, torque and stress of moving pairs, from deep overlap to beyond the outer gap (formulas in lubrication-scalars)",
                   conventions, 1e-10, reason))
        return false;
    struct dice d = { 12 };
    for (int exact = 0; exact < 2; exact++) {
        const struct theory_lubrication law = law_of(exact);
        group(&f, "lubrication", exact);
        for (int r = 0; r < 6; r++)
            for (int g = 0; g < GAPS; g += exact ? 3 : 1) {
                struct theory_sphere s[2];
                dice_pair(&d, ratios[r], gaps[g], s);
                put_forces(&f, &law, s, comment_of(ratios[r], gaps[g]), flags_of(gaps[g], exact, ""), gaps[g] > 0.05);
                if (g % 4 == 3) {
                    exchange(s, NULL);
                    put_forces(&f, &law, s, comment_of(1.0 / ratios[r], gaps[g]), flags_of(gaps[g], exact, " exchanged"), gaps[g] > 0.05);
                }
            }
        for (int r = 0; r < 6; r++) {       /* without spin and along n there is squeezing alone, which no convention touches */
            struct theory_sphere s[2];
            dice_pair(&d, ratios[r], 6e-3, s);
            for (int k = 0; k < 3; k++) {
                const double speed = (r % 2 ? -0.3 : 0.4) * (s[1].x[k] - s[0].x[k]);
                s[0].u[k] = s[1].u[k] + speed;
                s[0].w[k] = s[1].w[k] = 0.0;
            }
            put_forces(&f, &law, s, r % 2 ? "receding, no spin" : "approaching, no spin", flags_of(6e-3, exact, ""), true);
            make_rigid(&d, s);
            put_forces(&f, &law, s, "moves and turns as one rigid body", flags_of(6e-3, exact, " rigid"), false);
        }
    }
    return file_close(&f);
}
