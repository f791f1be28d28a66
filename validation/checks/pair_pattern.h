/*
 * What kind of mistake it is: from the ratio measured/expected of one quantity over many states, in words. "0.42 of expected at
 * every gap and size ratio: a factor" says where to look; a single worst state does not.
 */
#ifndef PAIR_PATTERN_H
#define PAIR_PATTERN_H

#include "pair.h"

enum { PATTERN_SIZES = 64, PATTERN_GAPS = 64, PATTERN_KINDS = 8 };

/* States seen at one size ratio, gap, or kind, where something is measured or expected; ratios of the wrong ones. */
struct pattern_bin { double key; size_t seen, wrong; double low, high; };

struct pattern {
    struct pattern_bin all, size[PATTERN_SIZES], gap[PATTERN_GAPS], kind[PATTERN_KINDS];
    size_t sizes, gaps, kinds;
    const char *kind_name[PATTERN_KINDS];       /* "with a history", "in a sheared cell"; borrowed */
    double tolerance;
    const char *of_size;                        /* what the size ratio is called: "a_2/a_1" */
    bool scattered;                             /* some wrong vector is not along the expected one: no single ratio */
    size_t nothing, unexpected;                 /* wrong states where nothing is measured, or nothing expected */
    double off;                                 /* largest error over its scale */
};

void pattern_start(struct pattern *p, double tolerance);
/*
 * One state: the vectors, what the error is measured against, a_2/a_1, and the gap xi (NaN: none), and up to two kinds to which
 * it belongs (null: none). Kinds that contain all the wrong states and not all states are told.
 */
void pattern_see(struct pattern *p, const double *measured, const double *expected, int components, double scale, double size_ratio,
                 double xi, const char *kind, const char *kind_too);
/* "1.02 of expected at every gap and size ratio: a factor" in a buffer of its own until the next call; empty if nothing is wrong. */
const char *pattern_words(const struct pattern *p);
/* Whether one number, or one for each size ratio, tells all of it. */
bool pattern_simple(const struct pattern *p);

#endif
