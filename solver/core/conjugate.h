/*
 * Conjugate gradients for A x = b, A symmetric and positive definite, preconditioned by a diagonal D near A.
 *
 * Starts from x as given; ends when |r|_D <= residual |b|_D with |v|_D^2 = v . D^-1 v. Source: Hestenes & Stiefel (1952).
 */
#ifndef CORE_CONJUGATE_H
#define CORE_CONJUGATE_H

#include <stdbool.h>
#include <stddef.h>

struct linear_system {
    size_t size;
    void (*apply)(const void *context, const double *x, double *Ax);
    const void *context;
    const double *diagonal;                 /* D, all above 0 */
    double *work;                           /* 3 size numbers */
    double residual;
    int most_iterations;
};

/* Number of iterations taken, or -1 if `residual` was not reached. */
int conjugate_solve(const struct linear_system *s, const double *b, double *x);

#endif
