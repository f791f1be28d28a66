/* Words for kinds of mistake (validation/checks/pair_pattern.h): each kind made by hand over size ratios, gaps and directions. */
#include "checks/dense.h"
#include "checks/pair_pattern.h"
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Which multiple of the expected vector is measured at a size ratio (0.2 to 7) and gap (0.0005 to 0.05). */
typedef double mistake(double ratio, double xi);

static const char *words(mistake *factor, bool turned)
{
    static const double ratio[] = { 1, 0.2, 1.4, 7 }, xi[] = { 0.0005, 0.003, 0.02, 0.05 };
    struct pattern p;
    pattern_start(&p, 1e-10);
    for (int b = 0; b < 4; b++)
        for (int g = 0; g < 4; g++) {
            const double expected[3] = { 1 + b, -2, 0.3 * g }, f = factor(ratio[b], xi[g]);
            const double measured[3] = { f * expected[0] + (turned ? 0.1 : 0), f * expected[1], f * expected[2] };
            pattern_see(&p, measured, expected, 3, 5, ratio[b], xi[g], xi[g] > 0.01 ? "far" : "near", NULL);
        }
    return pattern_words(&p);
}

static double right(double ratio, double xi) { return ratio * xi > 0 ? 1 : 0; }
static double factor(double ratio, double xi) { return right(ratio, xi) * 0.42; }
static double sign(double ratio, double xi) { return -right(ratio, xi); }
static double nothing(double ratio, double xi) { return 0 * ratio * xi; }
static double radius(double ratio, double xi) { return right(ratio, xi) / ratio; }
static double index_of(double ratio, double xi) { return right(ratio, xi) * 0.5 * (1 + ratio); }
static double clamped(double ratio, double xi) { return right(ratio, xi) * (xi < 0.001 ? 1.1 : 1); }
static double outside(double ratio, double xi) { return right(ratio, xi) * (xi > 0.01 ? 1 + xi : 1); }
static double scaled_gap(double ratio, double xi) { return ratio == 1 ? 1 : 1 + 0.1 * ratio * xi; }

static double rounded(double ratio, double xi) { return right(ratio, xi) * (1 + 3e-7); }

static void expect(mistake *made, bool turned, const char *said)
{
    const char *text = words(made, turned);
    check_true(strcmp(text, said) == 0, said);
    if (strcmp(text, said) != 0)
        printf("\n    said: %s\n", text);
}

static void kinds_of_mistake(void)
{
    expect(right, false, "");
    expect(factor, false, "0.42 of expected at every gap and size ratio: a factor");
    expect(rounded, false, "right to 2e-07");
    expect(sign, false, "the opposite sign everywhere");
    expect(nothing, false, "nothing at all: the term is missing");
    expect(radius, false, "0.1429 to 5 of expected, as the power -1 of a_2/a_1: a radius, or a power of one; right for equal radii, so an index, or a size ratio");
    expect(index_of, false, "0.6 to 4 of expected, by size ratio alone; right for equal radii, so an index, or a size ratio");
    expect(clamped, false, "1.1 of expected where it is wrong, only at gaps up to xi = 0.0005: an inner cut-off, only near");
    expect(outside, false, "1.02 to 1.05 of expected, by gap alone, only at gaps from xi = 0.02: an outer cut-off, or how the gap is scaled, only far");
    expect(scaled_gap, false, "1 to 1.035 of expected, by gap and size ratio; right for equal radii, so how the gap is scaled, or a size ratio");
    expect(right, true, "in another direction than expected: a term is missing or added, or a vector is wrong");
}

static void how_far_apart_paths_are(void)
{
    check_true(strstr(dense_path_likely(0.3), "is a force, not a step") != NULL, "a third of a radius");
    check_true(strstr(dense_path_likely(0.002), "a cell that lags one step") != NULL, "rate times edge times dt");
}

static const struct unit_test tests[] = { { "kinds of mistake", kinds_of_mistake }, { "how far apart paths are", how_far_apart_paths_are }, { NULL, NULL } };

const struct suite pattern_suite = { "pattern", tests };
