/* Nine columns per origin of stress: used by runs and by single evaluations alike. */
#ifndef OUTPUT_STRESS_COLUMNS_H
#define OUTPUT_STRESS_COLUMNS_H

#include "core/stress.h"

#include <stdio.h>

static inline void stress_write_names(FILE *out, const struct stress *s)
{
    for (int o = 0; o < s->origins; o++)
        for (int k = 0; k < 9; k++)
            fprintf(out, ",%s_%c%c", s->name[o], "xyz"[k / 3], "xyz"[k % 3]);
    fputc('\n', out);
}

static inline void stress_write_values(FILE *out, const struct stress *s)
{
    for (int o = 0; o < s->origins; o++)
        for (int k = 0; k < 9; k++)
            fprintf(out, ",%.17g", s->sum[o].m[k / 3][k % 3]);
    fputc('\n', out);
}

#endif
