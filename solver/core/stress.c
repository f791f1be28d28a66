#include "core/stress.h"

#include <string.h>

int stress_origin(struct stress *s, const char *name)
{
    s->name[s->origins] = name;
    return s->origins++;
}

void stress_clear(struct stress *s)
{
    memset(s->sum, 0, sizeof s->sum);
}

void stress_finish(struct stress *s, double volume)
{
    for (int o = 0; o < s->origins; o++)
        for (int k = 0; k < 9; k++)
            s->sum[o].m[k / 3][k % 3] /= volume;
}

void stress_kinetic(struct stress *s, int origin, const struct box *box, const struct particles *p)
{
    for (int i = 0; i < p->count; i++) {
        const vec3 peculiar = minus(p->velocity[i], box_flow(box, p->position[i]));
        if (!p->kind[p->species[i]].driven)         /* a driven one's momentum is not the crowd's */
            mat3_add_outer(&s->sum[origin], -mass_of(p, i), peculiar, peculiar);
    }
}
