/*
 * Many spheres of several sizes in a strained periodic cell, against a brute-force sum over all images of all pairs.
 * Lost neighbours, doubled pairs, images that are not the nearest one, and a sphere that meets its own image in a small
 * cell all show here; so does any force that is right alone and wrong in company. What is expected: crowd.c.
 */
#include "crowd.h"
#include "pair_checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Random places, largest spheres first, overlaps of at most `overlap` of the sizes allowed. */
static void place(struct crowd *c, gsl_rng *random, double overlap)
{
    const size_t wanted = c->count;
    c->count = 0;
    for (int tries = 0; c->count < wanted && tries < 200000; tries++) {
        crowd_anywhere(c, random, c->count);
        double smallest = INFINITY;
        for (size_t j = 0; j < c->count && smallest >= -overlap; j++)
            crowd_each_image(c, j, c->count, crowd_range(c, j, c->count), crowd_note_gap, &smallest);
        c->count += smallest >= -overlap;
    }
}

static void make(struct check_run *run, const json_t *variant, struct crowd *c)
{
    gsl_rng *random = pair_random(run);
    c->count = (size_t)scene_number(variant, "count", 40);
    const double overlap = scene_number(variant, "overlap", 0.02), drift = scene_number(variant, "speed", 0.9);
    c->sphere = calloc(c->count, sizeof *c->sphere);
    for (size_t k = 0; k < c->count; k++) { /* species in blocks, the last (largest) first */
        c->sphere[k].species = (int)(c->m.species - k * c->m.species / c->count);
        c->sphere[k].s.radius = c->m.radius[c->sphere[k].species - 1];
    }
    const json_t *fixed = json_object_get(variant, "positions");
    if (!fixed)
        place(c, random, overlap);
    for (size_t k = 0; k < c->count; k++) {
        for (size_t d = 0; fixed && d < 3; d++)
            c->sphere[k].s.x[d] = json_number_value(json_array_get(json_array_get(fixed, k), d));
        random_vector(random, drift, c->sphere[k].s.u);
        random_vector(random, drift, c->sphere[k].s.w);
    }
    if (c->present[CONTACT] && c->m.contact.friction > 0)
        crowd_give_histories(c, random, 0.01);
    gsl_rng_free(random);
}

/* Looks for one pair whose force is just what is missing from, or too much on, a sphere. */
struct search { size_t sphere; int force; double off[3], tolerance; char *text; };

static void try_pair(struct crowd *c, size_t i, size_t j, const double shift[3], void *data)
{
    struct search *s = data;
    struct pair_state p;
    struct expected e;
    if ((i != s->sphere && j != s->sphere) || i == j)
        return;
    crowd_expect_pair(c, i, j, shift, s->force, &p, &e);
    const double *own = e.pair.force[i == s->sphere ? 0 : 1], size = norm(own);
    for (int sign = -1; sign <= 1 && size > 0; sign += 2) {
        double rest = 0;
        for (int k = 0; k < 3; k++)
            rest = fmax(rest, fabs(s->off[k] - sign * own[k]));
        if (rest <= s->tolerance * size)
            snprintf(s->text, WHY_LENGTH, ": the pair with sphere %zu%s is %s", (i == s->sphere ? j : i) + 1,
                     norm(shift) > 0 ? ", across a face," : "", sign < 0 ? "missing" : "counted twice");
    }
}

/* What a wrong force on a sphere is made of: a lost or doubled pair; else what shear has to do with it. */
static const char *crowd_words(struct crowd *c, int force, size_t at, const double *own, double tolerance, bool right_at_rest)
{
    static char text[WHY_LENGTH];
    struct search s = { .sphere = at, .force = force, .tolerance = fmax(1e-6, tolerance), .text = text };
    const bool flows = norm(c->m.gradient[0]) + norm(c->m.gradient[1]) + norm(c->m.gradient[2]) > 0;
    for (int k = 0; k < 3; k++)
        s.off[k] = own[k] - c->expected[at][force][k];
    text[0] = '\0';
    for (size_t other = 0; other < c->count && force != DRAG && force != APPLIED; other++)
        crowd_each_image(c, other < at ? other : at, other < at ? at : other, crowd_range(c, at, other) * (1 + 1e-12), try_pair, &s);
    if (text[0])
        return text;
    if (force == APPLIED)
        return "";
    if (force == DRAG)
        return flows && right_at_rest ? ": right at rest, so how the flow enters" : "";
    if (flows && right_at_rest)
        return ": right at rest, so the velocity of an image or the place of a remapped one";
    return ", not one pair more or less: if single pairs are right, a neighbour is misplaced or several are lost";
}

void crowd_verdict_start(struct crowd_verdict *v)
{
    *v = (struct crowd_verdict){ .total.w = WORST_NONE };
    for (int force = 0; force < FORCES; force++)
        v->force[force].w = (struct worst)WORST_NONE;
    for (int origin = 0; origin < ORIGINS; origin++)
        v->stress[origin].w = (struct worst)WORST_NONE;
}

/* Room for a sentence about `w`, if it is worse than what was seen before. */
static char *worse(struct crowd_seen *s, const struct worst *w)
{
    if (w->error <= s->w.error || isnan(s->w.error))
        return NULL;
    s->w = *w;
    return s->sentence;
}

static void see_forces(struct check_run *run, struct crowd *c, const char *variant, const struct forces *f, struct crowd_verdict *v)
{
    struct worst total = WORST_NONE;
    char *sentence;
    for (int force = 0; force < FORCES; force++) {
        struct worst w = WORST_NONE;
        if (!c->present[force])
            continue;
        for (size_t k = 0; k < c->count; k++) {
            const double *own = forces_at(f, 0, crowd_force[force], (int)k + 1), *scale = c->scale[k][force];
            worst_see_vector(&w, own, c->expected[k][force], 3, scale[0], k);
            worst_see_vector(&w, own + 3, c->expected[k][force] + 3, 3, scale[1], k);
        }
        const bool right = w.error <= run->gate_case->tolerance;
        if ((sentence = worse(&v->force[force], &w)))
            snprintf(sentence, WHY_LENGTH, "%s: %s on sphere %zu (radius %g) is %s%.900s; %zu spheres, %zu pairs in range, %zu of them a sphere and its own image",
                     variant, crowd_force[force], w.at + 1, c->sphere[w.at].s.radius, compare(&w),
                     right ? "" : crowd_words(c, force, w.at, forces_at(f, 0, crowd_force[force], (int)w.at + 1), run->gate_case->tolerance, v->right_at_rest[force]),
                     c->count, c->pairs, c->self_pairs);
        if (norm(c->m.gradient[0]) + norm(c->m.gradient[1]) + norm(c->m.gradient[2]) == 0)
            v->right_at_rest[force] = right;
    }
    for (size_t k = 0; k < c->count; k++)
        for (int d = 0; d < 6; d++) {
            double sum = 0, scale = 1e-300;
            for (int force = 0; force < FORCES; force++)
                if (c->present[force]) {
                    sum += forces_at(f, 0, crowd_force[force], (int)k + 1)[d];
                    scale += c->scale[k][force][d / 3];
                }
            worst_see(&total, forces_at(f, 0, "total", (int)k + 1)[d], sum, scale, k);
        }
    if ((sentence = worse(&v->total, &total)))
        snprintf(sentence, WHY_LENGTH, "%s: `total` on sphere %zu is not the sum of the forces listed: %s", variant, total.at + 1, compare(&total));
}

static bool see_stress(struct check_run *run, const struct crowd *c, const char *variant, const struct pair_answer *answer, struct crowd_verdict *v)
{
    const bool wanted[ORIGINS] = { c->present[CONTACT], c->present[CONTACT] && c->m.contact.friction > 0,
                                   c->present[LUBRICATION], c->present[DRAG], c->present[REPULSION], true };
    for (int origin = 0; origin < ORIGINS; origin++) {
        if (!wanted[origin])
            continue;
        double *own = answer_stress(run, answer, 1, crowd_origin[origin], c->m.volume);
        if (!own)
            return false;
        struct worst w = WORST_NONE;
        worst_see_vector(&w, own, c->stress[origin], 9, c->stress_scale[origin] + 1e-300, 0);
        char *sentence = worse(&v->stress[origin], &w);
        if (sentence)
            snprintf(sentence, WHY_LENGTH, "%s: the %s stress times the volume is %s", variant, crowd_origin[origin], compare(&w));
        free(own);
    }
    return true;
}

static void judge(struct check_run *run, enum judgement judgement, const struct crowd_seen *s, const char *before, const char *name, const char *after)
{
    char what[128];
    snprintf(what, sizeof what, "%s%s%s", before, name, after);
    if (s->w.error >= 0 || isnan(s->w.error))
        check_error(run, judgement, what, s->w.measured, s->w.expected, s->w.error, run->gate_case->tolerance, "%s", s->sentence);
}

void crowd_judge(struct check_run *run, const struct crowd_verdict *v, const char *before)
{
    for (int force = 0; force < FORCES; force++)
        judge(run, MODEL, &v->force[force], before, crowd_force[force], "");
    judge(run, INVARIANT, &v->total, before, "total = sum of parts", "");
    for (int origin = 0; origin < ORIGINS; origin++)
        judge(run, MODEL, &v->stress[origin], before, crowd_origin[origin], " stress");
}

bool crowd_see(struct check_run *run, const char *name, json_t *scene, struct crowd *c, struct crowd_verdict *v)
{
    struct pair_answer answer = { 0 };
    const bool answered = crowd_ask(run, name, scene, c, &answer);
    if (answered)
        see_forces(run, c, name, &answer.forces, v);
    const bool seen = answered && see_stress(run, c, name, &answer, v);
    forces_free(&answer.forces);
    return seen;
}

void pair_crowd(struct check_run *run)
{
    size_t k;
    json_t *variant;
    bool right_at_rest[FORCES] = { false };     /* of the variants so far; those without shear come first */
    json_array_foreach(json_object_get(run->gate_case->parameters, "variants"), k, variant)
    {
        const char *name = json_string_value(json_object_get(variant, "name"));
        json_t *scene = variant_scene(run->gate_case, variant);
        struct crowd c = { 0 };
        struct crowd_verdict v;
        crowd_verdict_start(&v);
        memcpy(v.right_at_rest, right_at_rest, sizeof right_at_rest);
        bool answered = name && crowd_of_scene(run, scene, &c);
        if (answered) {
            make(run, variant, &c);
            answered = crowd_see(run, name, scene, &c, &v);
        }
        if (answered) {
            char before[96];
            snprintf(before, sizeof before, "%s: ", name);
            crowd_judge(run, &v, before);
        }
        memcpy(right_at_rest, v.right_at_rest, sizeof right_at_rest);
        crowd_free(&c);
        json_decref(scene);
        if (!answered && results_verdict(&run->results) != VERDICT_PASS)
            return; /* it will not do better in the others; but where some passed, one without support says nothing of them */
    }
}
