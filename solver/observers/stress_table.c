/*
 * Stress against time: `stress.csv`, nine components for each origin, and the relative viscosity
 *
 *     eta_r = 1 + sum over origins of (sigma_fg + sigma_gf) / (2 eta rate),     f flow, g gradient axis of the fastest shear
 *
 * in steady flow (in a flow that changes the rate passes through zero; see viscosity.csv),
 * without the kinetic and the instantaneous Brownian parts: the second has zero mean. The solvent's 1 is its own column.
 * Forces are those that acted at the end of the step; the kinetic part uses full-step velocities.
 */
#include "observers/observers.h"

#include "output/stress_columns.h"

#include <stdlib.h>
#include <string.h>

struct stress_table { struct observer base; struct table table; int flow, gradient; double unit; /* eta rate; 0: no viscosity */ };

static bool stress_table_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct stress_table *o = (struct stress_table *)self;
    if (!table_open(&o->table, to, "stress.csv", e))
        return false;
    fprintf(o->table.file, "step,time,strain%s", o->unit != 0.0 ? ",solvent,eta_r" : "");
    stress_write_names(o->table.file, &s->stress);
    return true;
}

static bool stress_table_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct stress_table *o = (struct stress_table *)self;
    FILE *out = o->table.file;
    fprintf(out, "%lld,%.17g,%.17g", (long long)s->step, s->box.time, box_strain(&s->box, s->start_time, s->box.time));
    if (o->unit != 0.0) {
        double sum = 0.0;
        for (int k = 0; k < s->stress.origins; k++)
            if (k != s->kinetic_origin && strcmp(s->stress.name[k], "lubrication_noise") != 0)
                sum += 0.5 * (s->stress.sum[k].m[o->flow][o->gradient] + s->stress.sum[k].m[o->gradient][o->flow]);
        fprintf(out, ",1,%.9g", 1.0 + sum / o->unit);
    }
    stress_write_values(out, &s->stress);
    return table_check(&o->table, e);
}

static void stress_table_remember(struct observer *self, struct fields *f)
{
    table_remember(&((struct stress_table *)self)->table, "stress.csv", f);
}

static bool stress_table_close(struct observer *self, struct error *e)
{
    const bool good = table_close(&((struct stress_table *)self)->table, e);
    free(self);
    return good;
}

/* "stress": { "every": 100 } */
struct observer *stress_table_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct stress_table *o = calloc(1, sizeof *o);
    if (!o)
        return error_out_of_memory(e), NULL;
    o->base = (struct observer){ .measures = true, .open = stress_table_open, .observe = stress_table_observe,
                                 .remember = stress_table_remember, .close = stress_table_close };
    o->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    for (int k = 0; k < 9 && !of->box.flow; k++)
        if (fabs(of->box.gradient.m[k / 3][k % 3]) == of->box.rate && of->box.rate > 0.0) {
            o->flow = k / 3;
            o->gradient = k % 3;
            o->unit = of->viscosity * of->box.gradient.m[k / 3][k % 3];
        }
    return &o->base;
}
