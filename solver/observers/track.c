#include "observers/track.h"

#include <stdlib.h>

static double *sum_of(const struct track *t, int row, int species)
{
    return t->sum + (size_t)(row * t->of->particles.species_count + species) * (TRACKED + 1);
}

double track_mean(const struct track *t, int row, int species, int k)
{
    const double *sum = sum_of(t, row, species);
    return k < 0 ? sum[0] : sum[0] > 0.0 ? sum[1 + k] / sum[0] : NAN;
}

static bool track_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct track *t = (struct track *)self;
    t->of = s;
    t->to = to;
    const int values = 1 + TRACKED * s->particles.count;
    if (!lags_new(&t->lags, t->levels, values, e))
        return false;
    t->sample = calloc((size_t)values, sizeof *t->sample);
    t->sum = calloc((size_t)(lags_rows(&t->lags) * s->particles.species_count * (TRACKED + 1)), sizeof *t->sum);
    return (t->sample && t->sum) || error_out_of_memory(e);
}

static void add_pair(void *owner, int row, const double *old, const double *now)
{
    struct track *t = owner;
    const struct particles *p = &t->of->particles;
    const mat3 F = box_deformation(&t->of->box, old[0], now[0]);
    for (int i = 0; i < p->count; i++) {
        double product[TRACKED], *sum = sum_of(t, row, p->species[i]);
        t->compare(t, &F, now[0] - old[0], old + 1 + TRACKED * i, now + 1 + TRACKED * i, product);
        sum[0] += 1.0;
        for (int k = 0; k < TRACKED; k++)
            sum[1 + k] += product[k];
    }
}

static bool track_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct track *t = (struct track *)self;
    (void)e;
    t->sample[0] = s->box.time;
    for (int i = 0; i < s->particles.count; i++)
        t->fill(s, i, t->sample + 1 + TRACKED * i);
    lags_push(&t->lags, t->sample, add_pair, t);
    return true;
}

static void track_remember(struct observer *self, struct fields *f)
{
    struct track *t = (struct track *)self;
    const size_t rows = (size_t)(lags_rows(&t->lags) * t->of->particles.species_count * (TRACKED + 1));
    fields_add(f, t->name_taken, &t->lags.taken, sizeof t->lags.taken);
    fields_add(f, t->name_ring, t->lags.ring, (size_t)t->levels * LAG_WIDTH * (size_t)t->lags.values * sizeof(double));
    fields_add(f, t->name_sum, t->sum, rows * sizeof(double));
}

static bool track_close(struct observer *self, struct error *e)
{
    struct track *t = (struct track *)self;
    struct table table = { .file = NULL };
    if (t->sum && t->lags.taken > 0 && table_open_whole(&table, t->to, t->file, e)) {
        t->write(t, table.file);
        table_place(&table, e);
    }
    lags_free(&t->lags);
    free(t->sample);
    free(t->sum);
    free(t);
    return !error_raised(e);
}

struct track *track_new(struct settings *s, struct error *e)
{
    struct track *t = calloc(1, sizeof *t);
    if (!t)
        return error_out_of_memory(e), NULL;
    t->base = (struct observer){ .open = track_open, .observe = track_observe, .remember = track_remember, .close = track_close };
    t->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    t->levels = (int)settings_whole(s, "levels", 1, LAG_LEVELS, e);
    return t;
}
