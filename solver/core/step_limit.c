#include "core/step_limit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct { double m[6][6]; } block;

/* From w^2 dt^2 + 2 g dt = 4; with 4 g dt where friction acts at predicted velocities. */
static double limit_of(const struct suspension *s, double g, double w2)
{
    const double friction = s->predicted_friction ? 2.0 * g : g;
    return 4.0 / (friction + sqrt(friction * friction + 4.0 * w2));
}

/* Largest eigenvalue of a symmetric positive semidefinite block, from above by at most 6 %: |A^16|^(1/16), Frobenius norm. */
static double largest_eigenvalue(block A)
{
    double scale = 1.0, trace = 0.0;
    for (int r = 0; r < 6; r++)
        trace += A.m[r][r];
    if (trace <= 0.0)
        return 0.0;
    double exponent = 1.0, size = 0.0;
    for (int squaring = 0; squaring <= 4; squaring++) {
        size = 0.0;
        for (int k = 0; k < 36; k++)
            size += A.m[k / 6][k % 6] * A.m[k / 6][k % 6];
        size = sqrt(size);
        scale *= pow(size, exponent);                       /* largest <= scale at each stage; A is kept of norm 1 */
        for (int k = 0; k < 36; k++)
            A.m[k / 6][k % 6] /= size;
        block square = { { { 0.0 } } };
        for (int r = 0; r < 6; r++)
            for (int c = 0; c < 6; c++)
                for (int k = 0; k < 6; k++)
                    square.m[r][c] += A.m[r][k] * A.m[k][c];
        A = square;
        exponent *= 0.5;
    }
    return scale;
}

/*
 * Adds to the block of one side of a pair, scaled by mass: normal N n n + T (I - n n) for velocities, rotation C (I - n n),
 * and the coupling B of spin to force; `side` is +1 for i, -1 for j, where n points the other way.
 */
static void add_side(block *A, double weight, double mass, double inertia, vec3 n, double side, double N, double T, double B, double C)
{
    const double u[3] = { n.x, n.y, n.z };
    const double cross_n[3][3] = { { 0, n.z, -n.y }, { -n.z, 0, n.x }, { n.y, -n.x, 0 } };     /* W -> W x n */
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const double along = u[r] * u[c], over = (r == c) - along;
            A->m[r][c] += weight * (N * along + T * over) / mass;
            A->m[r + 3][c + 3] += weight * C * over / inertia;
            A->m[r][c + 3] -= weight * side * B * cross_n[r][c] / sqrt(mass * inertia);
            A->m[c + 3][r] -= weight * side * B * cross_n[r][c] / sqrt(mass * inertia);
        }
}

struct blocks { block friction, stiffness; };

/* Blocks of species a against b, as particle i (side 1) or j (side -1) of the pair. */
static void add_pair(struct blocks *at, const struct suspension *s, const struct response *r, int a, double side, vec3 n, double weight)
{
    const struct species *own = &s->particles.kind[a];
    const struct resistance *R = &r->resistance;
    add_side(&at->friction, weight, own->mass, own->inertia, n, side, R->X_A, R->Y_A, side > 0 ? R->B_1 : R->B_2, side > 0 ? R->C_11 : R->C_22);
    const double k = r->tangential_stiffness, zeta = r->tangential_dashpot, lever = own->radius;
    if (own->driven)
        return;
    add_side(&at->friction, weight, own->mass, own->inertia, n, side, r->normal_dashpot, zeta, -zeta * lever, zeta * lever * lever);
    add_side(&at->stiffness, weight, own->mass, own->inertia, n, side, r->normal_stiffness, k, -k * lever, k * lever * lever);
}

/* Does this force limit an explicit step? Not where an implicit friction step takes care of it. */
static bool limits(const struct suspension *s, const struct force *f, const struct force *only)
{
    return (!only || only == f) && !(s->implicit_friction && f->kind == FRICTION);
}

static struct response response_of(const struct suspension *s, const struct force *only, int a, int b, double gap)
{
    struct response r = { 0 };
    for (int k = 0; k < s->force_count; k++)
        if (s->force[k]->respond && limits(s, s->force[k], only))
            s->force[k]->respond(s->force[k], &s->particles, a, b, gap, &r);
    return r;
}

static void drag_rates(const struct suspension *s, const struct force *only, int a, double rate[2])
{
    rate[0] = rate[1] = 0.0;
    for (int k = 0; k < s->force_count; k++)
        if (s->force[k]->respond_alone && limits(s, s->force[k], only))
            s->force[k]->respond_alone(s->force[k], &s->particles, a, &rate[0], &rate[1]);
}

static double stiffness_alone(const struct suspension *s, const struct force *only, int a)
{
    double k = 0.0;
    for (int f = 0; f < s->force_count; f++)
        if (s->force[f]->stiffness_alone && (!only || only == s->force[f]))
            k += s->force[f]->stiffness_alone(s->force[f], &s->particles, a);
    return k;
}

static void judge(struct step_limit *worst, const struct suspension *s, const struct force *only, int species, const struct blocks *at,
                  int tag, int neighbours)
{
    double drag[2];
    drag_rates(s, only, species, drag);
    const double g = largest_eigenvalue(at->friction) + fmax(drag[0], drag[1]);
    const double w2 = largest_eigenvalue(at->stiffness) + stiffness_alone(s, only, species) / s->particles.kind[species].mass;
    const double dt = limit_of(s, g, w2);
    if (dt < worst->dt)
        *worst = (struct step_limit){ dt, NULL, tag, neighbours, g, w2 };
}

/* A lone pair just overlapping. Weights 1 + m/m' make the bound exact for the squeezing of unequal masses. */
static void judge_lone_pairs(struct step_limit *worst, const struct suspension *s, const struct force *only)
{
    const struct particles *p = &s->particles;
    for (int a = 0; a < p->species_count; a++) {
        struct blocks alone;
        memset(&alone, 0, sizeof alone);
        judge(worst, s, only, a, &alone, 0, 0);
        for (int b = 0; b < p->species_count && p->count > 1; b++) {
            const struct response r = response_of(s, only, a, b, -1e-300);
            struct blocks at;
            memset(&at, 0, sizeof at);
            add_pair(&at, s, &r, a, 1.0, vec(1, 0, 0), 1.0 + p->kind[a].mass / p->kind[b].mass);
            judge(worst, s, only, a, &at, 0, 1);
        }
    }
}

static struct step_limit limit_with(const struct suspension *s, const struct force *only, struct error *e)
{
    struct step_limit worst = { INFINITY, NULL, 0, 0, 0.0, 0.0 };
    const struct particles *p = &s->particles;
    const struct near_pairs *near = &s->neighbours.near;
    struct blocks *at = calloc((size_t)p->count + 1, sizeof *at);
    int *neighbours = calloc((size_t)p->count + 1, sizeof *neighbours);
    if (!at || !neighbours)
        error_out_of_memory(e);
    for (int k = 0; at && neighbours && k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        const int a = p->species[pair->i], b = p->species[pair->j];
        const struct response r = response_of(s, only, a, b, pair->gap);
        add_pair(&at[pair->i], s, &r, a, 1.0, pair->normal, 2.0);
        add_pair(&at[pair->j], s, &r, b, -1.0, pair->normal, 2.0);
        neighbours[pair->i]++;
        neighbours[pair->j]++;
    }
    judge_lone_pairs(&worst, s, only);
    for (int i = 0; at && neighbours && i < p->count; i++)
        judge(&worst, s, only, p->species[i], &at[i], p->tag[i], neighbours[i]);
    free(at);
    free(neighbours);
    return worst;
}

struct step_limit step_limit_of(const struct suspension *s, struct error *e)
{
    struct step_limit all = limit_with(s, NULL, e);
    double least = INFINITY;
    all.force = "no force";
    for (int k = 0; k < s->force_count; k++) {
        if ((!s->force[k]->respond && !s->force[k]->respond_alone && !s->force[k]->stiffness_alone) || !limits(s, s->force[k], NULL))
            continue;
        const double own = limit_with(s, s->force[k], e).dt;
        if (own < least) {
            least = own;
            all.force = s->force[k]->name;
        }
    }
    return all;
}

/* The cheap test, traces for eigenvalues, that every new list is put to: true if dt is certainly stable. */
static bool surely_stable(const struct suspension *s, double dt)
{
    const struct particles *p = &s->particles;
    const struct near_pairs *near = &s->neighbours.near;
    double (*trace)[2] = calloc((size_t)p->count + 1, sizeof *trace);       /* of friction and stiffness */
    bool stable = trace != NULL;
    for (int k = 0; stable && k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        const struct response r = response_of(s, NULL, p->species[pair->i], p->species[pair->j], pair->gap);
        const struct resistance *R = &r.resistance;
        const int end[2] = { pair->i, pair->j };
        for (int side = 0; side < 2; side++) {
            const int i = end[side];
            const double m = mass_of(p, i), I = inertia_of(p, i), a = radius_of(p, i), C = side ? R->C_22 : R->C_11;
            const double zeta = r.tangential_dashpot;
            trace[i][0] += 2.0 * ((R->X_A + 2.0 * R->Y_A + r.normal_dashpot + 2.0 * zeta) / m + 2.0 * (C + zeta * a * a) / I);
            trace[i][1] += 2.0 * ((r.normal_stiffness + 2.0 * r.tangential_stiffness) / m + 2.0 * r.tangential_stiffness * a * a / I);
        }
    }
    for (int i = 0; stable && i < p->count; i++) {
        double drag[2];
        drag_rates(s, NULL, p->species[i], drag);
        const double w2 = trace[i][1] + stiffness_alone(s, NULL, p->species[i]) / mass_of(p, i);
        stable = dt < limit_of(s, trace[i][0] + fmax(drag[0], drag[1]), w2);
    }
    struct step_limit lone = { INFINITY, NULL, 0, 0, 0.0, 0.0 };
    judge_lone_pairs(&lone, s, NULL);
    free(trace);
    return stable && dt < lone.dt;
}

double step_advised(const struct suspension *s)
{
    const struct particles *p = &s->particles;
    const int touching = p->count > 0 && p->count - 1 < 12 ? p->count - 1 : 12;     /* a crowd where particles are yet to be placed */
    double dt = s->box.rate > 0.0 ? 1e-3 / s->box.rate : INFINITY;
    for (int a = 0; a < p->species_count; a++) {
        double drag[2];
        drag_rates(s, NULL, a, drag);
        const double k = stiffness_alone(s, NULL, a);
        if (k > 0.0)
            dt = fmin(dt, 0.03 * M_PI * sqrt(p->kind[a].mass / k));
        if (drag[0] > 0.0)
            dt = fmin(dt, 0.02 / fmax(drag[0], drag[1]));
        for (int b = 0; b < p->species_count && touching > 0; b++) {
            const struct response r = response_of(s, NULL, a, b, -1e-300);
            const double per_mass = 1.0 / p->kind[a].mass + 1.0 / p->kind[b].mass;
            if (r.normal_stiffness > 0.0)
                dt = fmin(dt, 0.03 * M_PI / sqrt(r.normal_stiffness * per_mass));
            if (r.normal_dashpot + r.tangential_dashpot > 0.0)      /* rotation makes the tangential rate 7/2 times as fast */
                dt = fmin(dt, 0.1 / (fmax(r.normal_dashpot, 3.5 * r.tangential_dashpot) * per_mass));
            if (r.resistance.X_A > 0.0 && s->kT > 0.0)
                dt = fmin(dt, 0.1 / (r.resistance.X_A * per_mass));
            /* z neighbours all around bring a particle's rate to about z/3 of one pair's */
            if (r.resistance.X_A > 0.0)
                dt = fmin(dt, 0.5 / (r.resistance.X_A * per_mass * fmax(1.0, touching / 3.0)));
        }
    }
    return dt;
}

double step_bias(const struct suspension *s, double dt)
{
    const struct particles *p = &s->particles;
    struct suspension any = *s;
    any.implicit_friction = false;                          /* friction counts, whoever takes care of it */
    double eps = 0.0;
    for (int a = 0; a < p->species_count; a++)
        for (int b = 0; b < p->species_count && p->count > 1; b++)
            eps = fmax(eps, response_of(&any, NULL, a, b, -1e-300).resistance.X_A * dt * (1.0 / p->kind[a].mass + 1.0 / p->kind[b].mass));
    return eps;
}

bool step_is_allowed(const struct suspension *s, const char *scheme, struct error *e)
{
    if (surely_stable(s, s->dt))
        return true;
    const struct step_limit limit = step_limit_of(s, e);
    if (error_raised(e) || s->dt < limit.dt)
        return !error_raised(e);
    char whom[80];
    if (limit.tag)
        snprintf(whom, sizeof whom, "particle %d with %d near neighbours", limit.tag, limit.neighbours);
    else
        snprintf(whom, sizeof whom, "%s", limit.neighbours ? "a lone pair in contact" : "a lone particle");
    return error_raise(e, ERROR_RUN, "dynamics.%s.dt is %g; at time %.9g it must be below %.4g, the limit that %s sets for %s: "
                       "take dt at most %.2g, or \"auto\"", scheme, s->dt, s->box.time, limit.dt, limit.force, whom, 0.5 * limit.dt);
}
