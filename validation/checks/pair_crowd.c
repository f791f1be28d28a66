/*
 * Many spheres of several sizes in a strained periodic cell, against a brute-force sum over all images of all pairs.
 * Lost neighbours, doubled pairs, images that are not the nearest one, and a sphere that meets its own image in a small
 * cell all show here; so does any force that is right alone and wrong in company. The stress of every origin is summed
 * in the same loop, with each pair once.
 */
#include "crowd.h"
#include "pair_checks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const force_name[FORCES] = { "contact", "lubrication", "drag", "repulsion", "applied" };
static const char *const origin_name[ORIGINS] = { "contact_normal", "contact_tangential", "lubrication", "drag", "repulsion", "kinetic" };

void crowd_each_image(struct crowd *c, size_t i, size_t j, double range, crowd_visitor *visit, void *data)
{
    double d[3], across[3][3];
    long low[3], high[3];
    for (int k = 0; k < 3; k++)
        d[k] = c->sphere[j].s.x[k] - c->sphere[i].s.x[k];
    for (int v = 0; v < 3; v++) { /* reciprocal vectors: how many planes of the lattice lie within range */
        cross(c->m.cell[(v + 1) % 3], c->m.cell[(v + 2) % 3], across[v]);
        const double height = dot(across[v], c->m.cell[v]), at = dot(across[v], d) / height;
        const double reach = range * norm(across[v]) / fabs(height);
        low[v] = c->m.open[v] ? 0 : lround(ceil(-at - reach));
        high[v] = c->m.open[v] ? 0 : lround(floor(-at + reach));
    }
    for (long p = low[0]; p <= high[0]; p++)
        for (long q = low[1]; q <= high[1]; q++)
            for (long s = low[2]; s <= high[2]; s++) {
                double shift[3], r[3];
                for (int k = 0; k < 3; k++) {
                    shift[k] = (double)p * c->m.cell[0][k] + (double)q * c->m.cell[1][k] + (double)s * c->m.cell[2][k];
                    r[k] = d[k] + shift[k];
                }
                const bool half = p > 0 || (p == 0 && (q > 0 || (q == 0 && s > 0)));
                if (norm(r) < range && (i != j || half))
                    visit(c, i, j, shift, data);
            }
}

double crowd_range(const struct crowd *c, size_t i, size_t j)
{
    const double outer = c->present[LUBRICATION] ? 0.5 * c->m.lubrication.outer_gap : 0;
    return (c->sphere[i].s.radius + c->sphere[j].s.radius) * (1 + fmax(outer, c->present[REPULSION] ? c->m.repulsion.cutoff * c->m.repulsion.kappa_factor : 0));
}

void crowd_note_gap(struct crowd *c, size_t i, size_t j, const double shift[3], void *smallest)
{
    double r[3];
    for (int k = 0; k < 3; k++)
        r[k] = c->sphere[j].s.x[k] + shift[k] - c->sphere[i].s.x[k];
    const double sizes = c->sphere[i].s.radius + c->sphere[j].s.radius;
    *(double *)smallest = fmin(*(double *)smallest, norm(r) / sizes - 1);
}

/* Random places, largest spheres first, overlaps of at most `overlap` of the sizes allowed. */
static void place(struct crowd *c, gsl_rng *random, double overlap)
{
    const size_t wanted = c->count;
    c->count = 0;
    for (int tries = 0; c->count < wanted && tries < 200000; tries++) {
        struct crowd_sphere *s = &c->sphere[c->count];
        for (int k = 0; k < 3; k++)
            s->s.x[k] = 0;
        for (int v = 0; v < 3; v++) {
            const double along = gsl_rng_uniform(random);
            for (int k = 0; k < 3; k++)
                s->s.x[k] += along * c->m.cell[v][k];
        }
        double smallest = INFINITY;
        for (size_t j = 0; j < c->count && smallest >= -overlap; j++)
            crowd_each_image(c, j, c->count, crowd_range(c, j, c->count), crowd_note_gap, &smallest);
        c->count += smallest >= -overlap;
    }
}

static void count_contact(struct crowd *c, size_t i, size_t j, const double shift[3], void *touching)
{
    double smallest = 0;
    crowd_note_gap(c, i, j, shift, &smallest);
    *(size_t *)touching += smallest < 0;
}

void crowd_give_histories(struct crowd *c, gsl_rng *random, double length)
{
    c->history = calloc(c->count * c->count + 1, sizeof *c->history);
    for (size_t i = 0; i < c->count; i++)
        for (size_t j = i + 1; j < c->count; j++) {
            size_t touching = 0;
            crowd_each_image(c, i, j, crowd_range(c, i, j), count_contact, &touching);
            if (touching != 1)
                continue;               /* contacts.csv names particles: it cannot tell two images of one */
            const bool back = c->histories % 2;
            struct contact_row *h = &c->history[c->histories++];
            *h = (struct contact_row){ .i = (int)(back ? j : i) + 1, .j = (int)(back ? i : j) + 1 };
            random_vector(random, length * c->sphere[i].s.radius, h->s);
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

static void history_of(const struct crowd *c, size_t i, size_t j, struct pair_state *p)
{
    for (size_t k = 0; k < c->histories; k++) {
        const struct contact_row *h = &c->history[k];
        const bool same = h->i == (int)i + 1 && h->j == (int)j + 1, back = h->j == (int)i + 1 && h->i == (int)j + 1;
        for (int d = 0; d < 3 && (same || back); d++)
            p->history[d] = same ? h->s[d] : -h->s[d];
        p->with_history = p->with_history || same || back;
    }
}

static void book_pair(struct crowd *c, int force, size_t i, size_t j, const struct pair_state *p, const struct expected *e)
{
    double n[3], r;
    pair_geometry(p, n, &r);
    const double *f = e->pair.force[0], normal = dot(f, n);
    for (int side = 0; side < 2; side++) {
        const size_t k = side ? j : i;
        for (int d = 0; d < 3; d++) {
            c->expected[k][force][d] += e->pair.force[side][d];
            c->expected[k][force][3 + d] += e->pair.torque[side][d];
        }
        c->scale[k][force][0] += e->force_scale;
        c->scale[k][force][1] += e->torque_scale;
    }
    const int origin = force == CONTACT ? CONTACT_NORMAL : force == REPULSION ? REPULSION_STRESS : LUBRICATION_STRESS;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const double along = force == CONTACT ? normal * n[a] : f[a];
            c->stress[origin][3 * a + b] += along * r * n[b];
            if (force == CONTACT)
                c->stress[CONTACT_TANGENTIAL][3 * a + b] += (f[a] - along) * r * n[b];
        }
    c->stress_scale[origin] += e->force_scale * r;
    c->stress_scale[CONTACT_TANGENTIAL] += e->force_scale * r;
}

static void expect_repulsion(const struct model *m, const struct pair_state *p, struct expected *e)
{
    const double sizes = p->s[0].radius + p->s[1].radius;
    double n[3], r;
    const double h = pair_geometry(p, n, &r);
    theory_repulsion_pair(&m->repulsion, p->s, &e->pair);
    e->force_scale = theory_repulsion_energy(&m->repulsion, p->s[0].radius, p->s[1].radius, h) / (m->repulsion.kappa_factor * sizes);
    e->torque_scale = e->force_scale * sizes;
}

static void add_pair(struct crowd *c, size_t i, size_t j, const double shift[3], void *data)
{
    (void)data;
    if (c->m.driven[c->sphere[i].species - 1] && c->m.driven[c->sphere[j].species - 1])
        return;                         /* both move as they are told: no pair */
    struct pair_state p = { .s = { c->sphere[i].s, c->sphere[j].s } };
    struct expected e = { 0 };
    double change[3];
    apply(c->m.gradient, shift, change);
    for (int k = 0; k < 3; k++) {
        p.s[1].x[k] += shift[k];
        p.s[1].u[k] += change[k];
    }
    history_of(c, i, j, &p);
    if (c->present[LUBRICATION]) {
        expect_lubrication(&c->m, &p, &e);
        e.force_scale += e.torque_scale / (p.s[0].radius + p.s[1].radius);
        book_pair(c, LUBRICATION, i, j, &p, &e);
    }
    if (c->present[CONTACT]) {
        expect_contact(&c->m, &p, &e);
        book_pair(c, CONTACT, i, j, &p, &e);
    }
    if (c->present[REPULSION]) {
        expect_repulsion(&c->m, &p, &e);
        book_pair(c, REPULSION, i, j, &p, &e);
    }
    c->pairs++;
    c->self_pairs += i == j;
}

static void add_single(struct crowd *c, size_t k)
{
    const struct theory_sphere *s = &c->sphere[k].s;
    double stresslet[3][3], flow[3];
    apply(c->m.gradient, s->x, flow);
    if (c->present[DRAG]) {
        double *f = c->expected[k][DRAG];
        theory_drag(c->m.viscosity, c->m.drag_torque, (const double (*)[3])c->m.gradient, s, f, f + 3, stresslet);
        c->scale[k][DRAG][0] = 6 * M_PI * c->m.viscosity * s->radius * (norm(s->u) + norm(flow) + 1);
        c->scale[k][DRAG][1] = 8 * M_PI * c->m.viscosity * pow(s->radius, 3) * (norm(s->w) + 1);
        for (int a = 0; a < 9; a++)
            c->stress[DRAG_STRESS][a] += stresslet[a / 3][a % 3];
        c->stress_scale[DRAG_STRESS] += c->scale[k][DRAG][1];
    }
    if (c->present[APPLIED]) {
        double *load = c->expected[k][APPLIED];
        scene_applied(c->scene, (size_t)c->sphere[k].species - 1, load);
        c->scale[k][APPLIED][0] = norm(load) + 1;
        c->scale[k][APPLIED][1] = norm(load + 3) + 1;
    }
    if (c->m.driven[c->sphere[k].species - 1])
        return;                         /* its momentum is not the crowd's */
    const double mass = 4 * M_PI / 3 * c->m.density[c->sphere[k].species - 1] * pow(s->radius, 3);
    for (int a = 0; a < 9; a++)
        c->stress[KINETIC][a] -= mass * (s->u[a / 3] - flow[a / 3]) * (s->u[a % 3] - flow[a % 3]);
    c->stress_scale[KINETIC] += mass * (dot(s->u, s->u) + dot(flow, flow));
}

static void expect(struct crowd *c)
{
    c->expected = calloc(c->count, sizeof *c->expected);
    c->scale = calloc(c->count, sizeof *c->scale);
    for (size_t i = 0; i < c->count; i++) {
        add_single(c, i);
        for (size_t j = i; j < c->count; j++)
            crowd_each_image(c, i, j, crowd_range(c, i, j) * (1 + 1e-12), add_pair, NULL);
    }
}

/* Looks for one pair whose force is just what is missing from, or too much on, a sphere. */
struct search { size_t sphere; int force; double off[3], tolerance; char *text; };

static void try_pair(struct crowd *c, size_t i, size_t j, const double shift[3], void *data)
{
    struct search *s = data;
    struct pair_state p = { .s = { c->sphere[i].s, c->sphere[j].s } };
    struct expected e = { 0 };
    double change[3];
    if ((i != s->sphere && j != s->sphere) || i == j)
        return;
    apply(c->m.gradient, shift, change);
    for (int k = 0; k < 3; k++) {
        p.s[1].x[k] += shift[k];
        p.s[1].u[k] += change[k];
    }
    history_of(c, i, j, &p);
    (s->force == CONTACT ? expect_contact : s->force == REPULSION ? expect_repulsion : expect_lubrication)(&c->m, &p, &e);
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
            const double *own = forces_at(f, 0, force_name[force], (int)k + 1), *scale = c->scale[k][force];
            worst_see_vector(&w, own, c->expected[k][force], 3, scale[0], k);
            worst_see_vector(&w, own + 3, c->expected[k][force] + 3, 3, scale[1], k);
        }
        const bool right = w.error <= run->gate_case->tolerance;
        if ((sentence = worse(&v->force[force], &w)))
            snprintf(sentence, WHY_LENGTH, "%s: %s on sphere %zu (radius %g) is %s%s; %zu spheres, %zu pairs in range, %zu of them a sphere and its own image",
                     variant, force_name[force], w.at + 1, c->sphere[w.at].s.radius, compare(&w),
                     right ? "" : crowd_words(c, force, w.at, forces_at(f, 0, force_name[force], (int)w.at + 1), run->gate_case->tolerance, v->right_at_rest[force]),
                     c->count, c->pairs, c->self_pairs);
        if (norm(c->m.gradient[0]) + norm(c->m.gradient[1]) + norm(c->m.gradient[2]) == 0)
            v->right_at_rest[force] = right;
    }
    for (size_t k = 0; k < c->count; k++)
        for (int d = 0; d < 6; d++) {
            double sum = 0, scale = 1e-300;
            for (int force = 0; force < FORCES; force++)
                if (c->present[force]) {
                    sum += forces_at(f, 0, force_name[force], (int)k + 1)[d];
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
        double *own = answer_stress(run, answer, 1, origin_name[origin], c->m.volume);
        if (!own)
            return false;
        struct worst w = WORST_NONE;
        worst_see_vector(&w, own, c->stress[origin], 9, c->stress_scale[origin] + 1e-300, 0);
        char *sentence = worse(&v->stress[origin], &w);
        if (sentence)
            snprintf(sentence, WHY_LENGTH, "%s: the %s stress times the volume is %s", variant, origin_name[origin], compare(&w));
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
        judge(run, MODEL, &v->force[force], before, force_name[force], "");
    judge(run, INVARIANT, &v->total, before, "total = sum of parts", "");
    for (int origin = 0; origin < ORIGINS; origin++)
        judge(run, MODEL, &v->stress[origin], before, origin_name[origin], " stress");
}

bool crowd_ask(struct check_run *run, const char *variant, json_t *scene, struct crowd *c, struct pair_answer *answer)
{
    expect(c);
    struct state_row *rows = calloc(c->count, sizeof *rows);
    for (size_t k = 0; k < c->count; k++) {
        rows[k] = (struct state_row){ .id = (int)k + 1, .species = c->sphere[k].species };
        memcpy(rows[k].x, c->sphere[k].s.x, sizeof rows[k].x);
        memcpy(rows[k].u, c->sphere[k].s.u, sizeof rows[k].u);
        memcpy(rows[k].w, c->sphere[k].s.w, sizeof rows[k].w);
    }
    const struct question q = { .protocol = "forces", .scene = scene, .state = rows, .states = c->count, .contact = c->history,
                                .contacts = c->histories };
    bool good = check_ask(run, variant, &q, answer->out);
    free(rows);
    if (!good)
        return false;
    char wanted[128] = "total", path[PATH_LENGTH], why[WHY_LENGTH];
    for (int force = 0; force < FORCES; force++)
        if (c->present[force]) {
            strcat(wanted, ",");
            strcat(wanted, force_name[force]);
        }
    path_join(path, answer->out, "forces.csv");
    good = forces_read(path, 1, c->count, wanted, &answer->forces, why);
    if (!good)
        check_garbage(run, why);
    return good;
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

bool crowd_of_scene(struct check_run *run, const json_t *scene, struct crowd *c)
{
    *c = (struct crowd){ .scene = scene };
    if (!model_read(run, scene, &c->m))
        return false;
    const bool present[FORCES] = { c->m.has_contact, c->m.has_lubrication, c->m.has_drag, scene_get(scene, "forces.repulsion") != NULL,
                                   scene_get(scene, "forces.applied") != NULL };
    memcpy(c->present, present, sizeof present);
    return true;
}

void crowd_free(struct crowd *c)
{
    free(c->sphere);
    free(c->history);
    free(c->expected);
    free(c->scale);
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
