/*
 * Brownian viscosity at rest, from fluctuations: `green_kubo.csv`, a row for each lag
 *
 *     C(lag) = <Sigma_xy(t) Sigma_xy(t + lag)>        and xz, yz, which isotropy makes equal
 *     eta(lag) = V/kT integral from 0 to lag of their mean                                               [M/(L T)]
 *
 * with the structural Brownian stress of the wide shell (brownian.h). Source: Green (1954), Kubo (1957); Li (2026) eq 4.3. The
 * integral is a trapezoid over the lags; take it where it levels off: at the first zero of C or some relaxation times.
 */
#include "observers/brownian.h"
#include "observers/lags.h"
#include "observers/observers.h"

#include <stdlib.h>

enum { PLANES = 3 };

struct green_kubo {
    struct observer base;
    int levels;
    struct lags lags;
    double *sum;                                /* [row][count, three products] */
    const struct suspension *of;
    const struct destination *to;
};

static bool green_kubo_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct green_kubo *o = (struct green_kubo *)self;
    o->of = s;
    o->to = to;
    if (!lags_new(&o->lags, o->levels, PLANES, e))
        return false;
    o->sum = calloc((size_t)(lags_rows(&o->lags) * (PLANES + 1)), sizeof *o->sum);
    return o->sum || error_out_of_memory(e);
}

static void add_pair(void *owner, int row, const double *old, const double *now)
{
    double *sum = ((struct green_kubo *)owner)->sum + row * (PLANES + 1);
    sum[0] += 1.0;
    for (int k = 0; k < PLANES; k++)
        sum[1 + k] += old[k] * now[k];
}

static bool green_kubo_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct green_kubo *o = (struct green_kubo *)self;
    struct snapshot at;
    const bool found = brownian_snapshot(&at, s, e);
    if (found) {
        const mat3 S = brownian_stress_of(&at, s, brownian_wide, brownian_depth(s));
        lags_push(&o->lags, (const double[PLANES]){ S.m[0][1], S.m[0][2], S.m[1][2] }, add_pair, o);
    }
    snapshot_free(&at);
    return found;
}

static void green_kubo_remember(struct observer *self, struct fields *f)
{
    struct green_kubo *o = (struct green_kubo *)self;
    fields_add(f, "green_kubo.taken", &o->lags.taken, sizeof o->lags.taken);
    fields_add(f, "green_kubo.ring", o->lags.ring, (size_t)(o->levels * LAG_WIDTH * PLANES) * sizeof(double));
    fields_add(f, "green_kubo.sum", o->sum, (size_t)(lags_rows(&o->lags) * (PLANES + 1)) * sizeof(double));
}

static void write(const struct green_kubo *o, FILE *out)
{
    double eta = 0.0, before = 0.0, last = 0.0;
    fputs("lag,samples,C_xy,C_xz,C_yz,eta\n", out);
    for (int row = 0; row < lags_rows(&o->lags); row++) {
        const double *sum = o->sum + row * (PLANES + 1), lag = (double)lags_of_row(row) * (double)o->base.every * o->of->dt;
        if (!(sum[0] > 0.0))
            continue;
        const double mean = (sum[1] + sum[2] + sum[3]) / ((o->of->dimensions == 2 ? 1.0 : 3.0) * sum[0]);     /* in a plane only xy */
        if (row > 0)
            eta += o->of->box.volume / o->of->kT * 0.5 * (before + mean) * (lag - last);
        before = mean;
        last = lag;
        fprintf(out, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", lag, sum[0], sum[1] / sum[0], sum[2] / sum[0], sum[3] / sum[0], eta);
    }
}

static bool green_kubo_close(struct observer *self, struct error *e)
{
    struct green_kubo *o = (struct green_kubo *)self;
    struct table table = { .file = NULL };
    if (o->sum && o->lags.taken > 0 && table_open_whole(&table, o->to, "green_kubo.csv", e)) {
        write(o, table.file);
        table_place(&table, e);
    }
    lags_free(&o->lags);
    free(o->sum);
    free(o);
    return !error_raised(e);
}

/* "green_kubo": { "every": 10, "levels": 10 } */
struct observer *green_kubo_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct green_kubo *o = calloc(1, sizeof *o);
    if (!o)
        return error_out_of_memory(e), NULL;
    o->base = (struct observer){ .open = green_kubo_open, .observe = green_kubo_observe, .remember = green_kubo_remember, .close = green_kubo_close };
    o->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    o->levels = (int)settings_whole(s, "levels", 1, LAG_LEVELS, e);
    if (!error_raised(e) && (of->box.flowing || !(of->kT > 0.0)))
        settings_refuse(s, "", e, "needs a scene at rest with fluid.kT above 0");
    return &o->base;
}
