/*
 * Layer 4: two spheres meet
 *
 *     head-on    speed ratio and duration of a damped contact, tension allowed and clipped: closed forms
 *     sliding    an oblique impact that slides throughout: velocities and spins after it, from the impulse of the load: closed form
 *     sticking   an oblique impact that never slides, soft enough to turn while it lasts: places, velocities and spins along the
 *                way against the equations of motion integrated to 1e-13
 *
 * Each impact is run at several steps eps = w dt, w = sqrt(k_n/m). A force that changes with velocity, or that begins or ends within
 * a step, makes an error of first order in the usual schemes, so what is allowed is a stated multiple of eps at each of the steps:
 * an error that does not shrink with dt fails at the smallest. Spheres start exactly touching, in a direction along no axis, with a
 * common velocity; the same pair is held to conservation of momentum, and a driven sphere to its motion.
 */
#include "single.h"

#include <stdio.h>
#include <string.h>

struct impact {
    const char *name;
    struct model m;
    struct theory_contact law;
    struct theory_collision c;          /* law and start */
    struct state_row start[2];
    double n[3], t[3];                  /* normal from 1 to 2, direction of the tangential velocity of 1 against 2 */
    double closing, sliding, w;         /* speeds; sqrt(k_n/m) */
};

/* What a result says of all steps: the largest error in units of the error allowed. */
struct judged { const char *what, *law; struct worst worst; double eps; };

static void see(struct judged *j, double measured, double expected, double scale, double allowed, double eps)
{
    const double before = j->worst.error;
    worst_see(&j->worst, measured, expected, scale * allowed, 0);
    if (j->worst.error != before)
        j->eps = eps;
}

static void record(struct check_run *run, const struct impact *i, const struct judged *j)
{
    char what[128];
    snprintf(what, sizeof what, "%s: %s", i->name, j->what);
    if (j->worst.error >= 0)
        check_error(run, MODEL, what, j->worst.measured, j->worst.expected, j->worst.error, 1.0,
                    "%s: %s; %s is %s at eps = %g, %.3g of what an error of first order in the step may be", i->name, j->law, j->what,
                    compare(&j->worst), j->eps, j->worst.error);
}

/* Directions along no axis, speeds from the case, a common velocity unless a sphere is driven. */
static void prepare(struct impact *i, const json_t *one)
{
    static const double n[3] = { 0.36, -0.48, 0.8 }, t[3] = { 0.8, 0.6, 0.0 }, common[3] = { 0.21, -0.13, 0.34 };
    struct theory_sphere *s = i->c.start;
    const struct model *m = &i->m;
    i->closing = scene_number(one, "closing", 0);
    i->sliding = scene_number(one, "sliding", 0);
    for (size_t a = 0; a < 2; a++) {
        s[a] = (struct theory_sphere){ .radius = m->radius[a] };
        for (int k = 0; k < 3; k++)
            s[a].w[k] = m->driven[a] ? m->spin[a][k] : scene_number(one, a ? "spin_2" : "spin_1", 0) * (n[(k + 1) % 3] * t[(k + 2) % 3] - n[(k + 2) % 3] * t[(k + 1) % 3]);
    }
    for (int k = 0; k < 3; k++) {
        i->n[k] = n[k];
        i->t[k] = t[k];
        s[1].u[k] = m->driven[1] ? m->velocity[1][k] : common[k];
        s[0].u[k] = s[1].u[k] + i->closing * n[k] + i->sliding * t[k];
        s[0].x[k] = 8.0 + k;
        s[1].x[k] = s[0].x[k] + (s[0].radius + s[1].radius) * n[k];
    }
    i->law = contact_between(m, m->radius[0], m->radius[1]);
    i->c.law = &i->law;
    i->w = sqrt(i->law.normal_stiffness / theory_reduced_mass(&i->law));
    for (int a = 0; a < 2; a++) {
        i->start[a] = (struct state_row){ .id = a + 1, .species = a + 1 };
        memcpy(i->start[a].x, s[a].x, sizeof s[a].x);
        if (!m->driven[a]) {            /* what a file says of a driven sphere's velocity does not count */
            memcpy(i->start[a].u, s[a].u, sizeof s[a].u);
            memcpy(i->start[a].w, s[a].w, sizeof s[a].w);
        }
    }
}

/* The scene of the case with the impact's own species and contact. */
static json_t *scene_of(const struct check_run *run, const json_t *one)
{
    json_t *scene = json_deep_copy(run->gate_case->scene), *contact = json_object_get(one, "contact"), *species = json_object_get(one, "species");
    if (contact)
        json_object_update(scene_get(scene, "forces.contact"), contact);
    if (species)
        json_object_set(scene, "species", species);
    return scene;
}

static void along(const double a[3], const double b[3], const double n[3], double *part)
{
    *part = 0;
    for (int k = 0; k < 3; k++)
        *part += (a[k] - b[k]) * n[k];
}

/* Momentum of free spheres; place, velocity and spin of a driven one. Rounding only, whatever the step. */
static void see_kept(const struct check_run *run, struct judged *kept, const struct impact *i, const struct track_point *p[2], double t, double eps)
{
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3 && i->m.driven[a]; k++) {
            see(kept, p[a]->u[k], i->m.velocity[a][k], 1, check_rounding(run, 1e-14), eps);
            see(kept, p[a]->w[k], i->m.spin[a][k], 1, check_rounding(run, 1e-14), eps);
            see(kept, p[a]->x[k], i->c.start[a].x[k] + t * i->m.velocity[a][k], 10, check_rounding(run, 1e-12), eps);
        }
    const double *m = i->law.mass;
    for (int k = 0; k < 3 && !i->m.driven[0] && !i->m.driven[1]; k++)
        see(kept, m[0] * p[0]->u[k] + m[1] * p[1]->u[k], m[0] * i->c.start[0].u[k] + m[1] * i->c.start[1].u[k], (m[0] + m[1]) * (i->closing + i->sliding),
            check_rounding(run, 1e-11), eps);
}

typedef bool look_at(struct check_run *run, struct impact *i, const struct track *track, double dt, const int *at, double eps, struct judged *j);

static bool look_head_on(struct check_run *run, struct impact *i, const struct track *track, double dt, const int *at, double eps, struct judged *j)
{
    const double allowed = scene_number(run->gate_case->parameters, "first_order", 1) * eps;
    const struct track_point *p[2] = { track_at(track, track->steps - 1, 0), track_at(track, track->steps - 1, 1) };
    double e, duration, leaving, distance;
    theory_head_on(&i->law, &e, &duration);
    along(p[1]->u, p[0]->u, i->n, &leaving);
    along(p[1]->x, p[0]->x, i->n, &distance);
    const double T = at[track->steps - 1] * dt;
    see(&j[0], leaving / i->closing, e, e, allowed, eps);
    see(&j[1], i->w * (T - (distance - i->m.radius[0] - i->m.radius[1]) / leaving), i->w * duration, i->w * duration, allowed, eps);
    see_kept(run, &j[2], i, p, T, eps);
    return true;
}

/* The normal turns by `turned` while the contact lasts: what the closed form leaves out. */
static bool look_sliding(struct check_run *run, struct impact *i, const struct track *track, double dt, const int *at, double eps, struct judged *j)
{
    double e, duration;
    theory_head_on(&i->law, &e, &duration);
    const double turned = 2 * i->sliding * duration / (i->m.radius[0] + i->m.radius[1]);
    const double first_order = scene_number(run->gate_case->parameters, "first_order", 1) * eps;
    const double J = i->law.friction * i->closing * theory_sliding_impulse(&i->law), m = theory_reduced_mass(&i->law);
    const double rub = J / m, push = (1 + e) * i->closing;      /* changes of relative velocity */
    const struct track_point *p[2] = { track_at(track, track->steps - 1, 0), track_at(track, track->steps - 1, 1) };
    for (int a = 0; a < 2; a++) {
        const double M = i->law.mass[a], radius = i->m.radius[a], side = a ? -1.0 : 1.0;
        for (int k = 0; k < 3 && !i->m.driven[a]; k++) {
            const int l = (k + 1) % 3, q = (k + 2) % 3;
            const double u = i->c.start[a].u[k] - side * (push * m * i->n[k] + J * i->t[k]) / M;
            const double spin = i->c.start[a].w[k] - J * radius * (i->n[l] * i->t[q] - i->n[q] * i->t[l]) / (0.4 * M * radius * radius);
            see(&j[0], p[a]->u[k], u, m / M, first_order * fmin(rub, push) + turned * (rub + push), eps);
            see(&j[1], p[a]->w[k], spin, m / M / radius, (first_order + turned) * rub, eps);
        }
    }
    see_kept(run, &j[2], i, p, at[track->steps - 1] * dt, eps);
    return true;
}

static bool look_sticking(struct check_run *run, struct impact *i, const struct track *track, double dt, const int *at, double eps, struct judged *j)
{
    const double allowed = scene_number(run->gate_case->parameters, "first_order", 1) * eps, speed = i->closing + i->sliding;
    for (size_t s = 0; s < track->steps; s++) {
        struct theory_sphere now[2];
        if (!theory_collide(&i->c, at[s] * dt, now)) {
            check_inconclusive(run, i->name, "the equations of motion could not be integrated; this is a mistake in the suite");
            return false;
        }
        const struct track_point *p[2] = { track_at(track, s, 0), track_at(track, s, 1) };
        for (int a = 0; a < 2; a++)
            for (int k = 0; k < 3; k++) {
                see(&j[0], p[a]->u[k], now[a].u[k], speed, allowed, eps);
                see(&j[1], p[a]->w[k], now[a].w[k], speed / now[a].radius, allowed, eps);
                see(&j[3], p[a]->x[k], now[a].x[k], speed / i->w, allowed, eps);
            }
        see_kept(run, &j[2], i, p, at[s] * dt, eps);
    }
    return true;
}

/* Every impact of the case at every step; looked at at the given shares of the duration of a head-on impact. */
static void collide(struct check_run *run, look_at *look, const double share[], size_t shares, struct judged template[4])
{
    double eps[8];
    size_t steps, k;
    json_t *one;
    parameter_list(run->gate_case->parameters, "eps", eps, &steps, 8);
    json_array_foreach(json_object_get(run->gate_case->parameters, "impacts"), k, one)
    {
        struct impact i = { .name = json_string_value(json_object_get(one, "name")) };
        struct judged j[4];
        memcpy(j, template, sizeof j);
        json_t *scene = scene_of(run, one);
        bool good = i.name && model_read(run, scene, &i.m);
        if (good)
            prepare(&i, one);
        for (size_t s = 0; s < steps && good; s++) {
            const double dt = eps[s] / i.w;
            double e, duration;
            int at[8];
            struct track track;
            char name[96];
            theory_head_on(&i.law, &e, &duration);
            for (size_t q = 0; q < shares; q++)
                at[q] = (int)(share[q] * duration / dt) + 1;
            scene_set(scene, "dynamics.verlet.dt", json_real(dt));
            snprintf(name, sizeof name, "%s-%zu", i.name, s + 1);
            good = track_ask(run, name, scene, i.start, 2, at, shares, &track);
            if (good) {
                good = look(run, &i, &track, dt, at, eps[s], j);
                track_free(&track);
            }
        }
        json_decref(scene);
        if (!good)
            return;
        for (size_t q = 0; q < 4; q++)
            if (j[q].what)
                record(run, &i, &j[q]);
    }
}

#define KEPT { "what is kept", "free spheres keep their momentum, a driven one its velocity and spin", WORST_NONE, 0 }

static void head_on(struct check_run *run)
{
    struct judged j[4] = { { "restitution", "the speed ratio of a damped head-on impact", WORST_NONE, 0 },
                           { "duration times w", "the time from touch to where the free flight passes zero overlap", WORST_NONE, 0 }, KEPT, { 0 } };
    collide(run, look_head_on, (const double[]){ 1.5 }, 1, j);
}

static void sliding(struct check_run *run)
{
    struct judged j[4] = { { "velocity after", "a sliding impact gives friction times the impulse of the load", WORST_NONE, 0 },
                           { "spin after", "a sliding impact turns both spheres, by arms of their radii", WORST_NONE, 0 }, KEPT, { 0 } };
    collide(run, look_sliding, (const double[]){ 1.3 }, 1, j);
}

static void sticking(struct check_run *run)
{
    struct judged j[4] = { { "velocity", "spring and dashpots along the way", WORST_NONE, 0 },
                           { "spin", "the tangential spring turns both spheres", WORST_NONE, 0 }, KEPT,
                           { "place", "where the spheres are along the way", WORST_NONE, 0 } };
    collide(run, look_sticking, (const double[]){ 0.3, 0.6, 0.9, 1.4 }, 4, j);
}

const struct check collision_checks[] = { { "collision-head-on", head_on }, { "collision-sliding", sliding }, { "collision-sticking", sticking },
                                          { NULL, NULL } };
