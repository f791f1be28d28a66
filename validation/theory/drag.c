/*
 * Drag on one sphere in the flow U_inf(x) = G x
 *
 *     F = 6 pi eta a (G x - U) ,   T = 8 pi eta a^3 (curl(G x)/2 - W) ,   S = (20/3) pi eta a^3 E ,  E = (G + G^T)/2
 *
 *     eta viscosity [M/(L T)], a radius [L], G_kl = dU_k/dx_l [1/T], S stresslet [M L^2/T^2]
 *
 * Source: Stokes (1851); Einstein (1906, corrected 1911) for S. Second origin: sum of S over a volume V gives 5 phi eta E, that
 * is, the slope 5/2 of the viscosity; energy: -F.U is the power 6 pi eta a U^2 in a resting fluid (tests/theory_test.c).
 */
#include "theory.h"

#define PI 3.14159265358979323846

void theory_drag(double viscosity, bool with_torque, const double G[3][3], const struct theory_sphere *s,
                 double force[3], double torque[3], double stresslet[3][3])
{
    const double a = s->radius;
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        const double flow = G[k][0] * s->x[0] + G[k][1] * s->x[1] + G[k][2] * s->x[2];
        const double half_vorticity = 0.5 * (G[m][l] - G[l][m]);
        force[k] = 6.0 * PI * viscosity * a * (flow - s->u[k]);
        torque[k] = with_torque ? 8.0 * PI * viscosity * a * a * a * (half_vorticity - s->w[k]) : 0.0;
        for (int j = 0; j < 3; j++)
            stresslet[k][j] = 10.0 / 3.0 * PI * viscosity * a * a * a * (G[k][j] + G[j][k]);
    }
}
