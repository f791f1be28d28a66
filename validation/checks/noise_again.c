/*
 * Layer 2: no random number is used twice
 *
 * Forces and torques of drag noise on spheres at rest, asked for in several ways (parameters.asks): many steps of few spheres, many spheres at few
 * steps, other seeds, other realisations. A generator that counts steps, ids, seeds or realisations with too few bits, or mixes them so that two
 * places get one number, comes back to vectors that were there before. The direction of a vector says which it is whatever its size, and its sign
 * does not matter. Of n directions that are independent n^2 s^2/4 pairs agree to s by chance: 1e-3 for n = 6e5 and s = 1e-7.
 */
#include "noise.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double alike = 1e-7;

struct direction { double n[3]; };

static int by_first(const void *left, const void *right)
{
    const struct direction *a = left, *b = right;
    return (a->n[0] > b->n[0]) - (a->n[0] < b->n[0]);
}

static struct direction direction_of(const double v[3])
{
    const double size = norm(v) * (v[0] < 0.0 ? -1.0 : 1.0);
    struct direction d = { { 0 } };
    for (int c = 0; c < 3 && size != 0.0; c++)
        d.n[c] = v[c] / size;
    return d;
}

/* The directions of one question, behind those that are there. False after recording what is wrong. */
static bool ask(struct check_run *run, const json_t *how, size_t number, struct direction **all, size_t *count)
{
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct model m;
    const size_t spheres = (size_t)scene_number(how, "spheres", 1), draws = (size_t)scene_number(how, "draws", 1);
    const struct frozen f = { .count = spheres };
    struct state_row *row = calloc(spheres, sizeof *row);
    char out[PATH_LENGTH], name[32];
    double *draw = NULL;
    scene_set(scene, "seed", json_integer((json_int_t)(uint32_t)(run->seed + (uint32_t)scene_number(how, "seed", 0))));
    scene_set(scene, "realisation", json_integer((json_int_t)scene_number(how, "realisation", 0)));
    snprintf(name, sizeof name, "ask-%zu", number + 1);
    const bool read = row && model_read(run, scene, &m);
    for (size_t i = 0; read && i < spheres; i++) {
        row[i] = (struct state_row){ .id = (int)i + 1, .species = (int)(i % m.species) + 1 };
        for (size_t c = 0; c < 3; c++)      /* on a lattice, apart: a code may look for neighbours */
            row[i].x[c] = ((double)(c == 0 ? i % 11 : c == 1 ? i / 11 % 11 : i / 121) + 0.5) / 11.0 * m.cell[c][c];
    }
    const struct question q = { .protocol = "noise", .scene = scene, .state = row, .states = spheres, .draws = draws };
    if (read && check_ask(run, name, &q, out))
        draw = noise_draws(run, out, "noise_drag_noise.npy", draws, &f, 1.0);
    struct direction *more = draw ? realloc(*all, (*count + 2 * spheres * draws) * sizeof *more) : NULL;
    for (size_t k = 0; more && k < 2 * spheres * draws; k++)
        more[(*count)++] = direction_of(draw + 3 * k);
    *all = more ? more : *all;
    free(draw);
    free(row);
    json_decref(scene);
    return more != NULL;
}

/* Sorts them. */
static void judge(struct check_run *run, struct direction *all, size_t count)
{
    size_t again = 0;
    qsort(all, count, sizeof *all, by_first);
    for (size_t a = 0; a < count; a++)
        for (size_t b = a + 1; b < count && all[b].n[0] - all[a].n[0] < alike; b++)
            if (fabs(all[b].n[1] - all[a].n[1]) < alike && fabs(all[b].n[2] - all[a].n[2]) < alike) {
                again++;
                break;
            }
    const double share = (double)again / (double)count;
    check_error(run, INVARIANT, "no number twice", share, 0.0, share, run->gate_case->tolerance,
                "%zu of %zu random vectors (of all steps, spheres or pairs, seeds and realisations asked for) were there before, or are nothing: something is "
                "counted with too few bits, or two places share their numbers", again, count);
}

void check_noise_again(struct check_run *run)
{
    struct direction *all = NULL;
    size_t count = 0, k;
    json_t *how;
    bool good = true;
    json_array_foreach(json_object_get(run->gate_case->parameters, "asks"), k, how)
        good = good && ask(run, how, k, &all, &count);
    if (good && count > 0)
        judge(run, all, count);
    free(all);
}

/*
 * Of pairs: triples of equal spheres on lines along x, all with the same gaps. The outer two feel one film each, and films that are alike turn the
 * same numbers into the same force. Ids are those of all the middles, of all the left, of all the right ones: partners whose ids differ by a power
 * of two meet the same sphere.
 */
void check_noise_again_pairs(struct check_run *run)
{
    const size_t triples = (size_t)scene_number(run->gate_case->parameters, "triples", 0), draws = (size_t)scene_number(run->gate_case->parameters, "draws", 0);
    const size_t across = (size_t)ceil(sqrt((double)triples)), spheres = 3 * triples;
    const double xi = scene_number(run->gate_case->parameters, "xi", NAN);
    const struct frozen f = { .count = spheres };
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct state_row *row = calloc(spheres, sizeof *row);
    struct direction *all = calloc(2 * triples * draws, sizeof *all);
    struct model m;
    char out[PATH_LENGTH];
    double *draw = NULL;
    size_t count = 0;
    scene_set(scene, "seed", json_integer(run->seed));
    const bool read = row && all && model_read(run, scene, &m);
    for (size_t i = 0; read && i < spheres; i++) {
        const size_t line = i % triples;
        const double off = (2.0 + xi) * m.radius[0] * (i < triples ? 0.0 : i < 2 * triples ? -1.0 : 1.0);
        row[i] = (struct state_row){ .id = (int)i + 1, .species = 1, .x = { 0.5 * m.cell[0][0] + off, ((double)(line % across) + 0.5) / (double)across * m.cell[1][1],
                                                                            ((double)(line / across) + 0.5) / (double)across * m.cell[2][2] } };
    }
    const struct question q = { .protocol = "noise", .scene = scene, .state = row, .states = spheres, .draws = draws };
    if (read && check_ask(run, "draws", &q, out))
        draw = noise_draws(run, out, "noise_lubrication_noise.npy", draws, &f, 1.0);
    for (size_t t = 0; draw && t < draws; t++)
        for (size_t i = triples; i < spheres; i++)
            all[count++] = direction_of(draw + 6 * (t * spheres + i));
    if (count > 0)
        judge(run, all, count);
    free(draw);
    free(all);
    free(row);
    json_decref(scene);
}
