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

enum { DRIVEN_MOMENTS = 2 };     /* halfway, where a flow in stages still goes, and at the end */

/* The kinetic stress at the end, -(1/V) sum of m c (x) c over the free spheres, c without the flow: a driven one has no mass to speak of. */
static void judge_kinetic(struct check_run *run, const char *dynamics, struct scattered *s, const struct track *track)
{
    char name[96], out[PATH_LENGTH], path[PATH_LENGTH];
    double expected[9] = { 0 };
    struct table stress;
    struct worst w = WORST_NONE;
    snprintf(name, sizeof name, "%s: kinetic stress", dynamics);
    path_join(out, run->work, dynamics);
    path_join(path, out, "out");
    if (!check_table(run, path, "stress.csv", "kinetic_xx,kinetic_xy,kinetic_xz,kinetic_yx,kinetic_yy,kinetic_yz,kinetic_zx,kinetic_zy,kinetic_zz", name, &stress))
        return;
    for (size_t k = 0; k < 2 * s->pairs; k++) {
        const struct track_point *p = track_at(track, DRIVEN_MOMENTS - 1, k);
        const size_t kind = (size_t)s->row[k].species - 1;
        const double mass = 4.0 / 3.0 * M_PI * s->m.density[kind] * pow(s->m.radius[kind], 3);
        double c[3];
        apply(s->m.gradient, p->x, c);
        for (int v = 0; v < 3; v++)
            c[v] = p->u[v] - c[v];
        for (int v = 0; v < 9 && !s->m.driven[kind]; v++)
            expected[v] -= mass * c[v / 3] * c[v % 3] / s->m.volume;
    }
    for (size_t v = 0; v < 9; v++)
        worst_see(&w, table_at(&stress, stress.rows - 1, v), expected[v], fabs(expected[0] + expected[4] + expected[8]), v);
    table_free(&stress);
    check_error(run, MODEL, name, w.measured, w.expected, w.error, run->gate_case->tolerance, "with %s the kinetic stress of free spheres among driven ones "
                "is %s in component %zu: of its own velocities less the flow's, and of the free spheres only", dynamics, compare(&w), w.at + 1);
}

/* Driven spheres among free ones, under each equation of motion: they go where and turn as the scene says, to rounding. */
static void check_driven(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const bool open[3] = { false, false, false };
    const int steps = (int)scene_number(parameters, "steps", NAN), at[DRIVEN_MOMENTS] = { steps / 2, steps };
    const char *dynamics;
    json_t *settings;
    json_object_foreach((json_t *)json_object_get(parameters, "dynamics"), dynamics, settings)
    {
        json_t *scene = json_deep_copy(run->gate_case->scene);
        const json_t *motion = scene_get(json_array_get(scene_get(scene, "species"), 1), "motion");
        char step[96];
        struct scattered s = { 0 };
        struct track track;
        struct worst w = WORST_NONE;
        scene_set(scene, "dynamics", json_deep_copy(settings));
        scene_set(scene, "output.stress.every", json_integer(steps));
        step_key(scene, step);
        const double dt = scene_number(scene, step, NAN);
        const bool good = model_read(run, scene, &s.m) && scatter(run, (size_t)scene_number(parameters, "across", 0), open, 0.02, 0.05, &s);
        for (size_t k = 0; good && k < 2 * s.pairs; k++)        /* whole cells away: put back at once, and followed without */
            s.row[k].x[1] += scene_number(parameters, "cells_away", 0) * s.m.cell[1][1];
        if (good && track_ask(run, dynamics, scene, s.row, 2 * s.pairs, at, DRIVEN_MOMENTS, &track)) {
            for (size_t n = 0; n < DRIVEN_MOMENTS * 2 * s.pairs; n++) {
                const size_t k = n % (2 * s.pairs), moment = n / (2 * s.pairs);
                const struct track_point *p = track_at(&track, moment, k);
                for (size_t c = 0; c < 3 && s.row[k].species == 2; c++) {
                    const double u = json_number_value(json_array_get(json_object_get(motion, "velocity"), c));
                    worst_see(&w, p->u[c], u, 1.0, k);
                    worst_see(&w, p->x[c], s.row[k].x[c] + u * dt * at[moment], s.m.radius[0], k);
                    if (isfinite(p->w[c]))
                        worst_see(&w, p->w[c], json_number_value(json_array_get(json_object_get(motion, "spin"), c)), 1.0, k);
                }
            }
            check_error(run, INVARIANT, dynamics, w.measured, w.expected, w.error, run->gate_case->tolerance,
                        "with %s driven sphere %zu does not keep the motion that the scene gives it: place, velocity or spin is %s", dynamics, w.at + 1, compare(&w));
            judge_kinetic(run, dynamics, &s, &track);
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
        if (good && !(good = table_read(path, "lubrication_xx,lubrication_yy,lubrication_xy,lubrication_yx,lubrication_yz", &stress[way], why) &&
                             table_expect_rows(&stress[way], (size_t)(at / (at / 10)) + 1, why)))
            check_garbage(run, why);
    }
    if (good) {
        struct worst spin = WORST_NONE, parts = WORST_NONE;
        double most = 0.0;
        for (size_t r = 1; r < stress[0].rows; r++)
            most = fmax(most, fabs(table_at(&stress[0], r, 2)));
        for (size_t r = 1; r < stress[0].rows && most > 0.0; r++)
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

/* One step of a run so short that nothing moves noticeably: m du and I dw over dt are the forces that the candidate itself tells of that state. */
static void judge_step(struct check_run *run, const char *label, json_t *scene, const struct scattered *s, const struct forces *told)
{
    static const char *const names[2] = { "velocities", "spins" };
    const int at = 1;
    struct track track;
    struct worst w[2] = { WORST_NONE, WORST_NONE };
    double largest[2] = { 0 };
    char step[96], name[96];
    step_key(scene, step);
    const double dt = scene_number(scene, step, NAN);
    if (!track_ask(run, label, scene, s->row, 2 * s->pairs, &at, 1, &track))
        return;
    for (size_t k = 0; k < 2 * s->pairs; k++)
        for (size_t c = 0; c < 6; c++)
            largest[c / 3] = fmax(largest[c / 3], fabs(forces_at(told, 0, "total", (int)k + 1)[c]));
    for (size_t k = 0; k < 2 * s->pairs; k++) {
        const struct track_point *p = track_at(&track, 0, k);
        const size_t kind = (size_t)s->row[k].species - 1;
        const double a = s->m.radius[kind], mass = 4.0 / 3.0 * M_PI * s->m.density[kind] * a * a * a, inertia = 0.4 * mass * a * a;
        for (size_t c = 0; c < 3; c++) {
            worst_see(&w[0], mass * (p->u[c] - s->row[k].u[c]) / dt, forces_at(told, 0, "total", (int)k + 1)[c], largest[0], k);
            if (isfinite(p->w[c]))
                worst_see(&w[1], inertia * (p->w[c] - s->row[k].w[c]) / dt, forces_at(told, 0, "total", (int)k + 1)[3 + c], largest[1], k);
        }
    }
    track_free(&track);
    for (int part = 0; part < 2; part++) {
        snprintf(name, sizeof name, "%s: %s", label, names[part]);
        check_error(run, INVARIANT, name, w[part].measured, w[part].expected, w[part].error, run->gate_case->tolerance,
                    "%s: what changes the %s of sphere %zu is %s: a run does not add up the forces that the candidate tells of the same state", label,
                    names[part], w[part].at + 1, compare(&w[part]));
    }
}

static void check_one_step(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const bool open[3] = { false, false, false };
    json_t *scene = json_deep_copy(run->gate_case->scene), *dynamics;
    struct scattered s = { 0 };
    struct forces told;
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH];
    const char *label;
    bool good = model_read(run, scene, &s.m) && scatter(run, (size_t)scene_number(parameters, "across", 0), open, -0.02, 0.05, &s);
    gsl_rng *random = pair_random(run);
    for (size_t k = 0; k < 2 * s.pairs && good; k++) {
        random_vector(random, 0.7, s.row[k].u);
        random_vector(random, 0.5, s.row[k].w);
    }
    gsl_rng_free(random);
    const struct question q = { .protocol = "forces", .scene = scene, .state = s.row, .states = 2 * s.pairs };
    good = good && check_ask(run, "told", &q, out);
    path_join(path, out, "forces.csv");
    if (good && !(good = forces_read(path, 1, 2 * s.pairs, "total", &told, why)))
        check_garbage(run, why);
    json_object_foreach(good ? (json_t *)json_object_get(parameters, "dynamics") : NULL, label, dynamics)
    {
        scene_set(scene, "dynamics", json_deep_copy(dynamics));
        judge_step(run, label, scene, &s, &told);
    }
    if (good)
        forces_free(&told);
    scattered_free(&s);
    json_decref(scene);
}

/*
 * The stress of a run against its own motion. Only pair forces act, noise too, and each pair is alone; in velocity Verlet of either form
 *
 *     m (x(n+1) - 2 x(n) + x(n-1))/dt^2 = F(n) ,      V sigma(n) = sum over pairs of F_i (x) (x_j - x_i)
 *
 * is the force that acted at step n, whatever it is made of, and what all its origins together must have booked. In the split, with friction and noise
 * only, it is m (U(n) - U(n-1))/dt, at the places of the middle of the step.
 */
static void judge_virial(struct check_run *run, const char *label, const struct scattered *s, const struct track *track, double dt)
{
    const bool split = strncmp(label, "split", 5) == 0;
    size_t k, at = track->steps / 2;
    json_t *origin;
    double expected[9] = { 0 }, booked[9] = { 0 }, size = 0.0, first = 0.0;
    struct worst w = WORST_NONE;
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH], columns[512], name[96];
    for (size_t pair = 0; pair < s->pairs; pair++) {
        const struct track_point *before = track_at(track, at - 1, 2 * pair), *now = track_at(track, at, 2 * pair), *after = track_at(track, at + 1, 2 * pair);
        const struct track_point *other = track_at(track, at, 2 * pair + 1);
        const size_t kind = (size_t)s->row[2 * pair].species - 1;
        const double mass = 4.0 / 3.0 * M_PI * s->m.density[kind] * pow(s->m.radius[kind], 3);
        for (int v = 0; v < 9; v++)
            expected[v] += split ? mass * (now->u[v / 3] - before->u[v / 3]) / dt * (other->x[v % 3] - now->x[v % 3] - 0.5 * dt * (other->u[v % 3] - now->u[v % 3])) / s->m.volume
                                 : mass * (after->x[v / 3] - 2.0 * now->x[v / 3] + before->x[v / 3]) / (dt * dt) * (other->x[v % 3] - now->x[v % 3]) / s->m.volume;
    }
    path_join(out, run->work, label);
    path_join(path, out, "out/stress.csv");
    json_array_foreach(json_object_get(run->gate_case->parameters, "origins"), k, origin)
    {
        const char *o = json_string_value(origin);
        struct table t;
        if (split && strncmp(o, "lubrication", 11) != 0)
            continue;
        snprintf(columns, sizeof columns, "%s_xx,%s_xy,%s_xz,%s_yx,%s_yy,%s_yz,%s_zx,%s_zy,%s_zz", o, o, o, o, o, o, o, o, o);
        if (!table_read(path, columns, &t, why)) {
            check_garbage(run, why);
            return;
        }
        for (size_t v = 0; v < 9; v++) {
            booked[v] += table_at(&t, at, v);
            first += strcmp(o, "lubrication_noise") == 0 ? fabs(table_at(&t, 0, v)) : 0.0;
        }
        table_free(&t);
    }
    for (size_t v = 0; v < 9; v++)
        size = fmax(size, fabs(expected[v]));
    for (size_t v = 0; v < 9; v++)
        worst_see(&w, booked[v], expected[v], size, v);
    snprintf(name, sizeof name, "%s: noise in the first row", label);
    check_error(run, INVARIANT, name, first, 0.0, first > 0.0 ? 0.0 : NAN, run->gate_case->tolerance, "%s: the stress of the noise in the row of the start is %g: noise acts "
                "from the start on", label, first);
    snprintf(name, sizeof name, "%s: stress", label);
    check_error(run, INVARIANT, name, w.measured, w.expected, w.error, run->gate_case->tolerance, "%s: component %zu of the stress of all pair forces and their "
                "noise is %s; the forces that moved the pairs give that", label, w.at + 1, compare(&w));
}

static void check_virial(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const bool open[3] = { false, false, false };
    json_t *scene = json_deep_copy(run->gate_case->scene), *dynamics;
    int at[9];
    const char *label;
    struct scattered s = { 0 };
    for (int k = 0; k < 9; k++)
        at[k] = k;
    scene_set(scene, "seed", json_integer(run->seed));
    scene_set(scene, "output.stress.every", json_integer(1));
    const bool good = model_read(run, scene, &s.m) && scatter(run, (size_t)scene_number(parameters, "across", 0), open, -0.02, 0.05, &s);
    json_object_foreach(good ? (json_t *)json_object_get(parameters, "dynamics") : NULL, label, dynamics)
    {
        struct track track;
        char step[96];
        json_t *own = json_deep_copy(scene);
        scene_set(own, "dynamics", json_deep_copy(dynamics));
        step_key(own, step);
        if (strncmp(label, "split", 5) == 0) {
            json_object_del(scene_get(own, "forces"), "contact");
            json_object_del(scene_get(own, "forces"), "repulsion");
        }
        if (track_ask(run, label, own, s.row, 2 * s.pairs, at, 9, &track)) {
            judge_virial(run, label, &s, &track, scene_number(own, step, NAN));
            track_free(&track);
        }
        json_decref(own);
    }
    scattered_free(&s);
    json_decref(scene);
}

const struct check scattered_checks[] = { { "scattered-pairs", check_frozen }, { "thrown-pairs", check_thrown }, { "driven-pairs", check_driven }, { "one-step", check_one_step }, { "one-step-drawn", check_drawn_step }, { "sliding", check_sliding }, { "virial", check_virial }, { "sweeps-or-global", check_sweeps }, { NULL, NULL } };
