/*
 * A sphere without noise in the flow U_inf(x) = G x
 *
 *     dx/dt = U ,   dU/dt = (G x - U)/tau ,   dW/dt = (curl(G x)/2 - W)/tau_spin
 *
 *     tau      m/(6 pi eta a)     relaxation time of the velocity     [T]
 *     tau_spin I/(8 pi eta a^3)   of the spin                         [T]
 *     G        dU_k/dx_l                                              [1/T]
 *
 * Linear with constant coefficients: (x, U) at time t is exp(t M) times that at 0. A sphere that starts with the flow of a simple
 * shear stays on its streamline exactly. Source: Newton and Stokes. Second origin: the solution for simple shear by hand, in
 * tests/theory_motion_test.c.
 */
#include "theory.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

void theory_free_sphere(const double G[3][3], double relaxation, double spin_relaxation, double t, const struct theory_sphere *start,
                        struct theory_sphere *now)
{
    double m[36] = { 0.0 }, e[36];
    for (int k = 0; k < 3; k++) {
        m[6 * k + 3 + k] = t;
        m[6 * (3 + k) + 3 + k] = -t / relaxation;
        for (int l = 0; l < 3; l++)
            m[6 * (3 + k) + l] = G[k][l] * t / relaxation;
    }
    gsl_matrix_view M = gsl_matrix_view_array(m, 6, 6), E = gsl_matrix_view_array(e, 6, 6);
    gsl_linalg_exponential_ss(&M.matrix, &E.matrix, GSL_PREC_DOUBLE);

    now->radius = start->radius;
    for (int k = 0; k < 3; k++) {
        now->x[k] = now->u[k] = 0.0;
        for (int l = 0; l < 3; l++) {
            now->x[k] += e[6 * k + l] * start->x[l] + e[6 * k + 3 + l] * start->u[l];
            now->u[k] += e[6 * (3 + k) + l] * start->x[l] + e[6 * (3 + k) + 3 + l] * start->u[l];
        }
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const double half_vorticity = 0.5 * (G[b][a] - G[a][b]);
        now->w[k] = half_vorticity + (start->w[k] - half_vorticity) * exp(-t / spin_relaxation);
    }
}
