/*
 * Layer 6: what a candidate says it has measured, against what its own trajectory says
 *
 * One run of a sheared crowd writes places, velocities, spins and stresses, and the tables of docs/formats.md, all at the same steps. From the
 * former the gate computes the latter anew, images by brute force, by the definitions in that document: no physics enters, so the numbers
 * must agree to rounding. A table that the candidate does not write is skipped. Last, the run without tables must take the same path:
 *
 *     displacement, velocity_correlation    <dx^2>, <dtheta^2> without the affine part, <c c>, <w w>, by species against lag
 *     pair_distribution                     pairs of every image counted, over those of an ideal gas
 *     contacts, temperature                 contact numbers with and without rattlers; <m c^2>, <I w^2>, spins of nearest neighbours
 *     viscosity, brownian_stress            parts over eta rate, N1, N2, pressure; -(kT/V) a/(shell + depth) n n
 *
 * What gathers over the run is in observers_run.c.
 */
#include "observers.h"
#include "packing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double film_radius(const struct film *f, size_t i) { return f->m.radius[f->row[i].species - 1]; }
static double mass(const struct film *f, size_t i) { return 4.0 / 3.0 * M_PI * f->m.density[f->row[i].species - 1] * gsl_pow_3(film_radius(f, i)); }

/* Velocity and spin without those of the flow. */
void film_peculiar(const struct film *f, const struct track_point *p, double c[3], double w[3])
{
    double G[3][3];
    memcpy(G, f->m.gradient, sizeof G);
    apply(G, p->x, c);
    for (int k = 0; k < 3; k++) {
        c[k] = p->u[k] - c[k];
        w[k] = p->w[k] - 0.5 * (G[(k + 2) % 3][(k + 1) % 3] - G[(k + 1) % 3][(k + 2) % 3]);
    }
}

static void find_axes(struct film *f)
{
    double fastest = 0.0;
    for (int c = 0; c < 3; c++)
        f->axis[c] = c;
    for (int c = 0; c < 9; c++)
        if (fabs(f->m.gradient[c / 3][c % 3]) > fastest) {
            fastest = fabs(f->m.gradient[c / 3][c % 3]);
            f->axis[0] = c / 3, f->axis[1] = c % 3, f->axis[2] = 3 - c / 3 - c % 3;
        }
}

double film_rate(const struct film *f) { return f->m.gradient[f->axis[0]][f->axis[1]]; }

void film_stress_columns(const struct film *f, const char *origin, char columns[400])
{
    static const int pair[5][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 0 } };
    *columns = 0;
    for (int k = 0; k < 5; k++) {
        const size_t used = strlen(columns);
        snprintf(columns + used, 400 - used, "%s%s_%c%c", k ? "," : "", origin, "xyz"[f->axis[pair[k][0]]], "xyz"[f->axis[pair[k][1]]]);
    }
}

static bool is_driven(const struct film *f, size_t i) { return f->m.driven[f->row[i].species - 1]; }

/* All pairs of a frame, whose cell is that of its time; two driven spheres are no pair. */
static bool find_pairs(struct film *f, size_t frame)
{
    struct model now;
    json_t *scene = json_deep_copy(f->scene);
    double inverse[3][3];
    size_t room = 0;
    scene_set(scene, "start.time", json_real(f->begin + (double)frame * f->every * f->dt));
    bool good = model_read(f->run, scene, &now);
    json_decref(scene);
    for (int v = 0; v < 3; v++) {
        cross(now.cell[(v + 1) % 3], now.cell[(v + 2) % 3], inverse[v]);
        for (int c = 0; c < 3; c++)
            inverse[v][c] /= now.volume;
    }
    for (size_t j = 1; good && j < f->count; j++)
        for (size_t i = 0; i < j; i++) {
            const double *a = track_at(&f->track, frame, i)->x, *b = track_at(&f->track, frame, j)->x, d[3] = { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
            double share[3];
            apply(inverse, d, share);
            for (int image = 0; image < 125; image++) {
                const int step[3] = { image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2 };
                struct near_pair p = { .i = i, .j = j };
                for (int v = 0; v < 3; v++)
                    for (int c = 0; c < 3; c++)
                        p.n[c] += (share[v] - round(share[v]) + step[v]) * now.cell[v][c];
                p.distance = norm(p.n);
                p.gap = p.distance - film_radius(f, i) - film_radius(f, j);
                if (p.distance >= f->range || (is_driven(f, i) && is_driven(f, j)))
                    continue;
                for (int c = 0; c < 3; c++)
                    p.n[c] /= p.distance;
                if (f->nears[frame] == room)
                    f->near[frame] = realloc(f->near[frame], (room = 2 * room + 64) * sizeof p);
                f->near[frame][f->nears[frame]++] = p;
            }
        }
    return good;
}

/* False where the case does not ask for the table, where the candidate has not written it (skipped) or it cannot be read (recorded). */
bool film_table(const struct film *f, const char *file, const char *columns, struct table *t)
{
    char path[PATH_LENGTH], why[WHY_LENGTH], asked[64];
    snprintf(asked, sizeof asked, "tables.%.*s", (int)strcspn(file, "."), file);
    if (strcmp(file, "stress.csv") != 0 && !scene_get(f->run->gate_case->parameters, strcmp(file, "pair_plane.csv") ? asked : "tables.pair_distribution.plane"))
        return false;
    path_join(path, f->out, file);
    FILE *there = fopen(path, "r");
    if (!there) {
        check_skip(f->run, file, "the candidate writes no %s", file);
        return false;
    }
    fclose(there);
    if (table_read(path, columns, t, why) && t->rows > 0)
        return true;
    check_garbage(f->run, why);
    return false;
}

/* The frame of a row whose first column is the step. */
size_t film_frame(const struct film *f, const struct table *t, size_t row)
{
    const double frame = table_at(t, row, 0) / f->every;
    return frame >= 0 && frame < (double)f->frames && frame == floor(frame) ? (size_t)frame : f->frames;
}

void film_judge(const struct film *f, const char *what, const struct worst *w)
{
    check_error(f->run, INVARIANT, what, w->measured, w->expected, w->error, f->run->gate_case->tolerance,
                "%s: row %zu says %s; its own trajectory says that", what, w->at + 1, compare(w));
}

/* --- at each moment --- */

void film_temperatures(const struct film *f, size_t frame, int species, double T[6])
{
    double of = 0.0;
    memset(T, 0, 6 * sizeof *T);
    for (size_t i = 0; i < f->count; i++) {
        double c[3], w[3];
        if ((species && f->row[i].species != species) || is_driven(f, i))
            continue;
        film_peculiar(f, track_at(&f->track, frame, i), c, w);
        of += 1.0;
        for (int k = 0; k < 3; k++) {
            T[k] += mass(f, i) * c[k] * c[k];
            T[3 + k] += 0.4 * mass(f, i) * gsl_pow_2(film_radius(f, i)) * w[k] * w[k];
        }
    }
    for (int k = 0; k < 6 && of > 0.0; k++)
        T[k] /= of;
}

/* A driven sphere, followed through the faces, goes straight on from where it began, whatever pulls at it. */
static void judge_driven(const struct film *f)
{
    struct worst w = WORST_NONE;
    for (size_t s = 0; s < f->frames; s++)
        for (size_t i = 0; i < f->count; i++) {
            const int kind = f->row[i].species - 1;
            const struct track_point *p = track_at(&f->track, s, i);
            double x[3];
            for (int k = 0; k < 3 && is_driven(f, i); k++)
                x[k] = f->row[i].x[k] + f->m.velocity[kind][k] * (double)s * f->every * f->dt;
            if (is_driven(f, i)) {
                worst_see_vector(&w, p->x, x, 3, film_radius(f, i), i);
                worst_see_vector(&w, p->u, f->m.velocity[kind], 3, film_radius(f, i), i);
                worst_see_vector(&w, p->w, f->m.spin[kind], 3, 1.0, i);
            }
        }
    if (w.error >= 0.0)
        check_error(f->run, MODEL, "driven spheres", w.measured, w.expected, w.error, f->run->gate_case->tolerance, "driven sphere %zu does not keep the motion that the "
                    "scene gives it: place, velocity or spin is %s", w.at + 1, compare(&w));
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
            if ((p->i == i || p->j == i) && in_range(f, p) && (!nearest || p->gap < nearest->gap))
                nearest = p;
        }
        if (!nearest)
            continue;
        film_peculiar(f, track_at(&f->track, frame, i), c, own);
        film_peculiar(f, track_at(&f->track, frame, nearest->i == i ? nearest->j : nearest->i), c, other);
        together += dot(own, other);
        alone += dot(own, own);
    }
    return alone > 0 ? together / alone : 0.0;
}

static void judge_temperature(const struct film *f)
{
    struct table t;
    char columns[200];
    struct worst w = WORST_NONE, spins = WORST_NONE;
    const char *one = json_string_value(scene_get(json_array_get(scene_get(f->scene, "species"), 0), "name"));
    const char *two = json_string_value(scene_get(json_array_get(scene_get(f->scene, "species"), 1), "name"));
    snprintf(columns, sizeof columns, "step,T_x,T_y,T_z,T,W_x,W_y,W_z,W,T_%s,W_%s,T_%s,W_%s,spin_neighbours", one, one, two, two);
    if (!film_table(f, "temperature.csv", columns, &t))
        return;
    for (size_t r = 0; r < t.rows; r++) {
        const size_t frame = film_frame(f, &t, r);
        double T[3][6];
        if (frame == f->frames)
            continue;
        for (int k = 0; k < 3; k++)
            film_temperatures(f, frame, k, T[k]);
        for (size_t k = 0; k < 3; k++) {
            worst_see(&w, table_at(&t, r, 1 + k), T[0][k], f->kT, r);
            worst_see(&w, table_at(&t, r, 5 + k), T[0][3 + k], f->kT, r);
            for (size_t part = 0; part < 2; part++)
                worst_see(&w, table_at(&t, r, k ? 7 + 2 * k + part : 4 + 4 * part), (T[k][3 * part] + T[k][3 * part + 1] + T[k][3 * part + 2]) / 3.0, f->kT, r);
        }
        worst_see(&spins, table_at(&t, r, 13), spins_of_neighbours(f, frame), 1.0, r);
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
            near += in_range(f, p);
            if (p->gap >= 0 || gone[p->i] || gone[p->j])
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

static void judge_contacts(const struct film *f)
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

static void judge_viscosity(const struct film *f)
{
    static const char *const parts[4] = { "contact_normal", "contact_tangential", "lubrication", "drag" };
    struct table t, stress[4];
    struct worst w = WORST_NONE, differences = WORST_NONE;
    const double unit = f->m.viscosity * film_rate(f);
    if (!film_table(f, "viscosity.csv", "step,eta_contact_normal,eta_contact_tangential,eta_lubrication,eta_drag,eta_r,N1,N2,pressure", &t))
        return;
    int opened = 0;
    for (; opened < 4; opened++) {
        char columns[400];
        film_stress_columns(f, parts[opened], columns);
        if (!film_table(f, "stress.csv", columns, &stress[opened]))
            break;
    }
    for (size_t r = 0; opened == 4 && r < t.rows && r < stress[0].rows; r++) {
        double diagonal[3] = { 0 }, shear = 0.0;
        for (size_t k = 0; k < 4; k++) {
            const double own = 0.5 * (table_at(&stress[k], r, 3) + table_at(&stress[k], r, 4));
            worst_see(&w, table_at(&t, r, 1 + k), own / unit, 1.0, r);
            shear += own;
            for (size_t c = 0; c < 3; c++)
                diagonal[c] += table_at(&stress[k], r, c);
        }
        worst_see(&w, table_at(&t, r, 5), 1.0 + shear / unit, 1.0, r);
        worst_see(&differences, table_at(&t, r, 6), diagonal[0] - diagonal[1], fabs(unit), r);
        worst_see(&differences, table_at(&t, r, 7), diagonal[1] - diagonal[2], fabs(unit), r);
        worst_see(&differences, table_at(&t, r, 8), -(diagonal[0] + diagonal[1] + diagonal[2]) / 3.0, fabs(unit), r);
    }
    for (int k = 0; k < opened; k++)
        table_free(&stress[k]);
    table_free(&t);
    film_judge(f, "viscosity.csv: parts and their sum", &w);
    film_judge(f, "viscosity.csv: N1, N2, pressure", &differences);
}

double film_depth(const struct film *f) { return sqrt(M_PI * f->kT / (2.0 * f->m.contact.normal_stiffness)); }

void film_structure(const struct film *f, size_t frame, double shell, double depth, double S[6])
{
    memset(S, 0, 6 * sizeof *S);
    for (size_t k = 0; k < f->nears[frame]; k++)
        for (int side = 0; side < 2; side++) {
            const struct near_pair *p = &f->near[frame][k];
            const double a = film_radius(f, side ? p->j : p->i);
            for (int c = 0; p->gap < shell * a && c < 6; c++)
                S[c] -= f->kT / f->m.volume * a / (shell * a + depth) * p->n[c < 3 ? c : c == 5] * p->n[c < 3 ? c : c == 3 ? 1 : 2];
        }
}

static void judge_brownian(const struct film *f)
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

/* --- the run --- */

static bool record(struct film *f, const char *name, bool with_tables, struct track *track)
{
    json_t *scene = json_deep_copy(f->scene);
    int at[128];
    for (size_t k = 0; k < f->frames; k++)
        at[k] = (int)k * f->every;
    if (with_tables) {
        json_t *tables = json_deep_copy(json_object_get(f->run->gate_case->parameters, "tables")), *one;
        const char *key;
        json_object_foreach(tables, key, one)
        {
            json_object_set_new(one, "every", json_integer(f->every));
            json_t *output = scene_get(scene, "output");
            json_object_set(output, key, one);
        }
        json_decref(tables);
    }
    const bool good = track_ask(f->run, name, scene, f->row, f->count, at, f->frames, track);
    char folder[PATH_LENGTH];
    path_join(folder, f->run->work, name);
    if (with_tables)
        path_join(f->out, folder, "out");
    json_decref(scene);
    return good;
}

static void judge_unwatched(struct film *f)
{
    struct track plain;
    struct worst w = WORST_NONE;
    if (!record(f, "unwatched", false, &plain))
        return;
    for (size_t s = 0; s < f->frames; s++)
        for (size_t i = 0; i < f->count; i++)
            worst_see_vector(&w, track_at(&f->track, s, i)->x, track_at(&plain, s, i)->x, 9, 1.0, i);      /* x, u, w lie one after the other */
    track_free(&plain);
    check_error(f->run, INVARIANT, "the path without tables", w.measured, w.expected, w.error, 0.0, "sphere %zu moves otherwise when the tables are written: "
                "%.17g instead of %.17g", w.at + 1, w.measured, w.expected);
}

void check_observers(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    struct film f = { .run = run, .scene = json_deep_copy(run->gate_case->scene), .frames = (size_t)scene_number(parameters, "frames", 0),
                      .every = (int)scene_number(parameters, "every", 1), .range = scene_number(parameters, "range", NAN) };
    double counts[2];
    size_t two;
    char why[WHY_LENGTH] = "the gate is out of memory";
    parameter_list(parameters, "spheres", counts, &two, 2);
    if (!model_read(run, f.scene, &f.m) || f.frames > 128)
        return;
    const struct packing_species kind[2] = { { f.m.radius[0], (int)counts[0] }, { f.m.radius[1], (int)counts[1] } };
    const double edge = packing_edge(kind, 2, scene_number(parameters, "phi", NAN));
    f.count = (size_t)(kind[0].count + kind[1].count);
    f.dt = scene_number(f.scene, "dynamics.verlet.dt", NAN);
    f.kT = scene_number(f.scene, "fluid.kT", NAN);
    f.begin = scene_number(f.scene, "start.time", 0.0);
    f.row = calloc(f.count, sizeof *f.row);
    f.near = calloc(f.frames, sizeof *f.near);
    f.nears = calloc(f.frames, sizeof *f.nears);
    scene_set(f.scene, "box.lengths", json_pack("[fff]", edge, edge, edge));
    scene_set(f.scene, "seed", json_integer(run->seed));
    scene_set(f.scene, "output.stress", json_pack("{si}", "every", f.every));
    bool good = f.row && f.near && f.nears && model_read(run, f.scene, &f.m) && packing_make(kind, 2, edge, 0.0, run->seed, f.row, why);
    if (!good)
        check_garbage(run, why);
    find_axes(&f);
    for (size_t i = 0; good && i < f.count; i++) {      /* with the flow */
        struct track_point at = { .u = { 0 } };
        double c[3], w[3];
        memcpy(at.x, f.row[i].x, sizeof at.x);
        film_peculiar(&f, &at, c, w);
        for (int k = 0; k < 3; k++) {
            f.row[i].u[k] = -c[k];
            f.row[i].w[k] = -w[k];
        }
    }
    good = good && record(&f, "watched", true, &f.track);
    for (size_t s = 0; good && s < f.frames; s++)
        good = find_pairs(&f, s);
    if (good) {
        judge_driven(&f);
        judge_temperature(&f);
        judge_contacts(&f);
        judge_viscosity(&f);
        judge_brownian(&f);
        film_judge_lags(&f);
        film_judge_distribution(&f);
        film_judge_plane(&f);
        film_judge_stress_table(&f);
        film_judge_green_kubo(&f);
        film_judge_averages(&f);
        judge_unwatched(&f);
        track_free(&f.track);
    }
    for (size_t s = 0; f.near && s < f.frames; s++)
        free(f.near[s]);
    free(f.near);
    free(f.nears);
    free(f.row);
    json_decref(f.scene);
}
