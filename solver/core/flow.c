#include "core/box.h"

mat3 flow_deformation(const struct flow *f, double from, double to)
{
    const mat3 S = f->strain(f, to), before = f->strain(f, from);
    mat3 F;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            F.m[r][c] = (r == c) + (S.m[r][c] - before.m[r][c]);
    return F;
}

mat3 flow_of_row(const struct flow *f, double time, double dt)
{
    if (!f->ends(f, time - dt, time + dt))
        return f->gradient(f, time);
    const mat3 before = f->mean(f, time - dt, time), after = f->mean(f, time, time + dt);
    mat3 G;
    for (int k = 0; k < 9; k++)
        G.m[k / 3][k % 3] = 0.5 * (before.m[k / 3][k % 3] + after.m[k / 3][k % 3]);
    return G;
}

double box_strain(const struct box *b, double from, double to)
{
    return b->flow ? b->flow->travelled(b->flow, to) - b->flow->travelled(b->flow, from) : b->rate * (to - from);
}
