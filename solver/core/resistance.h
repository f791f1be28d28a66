/*
 * Lubrication of two unequal spheres at small gap: the pair's resistance scalars. The only place where they are written;
 * drag, noise, stress and step limit all call it.
 *
 *     b = a_j / a_i,  xi = 2 h / (a_i + a_j),  L = ln(1/xi), xi not below the inner cut-off
 *
 *     X_A  = 6 pi eta a_i   [ 2 b^2/(1+b)^3 / xi + b (1 + 7b + b^2)/(5 (1+b)^3) L ]     squeeze
 *     Y_A  = 6 pi eta a_i   [ 4 b (2 + b + 2 b^2)/(15 (1+b)^3) L ]                      shear
 *     B_1  = -4 pi eta a_i^2 [ b (4+b)/(5 (1+b)^2) L ]                                  shear to spin of i
 *     C_11 =  8 pi eta a_i^3 [ 2 b/(5 (1+b)) L ]                                        spin to spin
 *     C_12 =  8 pi eta a_i^3 [ b^2/(10 (1+b)) L ]
 *     B_2, C_22: B_1, C_11 with i and j exchanged (b -> 1/b)
 *
 * Source: Jeffrey & Onishi (1984), leading terms; Li (2026) eq 3.8-3.18. Each log scalar is a fixed multiple of L.
 */
#ifndef CORE_RESISTANCE_H
#define CORE_RESISTANCE_H

#include "core/vec3.h"

/* Units: A [M/T], B [M L/T], C [M L^2/T]. */
struct resistance { double X_A, Y_A, B_1, B_2, C_11, C_12, C_22; };

/* What depends on the two sizes only: X_A = squeeze / xi + log.X_A L, and the other scalars are log.* L. */
struct resistance_sizes { double squeeze; struct resistance log; };

struct resistance_sizes resistance_of_sizes(double viscosity, double a_i, double a_j);

/* At dimensionless gap xi. `turn` = r/(a_i + a_j) scales the rotation columns (B turn, C turn^2); 1: the sources' model. */
static inline struct resistance resistance_at(const struct resistance_sizes *s, double xi, double inner_gap, double turn)
{
    const double gap = xi > inner_gap ? xi : inner_gap;
    const double L = -log(gap), TL = turn * L, TTL = turn * TL;
    return (struct resistance){ .X_A = s->squeeze / gap + s->log.X_A * L, .Y_A = s->log.Y_A * L,
                                .B_1 = s->log.B_1 * TL, .B_2 = s->log.B_2 * TL,
                                .C_11 = s->log.C_11 * TTL, .C_12 = s->log.C_12 * TTL, .C_22 = s->log.C_22 * TTL };
}

/*
 * What a pair of these resistances does at relative velocity dU = U_j - U_i and spins W: force on i (minus that on j), torques on i and j.
 *
 *     F_i = (X_A n n + Y_A (I - n n)) dU + (B_1 W_i + B_2 W_j) x n
 *     T_i = B_1 dU x n - (I - n n)(C_11 W_i + C_12 W_j),    T_j = B_2 dU x n - (I - n n)(C_12 W_i + C_22 W_j)
 */
static inline vec3 resistance_act(const struct resistance *R, vec3 n, vec3 dU, vec3 W_i, vec3 W_j, vec3 *torque_i, vec3 *torque_j)
{
    const vec3 rolling = cross(plus(scaled(W_i, R->B_1), scaled(W_j, R->B_2)), n), twist = cross(dU, n);
    *torque_i = minus(scaled(twist, R->B_1), across(plus(scaled(W_i, R->C_11), scaled(W_j, R->C_12)), n));
    *torque_j = minus(scaled(twist, R->B_2), across(plus(scaled(W_i, R->C_12), scaled(W_j, R->C_22)), n));
    return plus(plus(scaled(n, (R->X_A - R->Y_A) * dot(dU, n)), scaled(dU, R->Y_A)), rolling);
}

#endif
