/*
 * What displacements and velocity correlations have in common: six numbers per particle and sample, compared at many lags and
 * averaged over the particles of a species and over time. The table is written when the run ends.
 */
#ifndef OBSERVERS_TRACK_H
#define OBSERVERS_TRACK_H

#include "observers/lags.h"
#include "observers/observers.h"

enum { TRACKED = 6 };

struct track {
    struct observer base;
    const char *file;
    const char *name_ring, *name_taken, *name_sum;              /* in a checkpoint */
    int levels;
    struct lags lags;                                           /* a sample: time, then six numbers per particle */
    double *sample;
    double *sum;                                                /* [row][species][count, six sums] */
    const struct suspension *of;
    const struct destination *to;
    void (*fill)(const struct suspension *s, int i, double value[TRACKED]);
    /* Six products of one particle at two times, F the deformation from the old to the new. */
    void (*compare)(const struct track *t, const mat3 *F, double duration, const double *old, const double *now, double product[TRACKED]);
    void (*write)(const struct track *t, FILE *out);
};

/* "every" and "levels"; the caller fills in the functions and names. */
struct track *track_new(struct settings *s, struct error *e);
/* Mean number k of a row and a species, NaN without samples; number -1: how many samples. */
double track_mean(const struct track *t, int row, int species, int k);
static inline double track_lag(const struct track *t, int row)
{
    return (double)lags_of_row(row) * (double)t->base.every * t->of->dt;
}

#endif
