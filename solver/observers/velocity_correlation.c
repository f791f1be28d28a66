/*
 * How long velocities last: `velocity_correlation.csv`, a row for each lag and species
 *
 *     c_k = <c_k(t) c_k(t + lag)>,   w_k = <w_k(t) w_k(t + lag)>,   c = U - U_inf(x),   w = W - Omega_inf       [L^2/T^2, 1/T^2]
 *
 * averaged over particles and all times of origin. `integral` is the trapezoid of (c_x + c_y + c_z)/3 up to the lag: D by Green
 * and Kubo, if the samples are close enough to see the decay.
 */
#include "observers/track.h"

static void fill(const struct suspension *s, int i, double value[TRACKED])
{
    const struct particles *p = &s->particles;
    const vec3 c = minus(p->velocity[i], box_flow(&s->box, p->position[i]));
    const vec3 w = p->spin ? minus(p->spin[i], s->box.spin) : vec(0, 0, 0);
    value[0] = c.x, value[1] = c.y, value[2] = c.z, value[3] = w.x, value[4] = w.y, value[5] = w.z;
}

static void compare(const struct track *t, const mat3 *F, double duration, const double *old, const double *now, double product[TRACKED])
{
    (void)t, (void)F, (void)duration;
    for (int k = 0; k < TRACKED; k++)
        product[k] = old[k] * now[k];
}

static void write(const struct track *t, FILE *out)
{
    const int rows = lags_rows(&t->lags);
    const bool spins = t->of->particles.spin != NULL;
    fprintf(out, "lag,species,samples,c_x,c_y,c_z%s,integral\n", spins ? ",w_x,w_y,w_z" : "");
    for (int species = 0; species < t->of->particles.species_count; species++) {
        double integral = 0.0, before = 0.0;
        for (int row = 0; row < rows; row++) {
            double mean = 0.0;
            if (!(track_mean(t, row, species, -1) > 0.0))
                continue;
            fprintf(out, "%.17g,%d,%.17g", track_lag(t, row), species + 1, track_mean(t, row, species, -1));
            for (int k = 0; k < (spins ? TRACKED : 3); k++)
                fprintf(out, ",%.17g", track_mean(t, row, species, k));
            for (int k = 0; k < 3; k++)
                mean += track_mean(t, row, species, k) / t->of->dimensions;
            if (row > 0)
                integral += 0.5 * (before + mean) * (track_lag(t, row) - track_lag(t, row - 1));
            before = mean;
            fprintf(out, ",%.17g\n", integral);
        }
    }
}

/* "velocity_correlation": { "every": 1, "levels": 8 } */
struct observer *velocity_correlation_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct track *t = track_new(s, e);
    (void)of;
    if (!t)
        return NULL;
    t->file = "velocity_correlation.csv";
    t->name_ring = "velocities.ring", t->name_taken = "velocities.taken", t->name_sum = "velocities.sum";
    t->fill = fill;
    t->compare = compare;
    t->write = write;
    return &t->base;
}
