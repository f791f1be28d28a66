#include "simulation.h"
#include "core/step_limit.h"

static bool is_due(struct observer *o, int64_t step)
{
    if (o->every > 0)
        return step % o->every == 0;
    while (o->at_next < o->at_count && o->at[o->at_next] < step)
        o->at_next++;
    return o->at_next < o->at_count && o->at[o->at_next] == step;
}

/* Will anybody look at the stress of this step? If so it is summed up along the way. */
static void prepare_stress(struct simulation *sim, int64_t step)
{
    sim->suspension.measuring = false;
    for (int k = 0; k < sim->observer_count; k++)
        sim->suspension.measuring |= sim->observer[k]->measures && is_due(sim->observer[k], step);
    if (sim->suspension.measuring)
        stress_clear(&sim->suspension.stress);
}

static bool observe(struct simulation *sim, struct error *e)
{
    struct suspension *s = &sim->suspension;
    bool looked = s->step == sim->last_step;
    for (int k = 0; k < sim->observer_count; k++)
        looked = looked || is_due(sim->observer[k], s->step);
    if (looked && !particles_finite(&s->particles, s->box.time, e))
        return false;
    if (s->measuring) {
        stress_kinetic(&s->stress, s->kinetic_origin, &s->box, &s->particles);
        stress_finish(&s->stress, s->box.volume);
    }
    for (int k = 0; k < sim->observer_count; k++)
        if (is_due(sim->observer[k], s->step) && !sim->observer[k]->observe(sim->observer[k], s, e))
            return false;
    return true;
}

/* What must hold after each step for the model to mean anything. */
static bool sound(const struct simulation *sim, bool relisted, struct error *e)
{
    const struct suspension *s = &sim->suspension;
    const struct near_pairs *near = &s->neighbours.near;
    if (near->deepest > s->overlap_limit)
        return error_raise(e, ERROR_RUN, "particles %d and %d overlap by %.3g of the smaller radius at time %.9g (step %lld); the limit is %g: "
                           "stiffen the contact, slow the flow or shorten dt", near->deepest_tag[0], near->deepest_tag[1], near->deepest,
                           s->box.time, (long long)s->step, s->overlap_limit);
    return !relisted || step_is_allowed(s, sim->dynamics->name, e);
}

bool simulation_begin(struct simulation *sim, struct error *e)
{
    struct suspension *s = &sim->suspension;
    bool relisted;
    prepare_stress(sim, 0);
    if (!sim->dynamics->begin(sim->dynamics, s, &relisted, e) || !sound(sim, true, e))
        e->code = ERROR_INPUT;                              /* nothing has moved yet: what is wrong is what was given */
    return !error_raised(e);
}

bool simulation_run(struct simulation *sim, struct error *e)
{
    struct suspension *s = &sim->suspension;
    bool relisted;
    if (!checkpoint_read(&sim->checkpoint, e))
        return false;
    for (int k = 0; k < sim->observer_count; k++)
        if (!sim->observer[k]->open(sim->observer[k], s, &sim->destination, e))
            return false;
    if (sim->destination.resuming ? !checkpoint_apply(&sim->checkpoint, e) : !observe(sim, e))
        return false;
    progress_start(&sim->progress, s->step, sim->last_step);
    while (s->step < sim->last_step) {
        prepare_stress(sim, s->step + 1);
        if (!sim->dynamics->step(sim->dynamics, s, &relisted, e) || !sound(sim, relisted, e) || !observe(sim, e))
            break;
        progress_show(&sim->progress, s);
        if (!checkpoint_keep(&sim->checkpoint, s->step == sim->last_step, e))
            break;
    }
    progress_end(&sim->progress);
    return !error_raised(e);
}

bool simulation_close(struct simulation *sim, struct error *e)
{
    for (int k = 0; k < sim->observer_count && sim->observer[k]; k++)
        sim->observer[k]->close(sim->observer[k], e);
    if (sim->dynamics && sim->dynamics->free)
        sim->dynamics->free(&sim->suspension);
    checkpoint_free(&sim->checkpoint);
    suspension_free(&sim->suspension);
    return !error_raised(e);
}
