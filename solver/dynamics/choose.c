/*
 * The scene's choice of an equation of motion, of whether particles rotate, and of the step.
 *
 * "dynamics": { "split": { "dt": 1e-3, "rotation": "auto", "friction": "global", "residual": 1e-10 } }
 * "dynamics": { "split": { "dt": 1e-3, "friction": "sweeps" } }
 */
#include "core/step_limit.h"
#include "dynamics/dynamics.h"

static const struct dynamics *const dynamics_rows[] = { &verlet, &predicted_verlet, &split };

bool dynamics_choose(struct settings *root, struct suspension *s, const struct dynamics **d, struct settings *chosen, struct error *e)
{
    static const char *const rotations[] = { "auto", "on", "off", NULL }, *const solutions[] = { "global", "sweeps", NULL };
    struct settings dynamics = settings_child(root, "dynamics", e);
    int named = 0;
    for (size_t k = 0; k < sizeof dynamics_rows / sizeof *dynamics_rows && dynamics.node; k++)
        if (settings_has(&dynamics, dynamics_rows[k]->name)) {
            *d = dynamics_rows[k];
            *chosen = settings_child(&dynamics, dynamics_rows[k]->name, e);
            named++;
        }
    if (settings_has(&dynamics, "auto")) {      /* noise on lubricated pairs biases explicit schemes: docs/integrators.md */
        *d = s->kT > 0.0 && suspension_force(s, "lubrication") ? &split : &verlet;
        *chosen = settings_child(&dynamics, "auto", e);
        named++;
    }
    if (settings_done(&dynamics, e) && (!chosen->node || named > 1))
        error_raise(e, ERROR_INPUT, "dynamics must name one equation of motion: verlet, predicted_verlet, split or auto%s", named > 1 ? "; it names several" : "");
    const int rotation = settings_has(chosen, "rotation") ? settings_choice(chosen, "rotation", rotations, e) : 0;
    if (rotation == 2 && s->rotates)
        settings_refuse(chosen, "rotation", e, "must be \"auto\" or \"on\": a force of this scene turns particles");
    s->rotates = s->rotates || rotation == 1;
    s->implicit_friction = *d && (*d)->friction;
    s->predicted_friction = *d == &predicted_verlet;
    s->friction_sweeps = s->implicit_friction && settings_has(chosen, "friction") && settings_choice(chosen, "friction", solutions, e) == 1;
    if (s->implicit_friction && !s->friction_sweeps)
        s->friction_residual = settings_number_or(chosen, "residual", 1e-10, e);
    if (!error_raised(e) && s->implicit_friction && !s->friction_sweeps && !(s->friction_residual > 0.0 && s->friction_residual <= 0.01))
        settings_refuse(chosen, "residual", e, "must be above 0 and at most 0.01 of the right-hand side");
    return !error_raised(e);
}

bool step_choose(struct settings *chosen, struct suspension *s, struct error *e)
{
    if (settings_is_text(chosen, "dt", "auto")) {
        s->dt = step_advised(s);
        if (!isfinite(s->dt))
            settings_refuse(chosen, "dt", e, "but nothing in this scene sets a time scale; give a number");
    } else
        s->dt = settings_positive(chosen, "dt", e);
    return settings_done(chosen, e);
}
