/*
 * Layer 1, shared parts of crowds (crowd.h): images, and what is expected of all forces by a sum over all images of all pairs
 *
 * Every image within range is visited, of a sphere and its own images one of each two that face each other. The stress of every origin is summed in
 * the same loop, with each pair once. Nothing is skipped that a neighbour search could miss.
 */
#include "crowd.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const crowd_force[FORCES] = { "contact", "lubrication", "drag", "repulsion", "applied" };
const char *const crowd_origin[ORIGINS] = { "contact_normal", "contact_tangential", "lubrication", "drag", "repulsion", "kinetic" };

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

void crowd_anywhere(struct crowd *c, gsl_rng *random, size_t k)
{
    double *x = c->sphere[k].s.x;
    for (int v = 0; v < 3; v++) {
        const double along = gsl_rng_uniform(random);
        for (int d = 0; d < 3; d++)
            x[d] = (v ? x[d] : 0.0) + along * c->m.cell[v][d];
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
    c->stress_scale[CONTACT_TANGENTIAL] += force == CONTACT ? e->force_scale * r : 0.0;
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

void crowd_expect_pair(struct crowd *c, size_t i, size_t j, const double shift[3], int force, struct pair_state *p, struct expected *e)
{
    double change[3];
    *p = (struct pair_state){ .s = { c->sphere[i].s, c->sphere[j].s } };
    *e = (struct expected){ 0 };
    apply(c->m.gradient, shift, change);
    for (int k = 0; k < 3; k++) {
        p->s[1].x[k] += shift[k];
        p->s[1].u[k] += change[k];
    }
    history_of(c, i, j, p);
    (force == CONTACT ? expect_contact : force == REPULSION ? expect_repulsion : expect_lubrication)(&c->m, p, e);
    if (force == LUBRICATION)
        e->force_scale += e->torque_scale / (p->s[0].radius + p->s[1].radius);
}

static void add_pair(struct crowd *c, size_t i, size_t j, const double shift[3], void *data)
{
    (void)data;
    if (c->m.driven[c->sphere[i].species - 1] && c->m.driven[c->sphere[j].species - 1])
        return;                         /* both move as they are told: no pair */
    static const int pair_force[3] = { LUBRICATION, CONTACT, REPULSION };
    for (int k = 0; k < 3; k++) {
        struct pair_state p;
        struct expected e;
        if (!c->present[pair_force[k]])
            continue;
        crowd_expect_pair(c, i, j, shift, pair_force[k], &p, &e);
        book_pair(c, pair_force[k], i, j, &p, &e);
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

struct state_row *crowd_rows(const struct crowd *c)
{
    struct state_row *row = calloc(c->count + 1, sizeof *row);
    for (size_t k = 0; row && k < c->count; k++) {
        row[k] = (struct state_row){ .id = (int)k + 1, .species = c->sphere[k].species };
        memcpy(row[k].x, c->sphere[k].s.x, sizeof row[k].x);
        memcpy(row[k].u, c->sphere[k].s.u, sizeof row[k].u);
        memcpy(row[k].w, c->sphere[k].s.w, sizeof row[k].w);
    }
    return row;
}

bool crowd_ask(struct check_run *run, const char *variant, json_t *scene, struct crowd *c, struct pair_answer *answer)
{
    expect(c);
    struct state_row *rows = crowd_rows(c);
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
            strcat(wanted, crowd_force[force]);
        }
    path_join(path, answer->out, "forces.csv");
    good = forces_read(path, 1, c->count, wanted, &answer->forces, why);
    if (!good)
        check_garbage(run, why);
    return good;
}
