/*
 * Random non-overlapping spheres
 *
 * Centres uniformly at random, then damped motion down the energy E = sum over pairs (1/2) delta^2 of spheres a little too
 * large (FIRE: velocities are turned towards the force and set to zero when they go uphill) until no two of the
 * true size overlap by more than 1e-4 of their mean radius.
 *
 * Source: FIRE, Bitzek et al. (2006), their parameters. Reaches volume fractions of about 0.63; denser crowds jam.
 */
#include "core/noise.h"
#include "protocols/protocols.h"

#include <stdlib.h>
#include <string.h>

static const double too_large = 1.0005;         /* margin, so that a finite number of steps ends without true overlap */
static const double overlap_allowed = 1e-4;     /* over the mean radius of the pair */
enum { MOST_STEPS = 20000 };

/* Counts per species from their shares of the solid volume, by largest remainder, and the volume they fill. */
static double share_out(const struct particles *p, int count, const double *share, int *number)
{
    double per_volume[MAX_SPECIES], sum = 0.0, volume = 0.0;
    int given = 0;
    for (int k = 0; k < p->species_count; k++)
        sum += per_volume[k] = share[k] / pow(p->kind[k].radius, 3);
    for (int k = 0; k < p->species_count; k++) {
        number[k] = (int)floor(count * per_volume[k] / sum);
        given += number[k];
    }
    for (; given < count; given++) {
        int most = 0;
        for (int k = 1; k < p->species_count; k++)
            if (count * per_volume[k] / sum - number[k] > count * per_volume[most] / sum - number[most])
                most = k;
        number[most]++;
    }
    for (int k = 0; k < p->species_count; k++)
        volume += number[k] * 4.0 / 3.0 * M_PI * pow(p->kind[k].radius, 3);
    return volume;
}

/* Forces delta n of the enlarged spheres; returns the largest true overlap over the mean radius. */
static double repel(const struct near_pairs *near, struct particles *p)
{
    double worst = 0.0;
    memset(p->force, 0, (size_t)p->count * sizeof *p->force);
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        const double touch = pair->distance - pair->gap;
        const double overlap = too_large * touch - pair->distance;
        if (overlap > 0.0)
            pair_push(p, pair, scaled(pair->normal, -overlap));
        worst = fmax(worst, -pair->gap / (0.5 * touch));
    }
    return worst;
}

static bool minimise(struct suspension *s, double *worst, struct error *e)
{
    struct particles *p = &s->particles;
    struct neighbours search;
    memset(&search, 0, sizeof search);
    for (int a = 0; a < p->species_count; a++)
        for (int b = 0; b < p->species_count; b++)
            search.range[a][b] = too_large * (p->kind[a].radius + p->kind[b].radius);
    bool good = neighbours_start(&search, p, e), relisted;
    double dt = 0.1, alpha = 0.1;
    int downhill = 0;
    for (int step = 0; good && step < MOST_STEPS; step++) {
        good = neighbours_find(&search, &s->box, p, &relisted, e);
        if (!good || (*worst = repel(&search.near, p)) < overlap_allowed)
            break;
        double power = 0.0, speed = 0.0, force = 0.0;
        for (int i = 0; i < p->count; i++) {
            power += dot(p->force[i], p->velocity[i]);
            speed += dot(p->velocity[i], p->velocity[i]);
            force += dot(p->force[i], p->force[i]);
        }
        const double turn = power > 0.0 ? alpha * sqrt(speed / force) : 0.0;
        for (int i = 0; i < p->count; i++) {
            const vec3 kept = power > 0.0 ? scaled(p->velocity[i], 1.0 - alpha) : vec(0, 0, 0);
            p->velocity[i] = plus(kept, scaled(p->force[i], turn + dt));
            if (s->dimensions == 2)
                p->velocity[i].z = 0.0;
            p->position[i] = plus(p->position[i], scaled(p->velocity[i], dt));
        }
        if (power <= 0.0) {
            dt *= 0.5;
            alpha = 0.1;
            downhill = 0;
        } else if (++downhill > 5) {
            dt = fmin(1.1 * dt, 0.6);
            alpha *= 0.99;
        }
    }
    neighbours_free(&search);
    return good;
}

void follow_flow(struct suspension *s)
{
    struct particles *p = &s->particles;
    for (int i = 0; i < p->count; i++) {
        p->velocity[i] = box_flow(&s->box, p->position[i]);
        if (p->spin)
            p->spin[i] = s->box.spin;
    }
}

void thermal_start(struct suspension *s)
{
    struct particles *p = &s->particles;
    for (int i = 0; i < p->count; i++) {
        const struct noise_place place = { NOISE_THERMAL, 0, p->tag[i], 0, 0 };
        vec3 first, second;
        noise_vectors(NOISE_GAUSSIAN, &s->key, &place, &first, &second);
        if (s->dimensions == 2)
            first.z = second.x = second.y = 0.0;
        p->velocity[i] = plus(p->velocity[i], scaled(first, sqrt(s->kT / mass_of(p, i))));
        if (p->spin)
            p->spin[i] = plus(p->spin[i], scaled(second, sqrt(s->kT / inertia_of(p, i))));
    }
}

/* A sphere and its cell of the edge of a large sphere, counted along z, then y, then x. */
struct placed { int cell[3], species; vec3 position; };

static int by_place(const void *a, const void *b)
{
    const struct placed *one = a, *other = b;
    for (int k = 2; k >= 0; k--)
        if (one->cell[k] != other->cell[k])
            return one->cell[k] < other->cell[k] ? -1 : 1;
    return one->position.x < other->position.x ? -1 : 1;            /* no two alike: the same order with any qsort */
}

/*
 * Centres uniform in the cell, numbered from slab to slab: neighbours in space are neighbours in memory, which makes a step of 1e5 spheres
 * twice as fast. Slabs lie across z, so that a flow along x or y mixes spheres within a slab only.
 */
static bool place(struct suspension *s, const int *number, struct error *e)
{
    struct particles *p = &s->particles;
    double edge = 0.0, count[3];
    struct placed *sphere = calloc((size_t)p->count + 1, sizeof *sphere);
    if (!sphere)
        return error_out_of_memory(e);
    for (int k = 0; k < p->species_count; k++)
        edge = fmax(edge, 2.0 * p->kind[k].radius);
    for (int k = 0; k < 3; k++)
        count[k] = floor(s->box.start.m[k][k] / edge) + 1.0;
    for (int i = 0, kind = 0, left = number[0]; i < p->count; i++, left--) {
        while (left == 0)
            left = number[++kind];
        const struct noise_place at = { NOISE_START, 0, p->tag[i], 0, 0 };
        const philox4x64_ctr_t w = noise_words(&s->key, &at);
        double share[3];
        for (int k = 0; k < 3; k++) {
            share[k] = k == 2 && s->dimensions == 2 ? 0.0 : noise_fraction((uint32_t)w.v[k]);
            sphere[i].cell[k] = (int)(share[k] * count[k]);
        }
        sphere[i].species = kind;
        sphere[i].position = mat3_times(&s->box.cell, vec(share[0], share[1], share[2]));
    }
    qsort(sphere, (size_t)p->count, sizeof *sphere, by_place);
    for (int i = 0; i < p->count; i++) {
        p->species[i] = sphere[i].species;
        p->position[i] = sphere[i].position;
    }
    free(sphere);
    return true;
}

/* "random": { "phi": 0.5, "count": 1000, "volume_shares": [0.5, 0.5] } */
bool random_start(struct settings *s, struct suspension *in, struct error *e)
{
    struct particles *p = &in->particles;
    double share[MAX_SPECIES] = { 0.0 }, worst = 0.0;
    int number[MAX_SPECIES];
    const double phi = settings_positive(s, "phi", e);
    const int count = (int)settings_whole(s, "count", 1, 100000000, e);
    if (!error_raised(e) && phi > 0.74)
        settings_refuse(s, "phi", e, "must be at most 0.74, the densest crystal of equal spheres");
    const int shares = settings_numbers(s, "volume_shares", share, MAX_SPECIES, e);
    if (!error_raised(e) && shares != p->species_count)
        settings_refuse(s, "volume_shares", e, "must have one entry per species, %d", p->species_count);
    double sum = 0.0;
    for (int k = 0; k < shares; k++) {
        sum += share[k];
        if (!(share[k] >= 0.0))
            settings_refuse(s, "volume_shares", e, "must not be negative");
    }
    if (!error_raised(e) && !(sum > 0.0))
        settings_refuse(s, "volume_shares", e, "must not all be 0");
    if (!settings_done(s, e) || !particles_allocate(p, count, in->rotates, e))
        return false;

    const double stretch = cbrt(share_out(p, count, share, number) / (phi * in->box.volume));
    struct flow *flow = in->box.flow;
    mat3 cell = in->box.start, gradient = flow ? flow->largest : in->box.gradient;
    bool periodic[3];
    memcpy(periodic, in->box.periodic, sizeof periodic);
    for (int k = 0; k < 9; k++)
        cell.m[k / 3][k % 3] *= stretch;
    const double time = in->box.time;
    const bool made = box_new(&in->box, &cell, periodic, &gradient, e);
    in->box.flow = flow;
    if (!made)
        return false;
    box_set_time(&in->box, time);
    box_remap(&in->box);
    if (!place(in, number, e))
        return false;
    if (!minimise(in, &worst, e))
        return false;
    if (worst > overlap_allowed)
        return settings_refuse(s, "phi", e, "is too dense for a random start: after %d steps an overlap of %.2g radii is left (allowed %g)",
                               MOST_STEPS, worst, overlap_allowed);
    memset(p->image, 0, (size_t)count * sizeof *p->image);
    memset(p->velocity, 0, (size_t)count * sizeof *p->velocity);
    follow_flow(in);
    start_moving(p);
    return true;
}
