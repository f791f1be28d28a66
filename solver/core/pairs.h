/*
 * Pairs: what a pair force sees. It does not matter who made the list: our neighbour search, or another program's.
 *
 * The same i and j may occur with several images in a small box, also i = j. The particle with the smaller tag is i.
 */
#ifndef CORE_PAIRS_H
#define CORE_PAIRS_H

#include "core/particles.h"
#include "core/resistance.h"

#include <stdint.h>

struct pair {
    int i, j;
    vec3 normal;                    /* n, unit, from i to (the image of) j */
    double distance;                /* r, between centres    [L] */
    double gap;                     /* h = r - a_i - a_j     [L] */
    vec3 image_velocity;            /* velocity of that image of j less the velocity of j [L/T] */
    double weight;                  /* share of the pair that is booked here: 1, or 1/2 where two processes hold it */
    vec3 *history;                  /* tangential displacement of the contact; NULL: nobody keeps one */
    uint32_t image;                 /* key of the image for the noise; 0 where a pair can have only one */
};

struct near_pairs {
    int count, room;
    struct pair *pair;
    bool keeps_resistance;          /* somebody reads `resistance` */
    struct resistance *resistance;  /* of pair k where it is lubricated: left by the drag for the noise of the same step */
    double deepest;                 /* largest overlap over the smaller radius, and the tags that have it */
    int deepest_tag[2];
};

/* Adds `f` to i and -f to j: Newton's third law has one place. */
static inline void pair_push(struct particles *p, const struct pair *pair, vec3 f)
{
    p->force[pair->i] = plus(p->force[pair->i], f);
    p->force[pair->j] = minus(p->force[pair->j], f);
}

static inline void pair_turn(struct particles *p, const struct pair *pair, vec3 torque_i, vec3 torque_j)
{
    p->torque[pair->i] = plus(p->torque[pair->i], torque_i);
    p->torque[pair->j] = plus(p->torque[pair->j], torque_j);
}

#endif
