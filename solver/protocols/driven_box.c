#include "protocols/protocols.h"

bool driven_box(struct settings *root, struct suspension *s, const mat3 *cell, const bool periodic[3], struct error *e)
{
    struct flow *flow = stages_new(root, e);
    const mat3 gradient = flow ? flow->largest : steady_shear(root, e);         /* of stages: all that may ever lean */
    for (int k = 0; k < 3 && !error_raised(e) && s->dimensions == 2; k++)
        if (gradient.m[2][k] != 0.0 || gradient.m[k][2] != 0.0)
            error_raise(e, ERROR_INPUT, "shear: z is an axis of it; in two dimensions flows lie in the plane of x and y");
    const bool made = !error_raised(e) && box_new(&s->box, cell, periodic, &gradient, e);
    s->box.periodic[2] = s->box.periodic[2] && s->dimensions == 3;      /* no images above and below a plane */
    struct force *inertia = made && flow ? stages_inertia(e) : NULL;
    s->box.flow = flow;
    if (inertia)
        suspension_take(s, inertia);
    return !error_raised(e);
}
