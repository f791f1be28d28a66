/*
 * The same physics seen from elsewhere. In a flow U(x) = G x nothing changes when
 *   one sphere is replaced by its image, shifted by a lattice vector d with velocity + G d (26 neighbours, so that the
 *     pair is asked across every face, edge and corner of the strained cell);
 *   the whole pair is moved by any d with velocity + G d, in particular across faces;
 *   both get the same extra velocity (not for drag, which knows the flow);
 *   everything is turned (only without flow: the cell and the flow have directions).
 * All of these are invariants of the candidate's own numbers. Wrong image velocities, remaps, and offsets end here.
 */
#include "pair_checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum motion { INSIDE, IMAGE, MOVED, GALILEI, TURNED, MOTIONS };
static const char *const motion_name[MOTIONS] = { "inside", "across faces", "moved", "Galilean shift", "turned" };
static const char *const motion_fault[MOTIONS] = {
    "", "the force changes when sphere 2 is replaced by its image across a face of the cell",
    "the force changes when the pair is moved as a whole with the flow", "the force changes when both spheres get the same velocity",
    "the force does not turn with the pair"
};

/* What was done to a state: which state it must equal, and how its answer is turned back. */
struct view { enum motion motion; size_t base; double turn[3][3]; int shift[3]; bool faster /* the image has another velocity */; };
/* Images that are wrong, apart for those that move like the original ([0]) and those with another velocity ([1]). */
struct images { size_t seen[2], wrong[2]; };
struct views { struct pair_book book; struct view *view; };

static void add_view(struct views *v, const struct pair_state *p, const struct view *how)
{
    book_add(&v->book, p);
    v->view = realloc(v->view, v->book.count * sizeof *v->view);
    v->view[v->book.count - 1] = *how;
}

static void move(struct model *m, struct theory_sphere *s, const double d[3])
{
    double change[3];
    apply(m->gradient, d, change);
    for (int k = 0; k < 3; k++) {
        s->x[k] += d[k];
        s->u[k] += change[k];
    }
}

static void lattice_vector(const struct model *m, const int shift[3], double d[3])
{
    for (int k = 0; k < 3; k++)
        d[k] = shift[0] * m->cell[0][k] + shift[1] * m->cell[1][k] + shift[2] * m->cell[2][k];
}

static void add_images(struct views *v, struct model *m, const struct pair_state *base, size_t at)
{
    for (int code = 0; code < 27; code++) {
        struct view how = { .motion = IMAGE, .base = at, .shift = { code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1 } };
        struct pair_state p = *base;
        double d[3];
        lattice_vector(m, how.shift, d);
        move(m, &p.s[1], d);
        how.faster = norm(p.s[1].u) != norm(base->s[1].u);
        if (code != 13)
            add_view(v, &p, &how);
    }
}

/* Places the middle of the pair on faces, edges and the corner of the cell, and far outside it. */
static void add_moves(struct views *v, struct model *m, const struct pair_state *base, size_t at)
{
    static const double fraction[][3] = { { 0, .4, .6 }, { .3, 0, .7 }, { .6, .3, 0 }, { 1, .2, .5 }, { .5, 1, .2 }, { .2, .6, 1 },
                                          { 0, 1, .5 },  { 0, 0, 0 },   { 1, 1, 1 },   { -2.3, 1.6, .4 }, { 3.7, -2.2, -1.4 } };
    for (size_t k = 0; k < sizeof fraction / sizeof *fraction; k++) {
        struct pair_state p = *base;
        double d[3];
        for (int c = 0; c < 3; c++) {
            d[c] = -0.5 * (p.s[0].x[c] + p.s[1].x[c]);
            for (int a = 0; a < 3; a++)
                d[c] += fraction[k][a] * m->cell[a][c];
        }
        move(m, &p.s[0], d);
        move(m, &p.s[1], d);
        add_view(v, &p, &(struct view){ .motion = MOVED, .base = at });
    }
}

static void add_galilei(struct views *v, gsl_rng *random, const struct pair_state *base, size_t at)
{
    struct pair_state p = *base;
    double extra[3];
    random_vector(random, 1.9, extra);
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++)
            p.s[side].u[k] += extra[k];
    add_view(v, &p, &(struct view){ .motion = GALILEI, .base = at });
}

static void add_turned(struct views *v, gsl_rng *random, const struct pair_state *base, size_t at)
{
    struct view how = { .motion = TURNED, .base = at };
    struct pair_state p = *base;
    random_rotation(random, how.turn);
    for (int side = 0; side < 2; side++) {
        double from_centre[3];
        for (int k = 0; k < 3; k++)
            from_centre[k] = base->s[side].x[k] - base->s[0].x[k];
        apply(how.turn, from_centre, from_centre);
        for (int k = 0; k < 3; k++)
            p.s[side].x[k] = base->s[0].x[k] + from_centre[k];
        apply(how.turn, base->s[side].u, p.s[side].u);
        apply(how.turn, base->s[side].w, p.s[side].w);
    }
    apply(how.turn, base->history, p.history);
    add_view(v, &p, &how);
}

static void fill(struct check_run *run, struct model *m, const char *force, struct views *v)
{
    double xi[16];
    size_t gaps;
    parameter_list(run->gate_case->parameters, "xi", xi, &gaps, 16);
    gsl_rng *random = pair_random(run);
    const bool still = norm(m->gradient[0]) + norm(m->gradient[1]) + norm(m->gradient[2]) == 0;
    for (size_t b = 0; b < m->species; b++)
        for (size_t g = 0; g < gaps; g++) {
            struct pair_state p = random_pair(random, m->radius[0], m->radius[b], xi[g]);
            p.with_history = m->has_contact && m->contact.friction > 0 && xi[g] < 0;
            random_vector(random, 0.002 * m->radius[0], p.history);
            const size_t at = v->book.count;
            add_view(v, &p, &(struct view){ .motion = INSIDE, .base = at });
            add_images(v, m, &p, at);
            add_moves(v, m, &p, at);
            if (strcmp(force, "drag") != 0)
                add_galilei(v, random, &p, at);
            if (still)
                add_turned(v, random, &p, at);
        }
    gsl_rng_free(random);
}

/* The size of the terms that make the force of a state: what rounding is measured against. */
static void scales(const struct model *m, const char *force, const struct pair_state *p, double *f, double *t)
{
    struct expected e = { 0 };
    if (strcmp(force, "drag") == 0) {
        const double a = fmax(p->s[0].radius, p->s[1].radius);
        *f = 6 * M_PI * m->viscosity * a * 5; /* speeds of a few, spins of about one */
        *t = 8 * M_PI * m->viscosity * a * a * a * 2;
        return;
    }
    (strcmp(force, "contact") == 0 ? expect_contact : expect_lubrication)(m, p, &e);
    *f = e.force_scale;
    *t = e.torque_scale;
}

static void see(struct model *m, const char *force, const struct views *v, const struct pair_answer *a, double tolerance,
                struct worst worst[MOTIONS], struct images *images)
{
    for (size_t k = 0; k < v->book.count; k++) {
        struct view *how = &v->view[k];
        struct worst here = WORST_NONE;
        double f, t, expected[3];
        scales(m, force, &v->book.item[how->base], &f, &t);
        for (int part = 0; part < 4 && how->motion != INSIDE; part++) { /* force, torque on 1; on 2 */
            const double *now = forces_at(&a->forces, k, force, 1 + part / 2) + 3 * (part % 2);
            const double *before = forces_at(&a->forces, how->base, force, 1 + part / 2) + 3 * (part % 2);
            memcpy(expected, before, sizeof expected);
            if (how->motion == TURNED)
                apply(how->turn, before, expected);
            worst_see_vector(&worst[how->motion], now, expected, 3, part % 2 ? t : f, k);
            worst_see_vector(&here, now, expected, 3, part % 2 ? t : f, k);
        }
        if (how->motion == IMAGE) {
            images->seen[how->faster]++;
            images->wrong[how->faster] += !(here.error <= tolerance);
        }
    }
}

/* Which images are wrong says what is wrong with them. */
static const char *image_words(const struct images *i)
{
    if (i->wrong[0] == 0 && i->seen[0] > 0)
        return "; only images with another velocity are wrong: the image velocity";
    if (i->wrong[1] == 0 && i->seen[1] > 0)
        return "; only images with the same velocity are wrong";
    return i->seen[1] > 0 ? "; images with and without another velocity are wrong: their place, or how they are found"
                          : "; images are misplaced, or not found";
}

/* `right_still`: whether this motion was right in every cell without shear so far; those come first in a case. */
static void judge(struct check_run *run, const char *variant, const struct views *v, const struct worst worst[MOTIONS],
                  const struct images *images, bool still, bool right_still[MOTIONS])
{
    for (int motion = IMAGE; motion < MOTIONS; motion++) {
        const struct worst *w = &worst[motion];
        if (w->error == -1)
            continue;
        char what[128], where[64] = "";
        const char *which = motion == IMAGE ? image_words(images)
                            : !still && right_still[motion] ? "; right without shear, so the velocity of an image or of a wrapped sphere" : "";
        if (still)
            right_still[motion] = w->error <= run->gate_case->tolerance;
        const struct view *how = &v->view[w->at];
        snprintf(what, sizeof what, "%s: %s", variant, motion_name[motion]);
        if (motion == IMAGE)
            snprintf(where, sizeof where, ", shifted by %d, %d, %d cell vectors", how->shift[0], how->shift[1], how->shift[2]);
        check_error(run, INVARIANT, what, w->measured, w->expected, w->error, run->gate_case->tolerance,
                    "%s: %s%s: %s; worst at %s%s", variant, motion_fault[motion], which, compare(w),
                    describe(&v->book.item[w->at], w->at), where);
    }
}

void pair_frames(struct check_run *run)
{
    const char *force = json_string_value(json_object_get(run->gate_case->parameters, "force"));
    size_t k;
    json_t *variant;
    bool right_still[MOTIONS] = { false };
    json_array_foreach(json_object_get(run->gate_case->parameters, "variants"), k, variant)
    {
        const char *name = json_string_value(json_object_get(variant, "name"));
        json_t *scene = variant_scene(run->gate_case, variant);
        struct model m;
        struct views v = { 0 };
        struct pair_answer answer = { 0 };
        struct worst worst[MOTIONS] = { WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE, WORST_NONE };
        bool answered = force && name && model_read(run, scene, &m);
        if (answered) {
            fill(run, &m, force, &v);
            answered = book_ask(run, name, scene, &v.book, force, &answer);
        }
        if (answered) {
            struct images images = { { 0 }, { 0 } };
            see(&m, force, &v, &answer, run->gate_case->tolerance, worst, &images);
            judge(run, name, &v, worst, &images, norm(m.gradient[0]) + norm(m.gradient[1]) + norm(m.gradient[2]) == 0, right_still);
        }
        forces_free(&answer.forces);
        book_free(&v.book);
        free(v.view);
        json_decref(scene);
        if (!answered && results_verdict(&run->results) != VERDICT_PASS)
            return; /* it will not do better in the others; but where some passed, one without support says nothing of them */
    }
}
