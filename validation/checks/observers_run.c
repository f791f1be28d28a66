/*
 * Layer 6, tables of a run, third part: pairs, stresses, averages (observers.c)
 *
 *     pair_distribution       g, U = -kT ln g; g in the plane of shear     green_kubo             V/kT times the integral of <S S>
 *     stress                  strain, eta_r                                averages               means beyond the transient, errors by blocking
 */
#include "observers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- pairs --- */

void film_judge_distribution(const struct film *f)
{
    struct table t;
    struct worst counts = WORST_NONE, g = WORST_NONE, U = WORST_NONE;
    double of[4] = { 0 };
    if (!film_table(f, "pair_distribution.csv", "kind$,species_a,species_b,low,high,count,g,U$", &t))
        return;
    for (size_t i = 0; i < f->count; i++)
        of[f->row[i].species - 1] += 1.0;
    size_t each[4][4] = { { 0 } };
    for (size_t r = 0; r < t.rows; r++) {
        const double one = table_at(&t, r, 1), two = table_at(&t, r, 2);
        if (one < 1 || two < 1 || one > (double)f->m.species || two > (double)f->m.species || one != floor(one) || two != floor(two)) {
            check_garbage(f->run, "pair_distribution.csv: a species is none of the scene's");
            table_free(&t);
            return;
        }
        each[(int)fmin(one, two) - 1][(int)fmax(one, two) - 1]++;
    }
    for (size_t a = 0; a < f->m.species; a++)
        for (size_t b = a; b < f->m.species; b++)
            worst_see(&counts, (double)each[a][b], (double)each[0][0], 1.0, 0);      /* as many bins for each pair of species */
    for (size_t r = 0; r < t.rows; r++) {
        const int a = (int)table_at(&t, r, 1), b = (int)table_at(&t, r, 2);
        const bool near = strcmp(table_word(&t, r, 0), "near") == 0;
        const double low = table_at(&t, r, 3), high = table_at(&t, r, 4), touch = near ? f->m.radius[a - 1] + f->m.radius[b - 1] : 0.0;
        double found = 0.0;
        for (size_t s = 0; s < f->frames; s++)
            for (size_t k = 0; k < f->nears[s]; k++) {
                const struct near_pair *p = &f->near[s][k];
                const int one = f->row[p->i].species, two = f->row[p->j].species;
                const double at = near ? p->gap : p->distance;
                found += !p->own && ((one == a && two == b) || (one == b && two == a)) && at >= low && at < high;
            }
        const double pairs = a == b ? 0.5 * of[a - 1] * (of[a - 1] - 1.0) : of[a - 1] * of[b - 1];
        const double ideal = pairs / f->m.volume * 4.0 / 3.0 * M_PI * (gsl_pow_3(touch + high) - gsl_pow_3(touch + low)) * (double)f->frames;
        worst_see(&counts, table_at(&t, r, 5), found, 1.0, r);
        worst_see(&g, table_at(&t, r, 6), ideal > 0.0 ? found / ideal : 0.0, fmax(ideal > 0.0 ? found / ideal : 0.0, 1.0), r);
        if (found > 0.0)
            worst_see(&U, strtod(table_word(&t, r, 7), NULL), -f->kT * log(found / ideal), f->kT, r);
    }
    table_free(&t);
    film_judge(f, "pair_distribution.csv: counts", &counts);
    check_error(f->run, INVARIANT, "pair_distribution.csv: g", g.measured, g.expected, g.error, 1e-8, "row %zu: g is %s; the pairs found over those of an "
                "ideal gas in that shell give that", g.at + 1, compare(&g));      /* written with nine digits */
    check_error(f->run, INVARIANT, "pair_distribution.csv: U", U.measured, U.expected, U.error, 1e-7, "row %zu: U is %s; -kT ln g gives that", U.at + 1, compare(&U));
}

/* Both ends of each pair within the slab around the plane of shear. */
void film_judge_plane(const struct film *f)
{
    struct table t;
    struct worst counts = WORST_NONE, g = WORST_NONE;
    const json_t *p = f->run->gate_case->parameters;
    const double range = scene_number(p, "tables.pair_distribution.plane.range", NAN), slab = scene_number(p, "tables.pair_distribution.plane.half_width", NAN);
    const double bins = scene_number(p, "tables.pair_distribution.plane.bins", NAN), width = 2.0 * range / bins, N = (double)f->count;
    if (!film_table(f, "pair_plane.csv", "r_flow,r_gradient,count,g", &t))
        return;
    double *found = calloc(t.rows + 1, sizeof *found);
    for (size_t s = 0; s < f->frames; s++)
        for (size_t k = 0; k < f->nears[s]; k++)
            for (int end = -1; end <= 1; end += 2) {
                const struct near_pair *pair = &f->near[s][k];
                const double r = end * pair->distance, column = floor((r * pair->n[f->axis[0]] + range) / width), row = floor((r * pair->n[f->axis[1]] + range) / width);
                const size_t at = (size_t)(row * bins + column);
                if (!pair->own && fabs(r * pair->n[f->axis[2]]) < slab && column >= 0 && column < bins && row >= 0 && row < bins && at < t.rows)
                    found[at] += 1.0;
            }
    const double ideal = N * (N - 1.0) / f->m.volume * width * width * 2.0 * slab * (double)f->frames;
    for (size_t r = 0; r < t.rows; r++) {
        const size_t row = r / (size_t)bins, column = r % (size_t)bins;
        worst_see(&counts, table_at(&t, r, 2), found[r], 1.0, r);
        worst_see(&g, table_at(&t, r, 3), found[r] / ideal, fmax(1.0, found[r] / ideal), r);
        worst_see(&g, table_at(&t, r, 0), ((double)column + 0.5) * width - range, range, r);
        worst_see(&g, table_at(&t, r, 1), ((double)row + 0.5) * width - range, range, r);
    }
    free(found);
    table_free(&t);
    film_judge(f, "pair_plane.csv: counts", &counts);
    check_error(f->run, INVARIANT, "pair_plane.csv: g", g.measured, g.expected, g.error, 1e-8, "row %zu: the bin or its g is %s; the pairs found over those of an "
                "ideal gas in the slab give that", g.at + 1, compare(&g));
}

/* --- stresses --- */

/* The sum over origins without the kinetic and the noise part, as stress.csv gives them: ff, gg, vv, fg, gf of each of its rows. Null: no table. */
static double (*total_stress(const struct film *f, size_t *rows))[5]
{
    const char *parts[FILM_PARTS];
    const int count = film_parts(f, parts);
    double (*S)[5] = NULL;
    for (int k = 0; k < count; k++) {
        struct table t;
        char columns[400];
        film_stress_columns(f, parts[k], columns);
        if (!film_table(f, "stress.csv", columns, &t)) {
            free(S);
            return NULL;
        }
        S = S ? S : calloc(t.rows + 1, sizeof *S);
        *rows = t.rows;
        for (size_t r = 0; r < t.rows; r++)
            for (size_t c = 0; c < 5; c++)
                S[r][c] += table_at(&t, r, c);
        table_free(&t);
    }
    return S;
}

void film_judge_stress_table(const struct film *f)
{
    struct table t;
    struct worst strain = WORST_NONE, eta = WORST_NONE;
    size_t rows = 0;
    const double rate = film_rate(f), unit = f->m.viscosity * rate;
    double (*S)[5] = rate != 0.0 && f->m.has_lubrication ? total_stress(f, &rows) : NULL;       /* without it not all columns are there */
    if (S && film_table(f, "stress.csv", "step,time,strain,eta_r", &t)) {
        for (size_t r = 0; r < rows && r < t.rows; r++) {
            worst_see(&strain, table_at(&t, r, 2), fabs(rate) * (table_at(&t, r, 1) - f->begin), 1.0, r);
            const double expected = 1.0 + 0.5 * (S[r][3] + S[r][4]) / unit;
            worst_see(&eta, table_at(&t, r, 3), expected, fmax(1.0, fabs(expected)), r);      /* nine digits are written */
        }
        table_free(&t);
        film_judge(f, "stress.csv: strain", &strain);
        check_error(f->run, INVARIANT, "stress.csv: eta_r", eta.measured, eta.expected, eta.error, 1e-7, "row %zu: eta_r is %s; 1 and the parts without the kinetic "
                    "and the Brownian ones give that", eta.at + 1, compare(&eta));
    }
    strain = (struct worst)WORST_NONE;
    if (S && film_table(f, "viscosity.csv", "step,time,strain,rate", &t)) {
        for (size_t r = 0; r < t.rows; r++) {
            worst_see(&strain, table_at(&t, r, 2), fabs(rate) * (table_at(&t, r, 1) - f->begin), 1.0, r);
            worst_see(&strain, table_at(&t, r, 3), rate, fabs(rate), r);
        }
        table_free(&t);
        film_judge(f, "viscosity.csv: strain and rate", &strain);
    }
    free(S);
}

/* At rest: correlations of the structural stress, and V/kT times the integral of their mean. */
void film_judge_green_kubo(const struct film *f)
{
    struct table t;
    struct worst C = WORST_NONE, eta = WORST_NONE;
    double scale = 0.0, integral = 0.0;
    if (!film_table(f, "green_kubo.csv", "lag,samples,C_xy,C_xz,C_yz,eta", &t))
        return;
    double (*S)[6] = calloc(f->frames, sizeof *S);
    for (size_t s = 0; s < f->frames; s++)
        film_structure(f, s, 0.05, film_depth(f), S[s]);
    for (size_t r = 0; r < t.rows; r++) {
        const size_t lag = (size_t)lround(table_at(&t, r, 0) / (f->every * f->dt));
        size_t stride = 1;
        double mean[3] = { 0 }, samples = 0.0;
        while (lag > 16 * stride)
            stride *= 2;
        for (size_t s = 0; s + lag < f->frames; s += stride, samples += 1.0)
            for (int k = 0; k < 3; k++)
                mean[k] += S[s][3 + k] * S[s + lag][3 + k];
        for (int k = 0; k < 3; k++)
            scale = fmax(scale, fabs(mean[k] / samples));
        for (size_t k = 0; k < 3; k++)
            worst_see(&C, table_at(&t, r, 2 + k), mean[k] / samples, scale, r);
        worst_see(&C, table_at(&t, r, 1), samples, 1.0, r);
        for (size_t k = 2; k < 5 && r > 0; k++)
            integral += f->m.volume / f->kT * 0.5 * (table_at(&t, r, k) + table_at(&t, r - 1, k)) / 3.0 * (table_at(&t, r, 0) - table_at(&t, r - 1, 0));
        worst_see(&eta, table_at(&t, r, 5), integral, fmax(fabs(integral), 1e-300), r);
    }
    free(S);
    table_free(&t);
    film_judge(f, "green_kubo.csv: correlations", &C);
    film_judge(f, "green_kubo.csv: viscosity", &eta);
}

/* --- averages --- */

/* Samples to be dropped by MSER-5: of means over five, the first d that make sum (y - mean)^2/(n - d)^2 smallest, at most half of them. */
static size_t transient(const double *x, size_t count)
{
    const size_t batches = count / 5;
    double least = INFINITY;
    size_t best = 0;
    for (size_t d = 0; d <= batches / 2; d++) {
        double mean = 0.0, squares = 0.0;
        const double n = (double)(batches - d);
        for (size_t k = 5 * d; k < 5 * batches; k++)
            mean += x[k] / (5.0 * n);
        for (size_t b = d; b < batches; b++)
            squares += gsl_pow_2((x[5 * b] + x[5 * b + 1] + x[5 * b + 2] + x[5 * b + 3] + x[5 * b + 4]) / 5.0 - mean);
        if (squares / (n * n) < least * (1.0 - 1e-9)) {
            least = squares / (n * n);
            best = d;
        }
    }
    return 5 * best;
}

/* Flyvbjerg & Petersen: pairwise means until the error no longer rises by more than its uncertainty, with 20 blocks or more; else the largest with 8. */
static double blocked_error(double *x, size_t count)
{
    double largest = 0.0, before = NAN, mean = 0.0;
    for (size_t k = 0; k < count; k++)
        mean += x[k] / (double)count;
    for (size_t m = count; m >= 8; m /= 2) {
        double squares = 0.0;
        for (size_t k = 0; k < m; k++)
            squares += gsl_pow_2(x[k] - mean);
        const double error = sqrt(squares / ((double)m * ((double)m - 1.0)));
        if (m >= 20 && error <= before + error / sqrt(2.0 * ((double)m - 1.0)))
            return fmax(error, before);
        largest = fmax(largest, error);
        before = error;
        for (size_t k = 0; k < m / 2; k++)
            x[k] = 0.5 * (x[2 * k] + x[2 * k + 1]);
    }
    return largest;
}

/* The quantity of this name at each frame, and the size of the terms that it is a sum of; false: not one that is computed here. */
static bool series_of(const struct film *f, const char *name, double (*S)[5], double *x, double *size)
{
    static const char *const names[] = { "shear", "eta_r", "N1", "N2", "pressure", "T", "W", "contacts" };
    int which = 0;
    while (which < 8 && strcmp(name, names[which]) != 0)
        which++;
    for (size_t s = 0; s < f->frames && which < 8; s++) {
        double T[6], touching = 0.0;
        const double shear = 0.5 * (S[s][3] + S[s][4]);
        film_temperatures(f, s, 0, T);
        for (size_t k = 0; k < f->nears[s]; k++)
            touching += f->near[s][k].gap < 0.0 && !f->near[s][k].told;
        const double value[8] = { shear, 1.0 + shear / (f->m.viscosity * film_rate(f)), S[s][0] - S[s][1], S[s][1] - S[s][2],
                                  -(S[s][0] + S[s][1] + S[s][2]) / 3.0, (T[0] + T[1] + T[2]) / 3.0, (T[3] + T[4] + T[5]) / 3.0, 2.0 * touching / (double)f->count };
        x[s] = value[which];
        for (int k = 0; k < 5 && which < 5; k++)
            *size = fmax(*size, fabs(S[s][k]) / (which == 1 ? fabs(f->m.viscosity * film_rate(f)) : 1.0));
    }
    return which < 8;
}

/* The same for the shear stress of one origin, "shear_<origin>"; false: not that, or not as many rows as frames. */
static bool series_of_origin(const struct film *f, const char *name, double *x, double *size)
{
    char columns[400];
    struct table t;
    if (strncmp(name, "shear_", 6) != 0)
        return false;
    film_stress_columns(f, name + 6, columns);
    if (!film_table(f, "stress.csv", columns, &t))
        return false;
    const bool whole = t.rows == f->frames;
    for (size_t s = 0; s < f->frames && whole; s++) {
        x[s] = 0.5 * (table_at(&t, s, 3) + table_at(&t, s, 4));
        for (size_t k = 0; k < 5; k++)
            *size = fmax(*size, fabs(table_at(&t, s, k)));
    }
    table_free(&t);
    return whole;
}

void film_judge_averages(const struct film *f)
{
    struct table t;
    struct worst means = WORST_NONE, errors = WORST_NONE, dropped = WORST_NONE;
    size_t rows = 0;
    if (!film_table(f, "averages.csv", "quantity$,mean,error,samples,discarded", &t))
        return;
    static const char *const due[] = { "shear", "N1", "N2", "pressure", "T", "W", "contacts" };
    for (size_t k = 0; k < sizeof due / sizeof *due; k++) {
        size_t found = 0;
        for (size_t r = 0; r < t.rows; r++)
            found += strcmp(table_word(&t, r, 0), due[k]) == 0;
        worst_see(&dropped, (double)found, 1.0, 1.0, k);                /* each is there once */
    }
    for (size_t r = 0; r < t.rows; r++)
        worst_see(&dropped, table_at(&t, r, 3), (double)f->frames, 1.0, r);
    double (*S)[5] = total_stress(f, &rows), *x = calloc(f->frames, sizeof *x);
    for (size_t r = 0; r < t.rows && S && rows == f->frames; r++) {
        double terms = 0.0;
        if (!series_of(f, table_word(&t, r, 0), S, x, &terms) && !series_of_origin(f, table_word(&t, r, 0), x, &terms))
            continue;
        const size_t first = transient(x, f->frames);
        double low = x[first], high = x[first];
        for (size_t s = 0; s < f->frames; s++) {
            terms = fmax(terms, fabs(x[s]));
            low = s < first ? low : fmin(low, x[s]);
            high = s < first ? high : fmax(high, x[s]);
        }
        if (high - low < 1e-9 * terms)
            continue;                       /* the same each time, or terms that cancel: what is left is rounding, which has neither begin nor error bar */
        double mean = 0.0, size = 0.0;
        for (size_t s = first; s < f->frames; s++) {
            mean += x[s] / (double)(f->frames - first);
            size += fabs(x[s]) / (double)(f->frames - first);
        }
        const double error = blocked_error(x + first, f->frames - first);
        worst_see(&dropped, table_at(&t, r, 4), (double)first, 1.0, r);
        worst_see(&means, table_at(&t, r, 1), mean, size, r);
        worst_see(&errors, table_at(&t, r, 2), error, error, r);
    }
    free(S);
    free(x);
    table_free(&t);
    film_judge(f, "averages.csv: samples dropped", &dropped);
    check_error(f->run, INVARIANT, "averages.csv: means", means.measured, means.expected, means.error, 1e-7, "row %zu: the mean is %s; the frames beyond the "
                "transient give that", means.at + 1, compare(&means));
    check_error(f->run, INVARIANT, "averages.csv: errors", errors.measured, errors.expected, errors.error, 6e-3, "row %zu: the error is %s; blocking of the frames "
                "gives that", errors.at + 1, compare(&errors));          /* written with three digits */
}

