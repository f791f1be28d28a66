/*
 * What a run writes: every observer, in the order in which they look, and the checkpoint, which comes after all of them.
 */
#include "observers/observers.h"
#include "scene.h"

static const struct observer_row { const char *key; struct observer *(*make)(struct settings *s, struct suspension *of, struct error *e); }
observer_rows[] = {
    { "stress", stress_table_new },
    { "states", trajectory_new },
    { "dump", dump_new },
};

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
