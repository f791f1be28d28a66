/*
 * How large a step an explicit scheme may take in the present crowd.
 *
 *     w^2 dt^2 + 2 g dt < 4,    w^2 = largest eigenvalue of M^-1 K,   g = largest eigenvalue of M^-1 R
 *
 * (4 g dt for predicted_verlet: a mode that alternates in sign is predicted with twice its deviation.)
 * A pair's matrix is positive semidefinite, hence at most twice its diagonal blocks; so both eigenvalues are at most
 * twice the largest eigenvalue of any particle's own 6 x 6 block (plus its one-body rate). The bound is never low. No pair
 * of the scene, pressed together alone, may be unstable either.
 */
#ifndef CORE_STEP_LIMIT_H
#define CORE_STEP_LIMIT_H

#include "core/suspension.h"

struct step_limit {
    double dt;                              /* the limit [T] */
    const char *force;                      /* whose term it is that limits most */
    int tag, neighbours;                    /* the particle that needs it; tag 0: a lone pair in contact */
    double friction_rate, stiffness_rate;   /* g [1/T] and w^2 [1/T^2] there */
};

/* Is the suspension's dt below the limit? If not, the error names the force, the particle, the limit and what to do. */
bool step_is_allowed(const struct suspension *s, const char *scheme, struct error *e);
struct step_limit step_limit_of(const struct suspension *s, struct error *e);

/* The step of "dt": "auto": a stable and accurate one also when particles press together. Docs: docs/time-step.md */
double step_advised(const struct suspension *s);

/* What biases of schemes grow with: eps = X_A dt/m_eff of the stiffest pair at the inner gap; 0 without pair friction. */
double step_bias(const struct suspension *s, double dt);

#endif
