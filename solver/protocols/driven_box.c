#include "protocols/protocols.h"

bool driven_box(struct settings *root, struct suspension *s, const mat3 *cell, const bool periodic[3], struct error *e)
{
    struct flow *flow = stages_new(root, e);
    const mat3 gradient = flow ? flow->largest : steady_shear(root, e);         /* of stages: all that may ever lean */
    const bool made = !error_raised(e) && box_new(&s->box, cell, periodic, &gradient, e);
    struct force *inertia = made && flow ? stages_inertia(e) : NULL;
    s->box.flow = flow;
    if (inertia)
        suspension_take(s, inertia);
    return !error_raised(e);
}
