#include "core/dashpot.h"

#include <math.h>

double effective_mass(double m_i, double m_j) { return 1.0 / (1.0 / m_i + 1.0 / m_j); }

struct dashpot dashpot_of(double m_eff, double gamma_n, double gamma_t)
{
    return (struct dashpot){ m_eff * gamma_n, m_eff * gamma_t };
}

double restitution_of_damping_ratio(double ratio, bool clipped)
{
    if (!clipped)
        return ratio < 1.0 ? exp(-M_PI * ratio / sqrt(1.0 - ratio * ratio)) : 0.0;
    const double off = fabs(1.0 - ratio * ratio);
    if (off < 1e-9)
        return exp(-2.0);                           /* the limit at critical damping from both sides */
    return exp(-2.0 * ratio * (ratio < 1.0 ? acos(ratio) : acosh(ratio)) / sqrt(off));
}

/* Restitution falls with the damping ratio, so halving an interval finds it; 200 halvings are more than a double has digits. */
double damping_ratio_of_restitution(double e, bool clipped)
{
    const double L = log(e);
    if (!clipped)
        return -L / sqrt(M_PI * M_PI + L * L);
    double low = 0.0, high = 1.0;
    while (restitution_of_damping_ratio(high, true) > e && high < 1e12)
        high *= 2.0;
    for (int k = 0; k < 200; k++) {
        const double middle = 0.5 * (low + high);
        *(restitution_of_damping_ratio(middle, true) > e ? &low : &high) = middle;
    }
    return e < 1.0 ? 0.5 * (low + high) : 0.0;
}
