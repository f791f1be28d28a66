/*
 * Layer 6, tables of a run, first part: those that say what there is at each moment (observers.c)
 *
 *     temperature             <m c^2>, <I w^2>, spins of nearest neighbours       contacts      contact number, without rattlers, how many rattle
 *     viscosity               parts over eta rate, their sum, N1, N2, pressure    brownian_stress    -(kT/V) a/(shell + depth) n n
 *
 * and the motion of driven spheres, whom the tables leave out.
 */
#include "observers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void film_temperatures(const struct film *f, size_t frame, int species, double T[6])
{
    double of = 0.0;
    memset(T, 0, 6 * sizeof *T);
    for (size_t i = 0; i < f->count; i++) {
        double c[3], w[3];
        if ((species && f->row[i].species != species) || film_driven(f, i))
            continue;
        film_peculiar(f, frame, track_at(&f->track, frame, i), c, w);
        of += 1.0;
        for (int k = 0; k < 3; k++) {
            T[k] += film_mass(f, i) * c[k] * c[k];
            T[3 + k] += 0.4 * film_mass(f, i) * gsl_pow_2(film_radius(f, i)) * w[k] * w[k];
        }
    }
    for (int k = 0; k < 6 && of > 0.0; k++)
        T[k] /= of;
}

/* A driven sphere, followed through the faces, goes straight on from where it began, whatever pulls at it. */
void film_judge_driven(const struct film *f)
{
    struct worst w = WORST_NONE;
    for (size_t s = 0; s < f->frames; s++)
        for (size_t i = 0; i < f->count; i++) {
            const int kind = f->row[i].species - 1;
            const struct track_point *p = track_at(&f->track, s, i);
            double x[3];
            for (int k = 0; k < 3 && film_driven(f, i); k++)
                x[k] = f->row[i].x[k] + f->m.velocity[kind][k] * (double)s * f->every * f->dt;
            if (film_driven(f, i)) {
                worst_see_vector(&w, p->x, x, 3, film_radius(f, i), i);
                worst_see_vector(&w, p->u, f->m.velocity[kind], 3, film_radius(f, i), i);
                worst_see_vector(&w, p->w, f->m.spin[kind], 3, 1.0, i);
                for (int k = 0; k < 3 && isfinite(p->turn[0]); k++)
                    worst_see(&w, p->turn[k], f->m.spin[kind][k] * (double)s * f->every * f->dt, 1.0, i);
            }
        }
    if (w.error >= 0.0)
        check_error(f->run, MODEL, "driven spheres", w.measured, w.expected, w.error, f->run->gate_case->tolerance, "driven sphere %zu does not keep the motion that the "
                    "scene gives it: place, velocity, spin or angle is %s", w.at + 1, compare(&w));
}

static bool in_range(const struct film *f, const struct near_pair *p)
{
    const double mean = 0.5 * (film_radius(f, p->i) + film_radius(f, p->j));
    return p->gap <= (f->m.has_lubrication ? f->m.lubrication.outer_gap * mean : 0.0);
}

static double spins_of_neighbours(const struct film *f, size_t frame)
{
    double together = 0.0, alone = 0.0;
    for (size_t i = 0; i < f->count; i++) {
        const struct near_pair *nearest = NULL;
        double c[3], own[3], other[3];
        for (size_t k = 0; k < f->nears[frame]; k++) {
            const struct near_pair *p = &f->near[frame][k];
            if ((p->i == i || p->j == i) && !p->told && in_range(f, p) && (!nearest || p->gap < nearest->gap))
                nearest = p;
        }
        if (!nearest)
            continue;
        film_peculiar(f, frame, track_at(&f->track, frame, i), c, own);
        film_peculiar(f, frame, track_at(&f->track, frame, nearest->i == i ? nearest->j : nearest->i), c, other);
        together += dot(own, other);
        alone += dot(own, own);
    }
    return alone > 0 ? together / alone : 0.0;
}

void film_judge_temperature(const struct film *f)
{
    struct table t;
    char columns[400] = "step,T_x,T_y,T_z,T,W_x,W_y,W_z,W,spin_neighbours";
    struct worst w = WORST_NONE, spins = WORST_NONE;
    for (size_t k = 0; k < f->m.species; k++) {
        const char *name = json_string_value(scene_get(json_array_get(scene_get(f->scene, "species"), k), "name"));
        const size_t used = strlen(columns);
        snprintf(columns + used, sizeof columns - used, ",T_%s,W_%s", name, name);
    }
    if (!film_table(f, "temperature.csv", columns, &t))
        return;
    for (size_t r = 0; r < t.rows; r++) {
        const size_t frame = film_frame(f, &t, r);
        double T[6];
        if (frame == f->frames)
            continue;
        for (size_t k = 0; k <= f->m.species; k++) {        /* of all first, then of each */
            film_temperatures(f, frame, (int)k, T);
            for (size_t axis = 0; axis < 3 && k == 0; axis++) {
                worst_see(&w, table_at(&t, r, 1 + axis), T[axis], f->kT, r);
                worst_see(&w, table_at(&t, r, 5 + axis), T[3 + axis], f->kT, r);
            }
            for (size_t part = 0; part < 2; part++)
                worst_see(&w, table_at(&t, r, k ? 8 + 2 * k + part : 4 + 4 * part), (T[3 * part] + T[3 * part + 1] + T[3 * part + 2]) / 3.0, f->kT, r);
        }
        worst_see(&spins, table_at(&t, r, 9), spins_of_neighbours(f, frame), 1.0, r);
    }
    table_free(&t);
    film_judge(f, "temperature.csv", &w);
    film_judge(f, "temperature.csv: spins of nearest neighbours", &spins);
}

/* Contact number, that of the backbone, and how many rattle: taken away as long as some have fewer contacts than hold a place. */
static void count_contacts(const struct film *f, size_t frame, double out[4])
{
    const int needed = f->m.contact.friction > 0 ? 2 : 4;
    bool *gone = calloc(f->count, sizeof *gone);
    int *touches = calloc(f->count, sizeof *touches);
    size_t rattlers = 0, before;
    double touching = 0.0, all = 0.0, near = 0.0;
    do {
        before = rattlers;
        memset(touches, 0, f->count * sizeof *touches);
        touching = near = 0.0;
        for (size_t k = 0; k < f->nears[frame]; k++) {
            const struct near_pair *p = &f->near[frame][k];
            near += in_range(f, p) && !p->told;
            if (p->told || p->gap >= 0 || gone[p->i] || gone[p->j])
                continue;
            touches[p->i]++;
            touches[p->j]++;
            touching += 1.0;
        }
        all = before == 0 && all == 0.0 ? touching : all;
        for (size_t i = 0; i < f->count; i++)
            if (!gone[i] && touches[i] < needed) {
                gone[i] = true;
                rattlers++;
            }
    } while (rattlers > before);
    const double N = (double)f->count, left = N - (double)rattlers;
    const double answer[4] = { 2.0 * all / N, left > 0 ? 2.0 * touching / left : 0.0, (double)rattlers, 2.0 * near / N };
    memcpy(out, answer, sizeof answer);
    free(gone);
    free(touches);
}

void film_judge_contacts(const struct film *f)
{
    static const char *const names[4] = { "contact number", "backbone", "rattlers", "pairs in range" };
    struct table t;
    struct worst w[4] = { WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE };
    if (!film_table(f, "contacts.csv", "step,contacts,backbone,rattlers,near", &t))
        return;
    for (size_t r = 0; r < t.rows; r++) {
        double expected[4];
        const size_t frame = film_frame(f, &t, r);
        if (frame == f->frames)
            continue;
        count_contacts(f, frame, expected);
        for (size_t k = 0; k < 4; k++)
            worst_see(&w[k], table_at(&t, r, 1 + k), expected[k], 1.0, r);
    }
    table_free(&t);
    for (int k = 0; k < 4; k++) {
        char what[64];
        snprintf(what, sizeof what, "contacts.csv: %s", names[k]);
        film_judge(f, what, &w[k]);
    }
}

void film_judge_viscosity(const struct film *f)
{
    const char *part[FILM_PARTS];
    const size_t parts = (size_t)film_parts(f, part);
    struct table t, stress[FILM_PARTS];
    struct worst w = WORST_NONE, differences = WORST_NONE;
    const double unit = f->stages ? 1.0 : f->m.viscosity * film_rate(f), solvent = f->stages ? 0.0 : 1.0;     /* in stages stresses, not viscosities */
    char columns[400];
    snprintf(columns, sizeof columns, "step,%s,N1,N2,pressure", f->stages ? "shear" : "eta_r");
    for (size_t k = 0; k < parts; k++)
        snprintf(columns + strlen(columns), sizeof columns - strlen(columns), ",%s_%s", f->stages ? "shear" : "eta", part[k]);
    if (!film_table(f, "viscosity.csv", columns, &t))
        return;
    size_t opened = 0;
    for (; opened < parts; opened++) {
        film_stress_columns(f, part[opened], columns);
        if (!film_table(f, "stress.csv", columns, &stress[opened]))
            break;
    }
    for (size_t r = 0; opened == parts && r < t.rows && r < stress[0].rows; r++) {
        double diagonal[3] = { 0 }, shear = 0.0;
        for (size_t k = 0; k < parts; k++) {
            const double own = 0.5 * (table_at(&stress[k], r, 3) + table_at(&stress[k], r, 4));
            worst_see(&w, table_at(&t, r, 5 + k), own / unit, 1.0, r);
            shear += own;
            for (size_t c = 0; c < 3; c++)
                diagonal[c] += table_at(&stress[k], r, c);
        }
        worst_see(&w, table_at(&t, r, 1), solvent + shear / unit, 1.0, r);
        worst_see(&differences, table_at(&t, r, 2), diagonal[0] - diagonal[1], fabs(unit), r);
        worst_see(&differences, table_at(&t, r, 3), diagonal[1] - diagonal[2], fabs(unit), r);
        worst_see(&differences, table_at(&t, r, 4), -(diagonal[0] + diagonal[1] + diagonal[2]) / 3.0, fabs(unit), r);
    }
    for (size_t k = 0; k < opened; k++)
        table_free(&stress[k]);
    table_free(&t);
    film_judge(f, "viscosity.csv: parts and their sum", &w);
    film_judge(f, "viscosity.csv: N1, N2, pressure", &differences);
}

/* -(1/V) sum of m c (x) c over the free spheres, c without the flow of that moment. */
void film_judge_kinetic(const struct film *f)
{
    struct table t;
    struct worst worst = WORST_NONE;
    char columns[400], with_step[440];
    film_stress_columns(f, "kinetic", columns);
    snprintf(with_step, sizeof with_step, "step,%s", columns);
    if (!film_table(f, "stress.csv", with_step, &t))
        return;
    for (size_t r = 0; r < t.rows; r++) {
        static const int pair[5][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 0 } };
        const size_t frame = film_frame(f, &t, r);
        double S[5] = { 0 }, c[3], w[3];
        if (frame == f->frames)
            continue;
        for (size_t i = 0; i < f->count; i++) {
            film_peculiar(f, frame, track_at(&f->track, frame, i), c, w);
            for (int k = 0; k < 5 && !film_driven(f, i); k++)
                S[k] -= film_mass(f, i) * c[f->axis[pair[k][0]]] * c[f->axis[pair[k][1]]] / f->m.volume;
        }
        for (size_t k = 0; k < 5; k++)
            worst_see(&worst, table_at(&t, r, 1 + k), S[k], (double)f->count * f->kT / f->m.volume, r);
    }
    table_free(&t);
    film_judge(f, "stress.csv: kinetic", &worst);
}

double film_depth(const struct film *f) { return sqrt(M_PI * f->kT / (2.0 * f->m.contact.normal_stiffness)); }

void film_structure(const struct film *f, size_t frame, double shell, double depth, double S[6])
{
    memset(S, 0, 6 * sizeof *S);
    for (size_t k = 0; k < f->nears[frame]; k++)
        for (int side = 0; side < 2; side++) {
            const struct near_pair *p = &f->near[frame][k];
            const double a = film_radius(f, side ? p->j : p->i);
            for (int c = 0; !p->told && p->gap < shell * a && c < 6; c++)
                S[c] -= f->kT / f->m.volume * a / (shell * a + depth) * p->n[c < 3 ? c : c == 5] * p->n[c < 3 ? c : c == 3 ? 1 : 2];
        }
}

void film_judge_brownian(const struct film *f)
{
    static const char kinds[4][5] = { "wide", "thin", "zero", "raw" };
    struct table t;
    struct worst w = WORST_NONE;
    char columns[600] = "step";
    for (int k = 0; k < 4; k++) {
        const size_t used = strlen(columns);
        snprintf(columns + used, sizeof columns - used, ",%s_xx,%s_yy,%s_zz,%s_xy,%s_xz,%s_yz", kinds[k], kinds[k], kinds[k], kinds[k], kinds[k], kinds[k]);
    }
    if (!film_table(f, "brownian_stress.csv", columns, &t))
        return;
    for (size_t r = 0; r < t.rows; r++) {
        const size_t frame = film_frame(f, &t, r);
        double S[4][6] = { { 0 } };
        for (int kind = 0; kind < 4 && frame < f->frames; kind++)
            if (kind != 2)
                film_structure(f, frame, kind == 1 ? 0.02 : 0.05, kind == 3 ? 0.0 : film_depth(f), S[kind]);
        for (int c = 0; c < 6; c++)
            S[2][c] = S[1][c] + (S[1][c] - S[0][c]) * 0.02 / 0.03;      /* on a straight line to no shell */
        for (size_t k = 0; frame < f->frames && k < 24; k++)
            worst_see(&w, table_at(&t, r, 1 + k), S[k / 6][k % 6], (double)f->count * f->kT / f->m.volume, r);
    }
    table_free(&t);
    film_judge(f, "brownian_stress.csv", &w);
}
