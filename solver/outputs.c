/*
 * How long a run lasts, and what it writes: every observer, in the order in which they look, and the checkpoint, which
 * comes after all of them.
 */
#include "observers/observers.h"
#include "scene.h"

static const struct observer_row { const char *key; struct observer *(*make)(struct settings *s, struct suspension *of, struct error *e); }
observer_rows[] = {
    { "stress", stress_table_new },
    { "states", trajectory_new },
    { "dump", dump_new },
    { "viscosity", viscosity_new },
    { "contacts", contacts_new },
    { "temperature", temperature_new },
    { "displacement", displacement_new },
    { "velocity_correlation", velocity_correlation_new },
    { "pair_distribution", pair_distribution_new },
    { "brownian_stress", brownian_stress_new },
    { "green_kubo", green_kubo_new },
    { "averages", averages_new },
};

bool run_build(struct settings *root, struct simulation *sim, struct error *e)
{
    struct settings run = settings_child(root, "run", e);
    const struct suspension *s = &sim->suspension;
    double duration = 0.0;
    if (!run.node)
        return error_raise(e, ERROR_INPUT, "run is missing; it must have steps, time or strain");
    if (settings_has(&run, "steps"))
        sim->last_step = settings_whole(&run, "steps", 0, INT64_C(1) << 47, e);
    else if (settings_has(&run, "strain")) {
        duration = settings_at_least(&run, "strain", 0.0, e) / s->box.rate;
        if (!(s->box.rate > 0.0) || s->box.flow)
            settings_refuse(&run, "strain", e, "needs a steady shear");
    } else if (settings_is_text(&run, "time", "stages") && s->box.flow)
        duration = fmax(0.0, s->box.flow->duration - s->start_time);
    else
        duration = settings_at_least(&run, "time", 0.0, e);
    if (!error_raised(e) && !(duration / s->dt < 0x1p47))
        error_raise(e, ERROR_INPUT, "run: %g steps are more than 2^47", duration / s->dt);
    if (duration > 0.0 && !error_raised(e))
        sim->last_step = (int64_t)ceil(duration / s->dt * (1.0 - 1e-12));
    return settings_done(&run, e);
}

bool outputs_build(struct settings *root, struct simulation *sim, struct error *e)
{
    struct settings output = settings_child(root, "output", e);
    sim->checkpoint = (struct checkpoint){ .fingerprint = settings_fingerprint(root), .to = &sim->destination, .of = &sim->suspension,
                                           .observer = sim->observer, .observer_count = &sim->observer_count };
    for (size_t k = 0; k < sizeof observer_rows / sizeof *observer_rows && output.node; k++) {
        struct settings part = settings_child(&output, observer_rows[k].key, e);
        if (!part.node || error_raised(e))
            continue;
        sim->observer[sim->observer_count++] = observer_rows[k].make(&part, &sim->suspension, e);
        settings_done(&part, e);
    }
    struct settings checkpoint = output.node ? settings_child(&output, "checkpoint", e) : (struct settings){ .node = NULL };
    if (checkpoint.node) {
        sim->checkpoint.every = settings_whole(&checkpoint, "every", 1, INT64_MAX, e);
        settings_done(&checkpoint, e);
    }
    return settings_done(&output, e);
}
