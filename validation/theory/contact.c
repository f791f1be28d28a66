/*
 * Contact of two spheres: linear spring, tangential spring with history, Coulomb cap; frozen, no time passing
 *
 *     f_n = - k_n delta n                                    on 1
 *     f_t = - k_t s_t ,  |f_t| <= mu k_n delta ,  s_t = (1 - n n) s
 *     T_1 = (l_1 n) x f_t ,   T_2 = (- l_2 n) x (- f_t)      moment of each sphere's force about its own centre
 *
 *     delta = a_1 + a_2 - r   overlap                                                   [L]
 *     s                       displacement of the surface of 1 relative to that of 2    [L]
 *     k_n, k_t                stiffness                                                 [M/T^2]
 *     mu                      friction coefficient                                      [1]
 *     l_1, l_2                lever arms: the radii, or a_1 r/(a_1 + a_2), a_2 r/(a_1 + a_2)    [L]
 *
 * Source: Cundall & Strack, Geotechnique 29 (1979) 47; Li (2026) eq 3.3, 3.4, whose normal points from j to i in its formulas
 * and from i to j in its figure: with n from i to j the spring pushes 1 along -n. History is projected on the tangent plane,
 * then capped (the cap knows the spring only). Second origin: the elastic energy k_n delta^2/2 + k_t s_t^2/2, whose derivatives
 * are the forces, in tests/theory_test.c.
 */
#include "theory.h"

#include <math.h>
#include <string.h>

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        out[k] = a[l] * b[m] - a[m] * b[l];
    }
}

/* Unit vector from 1 to 2; returns the distance. */
static double normal_of(const struct theory_sphere s[2], double n[3])
{
    for (int k = 0; k < 3; k++)
        n[k] = s[1].x[k] - s[0].x[k];
    const double distance = hypot(hypot(n[0], n[1]), n[2]);
    for (int k = 0; k < 3; k++)
        n[k] /= distance;
    return distance;
}

/* Tangential force on 1 of a contact with this overlap > 0. */
static void friction_force(const struct theory_contact *law, const double n[3], double overlap, const double history[3],
                           double out[3])
{
    const double out_of_plane = history[0] * n[0] + history[1] * n[1] + history[2] * n[2];
    for (int k = 0; k < 3; k++)
        out[k] = -law->tangential_stiffness * (history[k] - out_of_plane * n[k]);
    const double size = hypot(hypot(out[0], out[1]), out[2]), cap = law->friction * law->normal_stiffness * overlap;
    if (size > cap)
        for (int k = 0; k < 3; k++)
            out[k] *= cap / size;
}

void theory_contact_pair(const struct theory_contact *law, const struct theory_sphere s[2], const double history[3],
                         struct theory_pair *out)
{
    memset(out, 0, sizeof *out);
    double n[3];
    const double distance = normal_of(s, n), touching = s[0].radius + s[1].radius, overlap = touching - distance;
    if (overlap <= 0.0)
        return;

    double tangential[3] = { 0.0, 0.0, 0.0 };
    if (law->friction > 0.0)     /* without friction there is no history and no torque, whatever k_t says */
        friction_force(law, n, overlap, history, tangential);

    for (int a = 0; a < 2; a++) {
        const double side = a == 0 ? 1.0 : -1.0;
        const double lever = law->lever_at_contact ? s[a].radius * distance / touching : s[a].radius;
        double arm[3], friction_on_a[3];
        for (int k = 0; k < 3; k++) {
            arm[k] = side * lever * n[k];
            friction_on_a[k] = side * tangential[k];
            out->force[a][k] = side * (tangential[k] - law->normal_stiffness * overlap * n[k]);
        }
        cross(arm, friction_on_a, out->torque[a]);
    }
    for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
            out->stress[k][l] = out->force[0][k] * distance * n[l];
}

/*
 * T_1 + T_2 + r x F_2 = delta n x f_t for arms equal to the radii, which together exceed r by the overlap; zero for arms that
 * meet in the contact.
 */
void theory_contact_torque_residual(const struct theory_contact *law, const struct theory_sphere s[2], const double history[3],
                                    double residual[3])
{
    double n[3], tangential[3];
    const double overlap = s[0].radius + s[1].radius - normal_of(s, n);
    memset(residual, 0, 3 * sizeof *residual);
    if (overlap <= 0.0 || law->lever_at_contact || law->friction <= 0.0)
        return;
    friction_force(law, n, overlap, history, tangential);
    cross(n, tangential, residual);
    for (int k = 0; k < 3; k++)
        residual[k] *= overlap;
}
