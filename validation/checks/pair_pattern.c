/* Recognising kinds of mistake from ratios (pair_pattern.h). */
#include "pair_pattern.h"

#include <stdio.h>
#include <string.h>

enum { TEXT = 400 };
static const double same = 1e-5;        /* ratios that differ less are one ratio: far above rounding, far below any mistake */

void pattern_start(struct pattern *p, double tolerance)
{
    *p = (struct pattern){ .all = { .low = INFINITY, .high = -INFINITY }, .tolerance = tolerance, .of_size = "a_2/a_1" };
}

static struct pattern_bin *bin_of(struct pattern_bin *bin, size_t *count, size_t room, double key)
{
    for (size_t k = 0; k < *count; k++)
        if (fabs(bin[k].key - key) <= 1e-9 * fabs(key))
            return &bin[k];
    if (*count == room)
        return &bin[room - 1];
    bin[*count] = (struct pattern_bin){ .key = key, .low = INFINITY, .high = -INFINITY };
    return &bin[(*count)++];
}

static struct pattern_bin *kind_of(struct pattern *p, const char *name)
{
    size_t k = 0;
    while (k < p->kinds && strcmp(p->kind_name[k], name) != 0)
        k++;
    if (k == p->kinds) {
        if (k == PATTERN_KINDS)
            return &p->kind[PATTERN_KINDS - 1];
        p->kind_name[p->kinds] = name;
        p->kind[p->kinds++] = (struct pattern_bin){ .low = INFINITY, .high = -INFINITY };
    }
    return &p->kind[k];
}

static void put(struct pattern_bin *bin, bool wrong, double ratio)
{
    bin->seen++;
    bin->wrong += wrong;
    if (!wrong || isnan(ratio))
        return;
    bin->low = fmin(bin->low, ratio);
    bin->high = fmax(bin->high, ratio);
}

void pattern_see(struct pattern *p, const double *measured, const double *expected, int components, double scale, double size_ratio,
                 double xi, const char *kind, const char *kind_too)
{
    double both = 0, own = 0, squared = 0, off = 0, beside = 0;
    for (int k = 0; k < components; k++) {
        both += measured[k] * expected[k];
        own += measured[k] * measured[k];
        squared += expected[k] * expected[k];
        off = fmax(off, fabs(measured[k] - expected[k]));
    }
    const bool wrong = !(off <= p->tolerance * scale);
    const double ratio = sqrt(squared) > 1e-3 * scale ? both / squared : NAN;    /* else rounding, or nothing, is expected */
    if (isnan(ratio) && !wrong)
        return;                             /* nothing expected, nothing there: that tells nothing */
    for (int k = 0; k < components; k++)
        beside = fmax(beside, fabs(measured[k] - (isnan(ratio) ? 0 : ratio) * expected[k]));
    if (wrong && squared == 0)
        p->unexpected++;
    else if (wrong && own == 0)
        p->nothing++;
    if (wrong && !isnan(ratio) && beside > fmax(p->tolerance * scale, same * sqrt(own)))
        p->scattered = true;
    p->off = fmax(p->off, off / scale);
    put(&p->all, wrong, ratio);
    put(bin_of(p->size, &p->sizes, PATTERN_SIZES, size_ratio), wrong, ratio);
    if (!isnan(xi))
        put(bin_of(p->gap, &p->gaps, PATTERN_GAPS, xi), wrong, ratio);
    if (kind)
        put(kind_of(p, kind), wrong, ratio);
    if (kind_too)
        put(kind_of(p, kind_too), wrong, ratio);
}

/* Whether within each bin there is but one ratio. */
static bool fixed_within(const struct pattern_bin *bin, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (bin[k].high - bin[k].low > same * (fabs(bin[k].high) + fabs(bin[k].low)))
            return false;
    return true;
}

/* The power of the key with which the ratio grows, from bins of one ratio each; NaN if it is no power. */
static double power_of(const struct pattern_bin *bin, size_t count)
{
    double power = NAN, at_one = 1;
    for (size_t k = 0; k < count; k++)
        if (fabs(bin[k].key - 1) < 1e-9 && isfinite(bin[k].low))
            at_one = bin[k].low;
    for (size_t k = 0; k < count; k++) {
        if (!isfinite(bin[k].low) || fabs(bin[k].key - 1) < 1e-9)
            continue;
        const double here = log(bin[k].low / at_one) / log(bin[k].key);
        if (isnan(here) || (!isnan(power) && fabs(here - power) > 1e-4))
            return NAN;
        power = here;
    }
    return power;
}

static bool right_for_equal(const struct pattern *p)
{
    bool equal = false, wrong_elsewhere = false;
    for (size_t k = 0; k < p->sizes; k++)
        if (fabs(p->size[k].key - 1) < 1e-9) {
            equal = p->size[k].wrong == 0;
        } else
            wrong_elsewhere = wrong_elsewhere || p->size[k].wrong > 0;
    return equal && wrong_elsewhere;
}

/* ", only at gaps up to xi = 0.003" where a threshold divides wrong from right, and what that means beyond touch; else empty. */
static void gaps_wrong(const struct pattern *p, char text[TEXT])
{
    double wrong_low = INFINITY, wrong_high = -INFINITY, right_low = INFINITY, right_high = -INFINITY;
    for (size_t k = 0; k < p->gaps; k++)
        if (p->gap[k].wrong) {
            wrong_low = fmin(wrong_low, p->gap[k].key);
            wrong_high = fmax(wrong_high, p->gap[k].key);
        } else {
            right_low = fmin(right_low, p->gap[k].key);
            right_high = fmax(right_high, p->gap[k].key);
        }
    text[0] = '\0';
    if (!isfinite(right_low) || !isfinite(wrong_low))
        return;
    if (wrong_high < right_low)
        snprintf(text, TEXT, ", only at gaps up to xi = %g%s", wrong_high, wrong_high > 0 ? ": an inner cut-off" : "");
    else if (wrong_low > right_high)
        snprintf(text, TEXT, ", only at gaps from xi = %g%s", wrong_low,
                 right_high > 0 ? ": an outer cut-off, or how the gap is scaled" : "");
    else if (right_low < wrong_low && wrong_high < right_high && p->gaps > 4)
        snprintf(text, TEXT, ", only at gaps from xi = %g to %g", wrong_low, wrong_high);
}

/* ", only in a sheared cell": a kind that has all of the wrong states, while others were seen. */
static void kinds_wrong(const struct pattern *p, char text[TEXT])
{
    size_t best = PATTERN_KINDS;
    for (size_t k = 0; k < p->kinds; k++)
        if (p->kind[k].wrong == p->all.wrong && p->kind[k].seen < p->all.seen
            && (best == PATTERN_KINDS || p->kind[k].seen < p->kind[best].seen))
            best = k;
    text[0] = '\0';
    if (best < PATTERN_KINDS)
        snprintf(text, TEXT, ", only %s", p->kind_name[best]);
}

/* The size of the mistake, and its likely kind unless `limited` to some gaps, which says more. */
static void how_much(const struct pattern *p, bool limited, char text[TEXT])
{
    const double low = p->all.low, high = p->all.high;
    const bool one = high - low <= same * (fabs(low) + fabs(high));
    const bool everywhere = p->all.wrong == p->all.seen, by_size = fixed_within(p->size, p->sizes);
    const double power = by_size ? power_of(p->size, p->sizes) : NAN;
    char equal[64] = "";
    for (size_t k = 0; k < p->sizes; k++)
        if (fabs(p->size[k].key - 1) < 1e-9 && p->size[k].wrong)
            snprintf(equal, sizeof equal, " (%.4g for equal radii)", p->size[k].low);
    if (p->off < FEW_DIGITS)
        snprintf(text, TEXT, "right to %.1g", p->off);
    else if (p->nothing == p->all.wrong)
        snprintf(text, TEXT, "nothing%s", everywhere ? " at all: the term is missing" : " where it is wrong: the term is missing there");
    else if (p->unexpected == p->all.wrong)
        snprintf(text, TEXT, "something where nothing is expected");
    else if (p->scattered || !isfinite(low))
        snprintf(text, TEXT, "in another direction than expected: a term is missing or added, or a vector is wrong");
    else if (one && fabs(low + 1) < same)
        snprintf(text, TEXT, "the opposite sign%s", everywhere ? " everywhere" : "");
    else if (one)
        snprintf(text, TEXT, "%.6g of expected%s%s", low, everywhere ? " at every gap and size ratio" : " where it is wrong",
                 limited ? "" : ": a factor");
    else if (!isnan(power))
        snprintf(text, TEXT, "%.4g to %.4g of expected, as the power %.3g of %s: a radius, or a power of one", low, high, power, p->of_size);
    else if (by_size)
        snprintf(text, TEXT, "%.4g to %.4g of expected, by size ratio alone%s", low, high, equal);
    else if (p->gaps > 1 && fixed_within(p->gap, p->gaps))
        snprintf(text, TEXT, "%.4g to %.4g of expected, by gap alone%s", low, high, limited ? "" : ": the dependence on the gap");
    else
        snprintf(text, TEXT, "%.4g to %.4g of expected%s", low, high, right_for_equal(p) ? ", by gap and size ratio" : "");
}

const char *pattern_words(const struct pattern *p)
{
    static char text[4 * TEXT];
    char much[TEXT], gaps[TEXT], kinds[TEXT];
    if (p->all.wrong == 0)
        return "";
    gaps_wrong(p, gaps);
    how_much(p, gaps[0] != '\0', much);
    kinds_wrong(p, kinds);
    snprintf(text, sizeof text, "%s%s%s%s", much, gaps, kinds,
             !right_for_equal(p)                 ? ""
             : fixed_within(p->size, p->sizes)   ? "; right for equal radii, so an index, or a size ratio"
                                                 : "; right for equal radii, so how the gap is scaled, or a size ratio");
    return text;
}

bool pattern_simple(const struct pattern *p)
{
    return p->all.wrong > 0 && !p->scattered && p->unexpected == 0 && isfinite(p->all.low) && fixed_within(p->size, p->sizes);
}
