/*
 * The friction of the whole crowd as one linear operator, and the implicit step over it
 *
 *     (M + dt/2 R) (v' - v)/2 = dt/2 (F(v) + F_B)         v = (U, W) of all particles
 *
 *     R     pair lubrication and one-body drag at fixed positions, force = -R v + (what flow and images add)
 *     F     friction forces at the old velocities;  F_B  noise of covariance (2 kT/dt) R
 *
 * This is the midpoint (Cayley) form v' = v + dt M^-1 (F((v + v')/2) + F_B). It keeps the Maxwell distribution, the
 * diffusion coefficient and the terminal velocity exactly at any dt, and pair forces conserve momentum. R is gathered from the
 * forces' own answers (`respond`), so there is no second copy of any resistance.
 */
#ifndef CORE_FRICTION_H
#define CORE_FRICTION_H

#include "core/suspension.h"

struct friction_link { int i, j, pair; vec3 normal; struct resistance resistance; };      /* pair: its place among the near pairs */

struct friction {
    int count, links, room, width;          /* particles; resisted pairs; numbers per particle: 3, or 6 with spins */
    bool driven;                            /* some particles keep their velocity: mass infinite */
    double half_dt;
    struct friction_link *link;
    double *number;                         /* every array below lies in here */
    double *mass, *drag, *diagonal;         /* M, one-body R, and M + dt/2 of the one-body part */
    double *change, *rhs, *work;            /* (v' - v)/2; the right-hand side; work of the solver */
    long solves, iterations;                /* so far: what the implicit step costs */
};

/* R at the present positions and near pairs. */
bool friction_gather(struct friction *f, const struct suspension *s, double dt, struct error *e);
/* y = (M + dt/2 R) x: `context` is a struct friction. */
void friction_apply(const void *context, const double *x, double *y);
/* Solves for `change` with the particles' present forces and torques as F + F_B. */
bool friction_solve(struct friction *f, const struct suspension *s, double residual, struct error *e);
/* v += times * change */
void friction_move(const struct friction *f, struct particles *p, double times);
void friction_free(struct friction *f);

#endif
