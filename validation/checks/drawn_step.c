/*
 * Layer 4: one very short step of scenes drawn at random (pair_drawn.c), by every scheme
 *
 *     m (U(dt) - U(0))/dt = F ,    I (W(dt) - W(0))/dt = T
 *
 * with the forces that the candidate itself tells of that state, which layer 1 holds to the model; driven spheres keep the velocity they are
 * told. A scheme that leaves a force out, for some species, some law, some place, shows. dt is 1e-4 of the shortest time in the scene:
 * forces change by about as much of the sizes of their terms within the step.
 *
 * And the same scenes by every scheme for a hundred steps: each has its own way to treat friction, noise-free equations of motion have one
 * solution. What the schemes' velocities and spins differ by is measured against the fastest rate times the duration, which is what a missing
 * force would change, and places against the way. The species in the other order are the same scene: no scheme may treat the first or the last otherwise.
 */
#include "crowd.h"
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SCHEMES = 8, STEPS = 100 };
enum { PLACES, VELOCITIES, SPINS };
struct seen { struct worst w[3]; size_t scene[3]; };

static double mass_of(const struct crowd *c, size_t k)
{
    return 4.0 / 3.0 * M_PI * c->m.density[c->sphere[k].species - 1] * pow(c->sphere[k].s.radius, 3);
}

/* Sum of the sizes of all terms of the force (part 0) or torque (1) on a sphere. */
static double size_of(const struct crowd *c, size_t k, int part)
{
    double size = 0.0;
    for (int force = 0; force < FORCES; force++)
        size += c->present[force] ? c->scale[k][force][part] : 0.0;
    return size;
}

/* The fastest rate at which the motion of a free sphere changes [1/T]; velocities and spins are about 1. */
static double fastest(const struct crowd *c)
{
    double rate = 0.0;
    for (size_t k = 0; k < c->count; k++) {
        const double m = mass_of(c, k), a = c->sphere[k].s.radius;
        if (!c->m.driven[c->sphere[k].species - 1])
            rate = fmax(rate, fmax(fmax(size_of(c, k, 0) / m, size_of(c, k, 1) / (0.4 * m * a * a)), c->present[CONTACT] ? sqrt(c->m.contact.normal_stiffness / m) : 0.0));
    }
    return rate;
}

static double smallest_radius(const struct crowd *c)
{
    double smallest = INFINITY;
    for (size_t k = 0; k < c->count; k++)
        smallest = fmin(smallest, c->sphere[k].s.radius);
    return smallest;
}

/* The fastest rate at which forces change, too, where spheres cross their shortest range or stretch a stiff tangential spring. */
static double fastest_force(const struct crowd *c)
{
    double shortest = 1e-3, stiffer = 1.0;
    if (c->present[LUBRICATION])
        shortest = fmin(shortest, c->m.lubrication.inner_gap);
    if (c->present[CONTACT] && c->m.contact.friction > 0.0)
        stiffer = fmax(stiffer, c->m.contact.tangential_stiffness / c->m.contact.normal_stiffness);
    return fmax(fastest(c), 2.0 * stiffer / (shortest * smallest_radius(c)));
}

/* Where no force can turn a sphere nothing is told of spins. */
static bool turns(const struct crowd *c, const struct forces *told)
{
    for (size_t k = 0; k < c->count; k++)
        for (int v = 3; v < 6; v++)
            if (forces_at(told, 0, "total", (int)k + 1)[v] != 0.0)
                return true;
    return false;
}

/* Notes in which scene the worst of each kind is. */
static void note(struct seen *s, const struct worst before[3], size_t scene)
{
    for (int part = 0; part < 3; part++)
        s->scene[part] = s->w[part].error != before[part].error ? scene : s->scene[part];
}

static void see(struct seen *s, size_t scene, const struct crowd *c, const struct forces *told, const struct track *track, double dt, double tolerance)
{
    const double rounding = 1e-15 / dt / tolerance;         /* of a velocity of about 1, so that it takes the whole tolerance */
    const bool spins = turns(c, told);
    struct worst before[3];
    memcpy(before, s->w, sizeof before);
    for (size_t k = 0; k < c->count; k++) {
        const struct track_point *now = track_at(track, 0, k);
        const struct theory_sphere *then = &c->sphere[k].s;
        const bool driven = c->m.driven[c->sphere[k].species - 1];
        const double m = mass_of(c, k), inertia = 0.4 * m * then->radius * then->radius;
        const double *F = forces_at(told, 0, "total", (int)k + 1);
        for (size_t v = 0; v < 3; v++) {
            worst_see(&s->w[VELOCITIES], m * (now->u[v] - then->u[v]) / dt, driven ? 0.0 : F[v], size_of(c, k, 0) + m * rounding * (1.0 + fabs(then->u[v])), k);
            if (spins && isfinite(now->w[v]))
                worst_see(&s->w[SPINS], inertia * (now->w[v] - then->w[v]) / dt, driven ? 0.0 : F[3 + v], size_of(c, k, 1) + inertia * rounding * (1.0 + fabs(then->w[v])), k);
        }
    }
    note(s, before, scene);
}

/* The species in the other order, and what is told of each: only the law of rough surfaces goes by number. */
static json_t *reversed(const json_t *scene)
{
    json_t *other = json_deep_copy(scene);
    json_t *const lists[] = { scene_get(other, "species"), scene_get(other, "forces.contact.rough") };
    for (int l = 0; l < 2; l++)
        for (size_t k = 0; k + 1 < json_array_size(lists[l]); k++) {
            json_t *last = json_incref(json_array_get(lists[l], json_array_size(lists[l]) - 1));
            json_array_remove(lists[l], json_array_size(lists[l]) - 1);
            json_array_insert_new(lists[l], k, last);
        }
    return other;
}

/* The state after so many steps of dt; `backwards`: of the scene with its species in the other order. */
static bool go(struct check_run *run, const char *name, json_t *scene, const struct crowd *c, double dt, int steps, bool backwards, struct track *track)
{
    char key[96];
    struct state_row *row = crowd_rows(c);
    for (size_t k = 0; backwards && k < c->count; k++)
        row[k].species = (int)c->m.species + 1 - row[k].species;
    step_key(scene, key);
    scene_set(scene, key, json_real(dt));
    const bool good = track_ask(run, name, scene, row, c->count, &steps, 1, track);
    free(row);
    return good;
}

static bool step(struct check_run *run, const char *name, json_t *scene, const struct crowd *c, const struct forces *told, size_t number, struct seen *s)
{
    const double dt = 1e-4 / fastest_force(c);
    struct track track;
    const bool good = go(run, name, scene, c, dt, 1, false, &track);
    if (good) {
        see(s, number, c, told, &track, dt, run->gate_case->tolerance);
        track_free(&track);
    }
    return good;
}

/* How far the ways of two schemes part. */
static void see_ways(struct seen *s, size_t scene, const struct crowd *c, const struct track *mine, const struct track *other, double duration)
{
    const double change = fmin(1.0, fastest(c) * duration);
    struct worst before[3];
    memcpy(before, s->w, sizeof before);
    for (size_t k = 0; k < c->count; k++) {
        const struct track_point *a = track_at(mine, 0, k), *b = track_at(other, 0, k);
        for (size_t v = 0; v < 3; v++) {
            worst_see(&s->w[PLACES], a->x[v], b->x[v], duration * (1.0 + fabs(b->u[v])), k);
            worst_see(&s->w[VELOCITIES], a->u[v], b->u[v], change * (1.0 + fabs(b->u[v])), k);
            if (isfinite(b->w[v]))
                worst_see(&s->w[SPINS], a->w[v], b->w[v], change * (1.0 + fabs(b->w[v])), k);
        }
    }
    note(s, before, scene);
}

/* All schemes, as long as the fastest motion lasts and no sphere goes farther than a fiftieth of a radius; and with the species in the other order. */
static bool ways(struct check_run *run, json_t *scene, const struct crowd *c, size_t number, struct seen parted[SCHEMES], struct seen turned[SCHEMES])
{
    json_t *all = json_object_get(run->gate_case->parameters, "dynamics"), *dynamics;
    const double duration = fmin(1.0 / fastest(c), 0.01 * smallest_radius(c)), dt = duration / STEPS;
    struct track first = { 0 };
    const char *label;
    char name[96];
    size_t which = 0;
    bool good = true;
    json_object_foreach(all, label, dynamics)
    {
        struct track track = { 0 }, other = { 0 };
        if (!good)
            continue;
        scene_set(scene, "dynamics", json_deep_copy(dynamics));
        json_t *back = reversed(scene);
        snprintf(name, sizeof name, "scene %zu, way by %s", number, label);
        good = go(run, name, scene, c, dt, STEPS, false, &track);
        snprintf(name, sizeof name, "scene %zu, species reversed, way by %s", number, label);
        good = good && go(run, name, back, c, dt, STEPS, true, &other);
        if (good) {
            see_ways(&turned[which], number, c, &other, &track, duration);
            if (which > 0)
                see_ways(&parted[which], number, c, &track, &first, duration);
        }
        track_free(&other);
        if (which++ == 0)
            first = track;
        else
            track_free(&track);
        json_decref(back);
    }
    track_free(&first);
    return good;
}

static void judge(struct check_run *run, const char *label, const struct seen *s, const char *after, double tolerance, const char *fault)
{
    static const char *const names[3] = { "places", "velocities", "spins" };
    char what[96];
    for (int part = 0; part < 3; part++) {
        const struct worst *w = &s->w[part];
        if (part == PLACES && w->error < 0.0)
            continue;               /* in one step nothing moves */
        snprintf(what, sizeof what, "%s: %s%s", label, names[part], after);
        check_error(run, INVARIANT, what, w->measured, w->expected, w->error, tolerance, "%s: the %s of sphere %zu of scene %zu: %s; %s", label,
                    names[part], w->at + 1, s->scene[part], compare(w), fault);
    }
}

void check_drawn_step(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t scenes = (size_t)scene_number(parameters, "scenes", 0);
    json_t *all = json_object_get(parameters, "dynamics"), *dynamics;
    struct seen steps[SCHEMES], parted[SCHEMES], turned[SCHEMES];
    const char *label;
    gsl_rng *random = pair_random(run);
    bool good = json_object_size(all) <= SCHEMES;
    for (size_t k = 0; k < SCHEMES; k++)
        steps[k] = parted[k] = turned[k] = (struct seen){ { WORST_NONE, WORST_NONE, WORST_NONE }, { 0 } };
    for (size_t k = 1; k <= scenes && good; k++) {
        struct crowd c = { 0 };
        struct pair_answer told = { 0 };
        size_t which = 0;
        char name[96];
        json_t *scene = drawn_crowd(run, random, false, &c);
        snprintf(name, sizeof name, "scene %zu, forces", k);
        good = scene && crowd_ask(run, name, scene, &c, &told);
        json_object_foreach(all, label, dynamics)
        {
            snprintf(name, sizeof name, "scene %zu, step by %s", k, label);
            if (good)
                scene_set(scene, "dynamics", json_deep_copy(dynamics));
            good = good && step(run, name, scene, &c, &told.forces, k, &steps[which++]);
        }
        good = good && ways(run, scene, &c, k, parted, turned);
        forces_free(&told.forces);
        crowd_free(&c);
        json_decref(scene);
    }
    size_t which = 0;
    json_object_foreach(good ? all : NULL, label, dynamics)
    {
        judge(run, label, &steps[which], "", run->gate_case->tolerance, "mass times what a step changes, against the force that the candidate tells of the same "
              "state: a run does not add up its forces, or a driven sphere does not move as told");
        judge(run, label, &turned[which], " with the species reversed", scene_number(parameters, "turned", 0.0), "with the species in the other order, which is the "
              "same scene");
        if (which++)
            judge(run, label, &parted[which - 1], " after a hundred steps", scene_number(parameters, "parted", 0.0), "by this scheme and by the first named: "
                  "they do not solve the same equations");
    }
    gsl_rng_free(random);
}
