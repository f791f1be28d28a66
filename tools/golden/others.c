/* Golden vectors of drag, repulsion, forces from outside, and of the Brownian forces' covariances. */
#include "vectors.h"

#include <math.h>
#include <string.h>

static const char rounding[] = "closed forms of 17-digit input; errors are measured against the size of the terms (scale)";

/* --- drag --- */

static void drag_vector(struct vector_file *f, double viscosity, bool torque, double G[3][3], const struct theory_sphere *s, const char *comment)
{
    double force[3], moment[3], stresslet[3][3];
    struct vector v = { .comment = comment, .result = "valid", .flags = torque ? "" : "no-torque" };
    theory_drag(viscosity, torque, (const double(*)[3])G, s, force, moment, stresslet);
    add_number(&v.input, "radius", s->radius);
    add_list(&v.input, "position", s->x, 3);
    add_list(&v.input, "velocity", s->u, 3);
    add_list(&v.input, "spin", s->w, 3);
    add_list(&v.input, "gradient", &G[0][0], 9);
    add_list(&v.expected, "force", force, 3);
    add_list(&v.expected, "torque", moment, 3);
    add_list(&v.expected, "stress", &stresslet[0][0], 9);
    double rate = 0.0, place = 0.0;
    for (int k = 0; k < 9; k++)
        rate += fabs(G[k / 3][k % 3]);
    for (int k = 0; k < 3; k++)
        place += fabs(s->x[k]);
    v.force_scale = 19.0 * viscosity * s->radius * (rate * place + speed_of(s) + 1e-3);
    v.torque_scale = v.stress_scale = 25.0 * viscosity * s->radius * s->radius * s->radius * (rate + spin_of(s) + 1e-3);
    file_vector(f, &v);
}

bool vectors_drag(const char *folder)
{
    static const char *const flags[] = { "no-torque", "the rotational drag is switched off", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "drag",
                   "Stokes drag on one sphere in the flow U_inf = G x (gradient: G_kl = dU_k/dx_l): F = 6 pi eta a (G x - U), "
                   "T = 8 pi eta a^3 (curl(G x)/2 - W), stresslet (20/3) pi eta a^3 (G + G^T)/2 (here: stress, not divided by a volume)",
                   flags, 1e-12, rounding))
        return false;
    struct dice d = { 21 };
    for (int torque = 1; torque >= 0; torque--) {
        struct fields model = { 0 };
        add_number(&model, "viscosity", 0.7);
        add_word(&model, "torque", torque ? "on" : "off");
        file_group(&f, "drag", torque ? "force and torque" : "force alone", &model);
        for (int plane = 0; plane < 7; plane++)
            for (int sign = 0; sign < (plane < 6 ? 2 : 1); sign++) {
                double G[3][3] = { { 0.0 } };
                struct theory_sphere s = { .radius = (plane + sign) % 2 ? 0.26 : 1.3 };
                char comment[80];
                const int flow = plane % 3, gradient = (flow + 1 + plane / 3) % 3;
                for (int k = 0; k < 3; k++)
                    s.x[k] = 6.0 + 4.0 * dice_number(&d);
                dice_vector(&d, 0.9, s.u);
                dice_vector(&d, 0.7, s.w);
                if (plane < 6)
                    G[flow][gradient] = sign ? 0.37 : -0.4;
                else {                      /* two shears at once */
                    G[0][1] = -0.4;
                    G[2][1] = 0.23;
                }
                snprintf(comment, sizeof comment, plane < 6 ? "flow %c, gradient %c, rate %g" : "flow x, gradient y, rate -0.4; flow z, gradient y, rate 0.23",
                         'x' + flow, 'x' + gradient, G[flow][gradient]);
                drag_vector(&f, 0.7, torque, G, &s, comment);
                if (plane == 1) {
                    memset(G, 0, sizeof G);
                    drag_vector(&f, 0.7, torque, G, &s, "at rest");
                }
            }
    }
    return file_close(&f);
}

/* --- repulsion --- */

bool vectors_repulsion(const char *folder)
{
    static const char *const flags[] = { "edge", "a millionth of the range inside or outside the cut-off; the force is not shifted", "exchanged",
                                         "the vector before with the labels exchanged", "form-energy", "the strength is an energy A, the force A/kappa exp(-h/kappa)",
                                         "form-force", "the strength is a force F_0", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "repulsion",
                   "Exponential repulsion: F_1 = -f exp(-h/kappa) n, kappa = kappa_factor (a_1 + a_2), f = energy/kappa or force, up to h = cutoff kappa, growing on in overlap",
                   flags, 1e-10, "a rounding of the gap, 1e-15 of a distance of 10, is 1e-13 of the range; errors are measured against the force without cut-off at the same gap"))
        return false;
    static const double kappas[] = { -4.0, -0.3, 1e-9, 1.0, 3.7, 0.999999, 1.000001, 1.3 };     /* from the sixth on: times the cut-off */
    struct dice d = { 22 };
    for (int energy = 0; energy < 2; energy++) {
        const struct theory_repulsion law = { energy, energy ? 0.53 : 2.3, energy ? 0.013 : 0.07, energy ? 14.0 : 6.0 };
        struct fields model = { 0 };
        add_word(&model, "form", energy ? "energy" : "force");
        add_number(&model, energy ? "energy" : "force", law.strength);
        add_number(&model, "kappa_factor", law.kappa_factor);
        add_number(&model, "cutoff", law.cutoff);
        file_group(&f, "repulsion", energy ? "strength given as an energy" : "strength given as a force", &model);
        for (int r = 0; r < 6; r++)
            for (int g = 0; g < 8; g++) {
                struct theory_sphere s[2];
                const double at = g < 5 ? kappas[g] : kappas[g] * law.cutoff;
                dice_pair(&d, ratios[r], 2.0 * at * law.kappa_factor, s);
                for (int back = 0; back < (g == 3 ? 2 : 1); back++) {
                    struct theory_pair p;
                    char comment[80], words[60];
                    if (back)
                        exchange(s, NULL);
                    snprintf(comment, sizeof comment, "size ratio %.6g, gap %.7g kappa", back ? 1.0 / ratios[r] : ratios[r], at);
                    snprintf(words, sizeof words, "%s%s%s", energy ? "form-energy" : "form-force", g == 5 || g == 6 ? " edge" : "", back ? " exchanged" : "");
                    struct vector v = { .comment = comment, .result = "acceptable", .flags = words };
                    theory_repulsion_pair(&law, s, &p);
                    add_pair(&v.input, s);
                    add_pair_answer(&v.expected, &p);
                    const double sizes = s[0].radius + s[1].radius, h = 0.5 * gap_of(s) * sizes;
                    v.force_scale = theory_repulsion_energy(&law, s[0].radius, s[1].radius, h) / (law.kappa_factor * sizes);
                    v.torque_scale = v.stress_scale = v.force_scale * (sizes + h);
                    file_vector(&f, &v);
                }
            }
    }
    return file_close(&f);
}

/* --- forces from outside: passed on unchanged, and no stress --- */

bool vectors_applied(const char *folder)
{
    static const char *const flags[] = { "force-only", "no torque is applied", "torque-only", "no force is applied", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "applied", "A constant force and torque from outside act on a sphere as they are, wherever it is and however it moves; they book no stress", flags,
                   1e-15, "numbers passed on unchanged"))
        return false;
    struct dice d = { 23 };
    for (int kind = 0; kind < 3; kind++) {
        struct fields model = { 0 };
        double load[6];
        for (int k = 0; k < 6; k++)
            load[k] = (kind == 1 && k > 2) || (kind == 2 && k < 3) ? 0.0 : 2.0 * dice_number(&d);
        add_list(&model, "force", load, 3);
        add_list(&model, "torque", load + 3, 3);
        file_group(&f, "applied", kind == 0 ? "force and torque" : kind == 1 ? "force alone" : "torque alone", &model);
        for (int k = 0; k < 2; k++) {
            struct theory_sphere s = { .radius = k ? 0.26 : 1.3 };
            static const double none[9] = { 0.0 };
            dice_vector(&d, 5.0, s.x);
            for (int c = 0; c < 3; c++)
                s.x[c] += 6.0;
            dice_vector(&d, 0.9, s.u);
            dice_vector(&d, 0.7, s.w);
            struct vector v = { .comment = "one sphere, moving and spinning", .result = "valid", .flags = kind == 0 ? "" : kind == 1 ? "force-only" : "torque-only" };
            add_number(&v.input, "radius", s.radius);
            add_list(&v.input, "position", s.x, 3);
            add_list(&v.input, "velocity", s.u, 3);
            add_list(&v.input, "spin", s.w, 3);
            add_list(&v.expected, "force", load, 3);
            add_list(&v.expected, "torque", load + 3, 3);
            add_list(&v.expected, "stress", none, 9);
            v.force_scale = v.torque_scale = v.stress_scale = 1.0;
            file_vector(&f, &v);
        }
    }
    return file_close(&f);
}

/* --- noise: covariance (2 kT/dt) R --- */

static const double kT = 0.31, dt = 3.1e-6, viscosity = 0.7;

static void noise_model(struct fields *model)
{
    add_number(model, "kT", kT);
    add_number(model, "dt", dt);
    add_number(model, "viscosity", viscosity);
}

bool vectors_noise_one_body(const char *folder)
{
    static const char *const flags[] = { NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "noise-one-body",
                   "Covariance of the Brownian force and torque on one sphere, held for a step dt: (2 kT/dt) diag(6 pi eta a, 8 pi eta a^3), order F_x F_y F_z T_x T_y T_z; "
                   "mean zero, independent between steps and spheres",
                   flags, 1e-10, "a closed form; a sampled covariance agrees within its sampling error, 1.4/sqrt(draws) of a diagonal element"))
        return false;
    struct fields model = { 0 };
    noise_model(&model);
    file_group(&f, "noise-one-body", "one sphere in a fluid at rest or in any flow", &model);
    static const double radius[] = { 0.26, 0.9285714285714286, 1.3, 9.1 };
    for (int k = 0; k < 4; k++) {
        double C[36] = { 0.0 }, rest[3][3] = { { 0.0 } };
        struct vector v = { .comment = "covariance of force and torque", .result = "valid", .flags = "" };
        for (int c = 0; c < 3; c++) {           /* R from the drag that unit velocity and spin feel */
            struct theory_sphere s = { .radius = radius[k] };
            double force[3], torque[3], stresslet[3][3];
            s.u[c] = s.w[c] = 1.0;
            theory_drag(viscosity, true, (const double(*)[3])rest, &s, force, torque, stresslet);
            C[7 * c] = -2.0 * kT / dt * force[c];
            C[7 * (c + 3)] = -2.0 * kT / dt * torque[c];
        }
        add_number(&v.input, "radius", radius[k]);
        add_list(&v.expected, "covariance", C, 36);
        v.covariance_scale = fmax(C[0], C[21]);
        file_vector(&f, &v);
    }
    return file_close(&f);
}

bool vectors_noise_pair(const char *folder)
{
    static const char *const flags[] = { "rotation-none", "couplings as the source has them", "rotation-exact", "couplings scaled so that rigid rotation costs nothing",
                                         "beyond", "beyond the outer gap: no noise", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "noise-pair",
                   "Covariance of the Brownian forces and torques of a lubricated pair, held for a step dt: (2 kT/dt) R, 12 x 12, order F_1 F_2 T_1 T_2; mean zero, "
                   "independent between steps, pairs, and of the one-body noise",
                   flags, 1e-10, "a closed form; a sampled covariance agrees within its sampling error, 1.4/sqrt(draws) of a diagonal element"))
        return false;
    static const double at[] = { -0.02, 5e-4, 3e-3, 0.049, 0.06 };
    struct dice d = { 24 };
    for (int exact = 0; exact < 2; exact++) {
        const struct theory_lubrication law = { viscosity, 1e-3, 0.05, exact };
        struct fields model = { 0 };
        noise_model(&model);
        add_number(&model, "inner_gap", law.inner_gap);
        add_number(&model, "outer_gap", law.outer_gap);
        add_word(&model, "rotation_correction", exact ? "exact" : "none");
        file_group(&f, "noise-pair", exact ? "couplings scaled so that rigid rotation costs nothing" : "couplings as the source has them", &model);
        for (int k = 0; k < (exact ? 6 : 13); k++) {
            struct theory_sphere s[2];
            double R[144], x[6], largest = 0.0;
            const double xi = k == 12 ? at[4] : at[(k + k / 6) % 4];
            dice_pair(&d, ratios[k % 6], xi, s);
            for (int c = 0; c < 6; c++)
                x[c] = s[c / 3].x[c % 3];
            const double between[3] = { x[3] - x[0], x[4] - x[1], x[5] - x[2] }, radius[2] = { s[0].radius, s[1].radius };
            theory_pair_resistance(&law, radius[0], radius[1], between, R);
            for (int c = 0; c < 144; c++) {
                R[c] *= 2.0 * kT / dt;
                largest = fmax(largest, fabs(R[c]));
            }
            char comment[80];
            snprintf(comment, sizeof comment, "size ratio %.6g, asked gap %g", ratios[k % 6], xi);
            struct vector v = { .comment = comment, .result = k == 12 ? "valid" : "acceptable",
                                .flags = k == 12 ? "rotation-none beyond" : exact ? "rotation-exact" : "rotation-none" };
            add_number(&v.input, "gap", gap_of(s));
            add_list(&v.input, "radius", radius, 2);
            add_list(&v.input, "position", x, 6);
            add_list(&v.expected, "covariance", R, 144);
            v.covariance_scale = largest > 0.0 ? largest : 2.0 * kT / dt * 19.0 * viscosity * radius[0];   /* of one-body noise */
            file_vector(&f, &v);
        }
    }
    return file_close(&f);
}
