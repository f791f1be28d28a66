/*
 * How far particles come: `displacement.csv`, a row for each lag and species
 *
 *     msd_k  = <dx_k^2>,     dx = x(t + lag) - F x(t)          unwrapped, without what the flow does to the old place [L^2]
 *     turn_k = <dtheta_k^2>, dtheta = integral of (W - Omega_inf) dt over the lag                                      [1]
 *     D      = half the slope of (msd_x + msd_y + msd_z)/3 between this lag and the one before                    [L^2/T]
 *
 * averaged over particles and all times of origin. The centre of mass is not held: drag lets it wander and that is physics.
 * At the end of the file, as comments, for each species
 *
 *     D_short  the largest D: after the ballistic rise, before neighbours get in the way
 *     D_long   half the slope of a straight line through the upper half of the lags, per axis
 *
 * Both also for rotation. D_long means something only where the lags reach beyond the time to move by a radius.
 */
#include "observers/track.h"

#include <stdlib.h>

static void put(double *value, vec3 v) { value[0] = v.x, value[1] = v.y, value[2] = v.z; }
static vec3 get(const double *value) { return vec(value[0], value[1], value[2]); }

static void fill(const struct suspension *s, int i, double value[TRACKED])
{
    const struct particles *p = &s->particles;
    put(value, plus(p->position[i], box_unwrapped(&s->box, p->image[i])));
    put(value + 3, p->turn ? p->turn[i] : vec(0, 0, 0));
}

static void compare(const struct track *t, const mat3 *F, double duration, const double *old, const double *now, double product[TRACKED])
{
    const vec3 dx = minus(get(now), mat3_times(F, get(old)));
    /* Omega_inf over the lag: half the curl of the strain, which in stages is F - I. */
    const vec3 flow = t->of->box.flow ? vec(0.5 * (F->m[2][1] - F->m[1][2]), 0.5 * (F->m[0][2] - F->m[2][0]), 0.5 * (F->m[1][0] - F->m[0][1]))
                                      : scaled(t->of->box.spin, duration);
    const vec3 turn = t->of->particles.turn ? minus(minus(get(now + 3), get(old + 3)), flow) : vec(0, 0, 0);
    put(product, vec(dx.x * dx.x, dx.y * dx.y, dx.z * dx.z));
    put(product + 3, vec(turn.x * turn.x, turn.y * turn.y, turn.z * turn.z));
}

/* The mean over three numbers from `first` on. */
static double over_axes(const struct track *t, int row, int species, int first)
{
    return (track_mean(t, row, species, first) + track_mean(t, row, species, first + 1) + track_mean(t, row, species, first + 2)) /
           (t->of->dimensions == 3 ? 3.0 : first == 0 ? 2.0 : 1.0);
}

static double local_slope(const struct track *t, int row, int species, int first)
{
    return row == 0 ? NAN : 0.5 * (over_axes(t, row, species, first) - over_axes(t, row - 1, species, first)) / (track_lag(t, row) - track_lag(t, row - 1));
}

static double largest_slope(const struct track *t, int rows, int species, int first)
{
    double most = NAN;
    for (int row = 1; row < rows; row++)
        most = fmax(most, local_slope(t, row, species, first));         /* fmax ignores NaN */
    return most;
}

/* Half the least-squares slope of number k against the lag, from half the longest sampled lag on. */
static double late_slope(const struct track *t, int rows, int species, int k)
{
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, longest = 0;
    for (int row = 1; row < rows; row++)
        if (track_mean(t, row, species, -1) > 0.0)
            longest = track_lag(t, row);
    for (int row = 1; row < rows; row++) {
        const double lag = track_lag(t, row), value = track_mean(t, row, species, k);
        if (lag < 0.5 * longest || !isfinite(value))
            continue;
        n++, x += lag, y += value, xx += lag * lag, xy += lag * value;
    }
    return 0.5 * (n * xy - x * y) / (n * xx - x * x);
}

static void write(const struct track *t, FILE *out)
{
    const int rows = lags_rows(&t->lags), first_turn = 3;
    const bool turns = t->of->particles.turn != NULL;
    fprintf(out, "lag,species,samples,msd_x,msd_y,msd_z,D%s\n", turns ? ",turn_x,turn_y,turn_z,D_turn" : "");
    for (int species = 0; species < t->of->particles.species_count; species++)
        for (int row = 1; row < rows; row++) {
            if (!(track_mean(t, row, species, -1) > 0.0))
                continue;
            fprintf(out, "%.17g,%d,%.17g", track_lag(t, row), species + 1, track_mean(t, row, species, -1));
            for (int k = 0; k < 3; k++)
                fprintf(out, ",%.17g", track_mean(t, row, species, k));
            fprintf(out, ",%.17g", local_slope(t, row, species, 0));
            for (int k = first_turn; turns && k < TRACKED; k++)
                fprintf(out, ",%.17g", track_mean(t, row, species, k));
            if (turns)
                fprintf(out, ",%.17g", local_slope(t, row, species, first_turn));
            fputc('\n', out);
        }
    for (int species = 0; species < t->of->particles.species_count; species++) {
        fprintf(out, "# species %d: D_short %.9g D_long %.9g %.9g %.9g", species + 1, largest_slope(t, rows, species, 0),
                late_slope(t, rows, species, 0), late_slope(t, rows, species, 1), late_slope(t, rows, species, 2));
        if (turns)
            fprintf(out, " rotation: D_short %.9g D_long %.9g %.9g %.9g", largest_slope(t, rows, species, first_turn),
                    late_slope(t, rows, species, 3), late_slope(t, rows, species, 4), late_slope(t, rows, species, 5));
        fputc('\n', out);
    }
}

/* "displacement": { "every": 10, "levels": 12 } */
struct observer *displacement_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct track *t = track_new(s, e);
    if (!t)
        return NULL;
    t->file = "displacement.csv";
    t->name_ring = "displacement.ring", t->name_taken = "displacement.taken", t->name_sum = "displacement.sum";
    t->fill = fill;
    t->compare = compare;
    t->write = write;
    if (of->rotates && !of->particles.turn)
        of->particles.turn = calloc((size_t)of->particles.count + 1, sizeof(vec3));
    return &t->base;
}
