/*
 * Who is near whom. A list of candidates (pairs within range plus a skin) is kept until the crowd may have moved by the
 * skin; each step `neighbours_find` turns the candidates into the pairs that are within range now.
 *
 * The list stays valid while  (1 - |D|) (range + skin) - 2 s >= range,  D = F - I the deformation since the list was made
 * and s the largest displacement of a particle beyond that deformation: affine motion alone costs only |D|.
 */
#ifndef CORE_NEIGHBOURS_H
#define CORE_NEIGHBOURS_H

#include "core/box.h"
#include "core/pairs.h"

struct candidate {
    int i, j;                       /* tag of i not above tag of j */
    int offset;                     /* which image of j: index into offsets */
    uint32_t image;                 /* key of that image in the never-remapped lattice */
    double touch, reach, weight;    /* a_i + a_j, the range squared, and the share booked here: core/pairs.h [L, L^2, 1] */
};

struct image_offset { int shift[3]; vec3 position, velocity; };

struct neighbours {
    double range[MAX_SPECIES][MAX_SPECIES];     /* between centres, the farthest of all forces [L] */
    double largest_range;
    double skin;                    /* [L]; grows where lists are short-lived and shrinks where they last */
    bool keeps_history, foreign;    /* foreign: another program makes the list and wraps particles; it is only looked through */
    bool many_images;               /* some vector of the lattice is so short that a pair may see several images */
    struct candidate *candidate;
    vec3 *history;                  /* one per candidate; NULL unless a force asked */
    int count, room;
    struct image_offset *offset;    /* images that candidates may refer to, moved with the box each step */
    int offset_count;
    vec3 *listed_at;                /* positions when the list was made */
    double listed_time;
    long made, steps_since;         /* lists made so far; searches since the last */
    struct near_pairs near;
};

/* Ready for these particles; `range` is set. May be called again for others. */
bool neighbours_start(struct neighbours *n, const struct particles *p, struct error *e);
void neighbours_free(struct neighbours *n);

/* Fills n->near for the present positions; remaps, wraps and makes a new list first where needed. `*relisted` says so. */
bool neighbours_find(struct neighbours *n, struct box *box, struct particles *p, bool *relisted, struct error *e);

#endif
