/*
 * Layer 6, tables of a run, second part: those of lags (observers.c)
 *
 *     displacement            <dx^2>, D half the slope between lags; D_short, D_long      velocity_correlation   <c c>, and its integral by trapezoids
 */
#include "observers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Mean of a product over the particles of a species and the origins of a lag: all of them to 16 samples, every 2^level-th beyond. */
typedef void product_of(const struct film *f, size_t i, size_t then, size_t now, double out[6]);

static double correlate(const struct film *f, size_t lag, int species, product_of *product, double mean[6])
{
    size_t stride = 1;
    double samples = 0.0, one[6];
    while (lag > 16 * stride)
        stride *= 2;
    memset(mean, 0, 6 * sizeof *mean);
    for (size_t s = 0; s + lag < f->frames; s += stride)
        for (size_t i = 0; i < f->count; i++) {
            if (f->row[i].species != species)
                continue;
            product(f, i, s, s + lag, one);
            samples += 1.0;
            for (int k = 0; k < 6; k++)
                mean[k] += one[k];
        }
    for (int k = 0; k < 6 && samples > 0; k++)
        mean[k] /= samples;
    return samples;
}

static void displaced(const struct film *f, size_t i, size_t then, size_t now, double out[6])
{
    const struct track_point *a = track_at(&f->track, then, i), *b = track_at(&f->track, now, i);
    double S[3][3], carried[3];
    for (int k = 0; k < 9; k++)
        S[k / 3][k % 3] = f->strain[now][k / 3][k % 3] - f->strain[then][k / 3][k % 3];
    apply(S, a->x, carried);
    for (int k = 0; k < 3; k++) {
        out[k] = gsl_pow_2(b->x[k] - a->x[k] - carried[k]);
        out[3 + k] = gsl_pow_2(b->turn[k] - a->turn[k] - 0.5 * (S[(k + 2) % 3][(k + 1) % 3] - S[(k + 1) % 3][(k + 2) % 3]));
    }
}

static void remembered(const struct film *f, size_t i, size_t then, size_t now, double out[6])
{
    double c[2][3], w[2][3];
    film_peculiar(f, then, track_at(&f->track, then, i), c[0], w[0]);
    film_peculiar(f, now, track_at(&f->track, now, i), c[1], w[1]);
    for (int k = 0; k < 3; k++) {
        out[k] = c[0][k] * c[1][k];
        out[3 + k] = w[0][k] * w[1][k];
    }
}

/* What a row says beyond the products: D, half the slope since the row before; or the integral by trapezoids since lag 0. */
static double derived(const struct table *t, size_t r, bool slope, double *integral)
{
    const bool first = r == 0 || table_at(t, r, 1) != table_at(t, r - 1, 1);
    double now = 0.0, before = 0.0;
    for (size_t k = 3; k < 6; k++) {
        now += table_at(t, r, k) / 3.0;
        before += first ? 0.0 : table_at(t, r - 1, k) / 3.0;
    }
    const double step = table_at(t, r, 0) - (first ? 0.0 : table_at(t, r - 1, 0));
    *integral = first ? 0.0 : *integral + 0.5 * (before + now) * step;
    return slope ? 0.5 * (now - before) / step : *integral;
}

static void judge_lags(const struct film *f, const char *file, const char *columns, bool slope, product_of *product)
{
    struct table t;
    struct worst w = WORST_NONE, samples = WORST_NONE, last = WORST_NONE;
    double integral = 0.0, largest = 0.0;
    if (!film_table(f, file, columns, &t))
        return;
    for (size_t r = 0; r < t.rows; r++)
        largest = fmax(largest, fabs(table_at(&t, r, 9)));
    for (size_t r = 0, k = 0; r < t.rows; r++) {           /* species by species all lags: of displacements from the first, of correlations from none */
        k = r > 0 && table_at(&t, r, 1) == table_at(&t, r - 1, 1) ? k + 1 : slope;
        worst_see(&samples, round(table_at(&t, r, 0) / (f->every * f->dt)), (double)lag_of(k), 1.0, r);
    }
    for (size_t r = 0; r < t.rows; r++) {
        worst_see(&last, table_at(&t, r, 9), derived(&t, r, slope, &integral), largest, r);
        double mean[6], scale[2] = { 0 };
        const double number = correlate(f, (size_t)lround(table_at(&t, r, 0) / (f->every * f->dt)), (int)table_at(&t, r, 1), product, mean);
        for (int k = 0; k < 6; k++)
            scale[k / 3] = fmax(scale[k / 3], fabs(mean[k]));
        worst_see(&samples, table_at(&t, r, 2), number, 1.0, r);
        for (size_t k = 0; k < 6; k++)
            worst_see(&w, table_at(&t, r, 3 + k), mean[k], scale[k / 3], r);
    }
    table_free(&t);
    char what[64];
    film_judge(f, file, &w);
    snprintf(what, sizeof what, "%s: samples", file);
    film_judge(f, what, &samples);
    snprintf(what, sizeof what, "%s: %s", file, slope ? "D" : "integral");
    film_judge(f, what, &last);
}

/* The line at the end of displacement.csv: D_short, the largest D of its rows; D_long, half the least-squares slope of each axis over the upper half of the lags. */
static void judge_late_diffusion(const struct film *f)
{
    char path[PATH_LENGTH], line[1024], why[WHY_LENGTH];
    struct table t;
    struct worst w = WORST_NONE, largest = WORST_NONE;
    path_join(path, f->out, "displacement.csv");
    FILE *in = fopen(path, "r");
    if (!in || !table_read(path, "lag,species,msd_x,msd_y,msd_z,D", &t, why)) {
        if (in)
            fclose(in);
        return;
    }
    while (fgets(line, sizeof line, in)) {
        int species;
        double brief, said[3], longest = 0.0, most = -INFINITY;
        if (sscanf(line, "# species %d: D_short %lf D_long %lf %lf %lf", &species, &brief, &said[0], &said[1], &said[2]) != 5)
            continue;
        for (size_t r = 0; r < t.rows; r++)
            if (table_at(&t, r, 1) == species) {
                longest = fmax(longest, table_at(&t, r, 0));
                most = fmax(most, table_at(&t, r, 5));
            }
        worst_see(&largest, brief, most, fabs(most), (size_t)species);
        for (size_t k = 0; k < 3; k++) {
            double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
            for (size_t r = 0; r < t.rows; r++) {
                const double lag = table_at(&t, r, 0) / longest, value = table_at(&t, r, 2 + k);
                if (table_at(&t, r, 1) != species || lag < 0.5)
                    continue;
                n += 1.0, x += lag, y += value, xx += lag * lag, xy += lag * value;
            }
            const double slope = 0.5 * (xy / n - x / n * y / n) / (xx / n - x / n * x / n) / longest;
            worst_see(&w, said[k], slope, fmax(fabs(slope), 0.5 * y / n / longest), (size_t)species);
        }
    }
    fclose(in);
    table_free(&t);
    if (largest.error >= 0.0)
        check_error(f->run, INVARIANT, "displacement.csv: D_short", largest.measured, largest.expected, largest.error, 1e-8, "displacement.csv: D_short of species %zu is "
                    "%s; the largest D of its own rows is that", largest.at, compare(&largest));       /* written with nine digits */
    if (w.error >= 0.0)
        check_error(f->run, INVARIANT, "displacement.csv: D_long", w.measured, w.expected, w.error, 1e-6, "displacement.csv: D_long of species %zu is %s; half the "
                    "slope of its own rows over the upper half of the lags gives that", w.at, compare(&w));
}

void film_judge_lags(const struct film *f)
{
    judge_lags(f, "displacement.csv", "lag,species,samples,msd_x,msd_y,msd_z,turn_x,turn_y,turn_z,D", true, displaced);
    judge_lags(f, "velocity_correlation.csv", "lag,species,samples,c_x,c_y,c_z,w_x,w_y,w_z,integral", false, remembered);
    judge_late_diffusion(f);
}
