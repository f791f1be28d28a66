#include "scene.h"

#include "dynamics/dynamics.h"
#include "forces/forces.h"
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
    { "repulsion", repulsion_new, false, NULL },
    { "applied", applied_new, false, NULL },
    { "tether", tether_new, false, NULL },
    { "drag", drag_new, false, "drag_noise" },
    { "lubrication", lubrication_new, false, "lubrication_noise" },
    { "drag_noise", drag_noise_new, true, NULL },
    { "lubrication_noise", lubrication_noise_new, true, NULL },
};

/* ---- the parts of a scene ---- */

static bool build_fluid(struct settings *root, struct suspension *s, struct error *e)
{
    struct settings fluid = settings_child(root, "fluid", e);
    s->viscosity = settings_has(&fluid, "viscosity") ? settings_at_least(&fluid, "viscosity", 0.0, e) : 0.0;
    s->kT = settings_has(&fluid, "kT") ? settings_at_least(&fluid, "kT", 0.0, e) : 0.0;
    return settings_done(&fluid, e);
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
    return !error_raised(e) && driven_box(root, s, &cell, periodic, e);
}

static bool build_forces(struct settings *root, struct suspension *s, struct error *e)
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
    return settings_done(&forces, e);
}

/* ---- all together ---- */

static bool build_key(struct settings *root, struct suspension *s, struct error *e)
{
    s->key.seed = (uint32_t)settings_whole_or(root, "seed", 0, 0, UINT32_MAX, e);
    s->key.realisation = (uint32_t)settings_whole_or(root, "realisation", 0, 0, 16777215, e);
    if (s->kT > 0.0 && !settings_has(root, "seed"))
        error_raise(e, ERROR_INPUT, "seed is missing; it must be a whole number, for fluid.kT > 0 draws random numbers");
    return !error_raised(e);
}

static bool build(struct settings *root, const char *path, const struct scene_options *options, struct simulation *sim, struct error *e)
{
    struct suspension *s = &sim->suspension;
    struct settings chosen = { .node = NULL };
    snprintf(sim->about, sizeof sim->about, "%s", settings_text(root, "about", e));
    s->dimensions = (int)settings_whole_or(root, "dimensions", 3, 2, 3, e);
    s->kinetic_origin = stress_origin(&s->stress, "kinetic");
    /* Keys that are known also where only forces are asked for; the schema is for editors. */
    settings_has(root, "run"), settings_has(root, "output"), settings_has(root, "$schema");
    return build_fluid(root, s, e) && build_key(root, s, e) && build_box(root, s, e) && species_build(root, &s->particles, s->dimensions, e) &&
           build_forces(root, s, e) && dynamics_choose(root, s, &sim->dynamics, &chosen, e) && suspension_start(root, path, options->states, s, e) &&
           step_choose(&chosen, s, e) && (options->frozen || (run_build(root, sim, e) && outputs_build(root, sim, e))) &&
           settings_done(root, e) && (options->states || neighbours_start(&s->neighbours, &s->particles, e));
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
