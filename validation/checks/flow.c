/*
 * Stress tables of sheared runs (docs/formats.md, stress.csv): stress is positive in tension, first index force, second position,
 * so with u_x = rate y each origin adds (sigma_xy + sigma_yx)/2/(viscosity rate) to the relative viscosity.
 */
#include "flow.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { XX, XY, YX, YY, ZZ, COMPONENTS, MOST_ORIGINS = 8 };

static int quantity_of(const char *origin)
{
    return strncmp(origin, "contact", 7) == 0 || strcmp(origin, "repulsion") == 0 ? CONTACT : strcmp(origin, "lubrication") == 0 ? LUBRICATION
         : strcmp(origin, "drag") == 0 ? DRAG : KINETIC;
}

/* The columns to read, and which quantity each origin belongs to. */
static int columns_of(const char *origins, char *columns, size_t room, int quantity[MOST_ORIGINS])
{
    int n = 0;
    char word[64];
    snprintf(columns, room, "step,time");
    for (const char *at = origins; *at && n < MOST_ORIGINS; n++) {
        snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
        quantity[n] = quantity_of(word);
        const size_t used = strlen(columns);
        snprintf(columns + used, room - used, ",%s_xx,%s_xy,%s_yx,%s_yy,%s_zz", word, word, word, word, word);
        at += strlen(word);
        at += *at == ',';
    }
    return n;
}

bool flow_read(struct check_run *run, const char *out, const char *origins, const struct flow *flow, struct flow_average *a)
{
    char path[PATH_LENGTH], why[WHY_LENGTH], columns[2048];
    int quantity[MOST_ORIGINS], rows = 0;
    struct table t;
    const int count = columns_of(origins, columns, sizeof columns, quantity);
    path_join(path, out, "stress.csv");
    if (!table_read(path, columns, &t, why)) {
        check_garbage(run, why);
        return false;
    }
    const double unit = flow->viscosity * flow->rate, size = fabs(unit);
    memset(a, 0, sizeof *a);
    for (size_t r = 0; r < t.rows; r++) {
        double sample[FLOW_QUANTITIES] = { [VISCOSITY] = 1.0 }, normal[COMPONENTS] = { 0 };
        for (int o = 0; o < count; o++) {
            double sigma[COMPONENTS];
            for (int c = 0; c < COMPONENTS; c++)
                sigma[c] = table_at(&t, r, (size_t)(2 + COMPONENTS * o + c));
            const double part = (sigma[XY] + sigma[YX]) / 2 / unit;
            sample[quantity[o]] += part;
            sample[VISCOSITY] += part;
            for (int c = 0; c < COMPONENTS; c++)
                normal[c] += sigma[c];
        }
        sample[PRESSURE] = -(normal[XX] + normal[YY] + normal[ZZ]) / 3 / size;
        sample[N1] = (normal[XX] - normal[YY]) / size;
        sample[N2] = (normal[YY] - normal[ZZ]) / size;
        const double now = table_at(&t, r, 1) * fabs(flow->rate);
        if (now <= flow->discard)
            continue;
        for (int q = 0; q < FLOW_QUANTITIES; q++)
            a->mean[q] += sample[q];
        rows++;
    }
    table_free(&t);
    for (int q = 0; q < FLOW_QUANTITIES; q++)
        a->mean[q] /= rows;
    if (rows == 0)
        check_garbage(run, "stress.csv ends before the flow is steady");
    return rows > 0;
}

double mean_of(const double *value, int n, double *standard_error)
{
    double sum = 0, squares = 0;
    for (int k = 0; k < n; k++)
        sum += value[k];
    for (int k = 0; k < n; k++)
        squares += (value[k] - sum / n) * (value[k] - sum / n);
    *standard_error = n > 1 ? sqrt(squares / (n - 1) / n) : INFINITY;
    return sum / n;
}
