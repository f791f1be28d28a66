#include "core/suspension.h"

#include <stdlib.h>
#include <string.h>

const struct force *suspension_force(const struct suspension *s, const char *name)
{
    for (int k = 0; k < s->force_count; k++)
        if (strcmp(s->force[k]->name, name) == 0)
            return s->force[k];
    return NULL;
}

void suspension_take(struct suspension *s, struct force *f)
{
    struct particles *p = &s->particles;
    s->force[s->force_count++] = f;
    s->neighbours.keeps_history |= f->keeps_history;
    p->anchored |= f->keeps_anchor;
    s->neighbours.near.keeps_resistance |= f->keeps_resistance;
    for (int k = 0; k < 2 && f->origin_name[k]; k++)
        f->origin[k] = stress_origin(&s->stress, f->origin_name[k]);
    for (int a = 0; a < p->species_count; a++)
        for (int b = 0; b < p->species_count; b++)
            if (!(p->kind[a].driven && p->kind[b].driven))      /* two driven ones are no pair: nothing could come of it */
                s->neighbours.range[a][b] = fmax(s->neighbours.range[a][b], f->range_factor * (p->kind[a].radius + p->kind[b].radius));
}

bool suspension_find(struct suspension *s, bool *relisted, struct error *e)
{
    struct box *b = &s->box;
    const double end = s->start_time + (double)s->step * s->dt;
    if (b->flow && s->step > 0)         /* a run starts with the flow that there is: box_set_time */
        b->image_gradient = b->flow->mean(b->flow, end - s->dt, end), b->mean_gradient = flow_of_row(b->flow, end, s->dt);
    return neighbours_find(&s->neighbours, &s->box, &s->particles, relisted, e);
}

void suspension_add_forces(struct suspension *s, unsigned kinds, const struct moment *now)
{
    struct particles *p = &s->particles;
    memset(p->force, 0, (size_t)p->count * sizeof *p->force);
    if (p->torque)
        memset(p->torque, 0, (size_t)p->count * sizeof *p->torque);
    for (int k = 0; k < s->force_count; k++)
        if (s->force[k]->kind & kinds)
            s->force[k]->add(s->force[k], p, &s->neighbours.near, now, s->measuring ? &s->stress : NULL);
    suspension_flatten(s);
}

void suspension_flatten(struct suspension *s)
{
    struct particles *p = &s->particles;
    for (int i = 0; s->dimensions == 2 && i < p->count; i++) {
        p->force[i].z = 0.0;
        if (p->torque)
            p->torque[i].x = p->torque[i].y = 0.0;
    }
}

void suspension_free(struct suspension *s)
{
    for (int k = 0; k < s->force_count; k++)
        free(s->force[k]);
    free(s->box.flow);
    neighbours_free(&s->neighbours);
    particles_free(&s->particles);
}
