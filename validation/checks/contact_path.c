/*
 * Layer 4: contacts with history, cap and dashpots against LAMMPS's gran/hooke/history, pair by pair, to rounding
 *
 * Tethered pairs start just out of contact, so that each code builds the tangential history itself, and hit each other again and again:
 * some stick, some slip, some reverse the direction in which they slip, all part and touch anew. At every step all places, velocities and
 * spins are compared. Forces and torques are read off the motion: in velocity Verlet
 *
 *     m (U(n+1) - U(n)) = dt (F(n) + F(n+1))/2 ,     I (W(n+1) - W(n)) = dt (T(n) + T(n+1))/2 ,
 *
 * so that the mean force of two successive steps is known from any code to rounding. The tangential force of a pair is the torque over the radius, and where
 * the pair sticks without a dashpot it is k_t times the history; so the history is compared too, step by step.
 */
#include "dense.h"
#include "pair.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PLACE, VELOCITY, SPIN, FORCE, TORQUE, QUANTITIES };
static const char *const quantity[QUANTITIES] = { "places", "velocities", "spins", "forces", "torques" };

struct motion { size_t steps, count; double *value; /* [step][id - 1][x u w] */ };

static const double *at(const struct motion *m, size_t step, size_t sphere) { return m->value + 9 * (step * m->count + sphere); }

static bool read_motion(struct check_run *run, const char *out, struct motion *m)
{
    struct table t;
    char path[PATH_LENGTH], why[WHY_LENGTH];
    path_join(path, out, "trajectory.csv");
    if (!table_read(path, "step,id,x,y,z,ux,uy,uz,wx,wy,wz", &t, why) || !table_expect_rows(&t, (m->steps + 1) * m->count, why)) {
        check_garbage(run, why);
        return false;
    }
    m->value = calloc(9 * (m->steps + 1) * m->count, sizeof(double));
    for (size_t r = 0; m->value && r < t.rows; r++) {
        const double step = table_at(&t, r, 0), id = table_at(&t, r, 1);
        if (step >= 0 && step <= (double)m->steps && id >= 1 && id <= (double)m->count)
            for (size_t c = 0; c < 9; c++)
                m->value[9 * ((size_t)step * m->count + (size_t)id - 1) + c] = table_at(&t, r, 2 + c);
    }
    table_free(&t);
    return m->value != NULL;
}

/* Mean force, then torque, on a sphere between two steps. */
static void load_between(const struct motion *m, size_t step, size_t sphere, double mass, double inertia, double dt, double load[6])
{
    for (size_t k = 0; k < 6; k++)
        load[k] = (at(m, step + 1, sphere)[3 + k] - at(m, step, sphere)[3 + k]) * (k < 3 ? mass : inertia) / dt;
}

static void read_three(const json_t *list, double v[3])
{
    for (size_t k = 0; k < 3; k++)
        v[k] = json_number_value(json_array_get(list, k));
}

/* The pairs of the case on a grid, and what they are made of. */
struct scene_of_pairs { struct dense_start start; double *mass, *inertia, *radius; double dt, friction; };

static void place_pairs(const json_t *par, const struct model *m, struct scene_of_pairs *s)
{
    const double spacing = scene_number(par, "spacing", 6);
    const json_t *pairs = json_object_get(par, "pairs");
    for (size_t p = 0; p < s->start.count / 2; p++) {
        const json_t *pair = json_array_get(pairs, p);
        const double centre[3] = { (0.5 + (double)(p % 3)) * spacing, (0.5 + (double)(p / 3 % 2)) * spacing, (0.5 + (double)(p / 6)) * spacing };
        double n[3], thrown[3], distance = scene_number(pair, "gap", 0.01);
        read_three(json_object_get(pair, "along"), n);
        read_three(json_object_get(pair, "thrown"), thrown);
        const double length = norm(n);
        for (size_t which = 0; which < 2; which++) {
            struct state_row *row = &s->start.row[2 * p + which];
            *row = (struct state_row){ .id = (int)(2 * p + which) + 1,
                                       .species = (int)json_integer_value(json_array_get(json_object_get(pair, "species"), which)) };
            s->radius[2 * p + which] = m->radius[row->species - 1];
            s->mass[2 * p + which] = 4.0 / 3.0 * M_PI * m->density[row->species - 1] * pow(s->radius[2 * p + which], 3);
            s->inertia[2 * p + which] = 0.4 * s->mass[2 * p + which] * s->radius[2 * p + which] * s->radius[2 * p + which];
            read_three(json_array_get(json_object_get(pair, "spins"), which), row->w);
            distance += s->radius[2 * p + which];
        }
        for (size_t which = 0; which < 2; which++)      /* thrown: velocity of the first relative to the second */
            for (int k = 0; k < 3; k++) {
                s->start.row[2 * p + which].x[k] = centre[k] + (which ? 0.5 : -0.5) * distance * n[k] / length;
                s->start.row[2 * p + which].u[k] = (which ? -0.4 : 0.6) * thrown[k];
            }
    }
}

struct tried { size_t made, remade, lost, sticking, slipping, reversed; };

/* How often pair p did what, from the reference's motion. Force on the first sphere without the tethers: minus that on the second with its own. */
static void see_events(const struct scene_of_pairs *s, const struct motion *m, const double *stiffness, size_t p, struct tried *t)
{
    const size_t i = 2 * p, j = 2 * p + 1;
    double slid[3] = { 0 };
    bool touched = false, slipped = false;
    size_t contacts = 0;
    for (size_t step = 0; step < m->steps; step++) {
        double n[3], load[6], tangential[3];
        for (int k = 0; k < 3; k++)
            n[k] = at(m, step, j)[k] - at(m, step, i)[k];
        const double distance = norm(n);
        const bool touches = distance < s->radius[i] + s->radius[j];
        t->made += touches && !touched;
        t->remade += touches && !touched && contacts > 0;
        t->lost += !touches && touched;
        contacts += touches && !touched;
        slipped = slipped && touches && touched;
        touched = touches;
        if (!touches)
            continue;
        load_between(m, step, i, s->mass[i], s->inertia[i], s->dt, load);
        for (int k = 0; k < 3; k++)     /* the tether at the middle of the step */
            load[k] += stiffness[s->start.row[i].species - 1] * (0.5 * (at(m, step, i)[k] + at(m, step + 1, i)[k]) - s->start.row[i].x[k]);
        const double along = dot(load, n) / distance;
        for (int k = 0; k < 3; k++)
            tangential[k] = load[k] - along * n[k] / distance;
        if (norm(tangential) > 0.98 * s->friction * fabs(along)) {
            t->reversed += slipped && dot(tangential, slid) < 0;
            memcpy(slid, tangential, sizeof slid);
            slipped = true;
            t->slipping++;
        } else {
            t->sticking++;
        }
    }
}

static void compare_motions(struct check_run *run, const char *name, const struct scene_of_pairs *s, const struct motion m[2])
{
    double worst[QUANTITIES] = { 0 }, largest[QUANTITIES] = { 0 };
    for (size_t step = 0; step <= m[0].steps; step++)
        for (size_t i = 0; i < s->start.count; i++) {
            double value[2][15] = { { 0 } };
            for (int code = 0; code < 2; code++) {
                memcpy(value[code], at(&m[code], step, i), 9 * sizeof(double));
                if (step < m[0].steps)
                    load_between(&m[code], step, i, s->mass[i], s->inertia[i], s->dt, value[code] + 9);
            }
            for (int k = 0; k < 15; k++) {
                largest[k / 3] = fmax(largest[k / 3], k < 3 ? s->radius[0] : fabs(value[1][k]));
                worst[k / 3] = fmax(worst[k / 3], fabs(value[0][k] - value[1][k]));
            }
        }
    for (int q = 0; q < QUANTITIES; q++) {
        char what[96];
        snprintf(what, sizeof what, "%s: %s", name, quantity[q]);
        check_error(run, MODEL, what, worst[q] / largest[q], 0, worst[q] / largest[q], run->gate_case->tolerance,
                    "%s of colliding pairs differ from LAMMPS's by %.2g of %s within %zu steps", quantity[q], worst[q] / largest[q],
                    q == PLACE ? "a radius" : "the largest", m[0].steps);
    }
}

static bool run_variant(struct check_run *run, const json_t *variant, struct tried *all)
{
    const json_t *par = run->gate_case->parameters;
    const char *name = json_string_value(json_object_get(variant, "name"));
    const size_t count = 2 * json_array_size(json_object_get(par, "pairs"));
    struct scene_of_pairs s = { .start = { .row = calloc(count, sizeof *s.start.row), .count = count, .scene = json_deep_copy(run->gate_case->scene) },
                                .mass = calloc(3 * count, sizeof(double)) };
    struct motion m[2] = { { (size_t)scene_number(par, "steps", 1000), count, NULL }, { (size_t)scene_number(par, "steps", 1000), count, NULL } };
    struct model model;
    char out[2][PATH_LENGTH];
    s.inertia = s.mass + count;
    s.radius = s.inertia + count;
    scene_set(s.start.scene, "forces.contact", json_deep_copy(json_object_get(variant, "contact")));
    scene_set(s.start.scene, "start.file", json_string("states.csv"));
    scene_set(s.start.scene, "run", json_pack("{sI}", "steps", (json_int_t)m[0].steps));
    scene_set(s.start.scene, "output.states.every", json_integer(1));
    s.dt = scene_number(s.start.scene, "dynamics.verlet.dt", 1);
    s.friction = scene_number(s.start.scene, "forces.contact.friction", 0);
    bool good = s.start.row && s.mass && model_read(run, s.start.scene, &model);
    if (good) {
        place_pairs(par, &model, &s);
        good = dense_ask_both(run, name, &s.start, out, NULL) && read_motion(run, out[0], &m[0]) && read_motion(run, out[1], &m[1]);
    }
    if (good) {
        double stiffness[64] = { 0 };
        for (size_t k = 0; k < model.species; k++) {
            char key[128];
            const json_t *species = json_array_get(json_object_get(s.start.scene, "species"), k);
            snprintf(key, sizeof key, "forces.tether.%s.stiffness", json_string_value(json_object_get(species, "name")));
            stiffness[k] = scene_number(s.start.scene, key, 0);
        }
        compare_motions(run, name, &s, m);
        for (size_t p = 0; p < count / 2; p++)
            see_events(&s, &m[1], stiffness, p, all);
    }
    free(m[0].value);
    free(m[1].value);
    free(s.mass);
    dense_start_free(&s.start);
    return good;
}

void contact_path(struct check_run *run)
{
    const json_t *variants = json_object_get(run->gate_case->parameters, "variants");
    struct tried t = { 0 };
    for (size_t v = 0; v < json_array_size(variants); v++) {
        check_progress(run, "variant %zu of %zu", v + 1, json_array_size(variants));
        if (!run_variant(run, json_array_get(variants, v), &t))
            return;
    }
    const bool all = t.made && t.remade && t.lost && t.sticking && t.slipping && t.reversed;
    struct result *r = check_error(run, INVARIANT, "what the pairs try", all, 1, all ? 0 : 1, 0.5,
                                   "contacts made %zu, made again %zu, lost %zu, steps sticking %zu, slipping %zu, slips reversed within a contact %zu: none may "
                                   "be 0", t.made, t.remade, t.lost, t.sticking, t.slipping, t.reversed);
    result_notes(r, "contacts made %zu, of them made again %zu, lost %zu; steps of a sticking pair %zu, of a slipping one %zu; direction of slip reversed within a "
                 "contact %zu times", t.made, t.remade, t.lost, t.sticking, t.slipping, t.reversed);
}
