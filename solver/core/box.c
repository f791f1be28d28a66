#include "core/box.h"

#include <string.h>

static mat3 inverse_of(const mat3 *H, double *determinant)
{
    const vec3 A = mat3_column(H, 0), B = mat3_column(H, 1), C = mat3_column(H, 2);
    const vec3 row[3] = { cross(B, C), cross(C, A), cross(A, B) };
    *determinant = dot(A, row[0]);
    mat3 inverse;
    for (int k = 0; k < 3; k++) {
        inverse.m[k][0] = row[k].x / *determinant;
        inverse.m[k][1] = row[k].y / *determinant;
        inverse.m[k][2] = row[k].z / *determinant;
    }
    return inverse;
}

/* What follows from G. */
static void set_gradient(struct box *b, const mat3 G)
{
    b->gradient = b->image_gradient = b->mean_gradient = G;
    for (int k = 0; k < 9; k++)
        b->strain_rate.m[k / 3][k % 3] = 0.5 * (G.m[k / 3][k % 3] + G.m[k % 3][k / 3]);
    b->spin = vec(0.5 * (G.m[2][1] - G.m[1][2]), 0.5 * (G.m[0][2] - G.m[2][0]), 0.5 * (G.m[1][0] - G.m[0][1]));
}

mat3 box_deformation(const struct box *b, double from, double to)
{
    if (b->flow)
        return flow_deformation(b->flow, from, to);
    const double duration = to - from;
    mat3 F;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            F.m[r][c] = (r == c) + b->gradient.m[r][c] * duration;
    return F;
}

static void set_cell(struct box *b)     /* H(t) = F H(0) M */
{
    const mat3 F = box_deformation(b, 0.0, b->time);
    const mat3 unmapped = mat3_product(&F, &b->start);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            b->cell.m[r][c] = unmapped.m[r][0] * b->lattice[0][c] + unmapped.m[r][1] * b->lattice[1][c] + unmapped.m[r][2] * b->lattice[2][c];
    b->inverse = inverse_of(&b->cell, &(double){ 0.0 });        /* shear keeps the volume */
}

void box_set_time(struct box *b, double time)
{
    b->time = time;
    if (b->flow)
        set_gradient(b, b->flow->gradient(b->flow, time));
    if (b->flowing)
        set_cell(b);
}

bool box_new(struct box *b, const mat3 *cell, const bool periodic[3], const mat3 *gradient, struct error *e)
{
    memset(b, 0, sizeof *b);
    b->start = b->cell = *cell;
    set_gradient(b, *gradient);
    b->inverse = inverse_of(cell, &b->volume);
    if (!(b->volume > 0.0))
        return error_raise(e, ERROR_INPUT, "box: the cell has volume %g; its vectors must be right-handed and span space", b->volume);
    for (int k = 0; k < 3; k++) {
        b->periodic[k] = periodic[k];
        b->lattice[k][k] = 1;
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const double g = gradient->m[r][c], *flows = gradient->m[c];
            if (g != 0.0 && (flows[0] != 0.0 || flows[1] != 0.0 || flows[2] != 0.0))
                return error_raise(e, ERROR_INPUT, "shear or stages: %c is a flow axis of one shear and the gradient axis of another; then "
                                                   "images accelerate even in steady flow, and no two of a sphere alike", "xyz"[c]);
            for (int k = 0; k < 3; k++)
                b->tilts[r][c] = b->tilts[r][c] || (r != c && gradient->m[r][k] != 0.0 && cell->m[k][c] != 0.0);
            if (b->tilts[r][c] && periodic[c] && !periodic[r])
                return error_raise(e, ERROR_INPUT, "box.periodic: flow along %c with a periodic gradient axis %c needs %c periodic too",
                                   "xyz"[r], "xyz"[c], "xyz"[r]);
            b->flowing = b->flowing || g != 0.0;
            b->rate = fmax(b->rate, fabs(g));
        }
    return true;
}

/* How often edge `a` must be taken off edge `c` to make the tilt of c along axis a at most half of a. Rounding must not flip a half to and fro. */
static int excess(const struct box *b, int a, int c)
{
    if (!b->tilts[a][c] || !b->periodic[c])
        return 0;
    const double tilt = b->cell.m[a][c] / b->cell.m[a][a];
    return fabs(tilt) > 0.5 + 1e-9 ? (int)lround(tilt) : 0;
}

bool box_wants_remap(const struct box *b)
{
    for (int k = 0; k < 9 && b->flowing; k++)
        if (excess(b, k / 3, k % 3))
            return true;
    return false;
}

void box_remap(struct box *b)
{
    while (box_wants_remap(b))
        for (int a = 0; a < 3; a++)
            for (int c = 0; c < 3; c++) {
                const int turns = excess(b, a, c);
                for (int r = 0; r < 3 && turns; r++)
                    b->lattice[r][c] -= turns * b->lattice[r][a];
                set_cell(b);    /* and not the flow: images move with that of the step */
            }
}

vec3 box_offset(const struct box *b, const int shift[3])
{
    return mat3_times(&b->cell, vec(shift[0], shift[1], shift[2]));
}

void box_lattice_shift(const struct box *b, const int shift[3], int lattice_shift[3])
{
    for (int r = 0; r < 3; r++)
        lattice_shift[r] = b->lattice[r][0] * shift[0] + b->lattice[r][1] * shift[1] + b->lattice[r][2] * shift[2];
}

vec3 box_unwrapped(const struct box *b, const int image[3])
{
    const mat3 F = box_deformation(b, 0.0, b->time);
    return mat3_times(&F, mat3_times(&b->start, vec(image[0], image[1], image[2])));
}

void box_wrap(const struct box *b, struct particles *p)
{
    for (int i = 0; i < p->count; i++) {
        const vec3 inside = mat3_times(&b->inverse, p->position[i]);            /* in units of the edges */
        const double cells[3] = { floor(inside.x), floor(inside.y), floor(inside.z) };
        int shift[3], crossed[3];
        for (int k = 0; k < 3; k++)
            shift[k] = b->periodic[k] ? (int)cells[k] : 0;
        if (!shift[0] && !shift[1] && !shift[2])
            continue;
        const vec3 offset = box_offset(b, shift);
        p->position[i] = minus(p->position[i], offset);
        p->velocity[i] = minus(p->velocity[i], mat3_times(&b->image_gradient, offset));
        box_lattice_shift(b, shift, crossed);
        for (int k = 0; k < 3; k++)
            p->image[i][k] += crossed[k];
    }
}

double box_width(const struct box *b, int axis)
{
    return 1.0 / norm(vec(b->inverse.m[axis][0], b->inverse.m[axis][1], b->inverse.m[axis][2]));
}
