#include "protocols/protocols.h"

bool driven_box(struct settings *root, struct suspension *s, const mat3 *cell, const bool periodic[3], struct error *e)
{
    struct flow *flow = stages_new(root, e);
    const mat3 gradient = flow ? flow->largest : steady_shear(root, e);         /* of stages: all that may ever lean */
    for (int k = 0; k < 3 && !error_raised(e) && s->dimensions == 2; k++)
        if (gradient.m[2][k] != 0.0 || gradient.m[k][2] != 0.0)
            error_raise(e, ERROR_INPUT, "shear: z is an axis of it; in two dimensions flows lie in the plane of x and y");
    if (!error_raised(e) && s->dimensions == 2 && (cell->m[2][0] != 0.0 || cell->m[2][1] != 0.0 || cell->m[0][2] != 0.0 || cell->m[1][2] != 0.0))
        error_raise(e, ERROR_INPUT, "box.cell: the first two vectors have a part along z, or the third one across it; in two dimensions they have none");
    for (int k = 0; k < 9 && !error_raised(e); k++)     /* an image along edge c would move with the flow, but lie where no sphere is carried along */
        for (int c = 0; c < 3 && gradient.m[k / 3][k % 3] != 0.0; c++)
            if (!periodic[k % 3] && c != k % 3 && periodic[c] && cell->m[k % 3][c] != 0.0)
                error_raise(e, ERROR_INPUT, "box.cell: vector %d, which is periodic, has a part along %c, the gradient axis of a shear, which is open", c + 1, "xyz"[k % 3]);
    const bool made = !error_raised(e) && box_new(&s->box, cell, periodic, &gradient, e);
    s->box.periodic[2] = s->box.periodic[2] && s->dimensions == 3;      /* no images above and below a plane */
    struct force *inertia = made && flow ? stages_inertia(e) : NULL;
    s->box.flow = flow;
    if (inertia)
        suspension_take(s, inertia);
    return !error_raised(e);
}
