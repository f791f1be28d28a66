/*
 * The p-values of the suite: uniform when the candidate is right, small when it is 5 % wrong. Seeds are fixed, so these tests
 * give the same numbers every time; thresholds on p of 1e-3 were chosen before the seeds were.
 */
#include "statistics.h"
#include "suite.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void fill_normal(gsl_rng *rng, double *x, size_t count)
{
    for (size_t k = 0; k < count; k++)
        x[k] = gsl_ran_gaussian_ziggurat(rng, 1.0);
}

/* Table values (Abramowitz & Stegun; Student's and chi-squared quantiles of any handbook), given to the digits printed. */
static void tails_agree_with_tables(void)
{
    check_close(statistics_normal_p(1.959964), 0.05, 1e-7, "normal 1.96");
    check_close(statistics_normal_p(-3.290527), 0.001, 1e-8, "normal 3.29");
    check_close(statistics_chi2_p(18.307, 10.0), 0.05, 1e-5, "chi-squared 10");
    check_close(statistics_chi2_p(31125.0, 31125.0), 0.499, 1e-3, "chi-squared with many degrees: median = mean - 2/3");
    /* where the cube-root approximation takes over from the incomplete gamma function (2000 degrees), at p = 1e-6 to 0.97 */
    for (double x = 1880.0; x < 2320.0; x += 40.0)
        check_relative(statistics_chi2_p(x, 2000.0000001), statistics_chi2_p(x, 2000.0), 5e-3, "both formulas");
    check_true(statistics_chi2_p(INFINITY, 3.0) == 0.0 && statistics_chi2_p(NAN, 3.0) == 0.0, "no number is no agreement");
    const double value[5] = { 1.0, 2.0, 3.0, 4.0, 5.0 };
    double mean;
    const struct interval i = statistics_mean_interval(value, 5, 0.95, &mean);
    check_close(mean, 3.0, 1e-15, "mean");
    check_close(i.high - mean, 2.776445 * sqrt(0.5), 1e-5, "Student's interval");
    const struct interval v = statistics_variance_interval(2.0, 10, 0.95);
    check_close(v.low, 20.0 / 20.48318, 1e-5, "variance, lower end");
    check_close(v.high, 20.0 / 3.246973, 1e-4, "variance, upper end");
}

static void holm_and_kolmogorov(void)
{
    const double p[4] = { 0.01, 0.04, 0.03, 0.005 }, expected[4] = { 0.03, 0.06, 0.06, 0.02 };
    double adjusted[4];
    statistics_holm(p, 4, adjusted);
    for (int k = 0; k < 4; k++)
        check_close(adjusted[k], expected[k], 1e-15, "Holm");
    double even[100], squeezed[100];
    for (int k = 0; k < 100; k++) {
        even[k] = (k + 0.5) / 100.0;
        squeezed[k] = 0.8 * even[k];
    }
    check_true(statistics_uniform_p(even, 100) > 0.999, "evenly spread");
    /* D = 1 - 0.8 * 0.995 = 0.204, n = 100: 2 exp(-2 (10.131 * 0.204)^2) = 3.9e-4 */
    check_close(statistics_uniform_p(squeezed, 100), 3.9e-4, 1e-6, "squeezed");
}

enum { TESTS = 7, DRAWS = 800, WIDTH = 40, REPETITIONS = 300 };
static const char *const test_name[TESTS] = { "identity", "scale", "mean", "lag 1", "lag 2", "cross", "fourth moment" };

static void all_p_values(const double *z, const double *other, double p[TESTS])
{
    double unused;
    p[0] = statistics_identity_p(z, DRAWS, WIDTH);
    p[1] = statistics_scale_p(z, DRAWS, WIDTH, &unused);
    p[2] = statistics_mean_p(z, DRAWS, WIDTH);
    p[3] = statistics_lag_p(z, DRAWS, WIDTH, 1);
    p[4] = statistics_lag_p(z, DRAWS, WIDTH, 2);
    p[5] = statistics_cross_p(z, WIDTH, other, WIDTH / 2, DRAWS);
    p[6] = statistics_fourth_moment_p(z, DRAWS, WIDTH, &unused);
}

/* WIDTH/DRAWS = 0.05 is four times what the checks use, so the corrections for it are tested where they matter more. */
static void p_values_are_uniform_for_a_right_candidate(void)
{
    static double z[DRAWS * WIDTH], other[DRAWS * WIDTH], p[TESTS][REPETITIONS];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    for (int r = 0; r < REPETITIONS; r++) {
        double one[TESTS];
        fill_normal(rng, z, DRAWS * WIDTH);
        fill_normal(rng, other, DRAWS * WIDTH / 2);
        all_p_values(z, other, one);
        for (int k = 0; k < TESTS; k++)
            p[k][r] = one[k];
    }
    for (int k = 0; k < TESTS; k++)
        check_true(statistics_uniform_p(p[k], REPETITIONS) > 1e-3, test_name[k]);
    gsl_rng_free(rng);
}

/* The size the cluster case has: 240 numbers, 20000 draws. One draw of p; 1e-3 is the chance of a false alarm, seed fixed. */
static void identity_test_holds_at_full_size(void)
{
    const size_t n = 20000, p = 240;
    double *z = malloc(n * p * sizeof *z);
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    fill_normal(rng, z, n * p);
    const double right = statistics_identity_p(z, n, p);
    check_true(right > 1e-3 && right < 1.0 - 1e-3, "right candidate");
    for (size_t t = 0; t < n; t++)   /* two of 240 numbers correlated by 0.3 */
        z[t * p + 7] = 0.3 * z[t * p + 190] + sqrt(1.0 - 0.09) * z[t * p + 7];
    check_true(statistics_identity_p(z, n, p) < 1e-4, "one wrong correlation among 28680");
    gsl_rng_free(rng);
    free(z);
}

/* A fault of 5 % with 8000 draws of 40 numbers: each test meets the fault that it is for. */
static void p_values_vanish_for_a_wrong_candidate(void)
{
    enum { n = 8000 };
    static double z[n * WIDTH], faulty[n * WIDTH];
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    fill_normal(rng, z, n * WIDTH);
    double ratio;
    for (int k = 0; k < n * WIDTH; k++)
        faulty[k] = z[k] * 1.025;                                  /* variance 5 % too large */
    check_true(statistics_scale_p(faulty, n, WIDTH, &ratio) < 1e-10, "scale");
    check_close(ratio, 1.05, 0.01, "ratio");                       /* standard error sqrt(2/320000) = 0.0025 */
    for (int k = 0; k < n * WIDTH; k++)
        faulty[k] = z[k] * (k % 2 ? 1.0247 : 0.9747);              /* half of the numbers 5 % up, half 5 % down */
    check_true(statistics_identity_p(faulty, n, WIDTH) < 1e-10, "identity");
    for (int k = 0; k < n * WIDTH; k++)
        faulty[k] = z[k] + 0.05;
    check_true(statistics_mean_p(faulty, n, WIDTH) < 1e-10, "mean");
    memcpy(faulty, z, sizeof z);
    for (int k = 2 * WIDTH; k < n * WIDTH; k++)
        faulty[k] += 0.05 * z[k - 2 * WIDTH];                      /* the noise of two steps before leaks in */
    check_true(statistics_lag_p(faulty, n, WIDTH, 2) < 1e-10, "lag 2");
    check_true(statistics_lag_p(faulty, n, WIDTH, 1) > 1e-3, "and not at lag 1");
    fill_normal(rng, faulty, n * WIDTH);
    for (int k = 0; k < n * WIDTH; k++)
        faulty[k] += 0.05 * z[k];
    check_true(statistics_cross_p(faulty, WIDTH, z, WIDTH, n) < 1e-10, "cross");
    for (int k = 0; k < n * WIDTH; k++)
        faulty[k] = k % 20 ? z[k] : sqrt(3.0) * (2.0 * gsl_rng_uniform(rng) - 1.0);   /* 5 % uniform numbers, same variance */
    check_true(statistics_fourth_moment_p(faulty, n, WIDTH, &ratio) < 1e-4, "fourth moment");
    gsl_rng_free(rng);
}

/* A 3-body toy: C = A A^T of rank 5 in 9 dimensions. */
static void rank_5_covariance(gsl_rng *rng, double A[9][5], double C[81])
{
    for (int i = 0; i < 9; i++)
        for (int k = 0; k < 5; k++)
            A[i][k] = gsl_ran_gaussian(rng, k == 0 ? 20.0 : 1.0);   /* one stiff direction, as squeezing is */
    for (int i = 0; i < 9; i++)
        for (int j = 0; j < 9; j++) {
            C[9 * i + j] = 0.0;
            for (int k = 0; k < 5; k++)
                C[9 * i + j] += A[i][k] * A[j][k];
        }
}

static void draw_from(gsl_rng *rng, double A[9][5], size_t n, double *x)
{
    memset(x, 0, 9 * n * sizeof *x);
    for (size_t t = 0; t < n; t++)
        for (int k = 0; k < 5; k++) {
            const double g = gsl_ran_gaussian_ziggurat(rng, 1.0);
            for (int i = 0; i < 9; i++)
                x[9 * t + (size_t)i] += A[i][k] * g;
        }
}

static void whitening_splits_range_and_null_space(void)
{
    enum { n = 500 };
    static double x[9 * n], z[5 * n];
    double A[9][5], C[81], p[200], ratio;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    struct whitening w;
    rank_5_covariance(rng, A, C);
    check_true(whitening_make(C, 9, 1e-10, &w) && w.rank == 5, "rank 5");
    for (int r = 0; r < 200; r++) {
        draw_from(rng, A, n, x);
        /* eigenvectors are good to 1e-16 of the largest eigenvalue over the smallest in the range, here 1e4 */
        check_close(whitening_apply(&w, x, n, z), 0.0, 1e-12, "nothing in the null space");
        p[r] = statistics_identity_p(z, n, 5);
    }
    check_true(statistics_uniform_p(p, 200) > 1e-3, "whitened draws are white");
    statistics_scale_p(z, n, 5, &ratio);
    check_close(ratio, 1.0, 5.0 * sqrt(2.0 / (5.0 * n)), "unit variance");   /* five standard errors */
    for (int i = 0; i < 9; i++)
        x[9 * 17 + i] += 1e-6;
    check_true(whitening_apply(&w, x, n, z) > 1e-9, "a stray part in one draw is seen");
    whitening_free(&w);
    gsl_rng_free(rng);
}

/* Bonferroni over dependent tries is conservative: P(p < x) <= x, shown at x = 0.1 and 0.02; not by more than a factor 10. */
static void worst_block_is_calibrated_and_names_the_fault(void)
{
    enum { n = 2000, TIMES = 500 };
    static double x[9 * n];
    double A[9][5], C[81], S[81];
    int below_tenth = 0, below_fiftieth = 0;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    rank_5_covariance(rng, A, C);
    for (int r = 0; r < TIMES; r++) {
        draw_from(rng, A, n, x);
        statistics_covariance(x, n, 9, S);
        const double p = statistics_worst_block(S, C, 3, n).p;
        below_tenth += p < 0.1;
        below_fiftieth += p < 0.02;
    }
    /* 50 and 10 expected at most; plus three standard deviations */
    check_true(below_tenth <= 70 && below_tenth >= 5, "false alarms at 0.1");
    check_true(below_fiftieth <= 20, "false alarms at 0.02");

    draw_from(rng, A, n, x);
    statistics_covariance(x, n, 9, S);
    for (int i = 0; i < 3; i++)
        for (int j = 6; j < 9; j++) {
            S[9 * i + j] -= 2.0 * C[9 * i + j];   /* the wrong sign between the first and the third body */
            S[9 * j + i] = S[9 * i + j];
        }
    const struct block_finding f = statistics_worst_block(S, C, 3, n);
    check_true(f.a == 0 && f.b == 2, "names the block");
    check_close(f.ratio, -1.0, 0.2, "measured is minus expected");
    check_true(f.p < 1e-10, "is sure");
    check_true(f.resolution > 0.0 && f.resolution < 0.5, "says what it could have seen");
    gsl_rng_free(rng);
}

/* The allowance makes p conservative inside the band and leaves it honest beyond: chi-squared at the edge. */
static void variance_test_respects_its_allowance(void)
{
    check_true(statistics_variance_p(1.0, 1e4, 0.0) > 0.9, "spot on");
    check_true(statistics_variance_p(1.01, 1e6, 0.02) > 0.99, "inside the allowance");
    check_true(statistics_variance_p(1.05, 1e6, 0.02) < 1e-6, "beyond it");
    check_true(statistics_variance_p(0.95, 1e6, 0.02) < 1e-6, "below it");
    /* 1.04 with 5000 degrees: z = 0.04/sqrt(2/5000) = 2.0, two-sided 0.046 */
    check_close(statistics_variance_p(1.04, 5000.0, 0.0), 0.046, 0.004, "plain");
    check_true(statistics_variance_p(NAN, 10.0, 0.0) == 0.0, "no number is no agreement");
}

static const struct unit_test tests[] = {
    { "tails and intervals agree with tables", tails_agree_with_tables },
    { "Holm and Kolmogorov", holm_and_kolmogorov },
    { "p-values are uniform for a right candidate", p_values_are_uniform_for_a_right_candidate },
    { "identity test holds at full size", identity_test_holds_at_full_size },
    { "p-values vanish for a 5 % fault", p_values_vanish_for_a_wrong_candidate },
    { "whitening splits range and null space", whitening_splits_range_and_null_space },
    { "worst block: calibrated, and names the fault", worst_block_is_calibrated_and_names_the_fault },
    { "variance test respects its allowance", variance_test_respects_its_allowance },
    { NULL, NULL }
};

const struct suite statistics_suite = { "statistics", tests };
