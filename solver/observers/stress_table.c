/*
 * Stress against time: `stress.csv`, nine components for each origin, and the relative viscosity
 *
 *     eta_r = 1 + sum over origins of (sigma_fg + sigma_gf) / (2 eta rate)
 *
 * in steady flow (in a flow that changes the rate passes through zero; see viscosity.csv). Axes and what the sum leaves out:
 * plane.h. The solvent's 1 is its own column.
 * Forces are those that acted at the end of the step; the kinetic part uses full-step velocities.
 */
#include "observers/observers.h"

#include "observers/plane.h"
#include "output/stress_columns.h"

#include <stdlib.h>

struct stress_table { struct observer base; struct table table; struct plane plane; double unit; /* eta rate; 0: no viscosity */ };

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
        const mat3 total = stress_total(s);
        fprintf(out, ",1,%.9g", 1.0 + shear_in(&o->plane, &total) / o->unit);
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
    o->plane = plane_of(&of->box);
    o->unit = of->viscosity * o->plane.rate;
    return &o->base;
}
