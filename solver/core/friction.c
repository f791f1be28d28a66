#include "core/friction.h"

#include "core/conjugate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 2000 };

static bool make_room(struct friction *f, const struct suspension *s, struct error *e)
{
    const int width = s->particles.spin ? 6 : 3;
    if (f->count != s->particles.count || f->width != width) {
        const size_t n = (size_t)s->particles.count * (size_t)width;
        free(f->number);
        f->number = calloc(8 * n + 1, sizeof *f->number);
        if (!f->number)
            return error_out_of_memory(e);
        double **const part[] = { &f->mass, &f->drag, &f->diagonal, &f->change, &f->rhs, &f->work };
        for (size_t k = 0; k < 6; k++)
            *part[k] = f->number + k * n;
        f->count = s->particles.count;
        f->width = width;
    }
    if (s->neighbours.near.count > f->room) {
        f->room = s->neighbours.near.count + s->neighbours.near.count / 4;
        free(f->link);
        f->link = malloc((size_t)f->room * sizeof *f->link);
        if (!f->link) {
            f->room = 0;
            return error_out_of_memory(e);
        }
    }
    return true;
}

bool friction_gather(struct friction *f, const struct suspension *s, double dt, struct error *e)
{
    const struct particles *p = &s->particles;
    const struct near_pairs *near = &s->neighbours.near;
    if (!make_room(f, s, e))
        return false;
    f->half_dt = 0.5 * dt;
    f->driven = false;
    for (int a = 0; a < p->species_count; a++)
        f->driven = f->driven || p->kind[a].driven;
    for (int i = 0; i < p->count; i++) {
        double rate[2] = { 0.0, 0.0 };
        for (int k = 0; k < s->force_count; k++)
            if (s->force[k]->kind == FRICTION && s->force[k]->respond_alone)
                s->force[k]->respond_alone(s->force[k], p, p->species[i], &rate[0], &rate[1]);
        for (int c = 0; c < f->width; c++) {
            const int at = i * f->width + c;
            f->mass[at] = c < 3 ? mass_of(p, i) : inertia_of(p, i);
            f->drag[at] = p->kind[p->species[i]].driven ? 0.0 : rate[c / 3] * f->mass[at];
            f->diagonal[at] = p->kind[p->species[i]].driven ? 1.0 : f->mass[at] + f->half_dt * f->drag[at];
        }
    }
    f->links = 0;
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        struct response r = { 0 };
        for (int w = 0; w < s->force_count; w++)
            if (s->force[w]->kind == FRICTION && s->force[w]->respond)
                s->force[w]->respond(s->force[w], p, p->species[pair->i], p->species[pair->j], pair->gap, &r);
        if (r.resistance.X_A > 0.0)
            f->link[f->links++] = (struct friction_link){ pair->i, pair->j, k, pair->normal, r.resistance };
    }
    return true;
}

static vec3 read3(const double *x) { return vec(x[0], x[1], x[2]); }

static void add3(double *y, double s, vec3 a)
{
    y[0] += s * a.x;
    y[1] += s * a.y;
    y[2] += s * a.z;
}

void friction_apply(const void *context, const double *x, double *y)
{
    const struct friction *f = context;
    const double h = f->half_dt;
    for (int k = 0; k < f->count * f->width; k++)
        y[k] = f->diagonal[k] * x[k];
    for (int k = 0; k < f->links; k++) {
        const struct friction_link *l = &f->link[k];
        const double *v_i = x + l->i * f->width, *v_j = x + l->j * f->width;
        double *y_i = y + l->i * f->width, *y_j = y + l->j * f->width;
        const bool spins = f->width == 6;
        vec3 torque_i, torque_j;
        const vec3 force = resistance_act(&l->resistance, l->normal, minus(read3(v_j), read3(v_i)), spins ? read3(v_i + 3) : vec(0, 0, 0),
                                          spins ? read3(v_j + 3) : vec(0, 0, 0), &torque_i, &torque_j);
        add3(y_i, -h, force);
        add3(y_j, h, force);
        if (spins) {
            add3(y_i + 3, -h, torque_i);
            add3(y_j + 3, -h, torque_j);
        }
    }
    for (int k = 0; k < f->count * f->width && f->driven; k++)
        if (isinf(f->mass[k]))
            y[k] = x[k];                    /* nothing changes a driven particle's velocity: x = 0 there */
}

bool friction_solve(struct friction *f, const struct suspension *s, double residual, struct error *e)
{
    const struct particles *p = &s->particles;
    for (int i = 0; i < p->count; i++) {
        double *b = f->rhs + i * f->width;
        memset(b, 0, (size_t)f->width * sizeof *b);
        if (p->kind[p->species[i]].driven)
            continue;
        add3(b, f->half_dt, p->force[i]);
        if (f->width == 6)
            add3(b + 3, f->half_dt, p->torque[i]);
    }
    const struct linear_system system = { .size = (size_t)(f->count * f->width), .apply = friction_apply, .context = f, .diagonal = f->diagonal,
                                          .work = f->work, .residual = residual, .most_iterations = MOST_ITERATIONS };
    memset(f->change, 0, system.size * sizeof *f->change);
    const int taken = conjugate_solve(&system, f->rhs, f->change);
    if (taken < 0)
        return error_raise(e, ERROR_RUN, "the friction step did not reach its residual %g in %d iterations at time %.9g: shorten dt", residual,
                           MOST_ITERATIONS, s->box.time);
    f->solves++;
    f->iterations += taken;
    return true;
}

void friction_move(const struct friction *f, struct particles *p, double times)
{
    for (int i = 0; i < p->count; i++) {
        const double *c = f->change + i * f->width;
        p->velocity[i] = plus(p->velocity[i], scaled(read3(c), times));
        if (f->width == 6)
            p->spin[i] = plus(p->spin[i], scaled(read3(c + 3), times));
    }
}

void friction_free(struct friction *f)
{
    free(f->number);
    free(f->link);
    memset(f, 0, sizeof *f);
}
