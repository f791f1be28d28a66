/*
 * Layer 6: a crowd described otherwise moves in the same way
 *
 * No reference value: one scene (spheres with contact, friction, drag and lubrication, sheared, without noise) is run, and run again
 * after a change that physics does not see. The second path must be the image of the first to rounding, which grows along the path:
 *
 *     x' = l Q x + s + V t ,   u' = (l/t) Q (u) + V ,   W' = det(Q) Q W / t ,   G' = Q G Q^T / t
 *
 * with units of length l, mass m and time t, a mirror or permutation of the axes Q, another origin s, another frame V (without drag). Other
 * numbers on the particles, another description of the same lattice (start.time later by whole strains, a cell with B + A for B,
 * with which the cell is remapped at other moments), two cells side by side as one, more outputs: nothing may change.
 *
 * Where forces from outside, or noise, know axes or labels, only the changes that they do not notice are made (parameters.only).
 *
 * These stand in the dense layer, not with two bodies, because they need a crowd: neighbour lists that are rebuilt, several
 * contacts per sphere, pairs across every face. The start is already sheared to a strain of 0.4 by the candidate itself, so that the
 * remap of the cell falls into the runs.
 */
#include "packing.h"
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct change {
    double length, mass, time, Q[3][3], origin[3], velocity[3];
    bool backwards;         /* ids in reverse order */
};
static const struct change nothing = { 1, 1, 1, { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } }, { 0, 0, 0 }, { 0, 0, 0 }, false };

struct crowd {
    json_t *scene;
    struct state_row *row;
    size_t count;
    double edge, rate, radius, dt;
    int steps;
};

static double handedness(const struct change *c)
{
    double n[3];
    cross(c->Q[0], c->Q[1], n);
    return dot(n, c->Q[2]);
}

/* Image of a place, a velocity and a spin at a time after the start (in old units). */
static void image(const struct change *c, const double x[3], const double u[3], const double w[3], double time, double out[9])
{
    double Q[3][3], hand = handedness(c);
    memcpy(Q, c->Q, sizeof Q);
    apply(Q, x, out);
    apply(Q, u, out + 3);
    apply(Q, w, out + 6);
    for (int k = 0; k < 3; k++) {
        out[k] = c->length * out[k] + c->origin[k] + c->velocity[k] * time * c->time;
        out[3 + k] = c->length / c->time * out[3 + k] + c->velocity[k];
        out[6 + k] *= hand / c->time;
    }
}

/* The scene in other units and axes; the cell is a cube at time 0, which Q takes to itself. */
static json_t *changed_scene(const struct crowd *crowd, const struct change *c, const struct model *m, double G[3][3])
{
    json_t *scene = scene_in_units(crowd->scene, &(struct units){ c->length, c->mass, c->time }), *shear = json_array();
    for (int f = 0; f < 3; f++)
        for (int g = 0; g < 3; g++) {
            G[f][g] = 0.0;
            for (int k = 0; k < 9; k++)
                G[f][g] += c->Q[f][k / 3] * m->gradient[k / 3][k % 3] * c->Q[g][k % 3] / c->time;
            const char flow[2] = { (char)('x' + f), 0 }, gradient[2] = { (char)('x' + g), 0 };
            if (G[f][g] != 0.0)
                json_array_append_new(shear, json_pack("{ss ss sf}", "flow", flow, "gradient", gradient, "rate", G[f][g]));
        }
    scene_set(scene, "shear", shear);
    return scene;
}

/* The states after the change; where the origin moves, so does the flow. */
static struct state_row *changed_rows(const struct crowd *crowd, const struct change *c, double G[3][3])
{
    struct state_row *row = calloc(crowd->count, sizeof *row);
    for (size_t i = 0; row && i < crowd->count; i++) {
        const struct state_row *old = &crowd->row[i];
        double now[9], flow[3];
        image(c, old->x, old->u, old->w, 0.0, now);
        apply(G, c->origin, flow);
        struct state_row *r = &row[c->backwards ? crowd->count - 1 - i : i];
        *r = (struct state_row){ .id = (int)(r - row) + 1, .species = old->species };
        for (int k = 0; k < 3; k++) {
            r->x[k] = now[k];
            r->u[k] = now[3 + k] + flow[k];
            r->w[k] = now[6 + k];
        }
    }
    return row;
}

/* Largest difference between a path and the image of the other, in radii, rate x edge and rate. */
static void judge(struct check_run *run, const char *what, const struct crowd *crowd, const struct change *c, double G[3][3],
                  const struct track *first, const struct track *second, double tolerance)
{
    const double unit[3] = { crowd->radius * c->length, fabs(crowd->rate) * crowd->edge * c->length / c->time, fabs(crowd->rate) / c->time };
    struct worst w[3] = { WORST_NONE, WORST_NONE, WORST_NONE };
    double flow[3];
    apply(G, c->origin, flow);
    for (size_t s = 0; s < first->steps; s++)
        for (size_t i = 0; i < crowd->count; i++) {
            const double time = crowd->dt * crowd->steps * (double)(s + 1) / (double)first->steps;
            const struct track_point *p = track_at(first, s, i), *q = track_at(second, s, c->backwards ? crowd->count - 1 - i : i);
            double now[9];
            image(c, p->x, p->u, p->w, time, now);
            for (int k = 0; k < 3; k++) {      /* the flow at the new origin carries everything along */
                now[k] += flow[k] * time * c->time;
                now[3 + k] += flow[k];
            }
            worst_see_vector(&w[0], q->x, now, 3, unit[0], i);
            worst_see_vector(&w[1], q->u, now + 3, 3, unit[1], i);
            if (isfinite(p->w[0]) && isfinite(q->w[0]))
                worst_see_vector(&w[2], q->w, now + 6, 3, unit[2], i);
        }
    const int k = w[1].error > w[0].error ? (w[2].error > w[1].error ? 2 : 1) : (w[2].error > w[0].error ? 2 : 0);
    check_error(run, INVARIANT, what, w[k].measured, w[k].expected, w[k].error, tolerance,
                "%s changes the path: %s of sphere %zu is %.9g instead of %.9g (positions differ by %.2g radii, velocities by %.2g, spins by %.2g)",
                what, k == 0 ? "place" : k == 1 ? "velocity" : "spin", w[k].at + 1, w[k].measured, w[k].expected, w[0].error, w[1].error, w[2].error);
}

static bool follow(struct check_run *run, const char *name, json_t *scene, const struct state_row *row, const struct crowd *crowd,
                   struct track *track)
{
    const int at[3] = { crowd->steps / 3, crowd->steps / 3 * 2, crowd->steps / 3 * 3 };
    return track_ask(run, name, scene, row, crowd->count, at, 3, track);
}

/* Run after a change and compare with `base`. False: no answer. */
static bool try_change(struct check_run *run, const char *name, const char *what, const struct crowd *crowd, const struct model *m,
                       const struct change *c, const struct track *base)
{
    double G[3][3];
    json_t *scene = changed_scene(crowd, c, m, G);
    struct state_row *row = changed_rows(crowd, c, G);
    struct track track;
    const bool answered = row && follow(run, name, scene, row, crowd, &track);
    if (answered) {
        judge(run, what, crowd, c, G, base, &track, run->gate_case->tolerance);
        track_free(&track);
    }
    free(row);
    json_decref(scene);
    return answered;
}

/* The same states in another description of the scene. */
static bool try_scene(struct check_run *run, const char *name, const char *what, const struct crowd *crowd, json_t *scene,
                      const struct track *base, double tolerance)
{
    double G[3][3] = { { 0 } };
    struct track track;
    const bool answered = follow(run, name, scene, crowd->row, crowd, &track);
    if (answered) {
        judge(run, what, crowd, &nothing, G, base, &track, tolerance);
        track_free(&track);
    }
    json_decref(scene);
    return answered;
}

/* Two cells side by side as one cell twice as long along the flow: every sphere has a double, which does what it does. */
static bool try_doubled(struct check_run *run, const struct crowd *crowd, const struct track *base)
{
    struct crowd two = *crowd;
    double G[3][3] = { { 0 } };
    struct track track;
    two.count = 2 * crowd->count;
    two.row = calloc(two.count, sizeof *two.row);
    two.scene = json_deep_copy(crowd->scene);
    scene_set(two.scene, "box.lengths", json_pack("[fff]", 2.0 * crowd->edge, crowd->edge, crowd->edge));
    for (size_t i = 0; two.row && i < two.count; i++) {
        two.row[i] = crowd->row[i % crowd->count];
        two.row[i].id = (int)i + 1;
        two.row[i].x[0] += i < crowd->count ? 0.0 : crowd->edge;
    }
    const bool answered = two.row && follow(run, "doubled", two.scene, two.row, &two, &track);
    if (answered) {
        judge(run, "two cells as one", crowd, &nothing, G, base, &track, run->gate_case->tolerance);
        track_free(&track);
    }
    free(two.row);
    json_decref(two.scene);
    return answered;
}

/* The run that wrote stresses: spheres that begin in contact have not slid yet, so before the first step no spring pulls along the contact. */
static void judge_start(struct check_run *run, const char *name, int steps)
{
    char path[PATH_LENGTH], out[PATH_LENGTH], why[WHY_LENGTH];
    struct table t;
    struct worst w = WORST_NONE;
    double normal = 0.0;
    path_join(out, run->work, name);
    path_join(path, out, "out/stress.csv");
    if (!table_has(path, "contact_tangential_xx")) {
        check_skip(run, "nothing has slid at the start", "the candidate writes no stress.csv with tangential parts");
        return;
    }
    if (!table_read(path, "step,contact_normal_xx,contact_normal_yy,contact_normal_zz,contact_tangential_xx,contact_tangential_xy,contact_tangential_xz,"
                          "contact_tangential_yx,contact_tangential_yy,contact_tangential_yz,contact_tangential_zx,contact_tangential_zy,contact_tangential_zz",
                    &t, why) || !table_expect_rows(&t, (size_t)(steps / 3) + 1, why)) {
        check_garbage(run, why);
        return;
    }
    for (size_t k = 1; t.rows > 0 && k < 4; k++)
        normal = fmax(normal, fabs(table_at(&t, 0, k)));
    for (size_t k = 0; t.rows > 0 && table_at(&t, 0, 0) == 0.0 && normal > 0.0 && k < 9; k++)
        worst_see(&w, table_at(&t, 0, 4 + k), 0.0, normal, k);
    table_free(&t);
    if (w.error >= 0.0)
        check_error(run, INVARIANT, "nothing has slid at the start", w.measured, w.expected, w.error, 1e-12, "before the first step the tangential stress of the contacts is "
                    "%.3g of the normal one; nothing has moved yet, so no spring is stretched", w.error);
}

/* Second half from what was written at the middle: without friction nothing is remembered but the half-step velocity. */
static bool try_split(struct check_run *run, const struct crowd *crowd)
{
    struct crowd whole = *crowd, half = *crowd;
    struct track first, second, rest = { 0 };
    const int at[2] = { crowd->steps / 2, crowd->steps / 2 * 2 };
    whole.scene = json_deep_copy(crowd->scene);
    scene_set(whole.scene, "forces.contact.friction", json_real(0.0));
    json_object_del(scene_get(whole.scene, "forces.contact"), "tangential_stiffness");
    json_object_del(scene_get(whole.scene, "forces.contact"), "lever");
    half.scene = json_deep_copy(whole.scene);
    half.row = calloc(crowd->count, sizeof *half.row);
    bool answered = track_ask(run, "whole", whole.scene, crowd->row, crowd->count, at, 2, &first);
    if (answered) {
        for (size_t i = 0; i < crowd->count; i++) {
            const struct track_point *p = track_at(&first, 0, i);
            half.row[i] = crowd->row[i];
            for (int k = 0; k < 3; k++) {
                half.row[i].x[k] = p->x[k];
                half.row[i].u[k] = p->u[k];
                half.row[i].w[k] = isfinite(p->w[k]) ? p->w[k] : 0.0;
            }
        }
        scene_set(half.scene, "start.time", json_real(scene_number(whole.scene, "start.time", 0.0) + at[0] * crowd->dt));
        answered = track_ask(run, "second-half", half.scene, half.row, crowd->count, at, 1, &second);
        if (answered) {
            double G[3][3] = { { 0 } };
            rest = (struct track){ 1, crowd->count, first.point + crowd->count };
            judge(run, "split in two", crowd, &nothing, G, &rest, &second, scene_number(run->gate_case->parameters, "split", NAN));
            track_free(&second);
        }
        track_free(&first);
    }
    free(half.row);
    json_decref(half.scene);
    json_decref(whole.scene);
    return answered;
}

/* Spheres where the case says (parameters.places, in a cell of parameters.edge), or at random. They start with the flow. */
static bool place(struct check_run *run, struct crowd *crowd, const struct packing_species kinds[2])
{
    const json_t *parameters = run->gate_case->parameters, *places = json_object_get(parameters, "places");
    char why[WHY_LENGTH] = "the gate is out of memory";
    crowd->edge = places ? scene_number(parameters, "edge", NAN) : packing_edge(kinds, 2, scene_number(parameters, "phi", NAN));
    crowd->row = calloc(crowd->count, sizeof *crowd->row);
    if (!crowd->row || (!places && !packing_make(kinds, 2, crowd->edge, crowd->rate, run->seed, crowd->row, why))) {
        check_garbage(run, why);
        return false;
    }
    for (size_t i = 0; places && i < crowd->count; i++) {
        struct state_row *r = &crowd->row[i];
        *r = (struct state_row){ .id = (int)i + 1, .species = i < (size_t)kinds[0].count ? 1 : 2 };
        for (int k = 0; k < 3; k++)
            r->x[k] = json_number_value(json_array_get(json_array_get(places, i), (size_t)k));
        r->u[0] = crowd->rate * r->x[1];
        r->w[2] = -0.5 * crowd->rate;
    }
    return true;
}

/* The crowd, sheared by the candidate for some strain: the start of all runs. */
static bool prepare(struct check_run *run, struct crowd *crowd)
{
    const json_t *parameters = run->gate_case->parameters;
    double count[2], strain = scene_number(parameters, "strain", NAN);
    size_t species;
    struct model m;
    struct track track;
    if (!model_read(run, crowd->scene, &m))
        return false;
    parameter_list(parameters, "counts", count, &species, 2);
    const struct packing_species kinds[2] = { { m.radius[0], (int)count[0] }, { m.radius[1], (int)count[1] } };
    crowd->count = (size_t)(kinds[0].count + kinds[1].count);
    crowd->rate = m.gradient[0][1];
    crowd->radius = m.radius[0];
    char step[96];
    step_key(crowd->scene, step);
    crowd->dt = scene_number(crowd->scene, step, NAN);
    crowd->steps = (int)scene_number(parameters, "steps", NAN);
    if (!place(run, crowd, kinds))
        return false;
    scene_set(crowd->scene, "box.lengths", json_pack("[fff]", crowd->edge, crowd->edge, crowd->edge));
    const int at = (int)(strain / (fabs(crowd->rate) * crowd->dt));
    json_t *scene = json_deep_copy(crowd->scene);
    const bool answered = track_ask(run, "preparation", scene, crowd->row, crowd->count, &at, 1, &track);
    json_decref(scene);
    if (!answered)
        return false;
    for (size_t i = 0; i < crowd->count; i++) {
        const struct track_point *p = track_at(&track, 0, i);
        memcpy(crowd->row[i].x, p->x, sizeof p->x);
        memcpy(crowd->row[i].u, p->u, sizeof p->u);
        memcpy(crowd->row[i].w, p->w, sizeof p->w);
    }
    track_free(&track);
    scene_set(crowd->scene, "start.time", json_real(at * crowd->dt));
    return true;
}

/* Changes that this scene allows: parameters.only, or all. Forces from outside know the axes and the origin; noise knows the labels. */
static bool wanted(struct check_run *run, const char *change)
{
    const json_t *only = json_object_get(run->gate_case->parameters, "only");
    return !only || case_lists(only, change);
}

static bool try_all(struct check_run *run, const struct crowd *crowd, const struct model *m, const struct track *base)
{
    const double L = crowd->edge, start = scene_number(crowd->scene, "start.time", 0.0), tolerance = run->gate_case->tolerance;
    struct change units = nothing, mirror = nothing, cyclic = nothing, origin = nothing, labels = nothing;
    units.length = 2.3, units.mass = 0.37, units.time = 1.9;
    mirror.Q[0][0] = -1;
    memcpy(cyclic.Q, (double[3][3]){ { 0, 0, 1 }, { 1, 0, 0 }, { 0, 1, 0 } }, sizeof cyclic.Q);
    memcpy(origin.origin, (double[3]){ 0.31 * L, -1.73 * L, 0.57 * L }, sizeof origin.origin);
    labels.backwards = true;

    json_t *later = json_deep_copy(crowd->scene), *tilted = json_deep_copy(crowd->scene), *watched = json_deep_copy(crowd->scene);
    scene_set(later, "start.time", json_real(start + 2.0 / fabs(crowd->rate)));
    json_object_del(scene_get(tilted, "box"), "lengths");
    scene_set(tilted, "box.cell", json_pack("[[fff][fff][fff]]", L, 0.0, 0.0, L, L, 0.0, -L, 0.0, L));
    scene_set(watched, "output.stress.every", json_integer(3));
    bool good = true;
    const struct { const char *name, *what; const struct change *change; json_t *scene; double tolerance; } tries[] = {
        { "units", "units", &units, NULL, tolerance },                    { "labels", "order of the particles", &labels, NULL, tolerance },
        { "mirror", "mirrored shear", &mirror, NULL, tolerance },         { "axes", "permuted axes", &cyclic, NULL, tolerance },
        { "origin", "moved origin", &origin, NULL, tolerance },           { "later", "start two strains later", NULL, later, tolerance },
        { "tilted", "another cell of the same lattice", NULL, tilted, tolerance }, { "watched", "more outputs", NULL, watched, 1e-15 } };
    for (size_t k = 0; k < sizeof tries / sizeof *tries; k++) {
        if (!wanted(run, tries[k].name))
            json_decref(tries[k].scene);
        else if (tries[k].change)
            good &= try_change(run, tries[k].name, tries[k].what, crowd, m, tries[k].change, base);
        else
            good &= try_scene(run, tries[k].name, tries[k].what, crowd, tries[k].scene, base, tries[k].tolerance);
    }
    good = good && (!wanted(run, "doubled") || try_doubled(run, crowd, base));
    if (good && wanted(run, "watched") && scene_number(crowd->scene, "forces.contact.tangential_damping", 0.0) == 0.0)
        judge_start(run, "watched", crowd->steps);
    return good && (!wanted(run, "split") || try_split(run, crowd));
}

/* Without drag no frame is special: the whole crowd drifts along all three axes, through all faces. */
static bool try_frame(struct check_run *run, const struct crowd *crowd, const struct model *m)
{
    struct crowd free_crowd = *crowd;
    struct change frame = nothing;
    struct track base;
    const double across = 0.4 * crowd->edge / (crowd->steps * crowd->dt);
    memcpy(frame.velocity, (double[3]){ across, -1.3 * across, 0.9 * across }, sizeof frame.velocity);
    free_crowd.scene = json_deep_copy(crowd->scene);
    json_object_del(scene_get(free_crowd.scene, "forces"), "drag");
    const bool answered = follow(run, "no-drag", free_crowd.scene, crowd->row, crowd, &base);
    if (answered) {
        try_change(run, "frame", "moving frame", &free_crowd, m, &frame, &base);
        track_free(&base);
    }
    json_decref(free_crowd.scene);
    return answered;
}

void check_metamorphic(struct check_run *run)
{
    struct crowd crowd = { .scene = json_deep_copy(run->gate_case->scene) };
    struct model m;
    struct track base;
    if (prepare(run, &crowd) && model_read(run, crowd.scene, &m)) {
        json_t *scene = json_deep_copy(crowd.scene);
        if (follow(run, "base", scene, crowd.row, &crowd, &base)) {
            if (try_all(run, &crowd, &m, &base) && wanted(run, "frame"))
                try_frame(run, &crowd, &m);
            track_free(&base);
        }
        json_decref(scene);
    }
    free(crowd.row);
    json_decref(crowd.scene);
}
