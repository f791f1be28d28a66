/*
 * Averages over the run with error bars: `averages.csv`, written at the end, a row for each quantity
 *
 *     quantity,mean,error,samples,discarded,blocks,plateau,settled
 *
 * The begin of each series is discarded by the rule MSER-5 and the error found by blocking: both in blocks.h. `plateau` 0 says that the
 * series is too short for its correlation and the error a lower bound; `settled` 0 that the transient may not be over.
 *
 * Quantities: shear stress by origin and in all (in steady shear of a viscous liquid also eta_r), N1, N2, pressure (plane.h),
 * temperatures of translation and rotation (temperature.c), contact number.
 */
#include "observers/blocks.h"
#include "observers/observers.h"
#include "observers/plane.h"
#include "observers/temperature.h"

#include <stdlib.h>

enum { MOST = MAX_ORIGINS + 8 };

struct averages {
    struct observer base;
    int64_t samples, room;
    int quantities;
    char name[MOST][48];
    double *series;                             /* [sample][quantity] */
    struct plane plane;
    double unit;
    const struct destination *to;
};

/* All quantities of the moment; names too if `o` is to learn them. Returns how many. */
static int quantities_of(struct averages *o, const struct suspension *s, double value[MOST], bool naming)
{
    const mat3 total = stress_total(s);
    double T[3], W[3];
    int n = 0, touching = 0;
    temperatures_of(s, -1, T, W);
    for (int k = 0; k < s->neighbours.near.count; k++)
        touching += s->neighbours.near.pair[k].gap < 0.0;
    for (int k = 0; k < s->stress.origins; k++) {
        if (naming)
            snprintf(o->name[n], sizeof *o->name, "shear_%.40s", s->stress.name[k]);
        value[n++] = shear_in(&o->plane, &s->stress.sum[k]);
    }
    const struct { const char *name; double value; bool there; } rest[] = {
        { "shear", shear_in(&o->plane, &total), true },
        { "eta_r", 1.0 + shear_in(&o->plane, &total) / o->unit, o->unit != 0.0 },
        { "N1", first_difference(&o->plane, &total), true },
        { "N2", second_difference(&o->plane, &total), true },
        { "pressure", pressure_of(&total), true },
        { "T", (T[0] + T[1] + T[2]) / s->dimensions, true },
        { "W", (W[0] + W[1] + W[2]) / (s->dimensions == 2 ? 1.0 : 3.0), s->particles.spin != NULL },
        { "contacts", 2.0 * touching / s->particles.count, true },
    };
    for (size_t k = 0; k < sizeof rest / sizeof *rest; k++) {
        if (!rest[k].there)
            continue;
        if (naming)
            snprintf(o->name[n], sizeof *o->name, "%s", rest[k].name);
        value[n++] = rest[k].value;
    }
    return n;
}

static bool averages_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct averages *o = (struct averages *)self;
    double value[MOST];
    (void)e;
    o->to = to;
    o->quantities = quantities_of(o, s, value, true);
    return true;
}

static bool averages_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct averages *o = (struct averages *)self;
    const size_t width = (size_t)o->quantities;
    if (o->samples >= o->room) {
        o->room = 2 * o->samples + 256;
        double *more = realloc(o->series, (size_t)o->room * width * sizeof *more);
        if (!more)
            return error_out_of_memory(e);
        o->series = more;
    }
    double value[MOST];
    quantities_of(o, s, value, false);
    memcpy(o->series + (size_t)o->samples++ * width, value, width * sizeof *value);
    return true;
}

static bool now_full(void *owner, struct error *e)
{
    struct averages *o = owner;
    (void)e;
    o->room = o->samples;                       /* what was loaded fills its array */
    return true;
}

static void averages_remember(struct observer *self, struct fields *f)
{
    struct averages *o = (struct averages *)self;
    fields_add(f, "averages.samples", &o->samples, sizeof o->samples);
    fields_grown(f, "averages.series", &o->series, (size_t)(o->samples * o->quantities) * sizeof *o->series);
    f->field[f->count - 1].loaded = now_full;
    f->field[f->count - 1].owner = o;
}

static void write(const struct averages *o, FILE *out, double *x)
{
    fputs("quantity,mean,error,samples,discarded,blocks,plateau,settled\n", out);
    for (int q = 0; q < o->quantities; q++) {
        const size_t all = (size_t)o->samples;
        for (size_t k = 0; k < all; k++)
            x[k] = o->series[k * (size_t)o->quantities + (size_t)q];
        const size_t dropped = blocks_transient(x, all);
        const struct block_mean b = blocks_mean(x + dropped, all - dropped);
        fprintf(out, "%s,%.9g,%.3g,%zu,%zu,%zu,%d,%d\n", o->name[q], b.mean, b.error, all, dropped, b.blocks, b.plateau, 2 * dropped + 10 <= all);
    }
}

static bool averages_close(struct observer *self, struct error *e)
{
    struct averages *o = (struct averages *)self;
    struct table table = { .file = NULL };
    double *x = malloc(((size_t)o->samples + 1) * sizeof *x);
    if (!x)
        error_out_of_memory(e);
    else if (o->samples > 0 && table_open_whole(&table, o->to, "averages.csv", e)) {
        write(o, table.file, x);
        table_place(&table, e);
    }
    free(x);
    free(o->series);
    free(o);
    return !error_raised(e);
}

/* "averages": { "every": 100 } */
struct observer *averages_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct averages *o = calloc(1, sizeof *o);
    if (!o)
        return error_out_of_memory(e), NULL;
    o->base = (struct observer){ .measures = true, .reads_pairs = true, .open = averages_open, .observe = averages_observe, .remember = averages_remember,
                                 .close = averages_close };
    o->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    o->plane = plane_of(&of->box);
    o->unit = of->viscosity * o->plane.rate;
    return &o->base;
}
