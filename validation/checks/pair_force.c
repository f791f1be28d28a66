/*
 * Force, torque and stress of frozen pairs, one force at a time, over size ratios, gaps, velocities, spins, histories.
 *
 * Judged first, without any formula for the coefficients:
 *   third law                F_1 + F_2 = 0
 *   torque balance           T_1 + T_2 + l n x F_2 = 0, where l = a_1 + a_2 is what levers at the radius (and lubrication
 *                            without rotation correction) leave, l = r where levers reach to the contact. The true
 *                            balance has l = r; the difference (h n x F_2) is a known property of these models.
 *   relabelling              exchanging the labels exchanges the forces
 *   total                    is the sum of the parts
 *   power, Coulomb cap       lubrication never gives energy; |F_t| <= mu |F_n|
 *   range                    nothing beyond touch (contact) or the outer cut-off (lubrication)
 *   stress                   equals F_1 (x) r / V with the candidate's own F_1
 * Then the numbers of the model that the scene declares.
 */
#include "pair_checks.h"
#include "pair_pattern.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct seen {
    struct worst third_law, balance, relabelling, total, power, cap, range, own_stress[2], force[2] /* along n, across n */, torque[2],
        stress[2], residual;
};

/* Several histories per contact: none, one that sticks, one that slides; all with a part along n, to be projected out. */
static void add_histories(gsl_rng *random, const struct model *m, struct pair_book *book, struct pair_state p)
{
    const double overlap = fmax(-0.5 * p.xi, 1e-3) * (p.s[0].radius + p.s[1].radius);
    const double slides_at = m->contact.friction * m->contact.normal_stiffness * overlap / m->contact.tangential_stiffness;
    const double sizes[] = { 0, 0.3, 0.3, 4 };
    for (int k = 0; k < 4; k++) {
        p.with_history = k > 0;
        p.listed_backwards = k == 2;
        random_direction(random, p.history);
        for (int d = 0; d < 3; d++)
            p.history[d] *= sizes[k] * slides_at;
        book_add(book, &p);
    }
}

/* Held and driven spheres have the velocity and spin of their species. */
static void keep_motion(const struct model *m, size_t other, struct pair_state *p)
{
    for (int side = 0; side < 2; side++) {
        const size_t kind = side ? other : 0;
        for (int k = 0; k < 3 && m->driven[kind]; k++) {
            p->s[side].u[k] = m->velocity[kind][k];
            p->s[side].w[k] = m->spin[kind][k];
        }
    }
}

static void fill_book(struct check_run *run, const struct model *m, bool contact, struct pair_book *book)
{
    double xi[64];
    size_t gaps;
    parameter_list(run->gate_case->parameters, "xi", xi, &gaps, 64);
    const int repeats = (int)scene_number(run->gate_case->parameters, "repeats", 2);
    gsl_rng *random = pair_random(run);
    for (size_t b = 0; b < m->species; b++)
        for (size_t g = 0; g < gaps; g++)
            for (int k = 0; k < repeats; k++) {
                struct pair_state p = random_pair(random, m->radius[0], m->radius[b], xi[g]);
                if (m->driven[0] && m->driven[b])
                    continue;           /* no pair */
                keep_motion(m, b, &p);
                if (xi[g] == 0) /* exact touch, to the last bit: along an axis, from the origin */
                    for (int d = 0; d < 3; d++) {
                        p.s[0].x[d] = 0;
                        p.s[1].x[d] = d == k % 3 ? p.s[0].radius + p.s[1].radius : 0;
                    }
                if (contact && m->contact.friction > 0)
                    add_histories(random, m, book, p);
                else
                    book_add(book, &p);
            }
    const size_t half = book->count; /* then all of them once more with the labels exchanged */
    for (size_t k = 0; k < half; k++) {
        const struct pair_state other = swapped(&book->item[k]);
        book_add(book, &other);
    }
    gsl_rng_free(random);
}

static void see_invariants(struct seen *s, const struct model *m, bool contact, const struct pair_state *p, size_t at,
                           const struct expected *e, const double *own[2])
{
    double n[3], r, minus[3], arm[3], sum[3];
    const double h = pair_geometry(p, n, &r), sizes = p->s[0].radius + p->s[1].radius;
    const bool reaches = contact ? m->contact.lever_at_contact : m->lubrication.exact_rotation;
    for (int k = 0; k < 3; k++) {
        minus[k] = -own[0][k];
        sum[k] = own[0][3 + k] + own[1][3 + k];
        arm[k] = -(reaches ? r : sizes) * n[k];
    }
    worst_see_vector(&s->third_law, own[1], minus, 3, e->force_scale, at);
    cross(arm, own[1], arm);
    worst_see_vector(&s->balance, sum, arm, 3, e->torque_scale, at);
    if (h > (contact ? 0 : 0.5 * sizes * m->lubrication.outer_gap))
        for (int side = 0; side < 2; side++)
            worst_see_vector(&s->range, own[side], (const double[6]){ 0 }, 6, 1, at);
    if (contact && !m->has_laws) {              /* other laws have another cap: judged by the model */
        const double normal = dot(own[0], n), cap = m->contact.friction * fabs(normal);
        double tangential = 0;
        for (int k = 0; k < 3; k++)
            tangential += pow(own[0][k] - normal * n[k], 2);
        worst_see(&s->cap, fmax(sqrt(tangential), cap), cap, e->force_scale, at);
    } else if (!contact) {
        double power = 0, scale = 0;
        for (int side = 0; side < 2; side++) {
            power += dot(own[side], p->s[side].u) + dot(own[side] + 3, p->s[side].w);
            scale += e->force_scale * norm(p->s[side].u) + e->torque_scale * norm(p->s[side].w);
        }
        worst_see(&s->power, fmax(power, 0), 0, scale, at);
    }
}

static void see_relabelling(struct seen *s, const struct pair_book *book, const struct pair_answer *a, const char *force,
                            size_t at, const struct expected *e)
{
    const size_t half = book->count / 2;
    for (int side = 0; side < 2 && at < half; side++) {
        const double *one = forces_at(&a->forces, at, force, 1 + side), *other = forces_at(&a->forces, at + half, force, 2 - side);
        worst_see_vector(&s->relabelling, other, one, 3, e->force_scale, at);
        worst_see_vector(&s->relabelling, other + 3, one + 3, 3, e->torque_scale, at);
    }
}

/* Part 0 along n, part 1 across it: squeezing and the normal spring, sliding and friction. */
static void split_force(const struct pair_state *p, const double force[3], double part[2][3])
{
    double n[3], r;
    pair_geometry(p, n, &r);
    for (int k = 0; k < 3; k++) {
        part[0][k] = dot(force, n) * n[k];
        part[1][k] = force[k] - part[0][k];
    }
}

static void see_model(struct seen *s, const struct model *m, bool contact, const struct pair_state *p, size_t at,
                      const struct expected *e, const double *own[2])
{
    double n[3], r, residual[3], own_residual[3], mine[2][3], expected[2][3];
    pair_geometry(p, n, &r);
    split_force(p, own[0], mine);
    split_force(p, e->pair.force[0], expected);
    for (int part = 0; part < 2; part++)
        worst_see_vector(&s->force[part], mine[part], expected[part], 3, e->force_scale, at);
    for (int side = 0; side < 2; side++)
        worst_see_vector(&s->torque[side], own[side] + 3, e->pair.torque[side], 3, e->torque_scale, at);
    if (contact && m->has_laws)
        for (int k = 0; k < 3; k++)     /* from the force and torques expected */
            residual[k] = e->pair.torque[0][k] + e->pair.torque[1][k]
                          + r * (n[(k + 1) % 3] * e->pair.force[1][(k + 2) % 3] - n[(k + 2) % 3] * e->pair.force[1][(k + 1) % 3]);
    else if (contact)
        theory_contact_torque_residual(&m->contact, p->s, p->with_history ? p->history : (const double[3]){ 0 }, residual);
    else
        theory_lubrication_torque_residual(&m->lubrication, p->s, residual);
    for (int k = 0; k < 3; k++)
        n[k] *= r;
    cross(n, own[1], own_residual);
    for (int k = 0; k < 3; k++)
        own_residual[k] += own[0][3 + k] + own[1][3 + k];
    worst_see_vector(&s->residual, own_residual, residual, 3, e->torque_scale, at);
}

/* Normal and tangential parts of F (x) r for a contact; all of it in the first for lubrication. */
static void split_stress(const struct pair_state *p, const double force[3], bool contact, double part[2][9])
{
    double n[3], r;
    pair_geometry(p, n, &r);
    const double normal = dot(force, n);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            part[0][3 * a + b] = (contact ? normal * n[a] : force[a]) * r * n[b];
            part[1][3 * a + b] = contact ? (force[a] - normal * n[a]) * r * n[b] : 0;
        }
}

/* `own`: patterns of the stress over F (x) r of the candidate's own force, normal and tangential. */
static bool see_stress(struct check_run *run, struct seen *s, struct pattern own[2], const struct model *m, bool contact,
                       const struct pair_book *book, const struct pair_answer *a)
{
    static const char *const origin[2][2] = { { "lubrication", NULL }, { "contact_normal", "contact_tangential" } };
    for (int o = 0; o < 2 && origin[contact][o]; o++) {
        if (o == 1 && m->contact.friction == 0)
            continue;
        double *stress = answer_stress(run, a, book->count, origin[contact][o], m->volume), part[2][9];
        if (!stress)
            return false;
        for (size_t k = 0; k < book->count; k++) {
            const struct pair_state *p = &book->item[k];
            struct expected e;
            (contact ? expect_contact : expect_lubrication)(m, p, &e);
            double n[3], r;
            pair_geometry(p, n, &r);
            split_stress(p, forces_at(&a->forces, k, contact ? "contact" : "lubrication", 1), contact, part);
            worst_see_vector(&s->own_stress[o], stress + 9 * k, part[o], 9, e.force_scale * r, k);
            pattern_see(&own[o], stress + 9 * k, part[o], 9, e.force_scale * r, p->s[1].radius / p->s[0].radius, p->xi, NULL, NULL);
            split_stress(p, e.pair.force[0], contact, part);
            worst_see_vector(&s->stress[o], stress + 9 * k, part[o], 9, e.force_scale * r, k);
        }
        free(stress);
    }
    return true;
}

static void judge(struct check_run *run, const struct pair_book *book, enum judgement judgement, const char *what,
                  const struct worst *w, const char *sentence)
{
    if (w->error == -1) /* nothing of the kind was asked */
        return;
    check_error(run, judgement, what, w->measured, w->expected, w->error, run->gate_case->tolerance, "%s: %s; worst at %s",
                sentence, compare(w), describe(&book->item[w->at], w->at));
}

/* To what kind of contact a state belongs; the friction law may be another than the plain one, so `slides` is a guess there. */
static void kinds_of(const struct model *m, const struct pair_state *p, const char *kind[2])
{
    double n[3], r, across[3];
    const double h = pair_geometry(p, n, &r), along = dot(p->history, n);
    for (int k = 0; k < 3; k++)
        across[k] = p->history[k] - along * n[k];
    kind[0] = p->with_history ? "with a history" : "without a history";
    kind[1] = !p->with_history ? NULL
              : norm(across) * m->contact.tangential_stiffness > m->contact.friction * m->contact.normal_stiffness * fmax(-h, 0)
                  ? "where the contact slides"
              : p->listed_backwards ? "where the history is listed from 2 to 1" : "where the contact sticks";
}

/* The force along n less that of the spring: what a dashpot adds. */
static void without_spring(const struct model *m, const struct pair_state *p, double force[3])
{
    double n[3], r;
    const double h = pair_geometry(p, n, &r);
    for (int k = 0; k < 3; k++)
        force[k] += m->contact.normal_stiffness * fmax(-h, 0) * n[k];
}

/* A quantity of the model, with the pattern of its ratios: part 0, 1 of the force, or 2, 3: torque on 1, 2. */
static void judge_pattern(struct check_run *run, const struct model *m, const struct pair_book *book, const struct pair_answer *a,
                          const char *force, bool contact, int part, const struct worst *w)
{
    static const char *const what[] = { "force along n", "force across n", "torque on 1", "torque on 2" };
    struct pattern pattern, damped;
    char dashpot[512] = "";
    pattern_start(&pattern, run->gate_case->tolerance);
    pattern_start(&damped, run->gate_case->tolerance);
    for (size_t k = 0; k < book->count && !(w->error <= run->gate_case->tolerance); k++) {
        const struct pair_state *p = &book->item[k];
        const double ratio = p->s[1].radius / p->s[0].radius;
        struct expected e;
        double mine[2][3], expected[2][3];
        const char *kind[2] = { NULL, NULL };
        (contact ? expect_contact : expect_lubrication)(m, p, &e);
        split_force(p, forces_at(&a->forces, k, force, 1), mine);
        split_force(p, e.pair.force[0], expected);
        if (contact)
            kinds_of(m, p, kind);
        if (part < 2)
            pattern_see(&pattern, mine[part], expected[part], 3, e.force_scale, ratio, p->xi, kind[0], kind[1]);
        else
            pattern_see(&pattern, forces_at(&a->forces, k, force, part - 1) + 3, e.pair.torque[part - 2], 3, e.torque_scale, ratio,
                        p->xi, kind[0], kind[1]);
        if (part == 0 && contact && m->has_laws) {
            without_spring(m, p, mine[0]);
            without_spring(m, p, expected[0]);
            pattern_see(&damped, mine[0], expected[0], 3, e.force_scale, ratio, p->xi, kind[0], kind[1]);
        }
    }
    if (pattern_simple(&damped))
        snprintf(dashpot, sizeof dashpot, "; less the spring it is %s", pattern_words(&damped));
    check_error(run, MODEL, what[part], w->measured, w->expected, w->error, run->gate_case->tolerance,
                "%s of %s: %s%s; worst is %s at %s", what[part], force, pattern_words(&pattern), dashpot, compare(w),
                describe(&book->item[w->at], w->at));
}

static void judge_all(struct check_run *run, const struct model *m, const struct pair_book *book, const struct pair_answer *a,
                      const char *force, const struct seen *s, const struct pattern own_stress[2], bool contact)
{
    judge(run, book, INVARIANT, "third law", &s->third_law, "the force on 2 is not minus the force on 1");
    judge(run, book, INVARIANT, "torque balance", &s->balance,
          "the torques do not balance the couple of the forces beyond what the levers leave");
    judge(run, book, INVARIANT, "relabelling", &s->relabelling, "exchanging the labels 1 and 2 changes the physics");
    judge(run, book, INVARIANT, "total = sum of parts", &s->total, "`total` is not the sum of the forces listed");
    judge(run, book, INVARIANT, "power", &s->power, "lubrication gives energy to the pair");
    if (contact)
        judge(run, book, INVARIANT, "Coulomb cap", &s->cap, "the tangential force exceeds friction times the normal force");
    judge(run, book, INVARIANT, "range", &s->range, "there is a force beyond the range");
    for (int part = 0; part < 2; part++) {
        char fault[2048];
        snprintf(fault, sizeof fault, "the %sstress is not F%s (x) r / V of the candidate's own force, it is %s", part ? "tangential " : "",
                 part ? "_t" : "", pattern_words(&own_stress[part]));
        judge(run, book, INVARIANT, part ? "tangential stress from own forces" : contact ? "normal stress from own forces" : "stress from own forces",
              &s->own_stress[part], fault);
    }
    for (int part = 0; part < 4; part++)
        judge_pattern(run, m, book, a, force, contact, part, part < 2 ? &s->force[part] : &s->torque[part - 2]);
    judge(run, book, MODEL, "torque residual", &s->residual, "T_1 + T_2 + r x F_2 is not what the declared lever leaves");
    judge(run, book, MODEL, contact ? "normal stress" : "stress", &s->stress[0], "the stress times the volume is");
    judge(run, book, MODEL, "tangential stress", &s->stress[1], "the tangential stress times the volume is");
}

void pair_forces(struct check_run *run)
{
    const char *force = json_string_value(json_object_get(run->gate_case->parameters, "force"));
    struct model m;
    if (!force || !model_read(run, run->gate_case->scene, &m))
        return;
    const bool contact = strcmp(force, "contact") == 0;
    struct pair_book book = { 0 };
    struct pair_answer answer = { 0 };
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%s,total", force);
    fill_book(run, &m, contact, &book);
    if (book_ask(run, "pairs", run->gate_case->scene, &book, wanted, &answer)) {
        struct seen s;
        struct pattern own_stress[2];
        pattern_start(&own_stress[0], run->gate_case->tolerance);
        pattern_start(&own_stress[1], run->gate_case->tolerance);
        for (size_t k = 0; k < sizeof s / sizeof(struct worst); k++)
            ((struct worst *)&s)[k] = (struct worst)WORST_NONE;
        for (size_t k = 0; k < book.count; k++) {
            const struct pair_state *p = &book.item[k];
            const double *own[2] = { forces_at(&answer.forces, k, force, 1), forces_at(&answer.forces, k, force, 2) };
            struct expected e;
            (contact ? expect_contact : expect_lubrication)(&m, p, &e);
            see_invariants(&s, &m, contact, p, k, &e, own);
            see_relabelling(&s, &book, &answer, force, k, &e);
            see_model(&s, &m, contact, p, k, &e, own);
            for (int side = 0; side < 2; side++) {
                const double *total = forces_at(&answer.forces, k, "total", 1 + side);
                worst_see_vector(&s.total, total, own[side], 3, e.force_scale, k);
                worst_see_vector(&s.total, total + 3, own[side] + 3, 3, e.torque_scale, k);
            }
        }
        if (see_stress(run, &s, own_stress, &m, contact, &book, &answer))
            judge_all(run, &m, &book, &answer, force, &s, own_stress, contact);
    }
    forces_free(&answer.forces);
    book_free(&book);
}
