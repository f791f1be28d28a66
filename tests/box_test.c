/* The sheared cell and the search for neighbours, against brute force over all images. */
#include "suite.h"

#include "core/neighbours.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static double uniform(void) { return (double)rand() / RAND_MAX; }

static mat3 one_shear(int flow, int gradient, double rate)
{
    mat3 G = { { { 0.0 } } };
    G.m[flow][gradient] = rate;
    return G;
}

static struct box box_of(double x, double y, double z, mat3 G)
{
    const mat3 cell = { { { x, 0, 0 }, { 0, y, 0 }, { 0, 0, z } } };
    const bool periodic[3] = { true, true, true };
    struct error e = { 0 };
    struct box b;
    check_true(box_new(&b, &cell, periodic, &G, &e), e.text);
    return b;
}

/* Particles of two sizes at random in and around the cell, at rest in the flow. */
static void crowd(struct particles *p, int count, const struct box *b)
{
    struct error e = { 0 };
    memset(p, 0, sizeof *p);
    p->species_count = 2;
    p->kind[0] = species_sphere("a", 0.5, 1.0);
    p->kind[1] = species_sphere("b", 0.7, 1.0);
    check_true(particles_allocate(p, count, true, &e), "memory");
    for (int i = 0; i < count; i++) {
        p->species[i] = rand() % 2;
        p->position[i] = mat3_times(&b->cell, vec(3 * uniform() - 1, 3 * uniform() - 1, 3 * uniform() - 1));
        p->velocity[i] = box_flow(b, p->position[i]);
    }
}

static void search_for(struct neighbours *n, const struct particles *p, double factor)
{
    struct error e = { 0 };
    memset(n, 0, sizeof *n);
    for (int a = 0; a < 2; a++)
        for (int c = 0; c < 2; c++)
            n->range[a][c] = factor * (p->kind[a].radius + p->kind[c].radius);
    check_true(neighbours_start(n, p, &e), e.text);
}

/* Number of pairs within range and the sum of their normals' second moments, over all images within a generous span. */
static int brute_force(const struct box *b, const struct particles *p, double factor, double *moment)
{
    int pairs = 0;
    *moment = 0.0;
    for (int i = 0; i < p->count; i++)
        for (int j = i; j < p->count; j++)
            for (int x = -6; x <= 6; x++)
                for (int y = -6; y <= 6; y++)
                    for (int z = -6; z <= 6; z++) {
                        if (i == j && (z < 0 || (z == 0 && (y < 0 || (y == 0 && x <= 0)))))
                            continue;
                        const int shift[3] = { x, y, z };
                        const vec3 r = minus(plus(p->position[j], box_offset(b, shift)), p->position[i]);
                        if (norm(r) <= factor * (radius_of(p, i) + radius_of(p, j))) {
                            pairs++;
                            *moment += r.x * r.y + 0.3 * r.z * r.z + 0.1 * r.x * r.z;
                        }
                    }
    return pairs;
}

static void finds_every_pair(double x, double y, double z, int count, double factor, mat3 G)
{
    struct box b = box_of(x, y, z, G);
    struct particles p;
    struct neighbours n;
    struct error e = { 0 };
    bool relisted;
    crowd(&p, count, &b);
    search_for(&n, &p, factor);
    for (int step = 0; step < 12; step++) {
        check_true(neighbours_find(&n, &b, &p, &relisted, &e), e.text);
        double expected, moment = 0.0;
        const int pairs = brute_force(&b, &p, factor, &expected);
        for (int k = 0; k < n.near.count; k++) {
            const vec3 r = scaled(n.near.pair[k].normal, n.near.pair[k].distance);
            moment += r.x * r.y + 0.3 * r.z * r.z + 0.1 * r.x * r.z;
        }
        check_close(n.near.count, pairs, 0, "pairs found");
        check_close(moment, expected, 1e-11 * (1 + pairs), "moment of the pairs: rounding of a sum");
        for (int i = 0; i < p.count; i++) {                         /* follow the flow and jitter */
            const vec3 jitter = vec(0.02 * uniform() - 0.01, 0.02 * uniform() - 0.01, 0.02 * uniform() - 0.01);
            p.position[i] = plus(p.position[i], plus(scaled(box_flow(&b, p.position[i]), 0.13), jitter));
        }
        box_set_time(&b, b.time + 0.13);
    }
    neighbours_free(&n);
    particles_free(&p);
}

static void pairs_in_boxes_of_all_kinds(void)
{
    srand(3);
    finds_every_pair(9.1, 7.3, 8.7, 120, 1.2, one_shear(0, 1, 0.0));
    finds_every_pair(9.1, 7.3, 8.7, 120, 1.2, one_shear(0, 1, -0.9));
    finds_every_pair(2.1, 2.6, 3.0, 9, 1.4, one_shear(0, 1, 1.1));          /* several images of a pair, and own images */
    finds_every_pair(1.3, 9.0, 2.2, 12, 1.5, one_shear(2, 0, 0.8));
}

static void pairs_in_all_six_planes_and_two_shears(void)
{
    srand(4);
    for (int f = 0; f < 3; f++)
        for (int g = 0; g < 3; g++)
            if (f != g)
                finds_every_pair(5.1, 6.3, 4.7, 40, 1.2, one_shear(f, g, f > g ? 0.7 : -0.9));
    mat3 G = one_shear(0, 1, 0.6);
    G.m[2][1] = -0.8;
    finds_every_pair(5.1, 6.3, 4.7, 40, 1.2, G);                            /* crosswise: two flows, one gradient */
    G = one_shear(0, 1, 0.6);
    G.m[0][2] = 0.5;
    finds_every_pair(5.1, 6.3, 4.7, 40, 1.2, G);                            /* one flow, two gradients */
}

static void circular_flow_is_refused(void)
{
    const mat3 cell = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    const bool periodic[3] = { true, true, true };
    mat3 G = one_shear(0, 1, 1.0);
    G.m[1][0] = 1.0;
    struct box b;
    struct error e = { 0 };
    check_true(!box_new(&b, &cell, periodic, &G, &e) && e.code == ERROR_INPUT, "x along y with y along x");
    struct error chained = { 0 }, flat = { 0 };
    G = one_shear(0, 1, 1.0);
    G.m[1][2] = 1.0;
    check_true(!box_new(&b, &cell, periodic, &G, &chained) && chained.code == ERROR_INPUT, "x along y with y along z");
    const mat3 none = { { { 0.0 } } };
    check_true(!box_new(&b, &none, periodic, &G, &flat), "flat cell");
}

/* Wrapping and remap only name other images: unwrapped positions and peculiar velocities stay, whatever happened. */
static void wrapping_changes_no_physics(void)
{
    srand(5);
    mat3 G = one_shear(0, 1, 0.6);
    G.m[0][2] = 0.5;
    struct box b = box_of(5.1, 6.3, 4.7, G);
    struct particles p;
    crowd(&p, 50, &b);
    vec3 before[50], peculiar[50];
    for (int i = 0; i < 50; i++) {
        p.velocity[i] = plus(p.velocity[i], vec(uniform(), uniform(), uniform()));
        before[i] = p.position[i];
        peculiar[i] = minus(p.velocity[i], box_flow(&b, p.position[i]));
    }
    for (int round = 0; round < 5; round++) {
        box_remap(&b);
        box_wrap(&b, &p);
        for (int i = 0; i < 50; i++) {
            const vec3 off = box_unwrapped(&b, p.image[i]), x = plus(p.position[i], off);
            const vec3 c = minus(p.velocity[i], box_flow(&b, p.position[i]));
            check_close(norm(minus(x, before[i])), 0, 1e-12, "unwrapped position: rounding of a few cells' offsets");
            check_close(norm(minus(c, peculiar[i])), 0, 1e-12, "peculiar velocity");
            const vec3 f = mat3_times(&b.inverse, p.position[i]);
            check_true(f.x > -1e-12 && f.x < 1 + 1e-12 && f.y > -1e-12 && f.y < 1 + 1e-12 && f.z > -1e-12 && f.z < 1 + 1e-12, "inside the cell");
        }
        for (int i = 0; i < 50; i++) {                              /* everything moves with the flow to a later time */
            const mat3 F = box_deformation(&b, b.time, b.time + 1.7);
            p.position[i] = mat3_times(&F, p.position[i]);
            before[i] = mat3_times(&F, before[i]);
            p.velocity[i] = plus(peculiar[i], box_flow(&b, p.position[i]));
        }
        box_set_time(&b, b.time + 1.7);
    }
    check_true(b.lattice[0][1] != 0 && b.lattice[0][2] != 0, "the cell was remapped on the way");
    check_close(b.volume, 5.1 * 6.3 * 4.7, 1e-11, "volume");
    particles_free(&p);
}

/* A history belongs to a pair and an image: it must survive wrapping, remap and new lists, and end with the contact. */
static void history_survives_remap(void)
{
    struct box b = box_of(6, 6, 6, one_shear(0, 1, 1.0));
    struct particles p;
    struct neighbours n;
    struct error e = { 0 };
    bool relisted;
    srand(6);
    crowd(&p, 2, &b);
    p.species[0] = p.species[1] = 0;
    vec3 where[2] = { vec(2.9, 5.8, 1.0), vec(2.9, 6.7, 1.0) };     /* unwrapped; touching across the y face */
    search_for(&n, &p, 1.3);
    n.keeps_history = true;
    for (int step = 0; step < 60; step++) {                         /* the pair moves as one, through faces and remaps */
        for (int i = 0; i < 2; i++) {
            where[i] = plus(where[i], vec(0.35, 0.31, -0.2));
            p.position[i] = minus(where[i], box_unwrapped(&b, p.image[i]));
        }
        check_true(neighbours_find(&n, &b, &p, &relisted, &e) && n.near.count == 1, "one pair");
        if (n.near.count != 1)
            break;
        if (step == 0)
            *n.near.pair[0].history = vec(1e-3, 2e-3, 3e-3);
        check_close(norm(minus(*n.near.pair[0].history, vec(1e-3, 2e-3, 3e-3))), 0, 0, "history");
        check_close(norm(minus(n.near.pair[0].normal, vec(0, 1, 0))), 0, 1e-12, "normal: rounding of a few cells' offsets");
        box_set_time(&b, b.time + 0.1);
    }
    check_true(n.made > 10 && b.lattice[0][1] != 0, "lists were made anew and the cell remapped");
    p.position[0] = minus(where[0], box_unwrapped(&b, p.image[0]));
    where[1].y += 5e-1;
    p.position[1] = minus(where[1], box_unwrapped(&b, p.image[1]));
    check_true(neighbours_find(&n, &b, &p, &relisted, &e) && n.near.count == 0, "parted");
    where[1].y -= 5e-1;
    p.position[1] = minus(where[1], box_unwrapped(&b, p.image[1]));
    check_true(neighbours_find(&n, &b, &p, &relisted, &e) && n.near.count == 1, "met again");
    check_close(norm(*n.near.pair[0].history), 0, 0, "history of a new contact");
    neighbours_free(&n);
    particles_free(&p);
}

static void lost_particles_are_named(void)
{
    struct box b = box_of(6, 6, 6, one_shear(0, 1, 0.0));
    struct particles p;
    struct neighbours n;
    struct error e = { 0 };
    bool relisted;
    crowd(&p, 3, &b);
    p.position[1].y = NAN;
    search_for(&n, &p, 1.0);
    check_true(!neighbours_find(&n, &b, &p, &relisted, &e) && strstr(e.text, "particle 2"), "NaN names the particle");
    struct error same = { 0 };
    p.position[1] = p.position[0];
    check_true(!neighbours_find(&n, &b, &p, &relisted, &same) && strstr(same.text, "same centre"), "coincident centres");
    neighbours_free(&n);
    struct box sheet = box_of(6, 6, 0.01, one_shear(0, 1, 0.0));
    struct error thin = { 0 };
    search_for(&n, &p, 1.0);
    check_true(!neighbours_find(&n, &sheet, &p, &relisted, &thin) && thin.code == ERROR_RUN && strstr(thin.text, "0.01 thin"), "a cell with hundreds of images within range");
    neighbours_free(&n);
    particles_free(&p);
}

/* Steps that meet a tilt of exactly half a cell, give or take rounding: the flip must not undo itself for ever (this test would hang). */
static void half_a_cell_is_remapped_once(void)
{
    const mat3 flow = { { { 0, 0.1, 0 }, { 0 }, { 0 } } };
    const bool periodic[3] = { true, true, true };
    for (int k = 0; k < 200; k++) {
        const double edge = 10.385666856777812 + 0.01 * k;
        const mat3 cell = { { { edge, 0, 0 }, { 0, edge, 0 }, { 0, 0, edge } } };
        struct box b;
        struct error e = { 0 };
        check_true(box_new(&b, &cell, periodic, &flow, &e), e.text);
        for (int n = 0; n < 40; n++) {
            box_set_time(&b, (1250 + 2500 * n) * 0.004);    /* strain n + 1/2 */
            box_remap(&b);
            if (fabs(b.cell.m[0][1] / edge) > 0.5 + 1e-9)
                check_close(b.cell.m[0][1] / edge, 0.5, 1e-9, "tilt after a remap");
        }
    }
}

/* An edge that has a part along the gradient axis is carried along, whatever it is called; it stays as short as it can be. */
static void leaning_edges_stay_compact(void)
{
    const mat3 flow = { { { 0, 0.7, 0 }, { 0 }, { 0 } } }, cell = { { { 10, 0, 0 }, { 0, 10, 3 }, { 0, 0, 10 } } };
    const bool periodic[3] = { true, true, true };
    struct box b;
    struct error e = { 0 };
    check_true(box_new(&b, &cell, periodic, &flow, &e), e.text);
    for (int n = 0; n < 400; n++) {
        box_set_time(&b, 7.3 * n);
        box_remap(&b);
        for (int c = 1; c < 3; c++)
            check_true(fabs(b.cell.m[0][c]) <= 5.0 + 1e-6, "lean of B and C");
        check_true(box_width(&b, 0) > 5.0, "width");
    }
}

/* Two particles of one rigid body never interact; in open directions nobody has images. */
static void bodies_and_open_sides(void)
{
    const mat3 cell = { { { 4, 0, 0 }, { 0, 4, 0 }, { 0, 0, 4 } } }, still = { { { 0.0 } } };
    const bool periodic[3] = { true, false, true };
    struct box b;
    struct particles p;
    struct neighbours n;
    struct error e = { 0 };
    bool relisted;
    check_true(box_new(&b, &cell, periodic, &still, &e), e.text);
    crowd(&p, 4, &b);
    p.position[0] = vec(0.1, 0.1, 2.0);
    p.position[1] = vec(3.9, 0.1, 2.0);         /* neighbour of 0 through the x face */
    p.position[2] = vec(0.1, 3.9, 2.0);         /* no neighbour of 0: y is open */
    p.position[3] = vec(0.1, 4.6, 2.0);         /* outside the cell, near 2 */
    search_for(&n, &p, 1.0);
    check_true(neighbours_find(&n, &b, &p, &relisted, &e), e.text);
    check_close(n.near.count, 2, 0, "pairs 0-1 and 2-3");
    p.body = malloc(4 * sizeof *p.body);
    p.body[0] = p.body[1] = 7;
    p.body[2] = p.body[3] = -1;
    check_true(neighbours_start(&n, &p, &e) && neighbours_find(&n, &b, &p, &relisted, &e), e.text);
    check_close(n.near.count, 1, 0, "only 2-3 once 0 and 1 are one body");
    neighbours_free(&n);
    particles_free(&p);
}

static const struct unit_test tests[] = {
    { "every pair in small, large and flat boxes", pairs_in_boxes_of_all_kinds },
    { "every pair in six shear planes and two shears at once", pairs_in_all_six_planes_and_two_shears },
    { "circular flows and flat cells are refused", circular_flow_is_refused },
    { "wrapping and remap change no physics", wrapping_changes_no_physics },
    { "contact history survives faces and remaps", history_survives_remap },
    { "a tilt of half a cell is remapped once", half_a_cell_is_remapped_once },
    { "leaning edges stay compact", leaning_edges_stay_compact },
    { "lost and coincident particles are named", lost_particles_are_named },
    { "bodies and open sides", bodies_and_open_sides },
    { NULL, NULL }
};
const struct suite box_suite = { "box", tests };
