/*
 * Structural Brownian stress against time: `brownian_stress.csv`, six components each of
 *
 *     wide    shell 0.05 a with the contact's thermal depth      thin    shell 0.02 a likewise
 *     zero    both extrapolated on a straight line to no shell   raw     shell 0.05 a as the source prints it
 *
 * The equation is brownian.h's. A finite shell averages g over its width: some per cent low at phi = 0.40, more when denser.
 */
#include "observers/brownian.h"
#include "observers/rows.h"

static bool brownian_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct rows *o = (struct rows *)self;
    (void)s;
    if (!rows_open(o, to, 0, e))
        return false;
    static const char *const kinds[] = { "wide", "thin", "zero", "raw" };
    fputs("step,time", o->table.file);
    for (int k = 0; k < 4; k++)
        fprintf(o->table.file, ",%s_xx,%s_yy,%s_zz,%s_xy,%s_xz,%s_yz", kinds[k], kinds[k], kinds[k], kinds[k], kinds[k], kinds[k]);
    fputc('\n', o->table.file);
    return true;
}

static void print(FILE *out, const mat3 *S)
{
    fprintf(out, ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", S->m[0][0], S->m[1][1], S->m[2][2], S->m[0][1], S->m[0][2], S->m[1][2]);
}

static bool brownian_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct rows *o = (struct rows *)self;
    struct snapshot at;
    const bool found = brownian_snapshot(&at, s, e);
    if (found) {
        const double depth = brownian_depth(s), share = brownian_wide / (brownian_wide - brownian_thin);
        const mat3 wide = brownian_stress_of(&at, s, brownian_wide, depth), thin = brownian_stress_of(&at, s, brownian_thin, depth);
        const mat3 raw = brownian_stress_of(&at, s, brownian_wide, 0.0);
        mat3 zero;
        for (int k = 0; k < 9; k++)
            zero.m[k / 3][k % 3] = share * thin.m[k / 3][k % 3] + (1.0 - share) * wide.m[k / 3][k % 3];
        FILE *out = rows_begin(o, s);
        print(out, &wide);
        print(out, &thin);
        print(out, &zero);
        print(out, &raw);
    }
    snapshot_free(&at);
    return found && rows_end(o, e);
}

/* "brownian_stress": { "every": 100 } */
struct observer *brownian_stress_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct rows *o = rows_new(sizeof *o, "brownian_stress.csv", s, e);
    if (!o)
        return NULL;
    o->base.open = brownian_open;
    o->base.observe = brownian_observe;
    if (!error_raised(e) && !(of->kT > 0.0))
        settings_refuse(s, "", e, "needs fluid.kT above 0");
    return &o->base;
}
