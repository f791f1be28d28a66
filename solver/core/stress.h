/*
 * Stress of the cell by origin, positive in tension:
 *
 *     sigma = (1/V) sum over pairs of F_i (x) (x_j - x_i)      pair forces, each pair once
 *     sigma = (1/V) sum over particles of S_i                  one-body stresslets
 *     sigma = -(1/V) sum over particles of m c (x) c           kinetic, c = U - U_inf(x)
 *
 * First index force, second index position. Source: Irving & Kirkwood (1950); Li (2026) section 3.4, signs repaired: with
 * n from i to j and F the force on i the sign is plus, and the volume is the only divisor.
 */
#ifndef CORE_STRESS_H
#define CORE_STRESS_H

#include "core/box.h"
#include "core/pairs.h"

enum { MAX_ORIGINS = 16 };

struct stress {
    int origins;
    const char *name[MAX_ORIGINS];
    mat3 sum[MAX_ORIGINS];                  /* sigma V until stress_finish, then sigma [M/(L T^2)] */
};

int stress_origin(struct stress *s, const char *name);          /* a new row; returns its index */
void stress_clear(struct stress *s);
void stress_finish(struct stress *s, double volume);
void stress_kinetic(struct stress *s, int origin, const struct box *box, const struct particles *p);

static inline void stress_add_pair(struct stress *s, int origin, const struct pair *pair, vec3 force_on_i)
{
    mat3_add_outer(&s->sum[origin], pair->weight * pair->distance, force_on_i, pair->normal);
}

#endif
