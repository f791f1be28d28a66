#include "scene.h"

#include "core/step_limit.h"
#include "dynamics/dynamics.h"
#include "forces/forces.h"
#include "observers/observers.h"
#include "protocols/protocols.h"

#include <stdlib.h>
#include <string.h>

/* ---- every force, in the order in which they act; a noise follows the drag that it belongs to ---- */

static const struct force_row {
    const char *key;
    struct force *(*make)(struct settings *s, const struct suspension *in, struct error *e);
    bool thermal;                               /* not built at kT = 0 */
    const char *quenched_by;                    /* at kT > 0 this force must be there too */
} force_rows[] = {
    { "contact", contact_new, false, NULL },
    { "drag", drag_new, false, "drag_noise" },
    { "lubrication", lubrication_new, false, "lubrication_noise" },
    { "drag_noise", drag_noise_new, true, NULL },
    { "lubrication_noise", lubrication_noise_new, true, NULL },
};

static const struct dynamics *const dynamics_rows[] = { &verlet };

/* ---- the parts of a scene ---- */

static void build_fluid(struct settings *root, struct suspension *s, struct error *e)
{
    struct settings fluid = settings_child(root, "fluid", e);
    if (fluid.node && settings_has(&fluid, "viscosity"))
        s->viscosity = settings_at_least(&fluid, "viscosity", 0.0, e);
    if (fluid.node && settings_has(&fluid, "kT"))
        s->kT = settings_at_least(&fluid, "kT", 0.0, e);
    if (fluid.node)
        settings_done(&fluid, e);
}

static bool build_box(struct settings *root, struct suspension *s, struct error *e)
{
    struct settings box = settings_child(root, "box", e);
    mat3 cell = { { { 0.0 } } };
    double number[9] = { 0.0 };
    bool periodic[3] = { false, false, false };
    if (!box.node)
        return error_raise(e, ERROR_INPUT, "box is missing; it must be an object with lengths (or cell) and periodic");
    if (settings_has(&box, "cell")) {
        if (settings_numbers(&box, "cell", number, 9, e) != 9)
            settings_refuse(&box, "cell", e, "must be three vectors of three numbers");
        for (int k = 0; k < 9; k++)
            cell.m[k % 3][k / 3] = number[k];
    } else {
        if (settings_numbers(&box, "lengths", number, 3, e) != 3 || !(number[0] > 0 && number[1] > 0 && number[2] > 0))
            settings_refuse(&box, "lengths", e, "must be three numbers above 0");
        for (int k = 0; k < 3; k++)
            cell.m[k][k] = number[k];
    }
    settings_flags(&box, "periodic", periodic, 3, e);
    settings_done(&box, e);
    const mat3 gradient = steady_shear(root, e);
    return !error_raised(e) && box_new(&s->box, &cell, periodic, &gradient, e);
}

static void build_species(struct settings *root, struct particles *p, struct error *e)
{
    const int kinds = settings_length(root, "species", e);
    if (!error_raised(e) && (kinds < 1 || kinds > MAX_SPECIES))
        settings_refuse(root, "species", e, "must list 1 to %d species", MAX_SPECIES);
    for (int k = 0; k < kinds && !error_raised(e); k++) {
        struct settings kind = settings_item(root, "species", k, e);
        const char *name = settings_text(&kind, "name", e);
        const double radius = settings_positive(&kind, "radius", e), density = settings_positive(&kind, "density", e);
        settings_done(&kind, e);
        p->kind[p->species_count++] = species_sphere(name, radius, density);
    }
}

static void build_forces(struct settings *root, struct suspension *s, struct error *e)
{
    struct settings forces = settings_child(root, "forces", e);
    s->overlap_limit = 0.1;
    for (size_t k = 0; k < sizeof force_rows / sizeof *force_rows && forces.node; k++) {
        const struct force_row *row = &force_rows[k];
        struct settings own = settings_child(&forces, row->key, e);
        if (!own.node || error_raised(e))
            continue;
        if (row->quenched_by && s->kT > 0.0 && !settings_has(&forces, row->quenched_by))
            settings_refuse(&forces, row->key, e, "without its noise at fluid.kT = %g would cool the particles: add forces.%s, or set kT to 0",
                            s->kT, row->quenched_by);
        struct force *force = row->make(&own, s, e);
        settings_done(&own, e);
        if (!force || error_raised(e) || (row->thermal && s->kT == 0.0)) {
            free(force);                        /* at kT = 0 a noise is not built: nothing will be drawn */
            continue;
        }
        suspension_take(s, force);
        s->rotates = s->rotates || force->rotates;
    }
    if (forces.node)
        settings_done(&forces, e);
}

static void build_start(struct settings *root, const char *scene_path, const struct scene_options *options, struct simulation *sim,
                        struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct settings start = settings_child(root, "start", e);
    s->start_time = start.node ? settings_number_or(&start, "time", 0.0, e) : 0.0;
    box_set_time(&s->box, s->start_time);
    box_remap(&s->box);
    const bool thermal = start.node && settings_flag_or(&start, "thermal", false, e);
    const bool given = start.node && settings_has(&start, "file"), drawn = start.node && settings_has(&start, "random");
    if (options->states)
        return;
    if (given == drawn) {
        error_raise(e, ERROR_INPUT, "start must have either file or random");
        return;
    }
    if (drawn) {
        struct settings random = settings_child(&start, "random", e);
        if (random.node)
            random_start(&random, s, e);
    } else {
        const char *file = settings_text(&start, "file", e), *slash = strrchr(scene_path, '/');
        char path[512];
        snprintf(path, sizeof path, "%.*s%s", *file == '/' || !slash ? 0 : (int)(slash - scene_path + 1), scene_path, file);
        struct state_file *states = error_raised(e) ? NULL : state_file_read(path, e);
        if (states)
            state_file_place(states, 0, s, e);
        state_file_free(states);
    }
    settings_done(&start, e);
    if (thermal && !error_raised(e))
        thermal_start(s);
}

static void build_dynamics(struct settings *root, struct simulation *sim, struct settings *chosen, struct error *e)
{
    static const char *const rotations[] = { "auto", "on", "off", NULL };
    struct settings dynamics = settings_child(root, "dynamics", e);
    for (size_t k = 0; k < sizeof dynamics_rows / sizeof *dynamics_rows && dynamics.node; k++)
        if (settings_has(&dynamics, dynamics_rows[k]->name)) {
            sim->dynamics = dynamics_rows[k];
            *chosen = settings_child(&dynamics, dynamics_rows[k]->name, e);
        }
    if (dynamics.node)
        settings_done(&dynamics, e);
    if (!error_raised(e) && !(sim->dynamics && chosen->node))
        error_raise(e, ERROR_INPUT, "dynamics must name one equation of motion: verlet");
    if (error_raised(e))
        return;
    const int rotation = settings_has(chosen, "rotation") ? settings_choice(chosen, "rotation", rotations, e) : 0;
    if (rotation == 2 && sim->suspension.rotates)
        settings_refuse(chosen, "rotation", e, "must be \"auto\" or \"on\": a force of this scene turns particles");
    sim->suspension.rotates = sim->suspension.rotates || rotation == 1;
}

static void choose_step(struct settings *chosen, struct suspension *s, struct error *e)
{
    if (settings_is_text(chosen, "dt", "auto")) {
        s->dt = step_advised(s);
        if (!isfinite(s->dt))
            settings_refuse(chosen, "dt", e, "but nothing in this scene sets a time scale; give a number");
    } else
        s->dt = settings_positive(chosen, "dt", e);
    settings_done(chosen, e);
}

static void build_run(struct settings *root, struct simulation *sim, struct error *e)
{
    struct settings run = settings_child(root, "run", e);
    const struct suspension *s = &sim->suspension;
    if (!run.node) {
        error_raise(e, ERROR_INPUT, "run is missing; it must have steps, time or strain");
        return;
    }
    double duration = 0.0;
    if (settings_has(&run, "steps"))
        sim->last_step = settings_whole(&run, "steps", 0, INT64_C(1) << 47, e);
    else if (settings_has(&run, "strain")) {
        duration = settings_at_least(&run, "strain", 0.0, e) / s->box.rate;
        if (!(s->box.rate > 0.0))
            settings_refuse(&run, "strain", e, "needs a shear");
    } else
        duration = settings_at_least(&run, "time", 0.0, e);
    if (duration > 0.0 && !error_raised(e))
        sim->last_step = (int64_t)ceil(duration / s->dt * (1.0 - 1e-12));
    settings_done(&run, e);
}

static void build_output(struct settings *root, struct simulation *sim, struct error *e)
{
    struct settings output = settings_child(root, "output", e), part;
    struct suspension *s = &sim->suspension;
    if (!output.node)
        return;
    if ((part = settings_child(&output, "stress", e)).node) {
        sim->observer[sim->observer_count++] = stress_table_new(&part, s, e);
        settings_done(&part, e);
    }
    if ((part = settings_child(&output, "states", e)).node) {
        sim->observer[sim->observer_count++] = trajectory_new(&part, s, e);
        settings_done(&part, e);
    }
    if ((part = settings_child(&output, "dump", e)).node) {
        sim->observer[sim->observer_count++] = dump_new(&part, s, e);
        settings_done(&part, e);
    }
    settings_done(&output, e);
}

/* ---- all together ---- */

static void build(struct settings *root, const char *path, const struct scene_options *options, struct simulation *sim, struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct settings chosen = { .node = NULL };
    snprintf(sim->about, sizeof sim->about, "%s", settings_text(root, "about", e));
    s->dimensions = settings_has(root, "dimensions") ? (int)settings_whole(root, "dimensions", 2, 3, e) : 3;
    build_fluid(root, s, e);
    if (settings_has(root, "seed"))
        s->key.seed = (uint32_t)settings_whole(root, "seed", 0, UINT32_MAX, e);
    else if (s->kT > 0.0)
        error_raise(e, ERROR_INPUT, "seed is missing; it must be a whole number, for fluid.kT > 0 draws random numbers");
    if (settings_has(root, "realisation"))
        s->key.realisation = (uint32_t)settings_whole(root, "realisation", 0, 16777215, e);
    s->kinetic_origin = stress_origin(&s->stress, "kinetic");
    if (error_raised(e) || !build_box(root, s, e))
        return;
    build_species(root, &s->particles, e);
    if (!error_raised(e))
        build_forces(root, s, e);
    if (!error_raised(e))
        build_dynamics(root, sim, &chosen, e);
    if (!error_raised(e))
        build_start(root, path, options, sim, e);
    if (!error_raised(e))
        choose_step(&chosen, s, e);
    settings_has(root, "shear");
    settings_has(root, "run");
    settings_has(root, "output");
    if (!error_raised(e) && !options->frozen) {
        build_run(root, sim, e);
        build_output(root, sim, e);
    }
    if (settings_done(root, e) && !options->states)
        neighbours_start(&s->neighbours, &s->box, &s->particles, e);
}

bool scene_build(const char *path, const struct scene_options *options, struct simulation *sim, struct error *e)
{
    memset(sim, 0, sizeof *sim);
    struct settings root;
    if (!settings_load(&root, path, options->set, options->set_count, e))
        return false;
    build(&root, path, options, sim, e);
    settings_unload(&root);
    return error_within(e, path);
}

bool scene_place(struct simulation *sim, const struct state_file *states, int state, struct error *e)
{
    struct suspension *s = &sim->suspension;
    return state_file_place(states, state, s, e) && neighbours_start(&s->neighbours, &s->box, &s->particles, e);
}
