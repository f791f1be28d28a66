/*
 * Samples remembered at lags that grow geometrically, for correlations from the shortest to the longest time at once.
 *
 * Level l holds the last 16 samples whose number is a multiple of 2^l. A new sample meets those of level 0 at lags 1 to 16, those
 * of level l at lags (9 to 16) 2^l: dense at short lags, a few per octave at long ones, memory that grows with the logarithm
 * of the longest lag. Nothing is averaged over time before it is compared, so that displacements stay exact.
 * Source: multiple-tau correlator, Schaetzel (1990), Ramirez et al. (2010), without their coarse-graining.
 */
#ifndef OBSERVERS_LAGS_H
#define OBSERVERS_LAGS_H

#include "core/error.h"
#include "core/fields.h"

#include <stdint.h>

enum { LAG_WIDTH = 16, LAG_LEVELS = 40 };

struct lags {
    int levels, values;                 /* values per sample */
    int64_t taken;                      /* samples so far */
    double *ring;                       /* [level][slot][value] */
};

typedef void (*lags_visit)(void *owner, int row, const double *old, const double *now);

bool lags_new(struct lags *l, int levels, int values, struct error *e);
/* Shows the pair (old, now) for each lag at which an old sample is known, lag 0 included, then keeps `now`. */
void lags_push(struct lags *l, const double *now, lags_visit visit, void *owner);
int lags_rows(const struct lags *l);                    /* row 0 is lag 0 */
int64_t lags_of_row(int row);                           /* its lag, in samples */
void lags_free(struct lags *l);

#endif
