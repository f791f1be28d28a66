/*
 * The sheared periodic cell.
 *
 *     U_inf(x) = G x                background flow, G = dU/dx a superposition of simple shears
 *     H(t) = F(t) H(0) M            cell: columns A, B, C
 *     F(t) = I + G t                what the flow makes of a material line; exact, for no axis is both a flow and a gradient axis (G G = 0); G(t): core/flow.h
 *
 * M is an integer matrix of determinant one that picks the least tilted cell of the same lattice (remap): it labels
 * images anew and changes nothing else. F is computed from time 0, never accumulated.
 *
 * The image of a particle shifted by s cells sits at x + H s and moves with U + G H s, for every image follows the flow.
 * Source: Lees & Edwards (1972); Li (2026) section 3.5. Lattice counts are kept for the never-remapped lattice F(t) H(0).
 */
#ifndef CORE_BOX_H
#define CORE_BOX_H

#include "core/error.h"
#include "core/flow.h"
#include "core/particles.h"
#include "core/vec3.h"

struct box {
    mat3 start;                     /* H(0)              [L] */
    mat3 gradient, image_gradient, mean_gradient;   /* G; that of velocities between two kicks: the mean over the step; that of full steps (core/flow.h) [1/T] */
    struct flow *flow;              /* G(t); NULL: steady */
    bool periodic[3];
    bool flowing;                   /* G is not zero */
    bool tilts[3][3];               /* [a][c]: edge c leans along axis a as time goes */
    double time;                    /* t                 [T] */
    mat3 cell, inverse;             /* H(t) and its inverse */
    int lattice[3][3];              /* M */
    double volume;                  /* det H, which shear keeps [L^3] */
    vec3 spin;                      /* Omega_inf = curl U_inf / 2 [1/T] */
    mat3 strain_rate;               /* E                 [1/T] */
    double rate;                    /* the largest |rate| of the shears: unit of strain and of viscosity */
};

/* `cell` has the columns A, B, C at time 0. Refuses a flat or left-handed cell and a flow that is no set of simple shears. */
bool box_new(struct box *b, const mat3 *cell, const bool periodic[3], const mat3 *gradient, struct error *e);
void box_set_time(struct box *b, double time);
mat3 box_deformation(const struct box *b, double from, double to);      /* F from one time to another */
double box_strain(const struct box *b, double from, double to);         /* the integral of |rate| */
bool box_wants_remap(const struct box *b);                              /* a tilt has passed half an edge */
void box_remap(struct box *b);
/* Puts particles back into the cell; where they cross a face their velocity becomes that of the image taken. */
void box_wrap(const struct box *b, struct particles *p);

static inline vec3 box_flow(const struct box *b, vec3 x) { return mat3_times(&b->mean_gradient, x); }
vec3 box_offset(const struct box *b, const int shift[3]);               /* H s */
vec3 box_unwrapped(const struct box *b, const int image[3]);            /* F H(0) n: what wrapping has taken off a position */
void box_lattice_shift(const struct box *b, const int shift[3], int lattice_shift[3]);  /* M s */
double box_width(const struct box *b, int axis);                        /* distance between opposite faces */

#endif
