/*
 * A Brownian sphere with inertia, one Cartesian component, started from equilibrium
 *
 *     m du/dt = - zeta u + sqrt(2 kT zeta) white noise ,     tau = m/zeta
 *
 *     <u(0) u(t)>     = (kT/m) exp(-t/tau)
 *     <dx(t)^2>       = 2 (kT/m) tau^2 [ t/tau - 1 + exp(-t/tau) ]
 *     <dx(s) dx(t)>   = ( <dx(s)^2> + <dx(t)^2> - <dx(|t - s|)^2> ) / 2        (increments are stationary)
 *
 *     m mass [M], zeta friction [M/T], kT thermal energy [M L^2/T^2], dx displacement since time 0 [L]
 *
 * The same with moment of inertia, 8 pi eta a^3, spin and angle turned through.
 * Source: Uhlenbeck & Ornstein, Phys. Rev. 36 (1930) 823; Li (2026) eq 4.1, 4.2 (per component, not summed over three).
 * Second origin: the integral 2 int_0^t (t - t') <u(0) u(t')> dt' by quadrature, and Li's form in tau_I and tau_B
 * (tests/theory_test.c).
 */
#include "theory.h"

#include <gsl/gsl_math.h>

/* x - 1 + exp(-x); its series where the three terms cancel (the sum below is good to 1e-17 at x = 0.5 after 14 terms) */
static double ballistic_to_diffusive(double x)
{
    if (x > 0.5)
        return x + gsl_expm1(-x);
    double term = 0.5 * x * x, sum = term;
    for (int k = 3; k < 17; k++) {
        term *= -x / k;
        sum += term;
    }
    return sum;
}

double theory_langevin_msd(double kT, double mass, double friction, double t)
{
    const double tau = mass / friction;
    return 2.0 * kT / mass * tau * tau * ballistic_to_diffusive(t / tau);
}

double theory_langevin_vacf(double kT, double mass, double friction, double t)
{
    return kT / mass * exp(-t * friction / mass);
}

double theory_langevin_msd_covariance(double kT, double mass, double friction, double s, double t)
{
    return 0.5 * (theory_langevin_msd(kT, mass, friction, s) + theory_langevin_msd(kT, mass, friction, t)
                  - theory_langevin_msd(kT, mass, friction, fabs(t - s)));
}
