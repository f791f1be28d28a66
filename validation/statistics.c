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

double statistics_normal_p(double z)
{
    return 2.0 * gsl_cdf_ugaussian_Q(fabs(z));
}

double statistics_chi2_p(double x, double dof)
{
    return isfinite(x) ? gsl_cdf_chisq_Q(x, dof) : 0.0;
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
    const double above = gsl_cdf_chisq_Q(ratio * dof / (1.0 + allowance), dof);
    const double below = gsl_cdf_chisq_P(ratio * dof / (1.0 - allowance), dof);
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
    } else {
        free(rows);
    }
    gsl_eigen_symmv_free(space);
    gsl_vector_free(eigenvalue);
    gsl_matrix_free(q);
    gsl_matrix_free(a);
    return enough;
}

static double project(const double *row, const double *x, size_t size)
{
    double sum = 0.0;
    for (size_t i = 0; i < size; i++)
        sum += row[i] * x[i];
    return sum;
}

double whitening_apply(const struct whitening *w, const double *draws, size_t n, double *z)
{
    const double unit = w->largest > 0.0 ? sqrt(w->largest) : 1.0;
    double stray = 0.0;
    for (size_t t = 0; t < n; t++) {
        const double *x = draws + t * w->size;
        for (size_t k = 0; k < w->rank; k++)
            z[t * w->rank + k] = project(w->to_range + k * w->size, x, w->size);
        for (size_t k = 0; k < w->size - w->rank; k++)
            stray = fmax(stray, fabs(project(w->to_null + k * w->size, x, w->size)) / unit);
    }
    return stray;
}

void whitening_free(struct whitening *w)
{
    free(w->to_range);
    memset(w, 0, sizeof *w);
}

void statistics_covariance(const double *draws, size_t n, size_t p, double *covariance)
{
    memset(covariance, 0, p * p * sizeof *covariance);
    for (size_t t = 0; t < n; t++) {
        const double *x = draws + t * p;
        for (size_t i = 0; i < p; i++) {
            double *row = covariance + i * p;
            for (size_t j = i; j < p; j++)
                row[j] += x[i] * x[j];
        }
    }
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

/* n |X^T Y / n|^2 summed over all p q entries, or NaN without memory. */
static double cross_correlation(const double *x, size_t p, size_t x_stride, const double *y, size_t q, size_t y_stride, size_t n)
{
    double *c = calloc(p * q, sizeof *c), sum = 0.0;
    if (!c)
        return NAN;
    for (size_t t = 0; t < n; t++)
        for (size_t i = 0; i < p; i++)
            for (size_t j = 0; j < q; j++)
                c[i * q + j] += x[t * x_stride + i] * y[t * y_stride + j];
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
    return statistics_matched_p(cross_correlation(z, p, p, z + lag * p, p, p, terms), mean,
                                2.0 * mean * (1.0 + (4.0 * (double)p + 1.0) / (double)terms));
}

/* tr(W_x W_y)/n for two independent Wishart Gram matrices: mean p q, variance 2 p q (1 + (p + q + 1)/n). */
double statistics_cross_p(const double *x, size_t p, const double *y, size_t q, size_t n)
{
    if (p == 0 || q == 0)
        return 1.0;
    const double mean = (double)p * (double)q;
    return statistics_matched_p(cross_correlation(x, p, p, y, q, q, n), mean,
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
