#include "evaluate.h"

#include "output/stress_columns.h"
#include "scene.h"

#include <stdlib.h>
#include <string.h>

/* Given histories of contacts: `contacts.csv`, state,i,j,sx,sy,sz, kept in memory as they stand. */
struct contacts { int count; struct { int state, i, j; vec3 history; } *row; };

static bool contacts_read(const char *path, struct contacts *c, struct error *e)
{
    FILE *in = fopen(path, "r");
    char line[512];
    int number = 0, room = 0;
    if (!in)
        return error_raise(e, ERROR_INPUT, "%s cannot be opened", path);
    while (!error_raised(e) && fgets(line, sizeof line, in)) {
        double v[6];
        number++;
        if (line[0] == '#' || strncmp(line, "state", 5) == 0)
            continue;
        if (sscanf(line, "%lf,%lf,%lf,%lf,%lf,%lf", &v[0], &v[1], &v[2], &v[3], &v[4], &v[5]) != 6)
            error_raise(e, ERROR_INPUT, "%s:%d: six numbers are due: state,i,j,sx,sy,sz", path, number);
        if (c->count == room) {
            room = room ? 2 * room : 64;
            void *more = realloc(c->row, (size_t)room * sizeof *c->row);
            if (!more) {
                error_out_of_memory(e);
                break;
            }
            c->row = more;
        }
        c->row[c->count].state = (int)v[0];
        c->row[c->count].i = (int)v[1];
        c->row[c->count].j = (int)v[2];
        c->row[c->count++].history = vec(v[3], v[4], v[5]);
    }
    fclose(in);
    return !error_raised(e);
}

/* The history of a pair of tags, that of their nearest images: they touch if any do; NULL if they are not neighbours. */
static vec3 *history_of(struct near_pairs *near, const struct particles *p, int tag_i, int tag_j)
{
    struct pair *nearest = NULL;
    for (int k = 0; k < near->count; k++) {
        struct pair *pair = &near->pair[k];
        if (p->tag[pair->i] == tag_i && p->tag[pair->j] == tag_j && (!nearest || pair->distance < nearest->distance))
            nearest = pair;
    }
    return nearest ? nearest->history : NULL;
}

/* The history of a contact is that of i against j; the list keeps pairs with the smaller tag first. */
static void contacts_place(const struct contacts *c, int state, struct suspension *s)
{
    for (int k = 0; k < c->count; k++) {
        const bool swap = c->row[k].i > c->row[k].j;
        vec3 *slot = c->row[k].state != state ? NULL
                   : history_of(&s->neighbours.near, &s->particles, swap ? c->row[k].j : c->row[k].i, swap ? c->row[k].i : c->row[k].j);
        if (slot)
            *slot = scaled(c->row[k].history, swap ? -1.0 : 1.0);
    }
}

/* The scene's particles replaced by one configuration of the file. */
static bool place(struct suspension *s, const struct state_file *states, int state, struct error *e)
{
    return state_file_place(states, state, s, e) && neighbours_start(&s->neighbours, &s->particles, e);
}

/* The same where the answer is one array, and what a scheme keeps of each particle serves all states: none may have more or fewer of them. */
static bool place_alike(struct suspension *s, const struct state_file *states, int state, struct error *e)
{
    const int before = s->particles.count;
    if (!place(s, states, state, e))
        return false;
    return state == 0 || s->particles.count == before ||
           error_raise(e, ERROR_INPUT, "case.json: state %d has %d particles where state 0 has %d; this protocol needs as many in each", state, s->particles.count, before);
}

/* Forces and torques of one force alone are in the particles' arrays afterwards; the stress is added to. */
static void act_alone(const struct force *f, struct suspension *s, int64_t step, struct stress *stress)
{
    struct particles *p = &s->particles;
    struct moment now = moment_of(s, 0.0);
    now.step = step;
    memset(p->force, 0, (size_t)p->count * sizeof *p->force);
    if (p->torque)
        memset(p->torque, 0, (size_t)p->count * sizeof *p->torque);
    f->add(f, p, &s->neighbours.near, &now, stress);
    suspension_flatten(s);
}

static void write_forces(FILE *out, int state, const char *name, const struct particles *p, const vec3 *force, const vec3 *torque)
{
    for (int i = 0; i < p->count; i++)
        fprintf(out, "%d,%s,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", state, name, p->tag[i], force[i].x, force[i].y, force[i].z,
                torque ? torque[i].x : 0.0, torque ? torque[i].y : 0.0, torque ? torque[i].z : 0.0);
}

static bool evaluate_state(struct simulation *sim, const struct state_file *states, const struct contacts *contacts, int state,
                           FILE *forces, FILE *stresses, struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct particles *p = &s->particles;
    bool relisted;
    if (!place(s, states, state, e) || !neighbours_find(&s->neighbours, &s->box, p, &relisted, e))
        return false;
    contacts_place(contacts, state, s);
    vec3 *force = calloc((size_t)p->count, sizeof *force), *torque = calloc((size_t)p->count, sizeof *torque);
    if (!force || !torque) {
        free(force);
        free(torque);
        return error_out_of_memory(e);
    }
    stress_clear(&s->stress);
    for (int k = 0; k < s->force_count; k++) {
        if (s->force[k]->kind == NOISE)
            continue;
        act_alone(s->force[k], s, 0, &s->stress);
        write_forces(forces, state, s->force[k]->name, p, p->force, p->torque);
        for (int i = 0; i < p->count; i++) {
            force[i] = plus(force[i], p->force[i]);
            torque[i] = p->torque ? plus(torque[i], p->torque[i]) : torque[i];
        }
    }
    write_forces(forces, state, "total", p, force, torque);
    free(force);
    free(torque);
    stress_kinetic(&s->stress, s->kinetic_origin, &s->box, p);
    stress_finish(&s->stress, s->box.volume);
    fprintf(stresses, "%d", state);
    stress_write_values(stresses, &s->stress);
    return true;
}

static bool evaluate_forces(struct simulation *sim, const struct state_file *states, const struct contacts *contacts, struct error *e)
{
    struct table forces = { .file = NULL }, stresses = { .file = NULL };
    if (table_open(&forces, &sim->destination, "forces.csv", e) && table_open(&stresses, &sim->destination, "stress.csv", e)) {
        fputs("state,force,id,fx,fy,fz,tx,ty,tz\n", forces.file);
        fputs("state", stresses.file);
        stress_write_names(stresses.file, &sim->suspension.stress);
        for (int k = 0; k < state_file_count(states); k++)
            if (!evaluate_state(sim, states, contacts, k, forces.file, stresses.file, e))
                break;
    }
    table_close(&forces, e);
    table_close(&stresses, e);
    return !error_raised(e);
}

/* NPY 1.0: magic, version, length of the header, the header padded to 64 bytes, then the numbers. */
static void npy_header(FILE *out, long draws, int particles)
{
    char text[118 + 1];
    const int length = snprintf(text, sizeof text, "{'descr': '<f8', 'fortran_order': False, 'shape': (%ld, %d, 6), }", draws, particles);
    fwrite("\x93NUMPY\x01\x00\x76\x00", 1, 10, out);
    fprintf(out, "%s%*s\n", text, 117 - length, "");
}

static bool evaluate_noise(struct simulation *sim, const struct state_file *states, long draws, struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct particles *p = &s->particles;
    bool relisted;
    if (!place(s, states, 0, e) || !neighbours_find(&s->neighbours, &s->box, p, &relisted, e))
        return false;
    for (int k = 0; k < s->force_count; k++)            /* the drags leave the resistances that their noises need */
        if (s->force[k]->kind != NOISE)
            act_alone(s->force[k], s, 0, NULL);
    for (int k = 0; k < s->force_count && !error_raised(e); k++) {
        char name[80];
        struct table t = { .file = NULL };
        if (s->force[k]->kind != NOISE)
            continue;
        snprintf(name, sizeof name, "noise_%s.npy", s->force[k]->name);
        struct destination bare = sim->destination;
        bare.provenance[0] = 0;
        if (!table_open(&t, &bare, name, e))
            break;
        npy_header(t.file, draws, p->count);
        for (long draw = 0; draw < draws; draw++) {
            act_alone(s->force[k], s, draw, NULL);
            for (int i = 0; i < p->count; i++) {
                const vec3 none = { 0, 0, 0 };
                fwrite(&p->force[i], sizeof(double), 3, t.file);
                fwrite(p->torque ? &p->torque[i] : &none, sizeof(double), 3, t.file);
            }
        }
        table_close(&t, e);
    }
    return !error_raised(e);
}

/*
 * The friction and noise of one step, from the velocities of each state, `draws` times as at successive steps: the impulses that every
 * particle gets of them, m (v' - v) and I (w' - w). Driven particles get none.
 */
static bool evaluate_friction(struct simulation *sim, const struct state_file *states, long draws, struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct particles *p = &s->particles;
    const int count = state_file_count(states);
    struct table t = { .file = NULL };
    struct destination bare = sim->destination;
    bare.provenance[0] = 0;
    if (!sim->dynamics->friction)
        return error_raise(e, ERROR_UNSUPPORTED, "dynamics %s has no friction step of its own", sim->dynamics->name);
    if (!table_open(&t, &bare, "friction.npy", e))
        return false;
    for (int state = 0; state < count && !error_raised(e); state++) {
        bool relisted;
        if (!place_alike(s, states, state, e) || !neighbours_find(&s->neighbours, &s->box, p, &relisted, e))
            break;
        if (state == 0)
            npy_header(t.file, draws * count, p->count);
        vec3 *before = calloc(2 * (size_t)p->count, sizeof *before), *spin = before + p->count;
        for (int i = 0; before && i < p->count; i++) {
            before[i] = p->velocity[i];
            spin[i] = p->spin ? p->spin[i] : vec(0, 0, 0);
        }
        for (long draw = 0; before && draw < draws && !error_raised(e); draw++) {
            for (int i = 0; i < p->count; i++) {
                p->velocity[i] = before[i];
                if (p->spin)
                    p->spin[i] = spin[i];
            }
            s->step++;
            if (!sim->dynamics->friction(sim->dynamics, s, e))
                break;
            for (int i = 0; i < p->count; i++) {
                const bool free_one = !p->kind[p->species[i]].driven;
                const vec3 push = scaled(minus(p->velocity[i], before[i]), free_one ? mass_of(p, i) : 0.0);
                const vec3 turn = p->spin && free_one ? scaled(minus(p->spin[i], spin[i]), inertia_of(p, i)) : vec(0, 0, 0);
                fwrite(&push, sizeof(double), 3, t.file);
                fwrite(&turn, sizeof(double), 3, t.file);
            }
        }
        if (!before)
            error_out_of_memory(e);
        free(before);
    }
    table_close(&t, e);
    return !error_raised(e);
}

/*
 * A run. With `pause` everything is dropped after that step but what is on disk, and the run goes on from the checkpoint: `pause` asks
 * whether a run that was stopped is the run that was not.
 */
static bool evaluate_run(struct simulation *sim, const char *scene, const char *out_folder, int64_t pause, struct error *e)
{
    const struct scene_options resumed = { .resume = true };
    if (pause > 0) {
        sim->last_step = pause;
        if (!sim->checkpoint.every)
            return error_raise(e, ERROR_INPUT, "case.json: pause needs output.checkpoint in the scene");
        if (!simulation_begin(sim, e) || !simulation_run(sim, e) || !simulation_close(sim, e))
            return false;
        memset(sim, 0, sizeof *sim);
        if (!scene_build(scene, &resumed, sim, e) || !destination_make(&sim->destination, out_folder, e))
            return false;
        sim->destination.resuming = true;
    }
    return simulation_begin(sim, e) && simulation_run(sim, e);
}

/* Of the image where the particle was put: some have been wrapped into the cell. */
static void write_velocities(FILE *out, const struct suspension *s)
{
    const struct particles *p = &s->particles;
    for (int i = 0; i < p->count; i++) {
        const vec3 none = { 0, 0, 0 }, u = plus(p->velocity[i], box_flow(&s->box, box_unwrapped(&s->box, p->image[i])));
        fwrite(&u, sizeof(double), 3, out);
        fwrite(p->spin ? &p->spin[i] : &none, sizeof(double), 3, out);
    }
}

/*
 * A few steps from every state, as a program without a way to tell its forces would make them: velocities and spins at each step, and the stress
 * of the start. No limit of overlap or step: whoever asks has chosen dt so that nothing moves noticeably.
 */
static bool evaluate_steps(struct simulation *sim, const struct state_file *states, const struct contacts *contacts, int64_t steps,
                           bool stress, struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct table velocities = { .file = NULL }, stresses = { .file = NULL };
    const int count = state_file_count(states);
    bool relisted = true;
    struct destination bare = sim->destination;
    bare.provenance[0] = 0;
    if (!table_open(&velocities, &bare, "velocities.npy", e) || (stress && !table_open(&stresses, &sim->destination, "stress.csv", e)))
        return false;
    if (stress) {
        fputs("state", stresses.file);
        stress_write_names(stresses.file, &s->stress);
    }
    for (int k = 0; k < count && !error_raised(e); k++) {
        s->step = 0;
        box_set_time(&s->box, s->start_time);
        if (!place_alike(s, states, k, e) || !neighbours_find(&s->neighbours, &s->box, &s->particles, &relisted, e))
            break;
        if (k == 0)
            npy_header(velocities.file, count * (steps + 1), s->particles.count);
        contacts_place(contacts, k, s);
        s->measuring = stress;
        stress_clear(&s->stress);
        if (!sim->dynamics->begin(sim->dynamics, s, &relisted, e))
            break;
        if (stress) {
            stress_kinetic(&s->stress, s->kinetic_origin, &s->box, &s->particles);
            stress_finish(&s->stress, s->box.volume);
            fprintf(stresses.file, "%d", k);
            stress_write_values(stresses.file, &s->stress);
        }
        s->measuring = false;
        write_velocities(velocities.file, s);
        while (s->step < steps && sim->dynamics->step(sim->dynamics, s, &relisted, e))
            write_velocities(velocities.file, s);
    }
    table_close(&velocities, e);
    table_close(&stresses, e);
    return !error_raised(e);
}

bool evaluate_case(const char *case_folder, const char *out_folder, struct error *e)
{
    static const char *const protocols[] = { "forces", "noise", "friction", "steps", "run", NULL };
    enum { FORCES, DRAWS, IMPULSES, STEPS, RUN };
    char path[512], scene[512], start[512] = "";
    struct settings c;
    snprintf(path, sizeof path, "%.400s/case.json", case_folder);
    if (!settings_load(&c, path, NULL, 0, e))
        return false;
    const int protocol = settings_choice(&c, "protocol", protocols, e);
    const int64_t pause = protocol == RUN && settings_has(&c, "pause") ? settings_whole(&c, "pause", 1, INT64_MAX, e) : 0;
    const long draws = protocol == DRAWS || protocol == IMPULSES ? (long)settings_whole(&c, "draws", 1, 1000000000, e) : 0;
    const int64_t steps = protocol == STEPS ? settings_whole(&c, "steps", 1, 1000000000, e) : 0;
    const bool stress = protocol == STEPS && settings_has(&c, "stress") && settings_flag(&c, "stress", e);
    snprintf(scene, sizeof scene, "%.350s/%.150s", case_folder, settings_text(&c, "scene", e));
    if (protocol != RUN)
        snprintf(start, sizeof start, "%.350s/%.150s", case_folder, settings_text(&c, "states", e));
    struct contacts contacts = { 0, NULL };
    if (!error_raised(e) && settings_has(&c, "contacts")) {
        snprintf(path, sizeof path, "%.350s/%.150s", case_folder, settings_text(&c, "contacts", e));
        contacts_read(path, &contacts, e);
    }
    settings_unload(&c);

    struct simulation *sim = calloc(1, sizeof *sim);
    struct state_file *states = error_raised(e) || protocol == RUN ? NULL : state_file_read(start, e);
    const struct scene_options options = { .states = protocol == RUN ? NULL : start, .frozen = protocol != RUN };
    if (!sim)
        error_out_of_memory(e);
    else if (!error_raised(e) && scene_build(scene, &options, sim, e)) {
        if (!destination_make(&sim->destination, out_folder, e))
            ;
        else if (protocol == FORCES)
            evaluate_forces(sim, states, &contacts, e);
        else if (protocol == DRAWS)
            evaluate_noise(sim, states, draws, e);
        else if (protocol == STEPS)
            evaluate_steps(sim, states, &contacts, steps, stress, e);
        else if (protocol == IMPULSES)
            evaluate_friction(sim, states, draws, e);
        else
            evaluate_run(sim, scene, out_folder, pause, e);
    }
    if (sim)
        simulation_close(sim, e);
    free(sim);
    state_file_free(states);
    free(contacts.row);
    return !error_raised(e);
}
