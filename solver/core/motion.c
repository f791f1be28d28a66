#include "core/motion.h"
#include "core/driven.h"

void kick(struct suspension *s, double duration, double ahead)
{
    struct particles *p = &s->particles;
    double per_mass[MAX_SPECIES], per_inertia[MAX_SPECIES];
    for (int k = 0; k < p->species_count; k++)
        per_mass[k] = duration / p->kind[k].mass, per_inertia[k] = duration / p->kind[k].inertia;
    for (int i = 0; i < p->count; i++)
        p->velocity[i] = plus(p->velocity[i], scaled(p->force[i], per_mass[p->species[i]]));
    for (int i = 0; p->spin && i < p->count; i++)
        p->spin[i] = plus(p->spin[i], scaled(p->torque[i], per_inertia[p->species[i]]));
    driven_keep(s, ahead);
}

void drift(struct suspension *s, double duration)
{
    struct particles *p = &s->particles;
    for (int i = 0; i < p->count; i++)
        p->position[i] = plus(p->position[i], scaled(p->velocity[i], duration));
    for (int i = 0; p->turn && i < p->count; i++)
        p->turn[i] = plus(p->turn[i], scaled(p->spin[i], duration));
}
