#include "core/driven.h"

void driven_keep(struct suspension *s, double ahead)
{
    struct particles *p = &s->particles;
    if (!s->box.flow)
        return;
    const mat3 G = ahead > 0.0 ? s->box.flow->mean(s->box.flow, s->box.time, s->box.time + 2.0 * ahead) : s->box.mean_gradient;
    for (int i = 0; i < p->count; i++) {
        const struct species *kind = &p->kind[p->species[i]];
        if (kind->driven)
            p->velocity[i] = minus(kind->velocity, mat3_times(&G, box_unwrapped(&s->box, p->image[i])));
    }
}
