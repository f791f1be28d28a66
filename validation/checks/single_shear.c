/*
 * Layer 3: a sphere without noise in shear
 *
 *     started with the flow:   x(t) = x(0) + G x(0) t ,  U = G x(0) ,  W = curl(U_inf)/2        exactly, for simple shear
 *     started otherwise:       relaxes to it with m/(6 pi eta a) and I/(8 pi eta a^3)           theory/free_sphere.c
 *
 * in all six planes, boxes of unequal edges and tilted ones, through all faces, over strains at which the cell is remapped. Every
 * wrap must give the image's velocity; positions are reported unwrapped, so that no trace of the box is left in them.
 *
 * Spheres on a streamline feel no force and an integrator of any order keeps them there to rounding. For the others the step
 * eps = dt/tau makes a first-order error (velocity Verlet with half-step velocities, LAMMPS: eps/2 of the peculiar velocity); the
 * tolerance is eps for the velocity and eps tau for the place, times the starting peculiar velocity.
 */
#include "single.h"
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SPHERES = 16, STREAMING = 8 };      /* the first half starts with the flow */

struct shear_plane { const char *name; struct worst place, velocity, spin, relaxing_place, relaxing_velocity, relaxing_spin; };

/* Anywhere in the cell, some outside it; half with the flow, a quarter at rest, a quarter thrown at the faces. */
static void spread(struct check_run *run, const struct model *m, double tau, struct state_row start[SPHERES])
{
    gsl_rng *random = pair_random(run);
    for (int i = 0; i < SPHERES; i++) {
        struct state_row *s = &start[i];
        *s = (struct state_row){ .id = i + 1, .species = 1 };
        double gradient[3][3];
        memcpy(gradient, m->gradient, sizeof gradient);
        for (int v = 0; v < 3; v++) {
            const double share = gsl_rng_uniform(random) * (i % 4 == 3 ? 2.4 : 1.0) - (i % 4 == 3 ? 0.7 : 0.0);
            for (int c = 0; c < 3; c++)
                s->x[c] += share * m->cell[v][c];
        }
        if (i < STREAMING + 4) {
            if (i >= STREAMING)
                continue;
            apply(gradient, s->x, s->u);
            for (int c = 0; c < 3; c++)
                s->w[c] = 0.5 * (m->gradient[(c + 2) % 3][(c + 1) % 3] - m->gradient[(c + 1) % 3][(c + 2) % 3]);
        } else {   /* far enough to leave through every face */
            random_vector(random, 0.8 * cbrt(m->volume) / tau, s->u);
            random_vector(random, 3.0, s->w);
        }
    }
    gsl_rng_free(random);
}

static void compare_with_theory(const struct model *m, const struct free_sphere *sphere, double dt, const int *at,
                                const struct track *track, const struct state_row *start, struct shear_plane *plane)
{
    const double tau = sphere->mass / sphere->friction, spin_tau = sphere->inertia / sphere->spin_friction;
    double gradient[3][3], size = cbrt(m->volume), speed = 0.0;
    memcpy(gradient, m->gradient, sizeof gradient);
    for (int k = 0; k < 9; k++)
        speed = fmax(speed, fabs(gradient[k / 3][k % 3]));
    for (size_t s = 0; s < track->steps; s++)
        for (size_t i = 0; i < track->count; i++) {
            const struct track_point *p = track_at(track, s, i);
            const double t = at[s] * dt;
            struct theory_sphere first = { .radius = sphere->radius }, now;
            memcpy(first.x, start[i].x, sizeof first.x);
            memcpy(first.u, start[i].u, sizeof first.u);
            memcpy(first.w, start[i].w, sizeof first.w);
            theory_free_sphere((const double (*)[3])gradient, tau, spin_tau, t, &first, &now);
            const bool spins = isfinite(p->w[0]);
            if (i < STREAMING) {
                worst_see_vector(&plane->place, p->x, now.x, 3, size * (1.0 + speed * t), i);
                worst_see_vector(&plane->velocity, p->u, now.u, 3, size * speed, i);
                if (spins)
                    worst_see_vector(&plane->spin, p->w, now.w, 3, speed, i);
                continue;
            }
            double peculiar[3], spin[3];
            apply(gradient, first.x, peculiar);
            for (int c = 0; c < 3; c++) {
                peculiar[c] -= first.u[c];
                spin[c] = first.w[c] - 0.5 * (gradient[(c + 2) % 3][(c + 1) % 3] - gradient[(c + 1) % 3][(c + 2) % 3]);
            }
            const double kick = norm(peculiar) * (1.0 + speed * t);    /* an error in the place is carried on by the flow */
            worst_see_vector(&plane->relaxing_place, p->x, now.x, 3, kick * tau * dt / tau, i);
            worst_see_vector(&plane->relaxing_velocity, p->u, now.u, 3, kick * dt / tau, i);
            if (spins)
                worst_see_vector(&plane->relaxing_spin, p->w, now.w, 3, norm(spin) * dt / spin_tau, i);
        }
}

static void record(struct check_run *run, const char *plane, const char *what, const struct worst *w, double tolerance,
                   const char *law)
{
    char name[96];
    snprintf(name, sizeof name, "%s: %s", plane, what);
    if (w->error < 0) {
        check_skip(run, name, "trajectory.csv gives no spins (wx, wy, wz)");
        return;
    }
    check_error(run, MODEL, name, w->measured, w->expected, w->error, tolerance, "sphere %zu in shear %s: %s; %s has %s", w->at + 1,
                plane, law, what, compare(w));
}

static void judge_plane(struct check_run *run, const struct shear_plane *p)
{
    const double rounding = run->gate_case->tolerance, first_order = 1.0;    /* in units of eps, already divided out */
    record(run, p->name, "place on the streamline", &p->place, rounding, "a sphere that starts with the flow stays on its streamline");
    record(run, p->name, "velocity on the streamline", &p->velocity, rounding, "a sphere that starts with the flow keeps its velocity");
    record(run, p->name, "spin on the streamline", &p->spin, rounding, "a sphere turns with half the vorticity");
    record(run, p->name, "relaxing place", &p->relaxing_place, first_order, "it drifts while its velocity relaxes in m/(6 pi eta a)");
    record(run, p->name, "relaxing velocity", &p->relaxing_velocity, first_order, "its velocity relaxes to the flow in m/(6 pi eta a)");
    record(run, p->name, "relaxing spin", &p->relaxing_spin, first_order, "its spin relaxes to half the vorticity in I/(8 pi eta a^3)");
}

void check_shear(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    size_t f, b;
    json_t *flow, *box;
    json_array_foreach(json_object_get(parameters, "flows"), f, flow)
    {
        struct shear_plane plane = { json_string_value(json_object_get(flow, "name")), WORST_NONE, WORST_NONE, WORST_NONE,
                                     WORST_NONE, WORST_NONE, WORST_NONE };
        bool answered = true;
        json_array_foreach(json_object_get(parameters, "boxes"), b, box)
        {
            json_t *variant = json_copy(box);
            json_object_set(variant, "shear", json_object_get(flow, "shear"));
            json_t *scene = variant_scene(run->gate_case, variant);
            json_decref(variant);
            struct model m;
            struct track track;
            struct state_row start[SPHERES];
            if (answered && model_read(run, scene, &m)) {
                const struct free_sphere sphere = free_sphere(&m);
                const double tau = sphere.mass / sphere.friction, dt = scene_number(parameters, "eps", NAN) * tau;
                double list[16];
                int at[16];
                size_t steps;
                parameter_list(parameters, "at", list, &steps, 16);
                for (size_t k = 0; k < steps; k++)
                    at[k] = (int)list[k];
                char step[96];
                step_key(scene, step);
                scene_set(scene, step, json_real(dt));
                spread(run, &m, tau, start);
                char name[64];
                snprintf(name, sizeof name, "%s-box-%zu", plane.name, b + 1);
                answered = track_ask(run, name, scene, start, SPHERES, at, steps, &track);
                if (answered) {
                    compare_with_theory(&m, &sphere, dt, at, &track, start, &plane);
                    track_free(&track);
                }
            }
            json_decref(scene);
        }
        if (!answered)
            return;
        judge_plane(run, &plane);
    }
}
