/*
 * Which 3 x 3 block of a covariance is wrong? (statistics.h)
 *
 *     q(x) = x^T K x ,   E q = tr(K C) ,   Var q = 2 tr(K C K C) ,   third cumulant 8 tr((K C)^3)       x normal, covariance C
 *
 * Every try is the mean of such a form over n draws: K picks one element of a block, or the block's component along its
 * expectation. Source: Mathai & Provost (1992), Quadratic forms in random variables, section 3.2; Cornish & Fisher (1937).
 */
#include "statistics.h"

#include <math.h>
#include <stdlib.h>

/* A quadratic form x^T K x of six Gaussians (two blocks), or three (one block on the diagonal). */
struct form { size_t size, index[6]; double K[6][6]; };

static void multiply(size_t size, const double a[6][6], const double b[6][6], double out[6][6])
{
    for (size_t i = 0; i < size; i++)
        for (size_t j = 0; j < size; j++) {
            out[i][j] = 0.0;
            for (size_t k = 0; k < size; k++)
                out[i][j] += a[i][k] * b[k][j];
        }
}

/*
 * Standardised deviation of the mean of x^T K x over n draws from tr(K C); its variance is 2 tr(K C K C)/n and its skewness
 * 8 tr((K C)^3)/n^2 over variance^1.5, taken out by Cornish & Fisher's expansion where that holds (|z| below 8; beyond, p is 0
 * for all purposes). `slope`: standardised size of tr(K C) itself, that is, z per unit relative change.
 */
static double form_z(const struct form *f, const double *measured, const double *expected, size_t m, size_t n, double *slope)
{
    double kc[6][6] = { { 0 } }, square[6][6], cube[6][6], c[6][6], deviation = 0.0, mean = 0.0, second = 0.0, third = 0.0;
    for (size_t i = 0; i < f->size; i++)
        for (size_t j = 0; j < f->size; j++) {
            c[i][j] = expected[f->index[i] * m + f->index[j]];
            deviation += f->K[i][j] * (measured[f->index[i] * m + f->index[j]] - c[i][j]);
            mean += f->K[i][j] * c[i][j];
        }
    multiply(f->size, f->K, (const double (*)[6])c, kc);
    multiply(f->size, (const double (*)[6])kc, (const double (*)[6])kc, square);
    multiply(f->size, (const double (*)[6])square, (const double (*)[6])kc, cube);
    for (size_t i = 0; i < f->size; i++) {
        second += 2.0 * square[i][i];
        third += 8.0 * cube[i][i];
    }
    *slope = 0.0;
    if (!(second > 0.0))
        return 0.0;
    const double spread = sqrt(second / (double)n), skew = third / (second * sqrt(second) * sqrt((double)n));
    const double z = deviation / spread;
    *slope = mean / spread;
    return fabs(z) < 8.0 ? z - skew / 6.0 * (z * z - 1.0) + skew * skew / 36.0 * (2.0 * z * z * z - 5.0 * z) : z;
}

static struct form block_form(size_t a, size_t b)
{
    struct form f = { .size = a == b ? 3 : 6 };
    for (size_t k = 0; k < 3; k++) {
        f.index[k] = 3 * a + k;
        f.index[3 + k] = 3 * b + k;
    }
    return f;
}

/* Put weight on element (i, j) of block (a, b); off the diagonal the symmetric form has half of it twice. */
static void weigh(struct form *f, size_t i, size_t j, double weight)
{
    const size_t column = f->size == 3 ? j : 3 + j;
    f->K[i][column] += 0.5 * weight;
    f->K[column][i] += 0.5 * weight;
}

/* The form that measures the size of block (a, b) along its expectation; false where that is zero but for rounding. */
static bool size_form(const double *expected, size_t m, size_t a, size_t b, struct form *f)
{
    *f = block_form(a, b);
    double own = 0.0, first = 0.0, second = 0.0;
    for (size_t i = 0; i < 3; i++) {
        first += expected[(3 * a + i) * (m + 1)];
        second += expected[(3 * b + i) * (m + 1)];
        for (size_t j = 0; j < 3; j++) {
            const double e = expected[(3 * a + i) * m + 3 * b + j];
            own += e * e;
            weigh(f, i, j, e);
        }
    }
    return own > 1e-20 * first * second;
}

static const double alarm_z = 3.9, margin_z = 2.0;   /* two-sided p = 1e-4, and 97.5 % of a normal below */

double statistics_block_resolution(const double *expected, size_t blocks, size_t a, size_t b, size_t n)
{
    struct form f;
    double slope;
    if (!size_form(expected, 3 * blocks, a, b, &f))
        return NAN;
    form_z(&f, expected, expected, 3 * blocks, n, &slope);
    const double tries = 10.0 * 0.5 * (double)blocks * ((double)blocks + 1.0);
    /* Bonferroni raises the alarm: z of p = 1e-4/tries, by the leading term of the normal tail */
    return (sqrt(alarm_z * alarm_z + 2.0 * log(tries)) + margin_z) / slope;
}

struct block_finding statistics_worst_block(const double *measured, const double *expected, size_t blocks, size_t n)
{
    const size_t m = 3 * blocks;
    struct block_finding worst = { .ratio = NAN, .resolution = NAN };
    double tries = 0.0, slope, *trace = calloc(blocks + 1, sizeof *trace);
    if (!trace)
        return (struct block_finding){ .ratio = NAN, .z = NAN, .p = NAN, .resolution = NAN };
    for (size_t i = 0; i < m; i++)
        trace[i / 3] += expected[i * (m + 1)];
    for (size_t a = 0; a < blocks; a++)
        for (size_t b = a; b < blocks; b++) {
            struct form f;
            double most = 0.0;
            if (size_form(expected, m, a, b, &f)) {
                most = form_z(&f, measured, expected, m, n, &slope);
                tries += 1.0;
            }
            for (size_t i = 0; i < 3; i++)
                for (size_t j = a == b ? i : 0; j < 3; j++) {
                    /* along the line of centres a torque has no variance but that of rounding: nothing to compare with */
                    if (expected[(3 * a + i) * (m + 1)] * expected[(3 * b + j) * (m + 1)] <= 1e-10 * trace[a] * trace[b])
                        continue;
                    f = block_form(a, b);
                    weigh(&f, i, j, 1.0);
                    const double z = form_z(&f, measured, expected, m, n, &slope);
                    most = fabs(z) > fabs(most) ? z : most;
                    tries += 1.0;
                }
            if (fabs(most) > fabs(worst.z)) {
                worst.a = a;
                worst.b = b;
                worst.z = most;
            }
        }
    free(trace);
    worst.p = fmin(1.0, tries * statistics_normal_p(worst.z));

    struct form f;
    if (size_form(expected, m, worst.a, worst.b, &f)) {
        double along = 0.0, own = 0.0;
        for (size_t i = 0; i < f.size; i++)
            for (size_t j = 0; j < f.size; j++) {
                along += f.K[i][j] * measured[f.index[i] * m + f.index[j]];
                own += f.K[i][j] * expected[f.index[i] * m + f.index[j]];
            }
        worst.ratio = along / own;
        worst.resolution = statistics_block_resolution(expected, blocks, worst.a, worst.b, n);
    }
    return worst;
}
