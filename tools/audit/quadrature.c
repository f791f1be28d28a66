/*
 * Quadratures and differential equations in quadruple precision.
 *
 *     double exponential rule   x = tanh(pi/2 sinh(k d)), weights the derivative        Takahasi & Mori (1974)
 *     Gauss-Legendre points     roots of P_n by Newton, P_n by its recursion
 *     Bulirsch & Stoer (1966)   midpoint rule with 2, 4, 6, ... substeps, extrapolated to none; the error has even powers only (Gragg 1965)
 */
#include "audit.h"

#include <string.h>

quad integral(quad (*f)(quad x, const void *with), const void *with, quad from, quad to)
{
    const quad half = (to - from) / 2, middle = (to + from) / 2, step = (quad)1 / 32, right_angle = PIQ / 2;
    quad sum = 0;
    for (int k = -160; k <= 160; k++) {
        const quad t = k * step, s = right_angle * sinhq(t), c = coshq(s);
        const quad weight = right_angle * coshq(t) / (c * c);
        /* distance from the nearer end without cancellation: 1 - tanh s = exp(-s)/cosh s */
        const quad to_end = half * expq(-fabsq(s)) / c;
        const quad x = k < 0 ? from + to_end : k > 0 ? to - to_end : middle;
        if (weight > (quad)1e-40 && x > from && x < to)
            sum += weight * f(x, with);
    }
    return sum * step * half;
}

void gauss_points(int n, quad *point, quad *weight)
{
    for (int k = 0; k < n; k++) {
        quad x = cosq(PIQ * (k + (quad)3 / 4) / (n + (quad)1 / 2)), slope = 1;
        for (int iteration = 0; iteration < 12; iteration++) {
            quad before = 1, now = x;
            for (int m = 2; m <= n; m++) {
                const quad next = ((2 * m - 1) * x * now - (m - 1) * before) / m;
                before = now;
                now = next;
            }
            slope = n * (x * now - before) / (x * x - 1);
            x -= now / slope;
        }
        point[k] = x;
        weight[k] = 2 / ((1 - x * x) * slope * slope);
    }
}

typedef void derivative(quad t, const quad *y, quad *dydt, const void *with);
enum { ROWS = 9 };      /* of the table: order 18 */

/* One step of length h; the result in `out`. Returns its error over what is allowed: the last extrapolation's change. */
static double extrapolated_step(derivative *f, const void *with, int n, quad t, const quad *y, quad h, double tolerance, const double *scale, quad *out)
{
    quad table[ROWS][ROWS][MOST_VARIABLES], first[MOST_VARIABLES], slope[MOST_VARIABLES], before[MOST_VARIABLES], now[MOST_VARIABLES];
    f(t, y, first, with);
    for (int r = 0; r < ROWS; r++) {
        const int pieces = 2 * (r + 1);
        const quad piece = h / pieces;
        for (int k = 0; k < n; k++) {
            before[k] = y[k];
            now[k] = y[k] + piece * first[k];
        }
        for (int m = 1; m < pieces; m++) {
            f(t + m * piece, now, slope, with);
            for (int k = 0; k < n; k++) {
                const quad next = before[k] + 2 * piece * slope[k];
                before[k] = now[k];
                now[k] = next;
            }
        }
        f(t + h, now, slope, with);
        for (int k = 0; k < n; k++) {
            table[r][0][k] = (now[k] + before[k] + piece * slope[k]) / 2;
            for (int m = 1; m <= r; m++) {
                const quad ratio = (quad)((r + 1) * (r + 1)) / ((r - m + 1) * (r - m + 1));
                table[r][m][k] = table[r][m - 1][k] + (table[r][m - 1][k] - table[r - 1][m - 1][k]) / (ratio - 1);
            }
        }
    }
    double error = 0.0;
    for (int k = 0; k < n; k++) {
        out[k] = table[ROWS - 1][ROWS - 1][k];
        const double off = (double)fabsq(out[k] - table[ROWS - 1][ROWS - 2][k]) / (tolerance * scale[k]);
        if (!(off <= error))
            error = off;
    }
    return error;
}

quad solve(derivative *f, const void *with, int n, quad *y, quad duration, double tolerance, const double *scale,
           quad (*until)(const quad *y, const void *with))
{
    quad t = 0, h = duration / 50, out[MOST_VARIABLES];
    bool armed = until && until(y, with) < 0;       /* the condition must have been negative before it can turn */
    for (long steps = 0; t < duration && steps < 400000; steps++) {
        if (h > duration - t)
            h = duration - t;
        const double error = extrapolated_step(f, with, n, t, y, h, tolerance, scale, out);
        if (error > 1.0 && h > duration * (quad)1e-20) {
            h *= error > 1e6 ? (quad)0.25 : (quad)0.6;
            continue;
        }
        if (armed && until(out, with) >= 0) {       /* halve the step in which it happens until it is nothing */
            quad low = 0, high = h;
            for (int k = 0; k < 70; k++) {
                const quad middle = (low + high) / 2;
                extrapolated_step(f, with, n, t, y, middle, tolerance, scale, out);
                *(until(out, with) >= 0 ? &high : &low) = middle;
            }
            extrapolated_step(f, with, n, t, y, high, tolerance, scale, out);
            memcpy(y, out, (size_t)n * sizeof *y);
            return t + high;
        }
        memcpy(y, out, (size_t)n * sizeof *y);
        armed = armed || (until && until(y, with) < 0);
        t += h;
        if (error < 0.01)
            h *= error < 1e-8 ? 2 : (quad)1.3;
    }
    if (t < duration)
        audit_fault("a differential equation was not solved to its end");
    return t;
}
