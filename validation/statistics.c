#include "statistics.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_sf_psi.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/*
 * Loops over draws are compiled a second time for processors with wider registers, which are chosen when the program starts. Each
 * number is still summed in the same order, so the results are the same bits on every machine.
 */
#if defined __x86_64__ && defined __GNUC__ && !defined __clang__
#define SEVERAL_AT_A_TIME __attribute__((target_clones("avx2", "default")))
#else
#define SEVERAL_AT_A_TIME
#endif

double statistics_normal_p(double z)
{
    return 2.0 * gsl_cdf_ugaussian_Q(fabs(z));
}

/*
 * Tails of chi-squared. With many degrees the incomplete gamma function of GSL does not always converge; the cube root is then
 * normal (Wilson & Hilferty 1931), to 5e-3 of the tail at p = 1e-6 from 2000 degrees on (tests/statistics_test.c).
 */
static double chi2_tail(double x, double dof, bool upper)
{
    if (!isfinite(x))
        return 0.0;
    if (dof <= 2000.0)
        return x > 20.0 * dof + 2000.0 ? (upper ? 0.0 : 1.0) : upper ? gsl_cdf_chisq_Q(x, dof) : gsl_cdf_chisq_P(x, dof);
    const double small = 2.0 / (9.0 * dof), z = (cbrt(fmax(x, 0.0) / dof) - 1.0 + small) / sqrt(small);
    return upper ? gsl_cdf_ugaussian_Q(z) : gsl_cdf_ugaussian_P(z);
}

double statistics_chi2_p(double x, double dof)
{
    return chi2_tail(x, dof, true);
}

double statistics_matched_p(double x, double mean, double variance)
{
    const double scale = variance / (2.0 * mean);   /* scale * chi2(dof): mean scale dof, variance 2 scale^2 dof */
    return statistics_chi2_p(x / scale, mean / scale);
}

double statistics_variance_p(double ratio, double dof, double allowance)
{
    if (!isfinite(ratio))
        return 0.0;
    const double above = chi2_tail(ratio * dof / (1.0 + allowance), dof, true);
    const double below = chi2_tail(ratio * dof / (1.0 - allowance), dof, false);
    return fmin(1.0, 2.0 * fmin(above, below));
}

struct interval statistics_mean_interval(const double *value, size_t n, double confidence, double *mean)
{
    double sum = 0.0, squares = 0.0;
    for (size_t k = 0; k < n; k++)
        sum += value[k];
    const double average = sum / (double)n;
    for (size_t k = 0; k < n; k++)
        squares += (value[k] - average) * (value[k] - average);
    if (mean)
        *mean = average;
    if (n < 2)
        return (struct interval){ -INFINITY, INFINITY };
    const double error = sqrt(squares / ((double)n - 1.0) / (double)n);
    const double width = error * gsl_cdf_tdist_Qinv(0.5 * (1.0 - confidence), (double)n - 1.0);
    return (struct interval){ average - width, average + width };
}

struct interval statistics_variance_interval(double variance, size_t n, double confidence)
{
    const double dof = (double)n, tail = 0.5 * (1.0 - confidence);
    return (struct interval){ variance * dof / gsl_cdf_chisq_Qinv(tail, dof), variance * dof / gsl_cdf_chisq_Pinv(tail, dof) };
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void statistics_holm(const double *p, size_t n, double *adjusted)
{
    /* The k-th smallest of n is multiplied by n - k (k = 0, 1, ...) and never falls below its predecessor. Ties get the same. */
    for (size_t i = 0; i < n; i++) {
        adjusted[i] = 0.0;
        for (size_t j = 0; j < n; j++) {
            if (p[j] > p[i])
                continue;
            size_t smaller = 0;
            for (size_t k = 0; k < n; k++)
                smaller += p[k] < p[j];
            adjusted[i] = fmax(adjusted[i], fmin(1.0, p[j] * (double)(n - smaller)));
        }
    }
}

double statistics_uniform_p(const double *value, size_t n)
{
    double *sorted = malloc(n * sizeof *sorted), furthest = 0.0;
    if (!sorted)
        return NAN;
    memcpy(sorted, value, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, ascending);
    for (size_t k = 0; k < n; k++)
        furthest = fmax(furthest, fmax(((double)k + 1.0) / (double)n - sorted[k], sorted[k] - (double)k / (double)n));
    free(sorted);
    const double root = sqrt((double)n), x = furthest * (root + 0.12 + 0.11 / root);
    double p = 0.0;
    for (int k = 1; k < 100; k++)
        p += (k % 2 ? 2.0 : -2.0) * exp(-2.0 * k * k * x * x);
    return x < 0.2 ? 1.0 : fmin(1.0, fmax(0.0, p));
}

static double project(const double *row, const double *x, size_t size)
{
    double sum = 0.0;
    for (size_t i = 0; i < size; i++)
        sum += row[i] * x[i];
    return sum;
}

/*
 * The eigenvectors of the null space come with errors of size * 1e-16 along weak directions of the range: take out what the
 * covariance still does to them, v -= C^+ C v, with C v summed in long double. Gains a factor of ten or more.
 */
static void sharpen_null_space(const double *covariance, struct whitening *w)
{
    for (double *v = w->to_null; v < w->to_null + (w->size - w->rank) * w->size; v += w->size) {
        double left[w->size];
        for (size_t i = 0; i < w->size; i++) {
            long double sum = 0.0;
            for (size_t j = 0; j < w->size; j++)
                sum += 0.5L * ((long double)covariance[i * w->size + j] + covariance[j * w->size + i]) * v[j];
            left[i] = (double)sum;
        }
        for (size_t k = 0; k < w->rank; k++) {
            const double *row = w->to_range + k * w->size, part = project(row, left, w->size);
            for (size_t i = 0; i < w->size; i++)
                v[i] -= part * row[i];
        }
    }
}

bool whitening_make(const double *covariance, size_t size, double threshold, struct whitening *w)
{
    memset(w, 0, sizeof *w);
    gsl_matrix *a = gsl_matrix_alloc(size, size), *q = gsl_matrix_alloc(size, size);
    gsl_vector *eigenvalue = gsl_vector_alloc(size);
    gsl_eigen_symmv_workspace *space = gsl_eigen_symmv_alloc(size);
    double *rows = malloc(size * size * sizeof *rows);
    const bool enough = a && q && eigenvalue && space && rows;
    if (enough) {
        for (size_t i = 0; i < size; i++)   /* a measured matrix may be asymmetric in its last digit */
            for (size_t j = 0; j < size; j++)
                gsl_matrix_set(a, i, j, 0.5 * (covariance[i * size + j] + covariance[j * size + i]));
        gsl_eigen_symmv(a, eigenvalue, q, space);
        gsl_eigen_symmv_sort(eigenvalue, q, GSL_EIGEN_SORT_VAL_DESC);
        w->size = size;
        w->largest = gsl_vector_get(eigenvalue, 0);
        while (w->rank < size && gsl_vector_get(eigenvalue, w->rank) > threshold * w->largest && w->largest > 0.0)
            w->rank++;
        for (size_t k = 0; k < size; k++)
            for (size_t i = 0; i < size; i++)
                rows[k * size + i] = gsl_matrix_get(q, i, k) / (k < w->rank ? sqrt(gsl_vector_get(eigenvalue, k)) : 1.0);
        w->to_range = rows;
        w->to_null = rows + w->rank * size;
        sharpen_null_space(covariance, w);
    } else {
        free(rows);
    }
    gsl_eigen_symmv_free(space);
    gsl_vector_free(eigenvalue);
    gsl_matrix_free(q);
    gsl_matrix_free(a);
    return enough;
}

/*
 * y(t) = A x(t) for n draws, with A^T given (size x wide): the inner loop runs along rows, which compilers do several at a time.
 * Four rows of A^T at once, added one after the other.
 */
SEVERAL_AT_A_TIME static void transform(const double *transposed, size_t size, size_t wide, const double *draws, size_t n, double *y)
{
    memset(y, 0, n * wide * sizeof *y);
    for (size_t t = 0; t < n; t++) {
        const double *x = draws + t * size;
        double *restrict row = y + t * wide;
        size_t i = 0;
        for (; i + 4 <= size; i += 4) {
            const double *a0 = transposed + i * wide, *a1 = a0 + wide, *a2 = a1 + wide, *a3 = a2 + wide;
            for (size_t k = 0; k < wide; k++)
                row[k] = row[k] + a0[k] * x[i] + a1[k] * x[i + 1] + a2[k] * x[i + 2] + a3[k] * x[i + 3];
        }
        for (; i < size; i++)
            for (size_t k = 0; k < wide; k++)
                row[k] += transposed[i * wide + k] * x[i];
    }
}

static double *transpose(const double *a, size_t rows, size_t columns)
{
    double *b = malloc((rows * columns + 1) * sizeof *b);
    for (size_t k = 0; b && k < rows * columns; k++)
        b[k % columns * rows + k / columns] = a[k];
    return b;
}

double whitening_apply(const struct whitening *w, const double *draws, size_t n, double *z)
{
    const size_t null = w->size - w->rank;
    const double unit = w->largest > 0.0 ? sqrt(w->largest) : 1.0;
    double stray = 0.0, *range = transpose(w->to_range, w->rank, w->size), *rest = transpose(w->to_null, null, w->size);
    double *left = malloc((n * null + 1) * sizeof *left);
    if (range && rest && left) {
        transform(range, w->size, w->rank, draws, n, z);
        transform(rest, w->size, null, draws, n, left);
        for (size_t k = 0; k < n * null; k++)
            stray = fmax(stray, fabs(left[k]) / unit);
    }
    free(range);
    free(rest);
    free(left);
    return stray;
}

void whitening_free(struct whitening *w)
{
    free(w->to_range);
    memset(w, 0, sizeof *w);
}

/*
 * c[i][j] += sum over n draws of x[i] y[j], for j >= i only if `upper`. Four draws at a time: c is large, and reading and writing
 * it for every draw would cost more than the sums.
 */
SEVERAL_AT_A_TIME static void add_products(const double *x, size_t p, const double *y, size_t q, size_t n, bool upper, double *c)
{
    size_t t = 0;
    for (; t + 4 <= n; t += 4) {
        const double *x0 = x + t * p, *x1 = x0 + p, *x2 = x1 + p, *x3 = x2 + p;
        const double *y0 = y + t * q, *y1 = y0 + q, *y2 = y1 + q, *y3 = y2 + q;
        for (size_t i = 0; i < p; i++) {
            const double a0 = x0[i], a1 = x1[i], a2 = x2[i], a3 = x3[i];
            double *restrict row = c + i * q;
            for (size_t j = upper ? i : 0; j < q; j++)
                row[j] += a0 * y0[j] + a1 * y1[j] + a2 * y2[j] + a3 * y3[j];
        }
    }
    for (; t < n; t++)
        for (size_t i = 0; i < p; i++)
            for (size_t j = upper ? i : 0; j < q; j++)
                c[i * q + j] += x[t * p + i] * y[t * q + j];
}

void statistics_covariance(const double *draws, size_t n, size_t p, double *covariance)
{
    memset(covariance, 0, p * p * sizeof *covariance);
    add_products(draws, p, draws, p, n, true, covariance);
    for (size_t i = 0; i < p; i++)
        for (size_t j = i; j < p; j++)
            covariance[i * p + j] = covariance[j * p + i] = covariance[i * p + j] / (double)n;
}

/*
 * -2 ln Lambda = n (tr S - ln det S - p), n S Wishart with n degrees and unit matrix (mean known). Its moments are exact:
 *     ln det(n S) = sum of ln chi2(n - i), i = 0 .. p - 1, so   E ln det S  = sum [ psi((n - i)/2) - ln(n/2) ]
 *     Var ln det S = sum psi'((n - i)/2) ,  Var tr S = 2 p/n ,  Cov(tr S, ln det S) = 2 p/n  (tr S is the sufficient statistic of
 *     the scale, and ln det S shifts by p per unit of ln scale).
 * For small p/n this is Bartlett's correction; for p = 250, n = 2e4 the chi-squared law with p(p + 1)/2 degrees would be wrong by
 * half a standard deviation. Source: Muirhead (1982), Aspects of multivariate statistical theory, sections 3.2 and 8.4.
 */
double statistics_identity_p(const double *z, size_t n, size_t p)
{
    if (p == 0)
        return 1.0;
    if (p >= n)
        return NAN;
    gsl_matrix *s = gsl_matrix_alloc(p, p);
    if (!s)
        return NAN;
    statistics_covariance(z, n, p, s->data);   /* a fresh gsl_matrix has no padding: tda = p */
    double trace = 0.0, log_determinant = 0.0;
    for (size_t i = 0; i < p; i++)
        trace += gsl_matrix_get(s, i, i);
    gsl_error_handler_t *handler = gsl_set_error_handler_off();
    const bool singular = gsl_linalg_cholesky_decomp1(s) != GSL_SUCCESS;
    gsl_set_error_handler(handler);
    for (size_t i = 0; i < p && !singular; i++)
        log_determinant += 2.0 * log(gsl_matrix_get(s, i, i));
    gsl_matrix_free(s);
    if (singular)
        return 0.0;                            /* fewer directions than the range has */

    const double count = (double)n;
    double mean = 0.0, variance = 0.0;
    for (size_t i = 0; i < p; i++) {
        const double half = 0.5 * (count - (double)i);
        mean += count * (log(0.5 * count) - gsl_sf_psi(half));
        variance += count * count * (gsl_sf_psi_1(half) - 2.0 / count);
    }
    return statistics_matched_p(count * (trace - log_determinant - (double)p), mean, variance);
}

double statistics_scale_p(const double *z, size_t n, size_t p, double *ratio)
{
    double squares = 0.0;
    for (size_t k = 0; k < n * p; k++)
        squares += z[k] * z[k];
    const double dof = (double)n * (double)p;
    *ratio = p ? squares / dof : 1.0;
    return p ? statistics_variance_p(*ratio, dof, 0.0) : 1.0;
}

double statistics_mean_p(const double *z, size_t n, size_t p)
{
    double total = 0.0;
    for (size_t k = 0; k < p; k++) {
        double sum = 0.0;
        for (size_t t = 0; t < n; t++)
            sum += z[t * p + k];
        total += sum * sum / (double)n;
    }
    return p ? statistics_chi2_p(total, (double)p) : 1.0;
}

double statistics_cross_sum(const double *x, size_t p, const double *y, size_t q, size_t n)
{
    double *c = calloc(p * q, sizeof *c), sum = 0.0;
    if (!c)
        return NAN;
    add_products(x, p, y, q, n, false, c);
    for (size_t k = 0; k < p * q; k++)
        sum += c[k] * c[k] / (double)n;
    free(c);
    return sum;
}

/* The mean of the sum is p^2; neighbouring terms z(t) z(t+k), z(t+k) z(t+2k) share a factor: variance 2 p^2 (1 + (4 p + 1)/n). */
double statistics_lag_p(const double *z, size_t n, size_t p, size_t lag)
{
    if (p == 0 || n <= lag)
        return 1.0;
    const size_t terms = n - lag;
    const double mean = (double)p * (double)p;
    return statistics_matched_p(statistics_cross_sum(z, p, z + lag * p, p, terms), mean,
                                2.0 * mean * (1.0 + (4.0 * (double)p + 1.0) / (double)terms));
}

/* tr(W_x W_y)/n for two independent Wishart Gram matrices: mean p q, variance 2 p q (1 + (p + q + 1)/n). */
double statistics_cross_p(const double *x, size_t p, const double *y, size_t q, size_t n)
{
    if (p == 0 || q == 0)
        return 1.0;
    const double mean = (double)p * (double)q;
    return statistics_matched_p(statistics_cross_sum(x, p, y, q, n), mean,
                                2.0 * mean * (1.0 + ((double)p + (double)q + 1.0) / (double)n));
}

double statistics_fourth_moment_p(const double *z, size_t n, size_t p, double *fourth_moment)
{
    double sum = 0.0;
    for (size_t k = 0; k < n * p; k++)
        sum += z[k] * z[k] * z[k] * z[k];
    const double count = (double)n * (double)p;
    *fourth_moment = sum / count;
    return statistics_normal_p((*fourth_moment - 3.0) * sqrt(count / 96.0));   /* E z^8 - (E z^4)^2 = 105 - 9 */
}
