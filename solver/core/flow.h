/*
 * A flow that changes with time, as the box asks for it: U_inf(x, t) = G(t) x.
 *
 *     F(from -> to) = I + S(to) - S(from),     S(t) = integral of G from 0 to t
 *
 * is what it makes of a material line. It is exact, however G changes, if no axis is both a flow and a gradient axis at
 * any time, for then G(t) G(t') = 0; box_new sees to that.
 */
#ifndef CORE_FLOW_H
#define CORE_FLOW_H

#include "core/vec3.h"

struct flow {
    mat3 largest;                                               /* of |G|, entry by entry, over all times [1/T] */
    int flow_axis, gradient_axis;                               /* of the first shear that is named: the plane that tables speak of */
    double duration;                                            /* from then on the flow is at rest [T] */
    double rounding;                                            /* times that differ by less are one moment [T] */
    mat3 (*gradient)(const struct flow *self, double time);     /* G(t); where a rate jumps, that of the stage that begins */
    mat3 (*mean)(const struct flow *self, double from, double to);  /* [S(to) - S(from)]/(to - from), without the rounding of differences */
    bool (*ends)(const struct flow *self, double from, double to);  /* does a stage begin or end in between? */
    mat3 (*strain)(const struct flow *self, double time);       /* S(t), in closed form */
    double (*travelled)(const struct flow *self, double time);  /* strain however it turned: integral of |rate| from 0 */
};

mat3 flow_deformation(const struct flow *f, double from, double to);
/*
 * The flow of a full step, as spheres have it that follow the flow: G(t), but the mean over the steps before and after where one of them holds the end
 * of a stage, for half of the push is given in each.
 */
mat3 flow_of_row(const struct flow *f, double time, double dt);

#endif
