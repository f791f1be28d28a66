/*
 * The plane of shear and what is read off a stress in it
 *
 *     f flow, g gradient, v vorticity axis of the fastest shear (of equally fast ones the first of xy, xz, yx ...), in stages of the
 *     first that is named (x, y, z at rest)
 *     shear  (sigma_fg + sigma_gf)/2     N1 = sigma_ff - sigma_gg     N2 = sigma_gg - sigma_vv     pressure = -tr/3
 *
 * The sum over origins leaves out the kinetic part (bookkept, not part of the model's viscosity) and the
 * instantaneous Brownian parts (mean zero; they only add scatter).
 */
#ifndef OBSERVERS_PLANE_H
#define OBSERVERS_PLANE_H

#include "core/suspension.h"

#include <string.h>

struct plane { int flow, gradient, vorticity; double rate; /* of steady shear, signed; 0: at rest or changing [1/T] */ };

static inline struct plane plane_of(const struct box *b)
{
    struct plane p = { 0, 1, 2, 0.0 };
    double largest = 0.0;
    if (b->flow && b->flow->flow_axis != b->flow->gradient_axis)
        return (struct plane){ b->flow->flow_axis, b->flow->gradient_axis, 3 - b->flow->flow_axis - b->flow->gradient_axis, 0.0 };
    for (int k = 0; k < 9; k++) {
        const double rate = b->gradient.m[k / 3][k % 3];
        if (!b->flow && fabs(rate) > largest) {
            largest = fabs(rate);
            p = (struct plane){ k / 3, k % 3, 3 - k / 3 - k % 3, rate };
        }
    }
    return p;
}

/* Room for centres: the volume, in two dimensions the area of the cell [L^3, L^2]. */
static inline double room_of(const struct suspension *s)
{
    const mat3 *H = &s->box.start;
    return s->dimensions == 3 ? s->box.volume : fabs(H->m[0][0] * H->m[1][1] - H->m[0][1] * H->m[1][0]);
}

static inline bool origin_is_summed(const struct suspension *s, int origin)
{
    return origin != s->kinetic_origin && !strstr(s->stress.name[origin], "_noise");
}

static inline mat3 stress_total(const struct suspension *s)
{
    mat3 total = { { { 0.0 } } };
    for (int o = 0; o < s->stress.origins; o++)
        for (int k = 0; k < 9 && origin_is_summed(s, o); k++)
            total.m[k / 3][k % 3] += s->stress.sum[o].m[k / 3][k % 3];
    return total;
}

static inline double shear_in(const struct plane *p, const mat3 *S) { return 0.5 * (S->m[p->flow][p->gradient] + S->m[p->gradient][p->flow]); }
static inline double first_difference(const struct plane *p, const mat3 *S) { return S->m[p->flow][p->flow] - S->m[p->gradient][p->gradient]; }
static inline double second_difference(const struct plane *p, const mat3 *S) { return S->m[p->gradient][p->gradient] - S->m[p->vorticity][p->vorticity]; }
static inline double pressure_of(const mat3 *S) { return -(S->m[0][0] + S->m[1][1] + S->m[2][2]) / 3.0; }

#endif
