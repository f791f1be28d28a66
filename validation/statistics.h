/*
 * p-values and intervals of the checks. Every p is uniform on (0, 1) for a candidate that is right, exactly or corrected as said
 * at each function, so a check that alarms at p < alpha is wrong with probability alpha; tests/statistics_test.c measures it.
 *
 * "Draws" are n rows of p numbers, row-major. Whitened draws are standard normal, independent between rows and columns, if the
 * candidate is right.
 */
#ifndef STATISTICS_H
#define STATISTICS_H

#include <stdbool.h>
#include <stddef.h>

struct interval { double low, high; };

double statistics_normal_p(double z);                       /* two-sided */
double statistics_chi2_p(double x, double dof);             /* upper tail; dof need not be whole */
/* Upper tail of a sum of squares whose mean and variance are known: the chi-squared variable with these two moments. */
double statistics_matched_p(double x, double mean, double variance);
/*
 * Two-sided p of a mean square over its expected value (dof squares of standard normals, divided by dof). `allowance`: relative
 * systematic error that is no fault (truncation of a time step): the band 1 +- allowance is the null, p is then conservative.
 */
double statistics_variance_p(double ratio, double dof, double allowance);

/* Intervals at this confidence (0.95): of a mean of n values (Student), of a variance from n values about a known mean. */
struct interval statistics_mean_interval(const double *value, size_t n, double confidence, double *mean);
struct interval statistics_variance_interval(double variance, size_t n, double confidence);

/* Holm's adjusted p-values: rejecting adjusted < alpha keeps the chance of any false rejection below alpha. */
void statistics_holm(const double *p, size_t n, double *adjusted);
/* Kolmogorov-Smirnov p of n values against the uniform distribution on (0, 1); sorts a copy. Asymptotic with Stephens's correction. */
double statistics_uniform_p(const double *value, size_t n);

/*
 * Whitening by a covariance C = Q L Q^T: z = L^-1/2 Q^T x on the eigenvectors with eigenvalue > threshold * largest; the others
 * span the null space, where a right candidate has nothing at all.
 */
struct whitening { size_t size, rank; double *to_range /* rank x size */, *to_null /* (size - rank) x size */, largest; };
bool whitening_make(const double *covariance, size_t size, double threshold, struct whitening *w);  /* false: out of memory */
/* `z`: n x rank. Returns the largest component in the null space, relative to the root of the largest eigenvalue. */
double whitening_apply(const struct whitening *w, const double *draws, size_t n, double *z);
void whitening_free(struct whitening *w);

/* Mean of x x^T over n draws (mean known to be zero): p x p, symmetric. */
void statistics_covariance(const double *draws, size_t n, size_t p, double *covariance);

/* Is the covariance of whitened draws the identity? Likelihood ratio, with its exact mean and variance (Wishart). p < n. */
double statistics_identity_p(const double *z, size_t n, size_t p);
/* Is the overall size right? sum z^2 is chi-squared with n p degrees. Leaves the mean square in *ratio. Exact. */
double statistics_scale_p(const double *z, size_t n, size_t p, double *ratio);
/* Is the mean zero? n |mean|^2 is chi-squared with p degrees. Exact. */
double statistics_mean_p(const double *z, size_t n, size_t p);
/* Are rows `lag` apart uncorrelated? Sum of all squared lagged correlations, mean exact, variance to order p/n. */
double statistics_lag_p(const double *z, size_t n, size_t p, size_t lag);
/* Are two sets of draws uncorrelated, row by row? Sum of all squared cross-correlations, mean and variance exact. */
double statistics_cross_p(const double *x, size_t p, const double *y, size_t q, size_t n);
/* Its sum n |X^T Y/n|^2 (mean p q), for those who add several. NaN without memory. */
double statistics_cross_sum(const double *x, size_t p, const double *y, size_t q, size_t n);
/* Is the fourth moment Gaussian? Mean of z^4 - 3 over all numbers, which has variance 96/(n p); normal for large n p. */
double statistics_fourth_moment_p(const double *z, size_t n, size_t p, double *fourth_moment);

/*
 * The 3 x 3 block <X_a X_b> of a measured covariance (n draws, known zero mean) that deviates most from the expected one. Each
 * block is tried for a wrong size (its component along the expected block) and element by element, each as a quadratic form of
 * Gaussians, with its skewness taken into account; `p` is corrected for the number of tries (Bonferroni).
 */
struct block_finding {
    size_t a, b;            /* a <= b */
    double ratio;           /* measured over expected size; NaN where the expected block is zero */
    double z;               /* of the worst try */
    double p;
    double resolution;      /* relative change of this block that p < 1e-4 would show with 97.5 % probability; NaN as above */
};
struct block_finding statistics_worst_block(const double *measured, const double *expected, size_t blocks, size_t n);
/* The same resolution for any one block. */
double statistics_block_resolution(const double *expected, size_t blocks, size_t a, size_t b, size_t n);

#endif
