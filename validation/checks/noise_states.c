/* Layer 2, shared parts: building the frozen configurations and measuring their resistance (noise.h). */
#include "noise.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Into the cell [0, 1)^3 of fractions; the cell of layer 2 is rectangular at time 0. */
static void wrap(const struct model *m, double x[3])
{
    for (int k = 0; k < 3; k++)
        x[k] -= m->cell[k][k] * floor(x[k] / m->cell[k][k]);
}

static bool suite_mistake(struct check_run *run, const char *what)
{
    check_error(run, INVARIANT, "configuration", NAN, NAN, NAN, NAN, "%s; this is a mistake in the suite", what);
    return false;
}

static void add_sphere(const struct model *m, struct frozen *f, double radius, const double x[3])
{
    size_t k = 0;
    while (k < f->sizes && f->size[k] != radius)
        k++;
    f->size[k] = radius;
    f->sizes += k == f->sizes;
    f->species[f->count] = (int)k + 1;
    f->radius[f->count] = radius;
    memcpy(f->x[f->count], x, 3 * sizeof *x);
    wrap(m, f->x[f->count]);
    f->count++;
}

bool frozen_pairs(struct check_run *run, const struct model *m, struct frozen *f)
{
    const json_t *p = run->gate_case->parameters, *list = json_object_get(p, "pairs");
    const double base = scene_number(p, "radius", NAN);
    size_t slots[3], at;
    for (size_t k = 0; k < 3; k++)
        slots[k] = (size_t)json_integer_value(json_array_get(json_object_get(p, "slots"), k));
    if (json_array_size(list) > slots[0] * slots[1] * slots[2] || 2 * json_array_size(list) > 64)
        return suite_mistake(run, "more pairs than slots");
    gsl_rng *random = pair_random(run);
    json_t *item;
    *f = (struct frozen){ 0 };
    json_array_foreach(list, at, item)
    {
        const double ratio = json_number_value(json_array_get(item, 0)), xi = json_number_value(json_array_get(item, 1));
        /* slots are centred on the corners of the grid: the first of each row straddle a face of the cell */
        const size_t slot[3] = { at % slots[0], at / slots[0] % slots[1], at / (slots[0] * slots[1]) };
        double n[3], x[2][3];
        random_direction(random, n);
        for (int k = 0; k < 3; k++) {
            const double middle = (double)slot[k] * m->cell[k][k] / (double)slots[k];
            const double half = 0.5 * base * (1.0 + ratio) * (1.0 + 0.5 * xi);
            x[0][k] = middle - half * n[k];
            x[1][k] = middle + half * n[k];
        }
        f->pair[f->pairs].i = f->count;
        f->pair[f->pairs].j = f->count + 1;
        f->pair[f->pairs++].xi = xi;
        add_sphere(m, f, base, x[0]);
        add_sphere(m, f, base * ratio, x[1]);
    }
    gsl_rng_free(random);
    return true;
}

/* Where sphere k may sit: no gap to an earlier one below `least`; counts those within the outer gap. */
static int neighbours_at(const struct model *m, const double *radius, double x[][3], size_t k, double least)
{
    int count = 0;
    for (size_t j = 0; j < k; j++) {
        const double d[3] = { x[k][0] - x[j][0], x[k][1] - x[j][1], x[k][2] - x[j][2] };
        const double xi = 2.0 * (norm(d) / (radius[j] + radius[k]) - 1.0);
        if (xi < least)
            return -1;
        count += xi <= m->lubrication.outer_gap;
    }
    return count;
}

/*
 * Each sphere is put at a listed gap from a random earlier one, in the best of many random directions: the one that gives the
 * most further neighbours, so that the cluster has loops and not only branches.
 */
bool frozen_cluster(struct check_run *run, const struct model *m, struct frozen *f)
{
    enum { TRIES = 2000, SIZES = 12 };    /* sizes: many codes have a table of species */
    const json_t *p = run->gate_case->parameters;
    const double smallest = scene_number(p, "smallest_radius", NAN), largest = scene_number(p, "largest_radius", NAN);
    const size_t count = (size_t)scene_number(p, "spheres", 0);
    double gap[16], radius[64], x[64][3], best[3] = { 0 };
    size_t gaps;
    parameter_list(p, "gaps", gap, &gaps, 16);
    if (count < 2 || count > 64 || gaps == 0 || !(smallest > 0))
        return suite_mistake(run, "the cluster is not described");
    double least = 0.0;
    for (size_t k = 0; k < gaps; k++)
        least = fmin(least, gap[k]);
    gsl_rng *random = pair_random(run);
    memset(x, 0, sizeof x);
    radius[0] = largest;
    for (size_t k = 1; k < count; k++) {
        int most = -1;
        radius[k] = smallest + (largest - smallest) * (double)gsl_rng_uniform_int(random, SIZES) / SIZES;
        for (int t = 0; t < TRIES || most < 0; t++) {
            const size_t j = gsl_rng_uniform_int(random, k);
            double n[3];
            random_direction(random, n);
            for (int c = 0; c < 3; c++)
                x[k][c] = x[j][c] + (radius[j] + radius[k]) * (1.0 + 0.5 * gap[k % gaps]) * n[c];
            const int found = neighbours_at(m, radius, x, k, least * (1.0 + 1e-9));
            if (found > most) {
                most = found;
                memcpy(best, x[k], sizeof best);
            }
        }
        memcpy(x[k], best, sizeof best);
    }
    gsl_rng_free(random);
    *f = (struct frozen){ 0 };
    for (size_t k = 0; k < count; k++) {
        for (size_t j = 0; j < k; j++) {
            const double d[3] = { x[k][0] - x[j][0], x[k][1] - x[j][1], x[k][2] - x[j][2] };
            const double xi = 2.0 * (norm(d) / (radius[j] + radius[k]) - 1.0);
            if (xi > m->lubrication.outer_gap || f->pairs == sizeof f->pair / sizeof *f->pair)
                continue;
            f->pair[f->pairs].i = j;
            f->pair[f->pairs].j = k;
            f->pair[f->pairs++].xi = xi;
        }
        add_sphere(m, f, radius[k], x[k]);
    }
    return true;
}

json_t *frozen_scene(struct check_run *run, const struct frozen *f)
{
    json_t *scene = json_deep_copy(run->gate_case->scene), *species = json_array();
    const double density = json_number_value(json_object_get(json_array_get(scene_get(scene, "species"), 0), "density"));
    for (size_t k = 0; k < f->sizes; k++) {
        char name[32];
        snprintf(name, sizeof name, "size%zu", k + 1);
        json_array_append_new(species, json_pack("{ss sf sf}", "name", name, "radius", f->size[k], "density", density));
    }
    scene_set(scene, "species", species);
    scene_set(scene, "seed", json_integer(run->seed));
    return scene;
}

bool measure_resistance(struct check_run *run, const char *name, json_t *scene, const struct frozen *f, size_t forces, const char *const force[],
                        double *R[])
{
    const size_t size = 6 * f->count, states = size + 1;
    struct state_row *row = calloc(states * f->count, sizeof *row);
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH], wanted[256] = "";
    if (!row)
        return suite_mistake(run, "out of memory");
    for (size_t s = 0; s < states; s++)
        for (size_t i = 0; i < f->count; i++) {
            struct state_row *r = &row[s * f->count + i];
            *r = (struct state_row){ .state = (int)s, .id = (int)i + 1, .species = f->species[i] };
            memcpy(r->x, f->x[i], sizeof r->x);
            if (s > 0 && (s - 1) / 6 == i)     /* state s: unit velocity or spin s - 1, in the order of the draws */
                *((s - 1) % 6 < 3 ? &r->u[(s - 1) % 3] : &r->w[(s - 1) % 3]) = 1.0;
        }
    for (size_t k = 0; k < forces; k++)
        snprintf(wanted + strlen(wanted), sizeof wanted - strlen(wanted), "%s%s", k ? "," : "", force[k]);
    const struct question q = { .protocol = "forces", .scene = scene, .state = row, .states = states * f->count };
    const bool answered = check_ask(run, name, &q, out);
    free(row);
    if (!answered)
        return false;
    struct forces answer;
    path_join(path, out, "forces.csv");
    if (!forces_read(path, states, f->count, wanted, &answer, why)) {
        check_garbage(run, why);
        return false;
    }
    for (size_t k = 0; k < forces; k++)
        for (size_t column = 0; column < size; column++)
            for (size_t i = 0; i < f->count; i++) {
                const double *moved = forces_at(&answer, column + 1, force[k], (int)i + 1);
                const double *rest = forces_at(&answer, 0, force[k], (int)i + 1);
                for (size_t c = 0; c < 6; c++)
                    R[k][(6 * i + c) * size + column] = rest[c] - moved[c];
            }
    forces_free(&answer);
    return true;
}

void theory_resistance(const struct model *m, const struct frozen *f, double *R)
{
    const size_t size = 6 * f->count;
    memset(R, 0, size * size * sizeof *R);
    for (size_t i = 0; i < f->count; i++)
        for (size_t j = i + 1; j < f->count; j++) {
            double r[3], block[144];
            for (int k = 0; k < 3; k++) {      /* cells of layer 2 are far wider than two ranges: one image at most */
                r[k] = f->x[j][k] - f->x[i][k];
                r[k] -= m->cell[k][k] * round(r[k] / m->cell[k][k]);
            }
            theory_pair_resistance(&m->lubrication, f->radius[i], f->radius[j], r, block);
            for (size_t a = 0; a < 12; a++)
                for (size_t b = 0; b < 12; b++) {   /* from U_1 U_2 W_1 W_2 to U_1 W_1 U_2 W_2 */
                    const size_t row = 6 * (a / 3 % 2 ? j : i) + 3 * (a / 6) + a % 3;
                    const size_t column = 6 * (b / 3 % 2 ? j : i) + 3 * (b / 6) + b % 3;
                    R[row * size + column] += block[12 * a + b];
                }
        }
}

double *noise_draws(struct check_run *run, const char *out, const char *file, size_t draws, const struct frozen *f, double unit)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    size_t shape[3] = { draws, f->count, 6 };
    double *value;
    path_join(path, out, file);
    if (!npy_read(path, 3, shape, &value, why)) {
        check_garbage(run, why);
        return NULL;
    }
    for (size_t k = 0; k < draws * f->count * 6; k++)
        value[k] /= unit;
    return value;
}
