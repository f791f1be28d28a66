/*
 * Contact of two spheres with dashpots and another friction law; frozen, no time passing
 *
 *     N   = k_n delta - zeta_n d(r)/dt                     normal load, r distance of centres
 *     f_t = - (k_t s_t + zeta_t c_t),  |f_t| <= cap        c_t velocity of the material point of 1 at the contact less that of 2
 *
 *     zeta_n, zeta_t   m gamma with the reduced mass m = 1/(1/m_1 + 1/m_2)                  [M/T]
 *     cap              mu g(N'):  g = N', or N' above a critical load N_c and 0 below it, or N'^2/N_c up to it, or N' - N_c,
 *                      or N' where both are rough and 0 elsewhere; N' the load of the declared rule: k_n delta, the positive part of
 *                      N or its absolute value
 *
 * gamma_n from a restitution coefficient: theory_damping_ratio, by halving an interval of the damping ratio.
 * Source: Cundall & Strack (1979); Schwager & Poeschel, Granular Matter 9 (2007) 465 for the clipped collision; Mari et al.,
 * J. Rheol. 58 (2014) 1693 for the critical load. Second origin: collisions integrated numerically, tests/collision_test.c.
 */
#include "theory.h"

#include <math.h>
#include <string.h>

static void turned(const double w[3], const double arm[3], double out[3])
{
    out[0] = w[1] * arm[2] - w[2] * arm[1];
    out[1] = w[2] * arm[0] - w[0] * arm[2];
    out[2] = w[0] * arm[1] - w[1] * arm[0];
}

/* log of the speed ratio of a head-on collision with damping ratio b; clipped: b = cos(phi), or cosh(phi) when overdamped. */
static double log_ratio(double b, bool clip)
{
    if (!clip)
        return b < 1.0 ? -M_PI / sqrt(1.0 / (b * b) - 1.0) : -INFINITY;
    if (b == 1.0)
        return -2.0;
    return b < 1.0 ? -2.0 * acos(b) / tan(acos(b)) : -2.0 * acosh(b) / tanh(acosh(b));
}

double theory_restitution(double b, bool clip)
{
    return b > 0.0 ? exp(log_ratio(b, clip)) : 1.0;
}

double theory_damping_ratio(double restitution, bool clip)
{
    const double wanted = log(restitution);
    if (wanted == 0.0)
        return 0.0;
    if (!clip)
        return 1.0 / hypot(1.0, M_PI / wanted);
    double low = 0.0, high = 1.0;                   /* the logarithm falls steadily: about -pi b at first, -2 log(2 b) at last */
    while (log_ratio(high, true) > wanted)
        high *= 2.0;
    while (high - low > 1e-15 * high) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high)
            break;
        if (log_ratio(middle, true) > wanted)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

double theory_reduced_mass(const struct theory_contact *law)
{
    return isinf(law->mass[0]) ? law->mass[1] : isinf(law->mass[1]) ? law->mass[0]
         : law->mass[0] * law->mass[1] / (law->mass[0] + law->mass[1]);
}

double theory_normal_dashpot(const struct theory_contact *law)
{
    const double m = theory_reduced_mass(law);
    if (law->restitution > 0.0)
        return 2.0 * theory_damping_ratio(law->restitution, law->clip) * sqrt(law->normal_stiffness * m);
    return law->normal_damping * m;
}

double theory_friction_cap(const struct theory_contact *law, double load)
{
    const double mu = law->friction, least = law->critical_load;
    switch (law->law) {
    case THEORY_CRITICAL:
        return load < least ? -1.0 : mu * load;
    case THEORY_SOFT:
        return load < least ? mu * load * load / least : mu * load;
    case THEORY_SHIFTED:
        return load < least ? -1.0 : mu * load - mu * least;
    case THEORY_BINARY:
        return law->rough[0] && law->rough[1] ? mu * load : -1.0;
    case THEORY_PLAIN:
    default:
        return mu * load;
    }
}

/* Normal force of an overlapping pair, and the load that friction feels; opening: dr/dt. */
static double normal_force(const struct theory_contact *law, double overlap, double opening, double *load)
{
    const double spring = law->normal_stiffness * overlap, damped = spring - theory_normal_dashpot(law) * opening;
    const double normal = law->clip && damped < 0.0 ? 0.0 : damped;
    *load = law->load == THEORY_LOAD_SPRING ? spring : law->load == THEORY_LOAD_ABSOLUTE ? fabs(normal) : fmax(normal, 0.0);
    return normal;
}

bool theory_contact_grips(const struct theory_contact *law, double overlap, double opening)
{
    double load;
    normal_force(law, overlap, opening, &load);
    return overlap > 0.0 && law->friction > 0.0 && theory_friction_cap(law, load) >= 0.0;
}

void theory_contact_laws_pair(const struct theory_contact *law, const struct theory_sphere s[2], const double history[3],
                              struct theory_pair *out)
{
    double n[3], distance = 0.0, opening = 0.0, point[2][3], arm[2][3], tangential[3];
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 3; k++) {
        n[k] = s[1].x[k] - s[0].x[k];
        distance = hypot(distance, n[k]);
    }
    const double touching = s[0].radius + s[1].radius, overlap = touching - distance;
    if (overlap <= 0.0)
        return;
    for (int k = 0; k < 3; k++) {
        n[k] /= distance;
        opening += (s[1].u[k] - s[0].u[k]) * n[k];
    }
    double load;
    const double normal = normal_force(law, overlap, opening, &load), cap = law->friction > 0.0 ? theory_friction_cap(law, load) : -1.0;     /* -1: no friction, no history */

    for (int a = 0; a < 2; a++) {
        const double side = a == 0 ? 1.0 : -1.0, lever = law->lever_at_contact ? s[a].radius * distance / touching : s[a].radius;
        for (int k = 0; k < 3; k++)
            arm[a][k] = side * lever * n[k];
        turned(s[a].w, arm[a], point[a]);
    }
    double size = 0.0, s_n = 0.0, c_n = 0.0, c[3];
    for (int k = 0; k < 3; k++) {
        c[k] = s[0].u[k] + point[0][k] - s[1].u[k] - point[1][k];
        s_n += history[k] * n[k];
        c_n += c[k] * n[k];
    }
    const double zeta_t = law->tangential_damping > 0.0 ? law->tangential_damping * theory_reduced_mass(law) : 0.0;
    for (int k = 0; k < 3; k++) {
        tangential[k] = -law->tangential_stiffness * (history[k] - s_n * n[k]) - zeta_t * (c[k] - c_n * n[k]);
        size = hypot(size, tangential[k]);
    }
    const double share = cap < 0.0 ? 0.0 : size > cap ? cap / size : 1.0;
    for (int a = 0; a < 2; a++) {
        double friction[3];
        for (int k = 0; k < 3; k++) {
            friction[k] = (a == 0 ? share : -share) * tangential[k];
            out->force[a][k] = friction[k] + (a == 0 ? -normal : normal) * n[k];
        }
        turned(arm[a], friction, out->torque[a]);
    }
    for (int k = 0; k < 9; k++)
        out->stress[k / 3][k % 3] = out->force[0][k / 3] * distance * n[k % 3];
}
