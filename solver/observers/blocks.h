/*
 * Mean and error of a correlated series.
 *
 * Transient, rule MSER-5 (White 1997): of means over five samples, drop the first d that make the estimated variance of the mean
 *     sum over k >= d of (y_k - mean)^2 / (n - d)^2
 * smallest, but never more than half: a minimum at half the series means that it has not settled.
 *
 * Error, by blocking (Flyvbjerg & Petersen 1989): neighbours are averaged pairwise until blocks are independent; with m blocks
 *     error^2 = sum (y - mean)^2 / (m (m - 1)),   known to a fraction 1/sqrt(2 (m - 1))
 * The plateau is the first level from which the next does not rise by more than the uncertainty; it counts only with 20 blocks or
 * more. Without a plateau the largest error of all levels with at least 8 blocks is given: a lower bound.
 */
#ifndef OBSERVERS_BLOCKS_H
#define OBSERVERS_BLOCKS_H

#include <stdbool.h>
#include <stddef.h>

struct block_mean {
    double mean, error;
    size_t blocks;                      /* independent ones, at the plateau */
    bool plateau;                       /* the error is one, not a lower bound */
};

/* How many samples at the begin of x are to be dropped. */
size_t blocks_transient(const double *x, size_t count);
/* Of the whole of x, which is used up. */
struct block_mean blocks_mean(double *x, size_t count);

#endif
