/*
 * Forces from steps. A run of two steps of length dt from each state gives velocities u0, u1, u2, and
 *
 *     F(start) = m/dt [ (u1 - u0) - c ((u2 - u1) - (u1 - u0)) ],    T = I/dt [ the same with spins ],
 *
 * c = 1/3 for velocity Verlet with half-step velocities (its first two changes are F at 1/4 and 1 step where F changes with the velocity), 0 for
 * Euler, 1/2 for any other scheme of second order. dt is so small that no position changes by a rounding (1e-20 of a crossing time), so that nothing
 * but the velocities changes, and masses such that these change by a part d or less in a step through forces that depend on them. What is left is
 *
 *     d^2 + eps u m/(F dt)        relative to F:  d = eps^(1/3) is best; states are asked in groups of like F/u, so that the second term stays small.
 */
#include "level_b.h"

#include "checks/pair.h"
#include "geometry.h"
#include "precision.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define DOUBLE_ROUNDOFF 1.1e-16
enum { STEPS = 2 };

/* A question of `forces`, and what is known of each of its states. */
struct subject {
    struct check_run *run;
    const char *name;
    const struct question *q;
    struct model model;
    size_t states, particles;
    double roundoff, change, bucket;    /* change: d above; bucket: decades of F/u in a group */
    double dt;
    double *fastest;                    /* of each state: the largest |u| or |w| a */
    double *rate, *force;               /* of each sphere: force over velocity, where it depends on velocity; all forces */
    double *least;                      /* of each sphere: a force in the direction in which it is weakest */
    double *state_rate, *state_force;   /* the largest in a state */
    int *group;
    double *value;                      /* forces and torques: [force][state][particle][6] */
};

double mass_of_row(const json_t *scene, const struct state_row *row)
{
    return 4.0 / 3.0 * M_PI * species_number(scene, row->species, "density") * pow(species_number(scene, row->species, "radius"), 3);
}

json_t *steps_scene(const json_t *scene, double dt)
{
    json_t *copy = json_deep_copy(scene), *rotation = json_incref(scene_get(scene, "dynamics.verlet.rotation"));
    scene_set(copy, "dynamics", json_pack("{s{sf}}", "verlet", "dt", dt));
    if (rotation)
        scene_set(copy, "dynamics.verlet.rotation", rotation);
    json_object_del(copy, "run");
    json_object_del(copy, "output");
    return copy;
}

struct friction { double viscosity, inner_gap, *strongest, *weakest; };

/* Squeezing, 6 pi eta R^2/h with R = a_i a_j/(a_i + a_j), is the largest resistance of a pair; sliding, about 6 pi eta R, the smallest. */
static void see_lubricated(void *context, const struct near_pair *p)
{
    struct friction *f = context;
    const double reduced = p->a[0] * p->a[1] / (p->a[0] + p->a[1]), h = fmax(p->gap, 0.5 * f->inner_gap * (p->a[0] + p->a[1]));
    const double sliding = 6 * M_PI * f->viscosity * reduced;
    const size_t sphere[2] = { p->i, p->j };
    for (int side = 0; side < 2; side++) {
        f->strongest[sphere[side]] += sliding * (reduced / h + 1);
        f->weakest[sphere[side]] += sliding;
    }
}

void estimate_friction(const json_t *scene, const struct state_row *row, size_t rows, double *strongest, double *weakest)
{
    struct friction f = { scene_number(scene, "fluid.viscosity", 0), scene_number(scene, "forces.lubrication.inner_gap", 1), strongest, weakest };
    for (size_t r = 0; r < rows && scene_get(scene, "forces.drag"); r++) {
        strongest[r] += 8 * M_PI * f.viscosity * species_number(scene, row[r].species, "radius");
        weakest[r] += 6 * M_PI * f.viscosity * species_number(scene, row[r].species, "radius");
    }
    if (scene_get(scene, "forces.lubrication"))
        near_pairs(scene, row, rows, scene_reach(scene), see_lubricated, &f);
}

struct springs { struct subject *s; const json_t *contact, *repulsion; };

/* Springs, dashpots and repulsion of a pair. */
static void see_spring(void *context, const struct near_pair *p)
{
    struct springs *c = context;
    struct subject *s = c->s;
    const size_t sphere[2] = { p->i, p->j };
    double force = 0, rate = 0;
    if (c->contact && p->gap < 0) {
        const struct theory_contact law = contact_between(&s->model, p->a[0], p->a[1]);
        force += law.normal_stiffness * fmax(-p->gap, 1e-3 * (p->a[0] + p->a[1]));     /* below that checks do not look */
        if (s->model.has_laws)
            rate += theory_normal_dashpot(&law) + law.tangential_damping * theory_reduced_mass(&law);
    }
    if (c->repulsion) {
        const double kappa = s->model.repulsion.kappa_factor * (p->a[0] + p->a[1]);
        force += s->model.repulsion.strength / (s->model.repulsion.by_energy ? kappa : 1) * exp(-p->gap / kappa);
    }
    for (int side = 0; side < 2; side++) {
        s->force[sphere[side]] += force;
        s->rate[sphere[side]] += rate;
    }
}

static void estimate(struct subject *s, const json_t *scene)
{
    const struct question *q = s->q;
    struct springs c = { s, scene_get(scene, "forces.contact"), scene_get(scene, "forces.repulsion") };
    memset(s->force, 0, q->states * sizeof *s->force);
    memset(s->rate, 0, q->states * sizeof *s->rate);
    memset(s->least, 0, q->states * sizeof *s->least);
    memset(s->state_force, 0, s->states * sizeof *s->state_force);
    memset(s->state_rate, 0, s->states * sizeof *s->state_rate);
    estimate_friction(scene, q->state, q->states, s->rate, s->least);
    near_pairs(scene, q->state, q->states, scene_reach(scene), see_spring, &c);
    for (size_t r = 0; r < q->states; r++) {
        const size_t state = r / s->particles;
        double load[6];
        scene_applied(scene, (size_t)q->state[r].species - 1, load);
        s->force[r] += norm(load) + norm(load + 3) / species_number(scene, q->state[r].species, "radius");
        s->least[r] = s->force[r] + s->least[r] * s->fastest[state];
        s->force[r] += s->rate[r] * s->fastest[state];
        s->state_rate[state] = fmax(s->state_rate[state], s->rate[r]);
        s->state_force[state] = fmax(s->state_force[state], s->force[r]);
    }
}

/* The species of a pair, where dashpots make masses of pairs matter; 0 where one factor serves all states. */
static int pair_kind(const struct subject *s, size_t state)
{
    const struct state_row *row = s->q->state + state * s->particles;
    return s->model.has_laws && s->particles == 2 ? 64 * row[0].species + row[1].species : 0;
}

/* The next state that has no group yet and those like it get the number `group`. False if none is left. */
static bool next_group(struct subject *s, int group)
{
    size_t first = 0;
    while (first < s->states && s->group[first] >= 0)
        first++;
    if (first == s->states)
        return false;
    const double per_speed = s->state_force[first] / (s->fastest[first] > 0 ? s->fastest[first] : 1);
    const int kind = pair_kind(s, first);
    const double decade = per_speed > 0 ? floor(log10(per_speed) / s->bucket) : -INFINITY;
    for (size_t k = first; k < s->states; k++) {
        const double other = s->state_force[k] / (s->fastest[k] > 0 ? s->fastest[k] : 1);
        if (s->group[k] < 0 && pair_kind(s, k) == kind && (!(other > 0) || floor(log10(other) / s->bucket) == decade))
            s->group[k] = group;    /* states without any force go with the first that comes */
    }
    return true;
}

/* Dashpots are given per mass: they stay what they are where the reduced mass is `times` as large. */
static void keep_dashpots(json_t *scene, const struct theory_contact *law, double reduced, double times)
{
    if (scene_get(scene, "forces.contact.restitution")) {
        scene_set(scene, "forces.contact.normal_damping", json_real(theory_normal_dashpot(law) / (reduced * times)));
        json_object_del(scene_get(scene, "forces.contact"), "restitution");
    } else if (scene_get(scene, "forces.contact.normal_damping"))
        scene_set(scene, "forces.contact.normal_damping", json_real(scene_number(scene, "forces.contact.normal_damping", 0) / times));
    if (scene_get(scene, "forces.contact.tangential_damping"))
        scene_set(scene, "forces.contact.tangential_damping", json_real(scene_number(scene, "forces.contact.tangential_damping", 0) / times));
}

/*
 * Masses for a group: as small as the change of velocity allows. Equal for all species, but where dashpots of crowds need the ratio that they have:
 * unequal ones would cost the large spheres digits.
 */
static bool set_masses(const struct subject *s, json_t *scene, int group, char why[WHY_LENGTH])
{
    double mass = 0;
    size_t member = 0, k;
    json_t *species;
    for (size_t state = 0; state < s->states; state++)
        if (s->group[state] == group) {
            const double speed = s->fastest[state] > 0 ? s->fastest[state] : 1;
            mass = fmax(mass, fmax(s->state_rate[state] * s->dt / s->change, s->state_force[state] * s->dt / (0.1 * speed)));
            member = state;
        }
    mass = mass > 0 ? mass : s->dt;     /* no force at all: any mass */
    const struct state_row *row = s->q->state + member * s->particles;
    const bool alike = !s->model.has_laws || s->particles == 2;
    double lightest = INFINITY;
    for (k = 0; k < s->model.species; k++)
        lightest = fmin(lightest, s->model.density[k] * pow(s->model.radius[k], 3));
    json_array_foreach(scene_get(scene, "species"), k, species)
    {
        const double a3 = pow(s->model.radius[k], 3), density = alike ? mass / (4.0 / 3.0 * M_PI * a3) : s->model.density[k] * mass / (4.0 / 3.0 * M_PI * lightest);
        json_object_set_new(species, "density", json_real(density));
    }
    if (!s->model.has_laws)
        return true;
    if (!alike && scene_get(scene, "forces.contact.restitution"))
        return why_not(why, "a restitution coefficient of more than two spheres cannot be kept when their masses change, as level B needs");
    if (alike) {
        const struct theory_contact law = contact_between(&s->model, s->model.radius[row[0].species - 1], s->model.radius[row[1].species - 1]);
        const double reduced = theory_reduced_mass(&law);
        keep_dashpots(scene, &law, reduced, 0.5 * mass / reduced);
    } else
        keep_dashpots(scene, NULL, 1, mass / (4.0 / 3.0 * M_PI * lightest));
    return true;
}

static double extrapolation(const struct subject *s)
{
    const struct capabilities *c = s->run->candidate->capabilities;
    return c->integrator == INTEGRATOR_VERLET ? 1.0 / 3.0 : c->integrator == INTEGRATOR_EULER ? 0 : 0.5;
}

/* Rows and contacts of one group, states numbered from 0. */
static void take_group(const struct subject *s, int group, struct state_row *row, size_t *rows, struct contact_row *contact, size_t *contacts)
{
    int number = 0;
    *rows = *contacts = 0;
    for (size_t state = 0; state < s->states; state++) {
        if (s->group[state] != group)
            continue;
        for (size_t i = 0; i < s->particles; i++) {
            row[*rows] = s->q->state[state * s->particles + i];
            row[(*rows)++].state = number;
        }
        for (size_t k = 0; k < s->q->contacts; k++)
            if (s->q->contact[k].state == s->q->state[state * s->particles].state) {
                contact[*contacts] = s->q->contact[k];
                contact[(*contacts)++].state = number;
            }
        number++;
    }
}

/* One group, one choice of forces: the velocities become forces in s->value[at]. */
static bool ask_group(struct subject *s, const json_t *variant, size_t at, const char *part, int group)
{
    struct state_row *row = calloc(s->q->states, sizeof *row);
    struct contact_row *contact = calloc(s->q->contacts + 1, sizeof *contact);
    json_t *scene = steps_scene(variant, s->dt);
    struct question q = { .protocol = "steps", .scene = scene, .state = row, .contact = contact, .steps = STEPS };
    char out[PATH_LENGTH], why[WHY_LENGTH];
    double (*v)[6] = NULL;
    take_group(s, group, row, &q.states, contact, &q.contacts);
    if (!scene_get(variant, "forces.contact"))
        q.contacts = 0;
    bool good = set_masses(s, scene, group, why);
    if (!good)
        check_skip(s->run, s->name, "%s: %s", s->name, why);
    good = good && check_ask_part(s->run, s->name, part, &q, out);
    if (good && !(good = steps_read(out, &q, q.states / s->particles, s->particles, &v, why)
                         && steps_start(out, &q, q.states / s->particles, s->particles, (const double (*)[6])v, s->roundoff, why)))
        check_garbage(s->run, why);
    const double c = extrapolation(s), eps = fmax(s->roundoff, DOUBLE_ROUNDOFF);
    double rounding = 0;
    for (size_t state = 0, number = 0; good && state < s->states; state++) {
        if (s->group[state] != group)
            continue;
        for (size_t i = 0; i < s->particles; i++) {
            const size_t from = state * s->particles + i, point = number * (STEPS + 1) * s->particles + i;
            const struct state_row *r = &s->q->state[from];
            const double m = mass_of_row(scene, r), I = 0.4 * m * pow(species_number(scene, r->species, "radius"), 2);
            for (size_t k = 0; k < 6; k++) {
                const double one = v[point + s->particles][k] - v[point][k], two = v[point + 2 * s->particles][k] - v[point + s->particles][k];
                s->value[(at * s->q->states + from) * 6 + k] = (k < 3 ? m : I) / s->dt * (one - c * (two - one));
            }
            rounding = fmax(rounding, s->least[from] > 0 ? eps * s->fastest[state] * m / (s->least[from] * s->dt) : 0);
        }
        number++;
    }
    if (good)
        allow(s->run, 4 * (s->change * s->change + rounding), "for level B: forces are differences of velocities that change by %.2g a step", s->change);
    free(v);
    free(row);
    free(contact);
    json_decref(scene);
    return good;
}

/* All states of one choice of forces. */
static bool ask_forces(struct subject *s, const json_t *scene, const char *force, size_t at)
{
    char part[64];
    estimate(s, scene);
    for (size_t k = 0; k < s->states; k++)
        s->group[k] = -1;
    for (int group = 0; next_group(s, group); group++) {
        snprintf(part, sizeof part, "%s-%d", force, group + 1);
        if (!ask_group(s, scene, at, part, group))
            return false;
    }
    return true;
}

/* The stress of the start does not depend on dt, so one step of the scene as it is shows it. */
static bool ask_stress(struct subject *s, const char *out)
{
    char part[PATH_LENGTH], from[PATH_LENGTH], to[PATH_LENGTH];
    json_t *scene = steps_scene(s->q->scene, s->dt);
    struct question q = *s->q;
    q.protocol = "steps";
    q.scene = scene;
    q.steps = 1;
    q.stress = true;
    bool good = check_ask_part(s->run, s->name, "stress", &q, part);
    json_decref(scene);
    path_join(from, part, "stress.csv");
    path_join(to, out, "stress.csv");
    if (good && link(from, to) != 0) {
        check_garbage(s->run, "stress.csv (or stress.txt) is missing, which the case asks for; a program without stresses leaves out \"stress\" in its capabilities");
        good = false;
    }
    return good;
}

static bool write_forces(const struct subject *s, const char *out, const char *const name[], size_t names)
{
    char path[PATH_LENGTH];
    path_join(path, out, "forces.csv");
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    fputs("state,force,id,fx,fy,fz,tx,ty,tz\n", file);
    for (size_t state = 0; state < s->states; state++)
        for (size_t k = 0; k < names; k++)
            for (size_t i = 0; i < s->particles; i++) {
                fprintf(file, "%d,%s,%zu", s->q->state[state * s->particles].state, name[k], i + 1);
                const size_t from = k < names - 1 || names > 2 ? k : 0;     /* the only force is also the total */
                for (size_t c = 0; c < 6; c++)
                    fprintf(file, ",%.17g", s->value[((from * s->states + state) * s->particles + i) * 6 + c]);
                fputc('\n', file);
            }
    return fclose(file) == 0;
}

static void prepare(struct subject *s, struct check_run *run)
{
    const double declared = run->candidate->capabilities->roundoff;
    double fastest = 0, smallest = INFINITY;
    s->roundoff = declared;
    s->bucket = declared > 0 ? 1 : 2;
    s->change = cbrt(fmax(declared, DOUBLE_ROUNDOFF) * pow(10, s->bucket));
    while (s->particles < s->q->states && s->q->state[s->particles].state == s->q->state[0].state)
        s->particles++;
    s->states = s->q->states / s->particles;
    s->fastest = calloc(3 * s->states + 3 * s->q->states + 1, sizeof(double));
    s->state_rate = s->fastest + s->states;
    s->state_force = s->state_rate + s->states;
    s->rate = s->state_force + s->states;
    s->force = s->rate + s->q->states;
    s->least = s->force + s->q->states;
    s->group = calloc(s->states + 1, sizeof *s->group);
    for (size_t r = 0; r < s->q->states; r++) {
        const double a = species_number(s->q->scene, s->q->state[r].species, "radius");
        double *most = &s->fastest[r / s->particles];
        *most = fmax(*most, fmax(norm(s->q->state[r].u), a * norm(s->q->state[r].w)));
        fastest = fmax(fastest, *most);
        smallest = fmin(smallest, a);
    }
    s->dt = (declared > 0 ? 1e-10 : 1e-20) * smallest / (fastest > 0 ? fastest : 1);
}

static bool forces_from_steps(struct check_run *run, const char *name, const struct question *q, const char *out)
{
    struct subject s = { .run = run, .name = name, .q = q };
    json_t *forces = scene_get(q->scene, "forces"), *force;
    const char *key, *names[32];
    size_t count = 0;
    if (!model_read(run, q->scene, &s.model))
        return false;
    prepare(&s, run);
    json_object_foreach(forces, key, force)
        if (!strstr(key, "_noise") && count < 31)
            names[count++] = key;
    const size_t alone = count;
    names[count++] = "total";
    s.value = calloc(count * q->states * 6, sizeof *s.value);
    json_t *all = json_deep_copy(q->scene);
    json_object_del(scene_get(all, "forces"), "drag_noise");
    json_object_del(scene_get(all, "forces"), "lubrication_noise");
    if (scene_get(all, "fluid.kT"))
        scene_set(all, "fluid.kT", json_integer(0));
    bool good = true;
    for (size_t k = 0; k < (alone == 1 ? 1 : count) && good; k++) {
        json_t *one = json_deep_copy(all);
        if (k < alone)
            scene_set(one, "forces", json_pack("{sO}", names[k], json_object_get(scene_get(all, "forces"), names[k])));
        good = ask_forces(&s, one, names[k], k);
        json_decref(one);
    }
    good = good && (!capabilities_list(run->candidate->capabilities, "stress") || ask_stress(&s, out));
    if (good && !write_forces(&s, out, names, count)) {
        check_garbage(run, "the gate cannot write forces.csv");
        good = false;
    }
    json_decref(all);
    free(s.fastest);
    free(s.group);
    free(s.value);
    return good;
}

bool level_b_ask(struct check_run *run, const char *name, const struct question *q, const char *folder, char out[PATH_LENGTH])
{
    char why[WHY_LENGTH];
    path_join(out, folder, "out");
    if (strcmp(q->protocol, "friction") == 0) {
        check_skip(run, name, "%s asks for the impulses of a friction step, which steps do not show (level B)", name);
        return false;
    }
    size_t k;
    json_t *species;
    json_array_foreach(scene_get(q->scene, "species"), k, species)
        if (json_object_get(species, "motion")) {
            check_skip(run, name, "%s asks for the force on held or driven spheres, which steps do not show (level B)", name);
            return false;
        }
    folder_remove(out);
    if (!folder_make(out, why)) {
        check_garbage(run, why);
        return false;
    }
    return strcmp(q->protocol, "noise") == 0 ? level_b_noise(run, name, q, out) : forces_from_steps(run, name, q, out);
}
