/*
 * Layers 1 and 4: who is near whom, wherever in the cell
 *
 * Pairs of spheres, each alone, on a lattice that fills the cell, in all directions and along its edges, most of them in touch by very little: a
 * spring pushes them apart with k delta along n, and nothing else acts. A pair that a neighbour search loses has no force; one that it lists twice
 * has two. Frozen: in cells that lean as far as they can, at places outside an open cell, with spheres that are held (two held ones are no pair).
 *
 * In motion: pairs thrown together from gaps of every size, so that they touch at every moment between two searches. The spring is elastic: each
 * comes back as fast as it went. One that is found only when it has already sunk in comes back faster.
 */
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct scattered { struct model m; size_t pairs; struct state_row *row; double (*n)[3], *overlap; };

static void scattered_free(struct scattered *s)
{
    free(s->row);
    free(s->n);
    free(s->overlap);
}

/* across^3 pairs, with gaps that grow from low to high; along an open axis half a cell apart from one cell below to two above, also where faces would be. */
static bool scatter(struct check_run *run, size_t across, const bool open[3], double low, double high, struct scattered *s)
{
    gsl_rng *random = pair_random(run);
    s->pairs = across * across * across;
    s->row = calloc(2 * s->pairs, sizeof *s->row);
    s->n = calloc(s->pairs, sizeof *s->n);
    s->overlap = calloc(s->pairs, sizeof *s->overlap);
    for (size_t k = 0; s->row && s->n && s->overlap && k < s->pairs; k++) {
        const size_t place[3] = { k % across, k / across % across, k / across / across };
        const int kind[2] = { k % 3 == 2 ? 2 : 1, k % 3 == 0 ? 1 : 2 };
        const double a[2] = { s->m.radius[kind[0] - 1], s->m.radius[kind[1] - 1] };
        double middle[3] = { 0 };
        for (int v = 0; v < 3; v++) {
            const double share = ((double)place[v] + 0.5 + 0.06 * (gsl_rng_uniform(random) - 0.5)) / (double)across;
            for (int c = 0; c < 3; c++)
                middle[c] += (open[v] ? 0.5 * (double)place[v] - 1.0 : share) * s->m.cell[v][c];
        }
        random_direction(random, s->n[k]);
        if (k / 3 % 4 < 3)                  /* three in four nearly along an axis: across as many planes of a grid as can be */
            for (size_t c = 0; c < 3; c++)
                s->n[k][c] = 0.05 * s->n[k][c] + (c == k / 3 % 4);
        const double length = norm(s->n[k]), gap = low + (high - low) * (double)k / (double)s->pairs;
        s->overlap[k] = -gap;
        for (size_t side = 0; side < 2; side++) {
            struct state_row *r = &s->row[2 * k + side];
            *r = (struct state_row){ .id = (int)(2 * k + side) + 1, .species = kind[side] };
            for (int c = 0; c < 3; c++) {
                s->n[k][c] /= side ? 1.0 : length;
                r->x[c] = middle[c] + (side ? 0.5 : -0.5) * (a[0] + a[1] + gap) * s->n[k][c];
            }
        }
    }
    gsl_rng_free(random);
    return s->row && s->n && s->overlap;
}

static void judge_frozen(struct check_run *run, const json_t *variant)
{
    const char *name = json_string_value(json_object_get(variant, "name"));
    json_t *scene = variant_scene(run->gate_case, variant);
    struct scattered s = { 0 };
    struct forces answer;
    struct worst w = WORST_NONE;
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH];
    bool open[3];
    if (json_object_get(variant, "held"))
        scene_set(json_array_get(scene_get(scene, "species"), 1), "motion", json_string("held"));
    for (size_t k = 0; k < 3; k++)
        open[k] = !json_is_true(json_array_get(scene_get(scene, "box.periodic"), k));
    const double low = scene_number(run->gate_case->parameters, "overlap", NAN);
    if (model_read(run, scene, &s.m) && scatter(run, (size_t)scene_number(run->gate_case->parameters, "across", 0), open, -low, 0.2 * low, &s)) {
        const struct question q = { .protocol = "forces", .scene = scene, .state = s.row, .states = 2 * s.pairs };
        if (check_ask(run, name, &q, out)) {
            path_join(path, out, "forces.csv");
            if (!forces_read(path, 1, 2 * s.pairs, "contact", &answer, why)) {
                check_garbage(run, why);
            } else {
                for (size_t k = 0; k < 2 * s.pairs; k++) {
                    const bool both_held = json_object_get(variant, "held") && s.row[k].species == 2 && s.row[k ^ 1].species == 2;
                    const double push = both_held ? 0.0 : s.m.contact.normal_stiffness * fmax(0.0, s.overlap[k / 2]);
                    double expected[3];
                    for (int c = 0; c < 3; c++)
                        expected[c] = (k % 2 ? push : -push) * s.n[k / 2][c];
                    worst_see_vector(&w, forces_at(&answer, 0, "contact", (int)k + 1), expected, 3, s.m.contact.normal_stiffness * low, k);
                }
                forces_free(&answer);
                check_error(run, INVARIANT, name, w.measured, w.expected, w.error, run->gate_case->tolerance,
                            "%s: the force on sphere %zu of scattered pairs is %s; %s", name, w.at + 1, compare(&w),
                            json_object_get(variant, "held") ? "two held spheres are no pair, or a pair was lost" : "a pair was lost, or found twice");
            }
        }
    }
    scattered_free(&s);
    json_decref(scene);
}

static void check_frozen(struct check_run *run)
{
    size_t k;
    json_t *variant;
    json_array_foreach(json_object_get(run->gate_case->parameters, "variants"), k, variant)
        judge_frozen(run, variant);
}

static void check_thrown(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    json_t *scene = json_deep_copy(run->gate_case->scene);
    const double speed = scene_number(parameters, "speed", NAN), most = scene_number(parameters, "gap", NAN);
    const int at = (int)scene_number(parameters, "steps", NAN);
    const bool open[3] = { false, false, false };
    struct scattered s = { 0 };
    struct track track;
    if (model_read(run, scene, &s.m) && scatter(run, (size_t)scene_number(parameters, "across", 0), open, 0.01 * most, most, &s)) {
        for (size_t k = 0; k < 2 * s.pairs; k++)
            for (int c = 0; c < 3; c++)
                s.row[k].u[c] = (k % 2 ? -speed : speed) * s.n[k / 2][c];
        if (track_ask(run, "thrown", scene, s.row, 2 * s.pairs, &at, 1, &track)) {
            struct worst w = WORST_NONE;
            for (size_t k = 0; k < s.pairs; k++) {
                double going = 0.0;         /* speed at which the pair parts */
                for (int c = 0; c < 3; c++)
                    going += (track_at(&track, 0, 2 * k + 1)->u[c] - track_at(&track, 0, 2 * k)->u[c]) * s.n[k][c];
                worst_see(&w, going, 2.0 * speed, 2.0 * speed, k);
            }
            check_error(run, INVARIANT, "every pair comes back as fast as it went", w.measured, w.expected, w.error, run->gate_case->tolerance,
                        "pair %zu, thrown together from a gap of %.3g, parts at a speed that is %s: an elastic spring gives back what it takes; a pair that is "
                        "found too late has sunk in already", w.at + 1, w.error >= 0.0 ? -s.overlap[w.at] : NAN, compare(&w));
            track_free(&track);
        }
    }
    scattered_free(&s);
    json_decref(scene);
}

/* Driven spheres among free ones, under each equation of motion: they go where and turn as the scene says, to rounding. */
static void check_driven(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const bool open[3] = { false, false, false };
    const int at = (int)scene_number(parameters, "steps", NAN);
    const char *dynamics;
    json_t *settings;
    json_object_foreach((json_t *)json_object_get(parameters, "dynamics"), dynamics, settings)
    {
        json_t *scene = json_deep_copy(run->gate_case->scene);
        const json_t *motion = scene_get(json_array_get(scene_get(scene, "species"), 1), "motion");
        const double dt = scene_number(settings, "dt", NAN);
        struct scattered s = { 0 };
        struct track track;
        struct worst w = WORST_NONE;
        scene_set(scene, "dynamics", json_pack("{sO}", dynamics, settings));
        if (model_read(run, scene, &s.m) && scatter(run, (size_t)scene_number(parameters, "across", 0), open, 0.02, 0.05, &s)
            && track_ask(run, dynamics, scene, s.row, 2 * s.pairs, &at, 1, &track)) {
            for (size_t k = 0; k < 2 * s.pairs; k++) {
                const struct track_point *p = track_at(&track, 0, k);
                for (size_t c = 0; c < 3 && s.row[k].species == 2; c++) {
                    const double u = json_number_value(json_array_get(json_object_get(motion, "velocity"), c));
                    worst_see(&w, p->u[c], u, 1.0, k);
                    worst_see(&w, p->x[c], s.row[k].x[c] + u * dt * at, s.m.radius[0], k);
                    if (isfinite(p->w[c]))
                        worst_see(&w, p->w[c], json_number_value(json_array_get(json_object_get(motion, "spin"), c)), 1.0, k);
                }
            }
            check_error(run, INVARIANT, dynamics, w.measured, w.expected, w.error, run->gate_case->tolerance,
                        "with %s driven sphere %zu does not keep the motion that the scene gives it: place, velocity or spin is %s", dynamics, w.at + 1, compare(&w));
            track_free(&track);
        }
        scattered_free(&s);
        json_decref(scene);
    }
}

/* The friction of the split solved at once and in sweeps: at a small step the same motion and the same stress, also of a sphere that meets itself. */
static void check_sweeps(struct check_run *run)
{
    static const char *const ways[2] = { "global", "sweeps" };
    const json_t *parameters = run->gate_case->parameters;
    const int at = (int)scene_number(parameters, "steps", NAN);
    const size_t across = (size_t)scene_number(parameters, "across", 0);
    const bool open[3] = { false, false, false };
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct scattered s = { 0 };
    struct track track[2] = { { 0 } };
    struct table stress[2] = { { 0 } };
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH];
    bool good = model_read(run, scene, &s.m) && scatter(run, across ? across : 1, open, 0.02, 0.05, &s);
    const size_t count = across ? 2 * s.pairs : 1;
    for (size_t k = 0; k < count && good; k++) {
        apply(s.m.gradient, s.row[k].x, s.row[k].u);
        for (size_t c = 0; c < 3; c++)
            s.row[k].w[c] = 0.3 - 0.2 * (double)c + 0.1 * (double)(k % 5);
    }
    scene_set(scene, "output.stress", json_pack("{si}", "every", at / 10));
    for (int way = 0; way < 2 && good; way++) {
        scene_set(scene, "dynamics.split.friction", json_string(ways[way]));
        good = track_ask(run, ways[way], scene, s.row, count, &at, 1, &track[way]);
        path_join(out, run->work, ways[way]);
        path_join(path, out, "out/stress.csv");
        if (good && !(good = table_read(path, "lubrication_xx,lubrication_yy,lubrication_xy,lubrication_yx,lubrication_yz", &stress[way], why)))
            check_garbage(run, why);
    }
    if (good) {
        struct worst spin = WORST_NONE, parts = WORST_NONE;
        double most = 0.0;
        for (size_t r = 1; r < stress[0].rows; r++)
            most = fmax(most, fabs(table_at(&stress[0], r, 2)));
        for (size_t r = 1; r < stress[0].rows && r < stress[1].rows && most > 0.0; r++)
            for (size_t c = 0; c < 5; c++)
                worst_see(&parts, table_at(&stress[1], r, c), table_at(&stress[0], r, c), most, r);
        for (size_t k = 0; k < count; k++)
            worst_see_vector(&spin, track_at(&track[1], 0, k)->w, track_at(&track[0], 0, k)->w, 3, 0.3, k);
        check_error(run, INVARIANT, "spins", spin.measured, spin.expected, spin.error, run->gate_case->tolerance,
                    "at a small step friction in sweeps and friction solved at once turn sphere %zu otherwise: %s", spin.at + 1, compare(&spin));
        if (most > 0.0)
            check_error(run, INVARIANT, "lubrication stress", parts.measured, parts.expected, parts.error, run->gate_case->tolerance,
                        "at a small step friction in sweeps and friction solved at once book another stress: %s", compare(&parts));
    }
    for (int way = 0; way < 2; way++) {
        track_free(&track[way]);
        if (stress[way].rows)
            table_free(&stress[way]);
    }
    scattered_free(&s);
    json_decref(scene);
}

const struct check scattered_checks[] = { { "scattered-pairs", check_frozen }, { "thrown-pairs", check_thrown }, { "driven-pairs", check_driven }, { "sweeps-or-global", check_sweeps }, { NULL, NULL } };
