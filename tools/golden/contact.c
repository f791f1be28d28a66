/* Golden vectors of contacts: the spring alone, friction with history, dashpots and friction laws. */
#include "vectors.h"

#include <math.h>
#include <string.h>

static const char reason[] = "closed forms of 17-digit input; what remains is rounding of positions, magnified by the smallest gap (1e-3), and of the "
                             "sums; errors are measured against the size of the terms (scale)";
static const double gaps[] = { -0.5, -0.1, -0.02, -0.003, 0.0, 1e-9, 0.03 };
enum { GAPS = sizeof gaps / sizeof *gaps };

static const char *comment_of(double xi, bool exchanged)
{
    static char text[120];
    snprintf(text, sizeof text, "%s, asked gap %g%s", xi < 0.0 ? "overlap" : xi == 0.0 ? "touching to rounding" : "apart", xi,
             exchanged ? ", labels exchanged" : "");
    return text;
}

/* Sizes of the terms. An overlap below a thousandth of the sizes is known to fewer digits: the scale does not shrink further with it. */
static void scales(struct vector *v, const struct theory_contact *law, const struct theory_sphere s[2])
{
    const double sizes = s[0].radius + s[1].radius, h = 0.5 * gap_of(s) * sizes;
    double zeta = 0.0;
    if (law->mass[0] > 0.0)
        zeta = theory_normal_dashpot(law) + law->tangential_damping * theory_reduced_mass(law);
    v->force_scale = law->normal_stiffness * fmax(-h, 1e-3 * sizes)
                     + zeta * (speed_of(&s[0]) + speed_of(&s[1]) + sizes * (spin_of(&s[0]) + spin_of(&s[1])));
    v->torque_scale = v->stress_scale = v->force_scale * sizes;
}

bool vectors_contact_frictionless(const char *folder)
{
    static const char *const flags[] = { "exchanged", "the vector before with the labels 1 and 2 exchanged", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "contact-frictionless",
                   "Linear spring between two spheres that overlap by delta = a_1 + a_2 - r: F_1 = -k_n delta n, nothing where they do not overlap",
                   flags, 1e-10, reason))
        return false;
    const struct theory_contact law = { .normal_stiffness = 310.0 };
    struct fields model = { 0 };
    add_number(&model, "normal_stiffness", law.normal_stiffness);
    add_number(&model, "friction", 0.0);
    file_group(&f, "contact", "spring alone", &model);
    struct dice d = { 1 };
    for (int r = 0; r < 6; r++)
        for (int g = 0; g < GAPS; g++) {
            struct theory_sphere s[2];
            dice_pair(&d, ratios[r], gaps[g], s);
            for (int back = 0; back < (g == 1 || g == 3 ? 2 : 1); back++) {
                struct theory_pair p;
                struct vector v = { .comment = comment_of(gaps[g], back), .result = "valid", .flags = back ? "exchanged" : "" };
                if (back)
                    exchange(s, NULL);
                theory_contact_pair(&law, s, (const double[3]){ 0.0, 0.0, 0.0 }, &p);
                add_pair(&v.input, s);
                add_pair_answer(&v.expected, &p);
                scales(&v, &law, s);
                file_vector(&f, &v);
            }
        }
    return file_close(&f);
}

/* Histories: none, a small one in some direction (partly along n, so that the projection is seen), one beyond the cap. */
static const double history_sizes[] = { 0.0, 0.004, 0.3 };

bool vectors_contact_friction(const char *folder)
{
    static const char *const flags[] = {
        "lever-radius", "arms of the tangential force are the radii; angular momentum is then left with delta (n x f_t)",
        "lever-contact", "arms are a_1 r/(a_1 + a_2) and a_2 r/(a_1 + a_2); angular momentum is kept",
        "history", "the tangential displacement is given; it is projected on the tangent plane first",
        "coulomb-cap", "the tangential force is cut to friction times k_n delta", "exchanged", "the vector before with the labels exchanged; the history changes sign", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "contact-friction",
                   "Spring, tangential spring with a given history s (displacement of the surface of 1 against that of 2), Coulomb cap; no time passes: "
                   "f_t = -k_t (s - (s.n) n), cut to mu k_n delta; F_1 = -k_n delta n + f_t, T_1 = l_1 n x f_t, T_2 = l_2 n x f_t",
                   flags, 1e-10, reason))
        return false;
    struct dice d = { 2 };
    for (int lever = 0; lever < 2; lever++) {
        const struct theory_contact law = { .normal_stiffness = 310.0, .tangential_stiffness = 87.0, .friction = 0.45, .lever_at_contact = lever };
        struct fields model = { 0 };
        add_number(&model, "normal_stiffness", law.normal_stiffness);
        add_number(&model, "tangential_stiffness", law.tangential_stiffness);
        add_number(&model, "friction", law.friction);
        add_word(&model, "lever", lever ? "contact" : "radius");
        file_group(&f, "contact", lever ? "arms meet in the contact" : "arms are the radii", &model);
        for (int r = 0; r < 6; r++)
            for (int g = 0; g < GAPS; g++) {
                struct theory_sphere s[2];
                double history[3];
                dice_pair(&d, ratios[r], gaps[g], s);
                dice_vector(&d, history_sizes[(r + g) % 3], history);
                for (int back = 0; back < (g == 1 ? 2 : 1); back++) {
                    struct theory_pair p;
                    struct vector v = { .comment = comment_of(gaps[g], back), .result = "acceptable" };
                    char words[80];
                    if (back)
                        exchange(s, history);
                    theory_contact_pair(&law, s, history, &p);
                    snprintf(words, sizeof words, "%s%s%s%s", lever ? "lever-contact" : "lever-radius", (r + g) % 3 ? " history" : "",
                             (r + g) % 3 == 2 ? " coulomb-cap" : "", back ? " exchanged" : "");
                    v.flags = words;
                    add_pair(&v.input, s);
                    add_list(&v.input, "history", history, 3);
                    add_pair_answer(&v.expected, &p);
                    scales(&v, &law, s);
                    file_vector(&f, &v);
                }
            }
    }
    return file_close(&f);
}

static const char *const law_word[] = { "plain", "critical", "soft", "shifted", "binary" }, *const load_word[] = { "spring", "damped", "absolute" };

/* Densities of the two spheres; masses follow. */
static const double density[2] = { 0.83, 1.1 };

static void law_vectors(struct vector_file *f, struct theory_contact law, bool held, struct dice *d)
{
    struct fields model = { 0 };
    const bool damped = law.normal_damping > 0.0 || law.restitution > 0.0;
    add_number(&model, "normal_stiffness", law.normal_stiffness);
    add_number(&model, "tangential_stiffness", law.tangential_stiffness);
    add_number(&model, "friction", law.friction);
    add_word(&model, "lever", law.lever_at_contact ? "contact" : "radius");
    add_word(&model, "law", law_word[law.law]);
    if (law.critical_load > 0.0)
        add_number(&model, "critical_load", law.critical_load);
    if (law.restitution > 0.0)
        add_number(&model, "restitution", law.restitution);
    else if (damped)
        add_number(&model, "normal_damping", law.normal_damping);
    if (damped) {
        add_number(&model, "tangential_damping", law.tangential_damping);
        add_word(&model, "tension", law.clip ? "clip" : "allow");
        add_word(&model, "cap", load_word[law.load]);
    }
    if (law.law == THEORY_BINARY)
        add_word(&model, "rough", law.rough[1] ? "both" : "only the first");
    if (held)
        add_word(&model, "second", "held");
    file_group(f, "contact", held ? "the second sphere is held: the reduced mass is the mass of the first" : "both spheres are free", &model);
    static const double at[] = { -0.2, -0.04, -0.015, -0.003, 0.02 };
    for (int k = 0; k < 10; k++) {
        const int r = (k * 7 + 3 * (int)law.law + (int)law.load) % 6;
        struct theory_sphere s[2];
        double history[3], mass[2];
        dice_pair(d, ratios[r], at[k % 5], s);
        dice_vector(d, history_sizes[k % 3] > 0.1 ? 0.1 : history_sizes[k % 3], history);
        for (int side = 0; side < 2; side++)
            mass[side] = law.mass[side] = 4.0 / 3.0 * 3.14159265358979323846 * density[side] * s[side].radius * s[side].radius * s[side].radius;
        if (held) {
            law.mass[1] = (double)INFINITY;
            memset(s[1].u, 0, sizeof s[1].u);
            memset(s[1].w, 0, sizeof s[1].w);
        }
        struct theory_pair p;
        struct vector v = { .comment = comment_of(at[k % 5], false), .result = "acceptable",
                            .flags = law.lever_at_contact ? "lever-contact" : "lever-radius" };
        theory_contact_laws_pair(&law, s, history, &p);
        add_pair(&v.input, s);
        add_list(&v.input, "history", history, 3);
        add_list(&v.input, "density", density, 2);
        add_list(&v.input, "mass", mass, 2);
        add_pair_answer(&v.expected, &p);
        scales(&v, &law, s);
        file_vector(f, &v);
    }
}

bool vectors_contact_laws(const char *folder)
{
    static const char *const flags[] = {
        "lever-radius", "arms of the tangential force, and of the slip velocity, are the radii",
        "lever-contact", "arms are a_1 r/(a_1 + a_2) and a_2 r/(a_1 + a_2)", NULL };
    struct vector_file f;
    if (!file_open(&f, folder, "contact-laws",
                   "Contacts with dashpots and friction laws; no time passes. N = k_n delta - zeta_n dr/dt, never below 0 with tension clip; "
                   "f_t = -(k_t s_t + zeta_t c_t) with c_t the tangential velocity of the surface of 1 against that of 2, cut to the cap; zeta = m gamma, m the "
                   "reduced mass, or from the restitution coefficient. Cap: mu N' (plain); mu N' from the critical load N_c up, else no friction (critical); "
                   "mu N' min(1, N'/N_c) (soft); mu (N' - N_c) from N_c up, else none (shifted); mu N' between two rough spheres, else none (binary). "
                   "N': k_n delta (spring), max(N, 0) (damped) or |N| (absolute)",
                   flags, 1e-10, reason))
        return false;
    struct dice d = { 3 };
    const struct theory_contact base = { .normal_stiffness = 310.0, .tangential_stiffness = 87.0, .friction = 0.45, .rough = { true, true } };
    for (int law = THEORY_PLAIN; law <= THEORY_BINARY; law++) {
        struct theory_contact c = base;
        c.law = (enum theory_law)law;
        c.critical_load = law == THEORY_PLAIN || law == THEORY_BINARY ? 0.0 : 9.0;
        law_vectors(&f, c, false, &d);
        c.normal_damping = 3.1;
        c.tangential_damping = 1.7;
        c.load = law == THEORY_SOFT || law == THEORY_PLAIN ? THEORY_LOAD_DAMPED : THEORY_LOAD_SPRING;
        c.clip = law == THEORY_CRITICAL || law == THEORY_SOFT;
        law_vectors(&f, c, false, &d);
    }
    struct theory_contact c = base;
    c.law = THEORY_BINARY;
    c.rough[1] = false;
    law_vectors(&f, c, false, &d);
    c = base;
    c.normal_damping = 40.0;        /* strong: N changes sign while the spheres part */
    c.tangential_damping = 11.0;
    for (int load = THEORY_LOAD_SPRING; load <= THEORY_LOAD_ABSOLUTE; load++)
        for (int clip = 0; clip < 2; clip++) {
            c.load = (enum theory_load)load;
            c.clip = clip;
            law_vectors(&f, c, false, &d);
        }
    c.lever_at_contact = true;
    law_vectors(&f, c, false, &d);
    c.lever_at_contact = false;
    law_vectors(&f, c, true, &d);
    for (int clip = 0; clip < 2; clip++) {
        c.normal_damping = 0.0;
        c.restitution = clip ? 0.5 : 0.35;
        c.clip = clip;
        c.load = THEORY_LOAD_DAMPED;
        law_vectors(&f, c, false, &d);
    }
    return file_close(&f);
}
