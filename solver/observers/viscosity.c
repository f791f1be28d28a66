/*
 * Rheology against time: `viscosity.csv`, one column for each origin of stress, their sum, and the normal stresses.
 *
 *     eta_<origin> = shear_<origin> / (eta rate)       relative, in steady shear of a viscous liquid
 *     eta_r = 1 + sum over origins of eta_<origin>     the 1 of the solvent is its own column
 *     N1, N2, pressure                                 of the sum over origins [M/(L T^2)]
 *
 * Axes and what the sum leaves out: plane.h. Where the rate changes with time, or at rest, the stresses shear_<origin> themselves
 * stand in place of viscosities, for a rate passes through zero and a viscosity does not survive that.
 */
#include "observers/plane.h"
#include "observers/rows.h"

struct viscosity { struct rows rows; struct plane plane; double unit; /* eta rate; 0: stresses are printed */ };

static bool viscosity_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct viscosity *o = (struct viscosity *)self;
    if (!rows_open(&o->rows, to, 0, e))
        return false;
    fprintf(o->rows.table.file, "step,time,strain,rate%s", o->unit != 0.0 ? ",solvent" : "");
    for (int k = 0; k < s->stress.origins; k++)
        fprintf(o->rows.table.file, ",%s_%s", o->unit != 0.0 ? "eta" : "shear", s->stress.name[k]);
    fprintf(o->rows.table.file, ",%s,N1,N2,pressure\n", o->unit != 0.0 ? "eta_r" : "shear");
    return true;
}

static bool viscosity_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct viscosity *o = (struct viscosity *)self;
    const struct plane *p = &o->plane;
    const double unit = o->unit != 0.0 ? o->unit : 1.0, solvent = o->unit != 0.0 ? 1.0 : 0.0;
    const mat3 total = stress_total(s);
    FILE *out = rows_begin(&o->rows, s);
    fprintf(out, ",%.17g,%.17g%s", box_strain(&s->box, s->start_time, s->box.time), s->box.gradient.m[p->flow][p->gradient], o->unit != 0.0 ? ",1" : "");
    for (int k = 0; k < s->stress.origins; k++)
        fprintf(out, ",%.17g", shear_in(p, &s->stress.sum[k]) / unit);
    fprintf(out, ",%.17g,%.17g,%.17g,%.17g", solvent + shear_in(p, &total) / unit, first_difference(p, &total), second_difference(p, &total),
            pressure_of(&total));
    return rows_end(&o->rows, e);
}

/* "viscosity": { "every": 100 } */
struct observer *viscosity_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct viscosity *o = rows_new(sizeof *o, "viscosity.csv", s, e);
    if (!o)
        return NULL;
    o->rows.base.measures = true;
    o->rows.base.open = viscosity_open;
    o->rows.base.observe = viscosity_observe;
    o->plane = plane_of(&of->box);
    o->unit = of->viscosity * o->plane.rate;
    return &o->rows.base;
}
