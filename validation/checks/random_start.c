/*
 * Layer 3: a random start
 *
 * `start.random`: `count` spheres that do not overlap, of numbers that give each species its share of the volume (whole, by largest remainder), in a box of the
 * scene's shape whose edges are stretched alike until the volume fraction is exactly phi:
 *
 *     n_k = count (s_k/a_k^3) / sum_l (s_l/a_l^3) ,   V = sum n_k (4 pi/3) a_k^3 / phi
 *
 * Asked for late in a shear, when the cell leans. Spheres move and turn with the flow. The stresslet of the drag tells the volume, sigma = 5 eta phi E
 * (Einstein), without a neighbour. Species are mixed: with n spheres placed evenly |mean exp(2 pi i x/L)| exceeds 1/2 in exp(-n/4) of starts.
 */
#include "single.h"

#include <stdio.h>
#include <stdlib.h>

enum { MOST = 4 };

/* Places, motions and species of one start; NULL without an answer. */
static double *ask_start(struct check_run *run, const char *name, const json_t *scene, size_t count, struct track *t, struct table *stress)
{
    const int at[1] = { 1 };
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH] = "stress.csv has no row";
    json_t *asked = json_deep_copy(scene);
    scene_set(asked, "run", json_pack("{si}", "steps", at[0]));
    scene_set(asked, "output", json_pack("{s{si}s{si}}", "states", "every", 1, "stress", "every", 1));
    const struct question q = { .protocol = "run", .scene = asked };
    const bool answered = check_ask(run, name, &q, out);
    json_decref(asked);
    const int begin[1] = { 0 };
    if (!answered || !track_load(run, out, begin, 1, count, t))
        return NULL;
    struct table table;
    double *species = calloc(count, sizeof *species);
    path_join(path, out, "trajectory.csv");
    bool good = species && table_read(path, "step,id,species", &table, why);
    for (size_t r = 0; good && r < table.rows; r++)
        if (table_at(&table, r, 0) == 0.0)                  /* ids were looked at by track_load */
            species[(size_t)table_at(&table, r, 1) - 1] = table_at(&table, r, 2);
    if (good)
        table_free(&table);
    path_join(path, out, "stress.csv");
    if (good && table_read(path, "step,drag_xy,drag_yx", stress, why) && stress->rows > 0)
        return species;
    check_garbage(run, why);
    free(species);
    track_free(t);
    return NULL;
}

/* Whole numbers of spheres by largest remainder; the solid volume. */
static double share_out(const struct model *m, const json_t *share, size_t count, double number[MOST])
{
    double sum = 0.0, given = 0.0, volume = 0.0, wanted[MOST];
    const size_t kinds = json_array_size(share);
    for (size_t k = 0; k < kinds; k++)
        sum += wanted[k] = json_number_value(json_array_get(share, k)) / gsl_pow_3(m->radius[k]);
    for (size_t k = 0; k < kinds; k++) {
        wanted[k] *= (double)count / sum;
        given += number[k] = floor(wanted[k]);
    }
    for (; given < (double)count; given += 1.0) {
        size_t most = 0;
        for (size_t k = 1; k < kinds; k++)
            if (wanted[k] - number[k] > wanted[most] - number[most])
                most = k;
        number[most] += 1.0;
    }
    for (size_t k = 0; k < kinds; k++)
        volume += number[k] * 4.0 / 3.0 * M_PI * gsl_pow_3(m->radius[k]);
    return volume;
}

/* Least gap over the smaller radius, over all images. cell: columns are edges, which lean in x only: x along y. */
static double least_gap(const struct model *m, const struct track *t, const double *species, const double edge[3], double lean)
{
    double least = INFINITY;
    for (size_t j = 0; j < t->count; j++)
        for (size_t i = 0; i < j; i++) {
            const double *a = track_at(t, 0, i)->x, *b = track_at(t, 0, j)->x, ai = m->radius[(int)species[i] - 1], aj = m->radius[(int)species[j] - 1];
            for (int y = -1; y <= 1; y++)
                for (int z = -1; z <= 1; z++) {
                    const double rows = round((b[1] - a[1]) / edge[1]) + y, dy = b[1] - a[1] - rows * edge[1], across = b[0] - a[0] - rows * lean;
                    const double dz = b[2] - a[2] - (round((b[2] - a[2]) / edge[2]) + z) * edge[2], dx = across - round(across / edge[0]) * edge[0];
                    least = fmin(least, (sqrt(dx * dx + dy * dy + dz * dz) - ai - aj) / fmin(ai, aj));
                }
        }
    return least;
}

/* The largest |mean exp(2 pi i s)| over species and edges, s the place within the cell in units of that edge. */
static double least_mixed(const struct track *t, const double *species, size_t kinds, const double edge[3], double lean)
{
    double worst = 0.0;
    for (size_t k = 0; k < kinds; k++)
        for (int c = 0; c < 3; c++) {
            double sine = 0.0, cosine = 0.0, n = 0.0;
            for (size_t i = 0; i < t->count; i++) {
                const double *x = track_at(t, 0, i)->x, s = (c == 0 ? x[0] - x[1] / edge[1] * lean : x[c]) / edge[c];
                if ((size_t)species[i] != k + 1)
                    continue;
                sine += sin(2.0 * M_PI * s);
                cosine += cos(2.0 * M_PI * s);
                n += 1.0;
            }
            worst = n > 0.0 ? fmax(worst, hypot(sine, cosine) / n) : NAN;
        }
    return worst;
}

void check_random_start(struct check_run *run)
{
    json_t *scene = json_deep_copy(run->gate_case->scene), *other;
    const json_t *share = scene_get(scene, "start.random.volume_shares");
    const size_t count = (size_t)scene_number(scene, "start.random.count", 0), kinds = json_array_size(share);
    const double phi = scene_number(scene, "start.random.phi", NAN), time = scene_number(scene, "start.time", 0.0);
    struct model m;
    struct track t, again;
    struct table stress, unused;
    scene_set(scene, "seed", json_integer(run->seed));
    if (!model_read(run, scene, &m) || kinds > MOST)
        return;
    double number[MOST], found[MOST] = { 0.0 }, edge[3];
    const double solid = share_out(&m, share, count, number), stretch = cbrt(solid / phi / (m.cell[0][0] * m.cell[1][1] * m.cell[2][2])), rate = m.gradient[0][1];
    for (int c = 0; c < 3; c++)
        edge[c] = stretch * m.cell[c][c];
    const double lean = rate * time * edge[1];
    double *species = ask_start(run, "start", scene, count, &t, &stress);
    bool known = species != NULL;
    for (size_t i = 0; known && i < count; i++) {
        known = species[i] >= 1.0 && species[i] <= (double)kinds;
        if (known)
            found[(int)species[i] - 1] += 1.0;
        else
            check_garbage(run, "trajectory.csv: a species is none of the scene's");
    }
    if (known) {
        struct worst numbers = WORST_NONE, flow = WORST_NONE, spin = WORST_NONE;
        for (size_t k = 0; k < kinds; k++)
            worst_see(&numbers, found[k], number[k], 1.0, k);
        check_error(run, INVARIANT, "numbers of the species", numbers.measured, numbers.expected, numbers.error, 0.0,
                    "there are %.0f spheres of species %zu where its share of the volume makes %.0f", numbers.measured, numbers.at + 1, numbers.expected);
        const double said = 0.5 * (table_at(&stress, 0, 1) + table_at(&stress, 0, 2)) / (2.5 * m.viscosity * rate);
        check_error(run, INVARIANT, "volume fraction", said, phi, fabs(said / phi - 1.0), run->gate_case->tolerance,
                    "by the stresslet of its drag the start has a volume fraction of %.9g where %.9g is asked for", said, phi);
        const double gap = least_gap(&m, &t, species, edge, lean);
        check_error(run, INVARIANT, "no overlap", gap, 0.0, fmax(0.0, -gap), 1e-3,          /* what a relaxation may leave; a tenth of what contacts bear */
                    "in the cell of that moment two spheres of the start overlap by %.3g of the smaller radius", -gap);
        const double mixed = least_mixed(&t, species, kinds, edge, lean);
        check_error(run, INVARIANT, "species mixed", mixed, 0.0, mixed, 0.5, "a species is not spread over the cell: |mean exp(2 pi i x/L)| is %.3g", mixed);
        for (size_t i = 0; i < count; i++) {
            const struct track_point *p = track_at(&t, 0, i);
            const double u[3] = { rate * p->x[1], 0.0, 0.0 }, w[3] = { 0.0, 0.0, -0.5 * rate };
            worst_see_vector(&flow, p->u, u, 3, fabs(rate) * edge[1], i);
            worst_see_vector(&spin, p->w, w, 3, fabs(rate), i);
        }
        check_error(run, INVARIANT, "velocities of the flow", flow.measured, flow.expected, flow.error, run->gate_case->tolerance,
                    "sphere %zu of the start moves at %s, the flow at its place", flow.at + 1, compare(&flow));
        check_error(run, INVARIANT, "spins of the flow", spin.measured, spin.expected, spin.error, run->gate_case->tolerance,
                    "sphere %zu of the start turns at %s, half the vorticity", spin.at + 1, compare(&spin));
    }
    for (int k = 0; known && k < 2; k++) {                  /* the same seed again; another realisation */
        other = json_deep_copy(scene);
        if (k == 1)
            scene_set(other, "realisation", json_integer(5));
        double *kind = ask_start(run, k ? "realisation" : "again", other, count, &again, &unused), farthest = 0.0;
        json_decref(other);
        if (!kind)
            continue;
        for (size_t i = 0; i < count; i++)
            for (int c = 0; c < 3; c++)
                farthest = fmax(farthest, fabs(track_at(&again, 0, i)->x[c] - track_at(&t, 0, i)->x[c]));
        if (k == 0)
            check_error(run, INVARIANT, "the same seed", farthest, 0.0, farthest / edge[0], run->gate_case->tolerance, "the same scene starts otherwise when asked again: a sphere is %.3g away", farthest);
        else
            check_error(run, INVARIANT, "another realisation", farthest, edge[0], farthest > 0.1 * edge[0] ? 0.0 : 1.0, 0.5, "another realisation starts as the first did: no sphere is farther away than %.3g", farthest);
        free(kind);
        track_free(&again);
        table_free(&unused);
    }
    if (species) {
        free(species);
        track_free(&t);
        table_free(&stress);
    }
    json_decref(scene);
}
