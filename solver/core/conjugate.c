#include "core/conjugate.h"

#include <math.h>

static double weighed_square(const struct linear_system *s, const double *v)
{
    double sum = 0.0;
    for (size_t k = 0; k < s->size; k++)
        sum += v[k] * v[k] / s->diagonal[k];
    return sum;
}

int conjugate_solve(const struct linear_system *s, const double *b, double *x)
{
    double *r = s->work, *p = s->work + s->size, *Ap = s->work + 2 * s->size;
    const double goal = s->residual * s->residual * weighed_square(s, b);

    s->apply(s->context, x, Ap);
    for (size_t k = 0; k < s->size; k++) {
        r[k] = b[k] - Ap[k];
        p[k] = r[k] / s->diagonal[k];
    }
    double square = weighed_square(s, r);
    for (int iteration = 0; iteration <= s->most_iterations; iteration++) {
        if (square <= goal)
            return iteration;
        double curvature = 0.0;
        s->apply(s->context, p, Ap);
        for (size_t k = 0; k < s->size; k++)
            curvature += p[k] * Ap[k];
        const double step = square / curvature;
        for (size_t k = 0; k < s->size; k++) {
            x[k] += step * p[k];
            r[k] -= step * Ap[k];
        }
        const double before = square;
        square = weighed_square(s, r);
        for (size_t k = 0; k < s->size; k++)
            p[k] = r[k] / s->diagonal[k] + square / before * p[k];
    }
    return -1;
}
