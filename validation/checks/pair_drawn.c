/*
 * Layer 1: what nobody thought of
 *
 * Scenes drawn at random over what a scene may say: one to five sizes up to twenty to one, held and driven ones, any sum of shears that keeps a
 * cell, at any time before or after 0, cells that lean, faces that are open, every contact and friction law with and without dashpots, both
 * forms of the repulsion, any cut-offs, drag with and without torque, constant loads; a dozen spheres that overlap, nearly touch or stand far outside the
 * cell, with histories. Force, torque and stress of every origin against the sum over all images (crowd.c): a law that is right for the
 * numbers of the other cases and wrong for others shows here.
 */
#include "crowd.h"
#include "pair_checks.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SPHERES = 12 };

static double between(gsl_rng *random, double low, double high) { return low + (high - low) * gsl_rng_uniform(random); }
static double between_logs(gsl_rng *random, double low, double high) { return low * pow(high / low, gsl_rng_uniform(random)); }
static bool chance(gsl_rng *random, double p) { return gsl_rng_uniform(random) < p; }
static size_t one_of(gsl_rng *random, size_t count) { return gsl_rng_uniform_int(random, count); }

static json_t *vector(gsl_rng *random, double size)
{
    double v[3];
    random_vector(random, size, v);
    return json_pack("[fff]", v[0], v[1], v[2]);
}

static json_t *draw_species(gsl_rng *random, double *largest)
{
    json_t *list = json_array();
    const size_t count = 1 + one_of(random, 5);
    *largest = 0.0;
    for (size_t k = 0; k < count; k++) {
        const double radius = between_logs(random, 0.2, 4.0);
        char name[32];
        snprintf(name, sizeof name, "s%zu", k + 1);
        json_t *one = json_pack("{sssfsf}", "name", name, "radius", radius, "density", between_logs(random, 0.1, 10.0));
        if (chance(random, 0.15))
            json_object_set_new(one, "motion", json_string("held"));
        else if (chance(random, 0.15))
            json_object_set_new(one, "motion", json_pack("{soso}", "velocity", vector(random, 0.8), "spin", vector(random, 0.6)));
        json_array_append_new(list, one);
        *largest = fmax(*largest, radius);
    }
    return list;
}

/* One or two shears, no axis both a flow and a gradient axis. */
static json_t *draw_flow(gsl_rng *random, double *rate)
{
    static const char *const axis[3] = { "x", "y", "z" };
    static const int sums[4][2][2] = { { { 0, 1 } }, { { 0, 2 }, { 1, 2 } }, { { 0, 1 }, { 0, 2 } }, { { 0, 1 }, { 0, 1 } } };
    static const int counts[4] = { 1, 2, 2, 2 };
    int order[3] = { 0, 1, 2 };
    gsl_ran_shuffle(random, order, 3, sizeof *order);
    const size_t kind = one_of(random, 4);
    json_t *list = json_array();
    *rate = 0.0;
    for (int k = 0; k < counts[kind]; k++) {
        const double one = (chance(random, 0.5) ? 1 : -1) * between_logs(random, 0.03, 1.0);
        json_array_append_new(list, json_pack("{sssssf}", "flow", axis[order[sums[kind][k][0]]], "gradient", axis[order[sums[kind][k][1]]], "rate", one));
        *rate += fabs(one);
    }
    return list;
}

/* Holds a dozen spheres of the largest size at a volume fraction of up to a third; leans where all faces are closed, in any direction where nothing flows. */
static json_t *draw_box(gsl_rng *random, double largest, bool leans, bool flows)
{
    const double edge = fmax(2.2 * largest, cbrt(SPHERES * 4.0 / 3.0 * M_PI * pow(largest, 3) * between_logs(random, 0.1, 1.0) / 0.33));
    double L[3];
    for (int k = 0; k < 3; k++)
        L[k] = edge * between(random, 1.0, 1.4);
    if (!leans)
        return json_pack("{s[fff]s[bbb]}", "lengths", L[0], L[1], L[2], "periodic", chance(random, 0.8), chance(random, 0.8), chance(random, 0.8));
    const double b = between(random, -0.5, 0.5) * L[0], c = between(random, -0.5, 0.5) * L[0], d = between(random, -0.5, 0.5) * L[1];
    double edge_of[3][3] = { { L[0], 0.0, 0.0 }, { b, L[1], 0.0 }, { c, d, L[2] } }, Q[3][3];
    random_rotation(random, Q);
    for (int v = 0; v < 3 && !flows; v++)
        apply(Q, edge_of[v], edge_of[v]);
    const double (*e)[3] = (const double (*)[3])edge_of;
    return json_pack("{s[[fff][fff][fff]]s[bbb]}", "cell", e[0][0], e[0][1], e[0][2], e[1][0], e[1][1], e[1][2], e[2][0], e[2][1], e[2][2], "periodic", 1, 1, 1);
}

static json_t *draw_contact(gsl_rng *random, size_t species)
{
    static const char *const laws[] = { "plain", "critical", "soft", "shifted", "binary" };
    static const char *const loads[] = { "spring", "damped", "absolute" };
    json_t *contact = json_pack("{sfsfsfss}", "normal_stiffness", between_logs(random, 1.0, 1e4), "tangential_stiffness", between_logs(random, 1.0, 1e4),
                                "friction", chance(random, 0.2) ? 0.0 : between_logs(random, 0.05, 5.0), "lever", chance(random, 0.5) ? "radius" : "contact");
    const size_t law = one_of(random, 6);
    if (law < 5)
        json_object_set_new(contact, "law", json_string(laws[law]));
    if (law >= 1 && law <= 3)
        json_object_set_new(contact, "critical_load", json_real(between_logs(random, 0.03, 30.0)));
    if (law == 4) {
        json_t *rough = json_array();
        for (size_t k = 0; k < species; k++)
            json_array_append_new(rough, json_boolean(chance(random, 0.6)));
        json_object_set_new(contact, "rough", rough);
    }
    if (chance(random, 0.4))
        return contact;
    if (chance(random, 0.5))
        json_object_set_new(contact, "restitution", json_real(chance(random, 0.5) ? between(random, 0.05, 1.0) : between_logs(random, 1e-6, 0.05)));
    else
        json_object_set_new(contact, "normal_damping", json_real(between_logs(random, 0.01, 30.0)));
    json_object_set_new(contact, "tangential_damping", json_real(chance(random, 0.2) ? 0.0 : between_logs(random, 0.01, 30.0)));
    json_object_set_new(contact, "tension", json_string(chance(random, 0.5) ? "allow" : "clip"));
    json_object_set_new(contact, "cap", json_string(loads[one_of(random, 3)]));
    return contact;
}

static json_t *draw_repulsion(gsl_rng *random)
{
    const bool energy = chance(random, 0.5);
    return json_pack("{sssfsfsf}", "form", energy ? "energy" : "force", energy ? "energy" : "force", between_logs(random, 0.01, 10.0),
                     "kappa_factor", between_logs(random, 0.005, 0.1), "cutoff", between(random, 1.0, 8.0));
}

static json_t *draw_forces(gsl_rng *random, const json_t *species)
{
    json_t *forces = json_object();
    if (chance(random, 0.8))
        json_object_set_new(forces, "contact", draw_contact(random, json_array_size(species)));
    if (chance(random, 0.6))
        json_object_set_new(forces, "drag", json_pack("{sb}", "torque", chance(random, 0.6)));
    if (chance(random, 0.6)) {
        const double outer = between_logs(random, 0.02, 0.99);
        json_object_set_new(forces, "lubrication", json_pack("{sfsfss}", "inner_gap", outer * between_logs(random, 1e-3, 0.5), "outer_gap", outer,
                                                             "rotation_correction", chance(random, 0.5) ? "none" : "exact"));
    }
    if (chance(random, 0.6) || json_object_size(forces) == 0)
        json_object_set_new(forces, "repulsion", draw_repulsion(random));
    if (chance(random, 0.4)) {
        const char *first = json_string_value(json_object_get(json_array_get(species, one_of(random, json_array_size(species))), "name"));
        json_object_set_new(forces, "applied", json_pack("{s{soso}}", first, "force", vector(random, 3.0), "torque", vector(random, 2.0)));
    }
    return forces;
}

/* A flow carries what crosses a face: where its gradient axis is closed, the flow's own axis has to be. */
static void close_faces(json_t *periodic, const json_t *shear)
{
    for (size_t k = 0; k < json_array_size(shear); k++) {
        const json_t *one = json_array_get(shear, k);
        const size_t flow = (size_t)(*json_string_value(json_object_get(one, "flow")) - 'x'), gradient = (size_t)(*json_string_value(json_object_get(one, "gradient")) - 'x');
        if (json_is_true(json_array_get(periodic, gradient)))
            json_array_set_new(periodic, flow, json_true());
    }
}

static json_t *draw_scene(gsl_rng *random)
{
    double largest, rate = 0.0;
    const bool leans = chance(random, 0.3);
    json_t *species = draw_species(random, &largest), *shear = chance(random, 0.75) ? draw_flow(random, &rate) : NULL;
    json_t *scene = json_pack("{sis{sfsf}sosososo}", "dimensions", 3, "fluid", "viscosity", between_logs(random, 0.1, 10.0), "kT", 0.0, "species", species,
                              "box", draw_box(random, largest, leans, shear != NULL), "forces", draw_forces(random, species), "dynamics",
                              json_pack("{s{sf}}", "verlet", "dt", 1e-6));
    if (shear) {        /* a cell that leans already is kept compact along its own edges only: little strain */
        const double strain = between(random, -1.0, 1.0) * (leans ? 0.3 : 3.0);
        json_object_set_new(scene, "shear", shear);
        close_faces(json_object_get(json_object_get(scene, "box"), "periodic"), shear);
        json_object_set_new(scene, "start", json_pack("{sf}", "time", strain / rate));
    }
    return scene;
}

/* Overlap over the smaller radius, if it is above *data (a double), goes there. */
static void note_depth(struct crowd *c, size_t i, size_t j, const double shift[3], void *deepest)
{
    double smallest = INFINITY;
    const double a = c->sphere[i].s.radius, b = c->sphere[j].s.radius;
    crowd_note_gap(c, i, j, shift, &smallest);
    *(double *)deepest = fmax(*(double *)deepest, -smallest * (a + b) / fmin(a, b));
}

/* Beside one that is there, overlapping or within twice the range, or anywhere; false if that overlaps another too much. */
static bool place_one(struct crowd *c, gsl_rng *random, size_t k, double overlap)
{
    double *x = c->sphere[k].s.x, n[3], deepest = 0.0;
    if (k > 0 && chance(random, 0.8)) {
        const struct theory_sphere *other = &c->sphere[one_of(random, k)].s;
        const double sizes = other->radius + c->sphere[k].s.radius, smaller = fmin(other->radius, c->sphere[k].s.radius);
        const double gap = chance(random, 0.5) ? -overlap * gsl_rng_uniform(random) * smaller / sizes : between_logs(random, 1e-3, 2.0 * (crowd_range(c, k, k) / sizes + 0.01));
        random_direction(random, n);
        for (int d = 0; d < 3; d++)
            x[d] = other->x[d] + sizes * (1.0 + gap) * n[d];
    } else
        crowd_anywhere(c, random, k);
    for (size_t j = 0; j <= k && deepest <= overlap; j++)
        crowd_each_image(c, j, k, 1.001 * crowd_range(c, j, k), note_depth, &deepest);
    return deepest <= overlap;
}

/* Brought to another image, up to three cells away along every closed axis, with the velocity it has there. */
static void move_far(struct crowd *c, gsl_rng *random, size_t k)
{
    struct theory_sphere *s = &c->sphere[k].s;
    double shift[3] = { 0 }, change[3];
    for (int v = 0; v < 3; v++) {
        const double cells = c->m.open[v] ? 0.0 : (double)one_of(random, 7) - 3.0;
        for (int d = 0; d < 3; d++)
            shift[d] += cells * c->m.cell[v][d];
    }
    apply(c->m.gradient, shift, change);
    for (int d = 0; d < 3; d++) {
        s->x[d] += shift[d];
        s->u[d] += change[d];
    }
}

json_t *drawn_crowd(struct check_run *run, gsl_rng *random, bool histories, struct crowd *c)
{
    json_t *scene = draw_scene(random);
    if (!crowd_of_scene(run, scene, c)) {
        json_decref(scene);
        return NULL;
    }
    const double overlap = between_logs(random, 1e-3, histories ? 0.2 : 0.05);       /* of the smaller radius; a run stops at 0.1 */
    c->sphere = calloc(SPHERES, sizeof *c->sphere);
    for (int tries = 0; c->count < SPHERES && tries < 3000; tries++) {
        struct crowd_sphere *s = &c->sphere[c->count];
        s->species = 1 + (int)one_of(random, c->m.species);
        s->s.radius = c->m.radius[s->species - 1];
        c->count += place_one(c, random, c->count, overlap);
    }
    for (size_t k = 0; k < c->count; k++) {
        struct theory_sphere *s = &c->sphere[k].s;
        const size_t kind = (size_t)c->sphere[k].species - 1;
        random_vector(random, 0.9, s->u);
        random_vector(random, 0.9, s->w);
        for (int d = 0; d < 3 && c->m.driven[kind]; d++) {
            s->u[d] = c->m.velocity[kind][d];
            s->w[d] = c->m.spin[kind][d];
        }
    }
    if (histories && c->present[CONTACT] && c->m.contact.friction > 0)
        crowd_give_histories(c, random, between_logs(random, 1e-4, 0.1));
    for (size_t k = 0; k < c->count; k++)
        if (!c->m.driven[c->sphere[k].species - 1] && chance(random, 0.3))
            move_far(c, random, k);
    return scene;
}

void pair_drawn(struct check_run *run)
{
    const int scenes = (int)scene_number(run->gate_case->parameters, "scenes", 0);
    gsl_rng *random = pair_random(run);
    struct crowd_verdict v;
    bool answered = true;
    crowd_verdict_start(&v);
    for (int k = 0; k < scenes && answered; k++) {
        struct crowd c = { 0 };
        char name[32];
        snprintf(name, sizeof name, "scene %d", k + 1);
        json_t *scene = drawn_crowd(run, random, true, &c);
        memset(v.right_at_rest, 0, sizeof v.right_at_rest);     /* of another scene */
        answered = scene && crowd_see(run, name, scene, &c, &v);
        crowd_free(&c);
        json_decref(scene);
    }
    gsl_rng_free(random);
    if (answered)
        crowd_judge(run, &v, "");
}
