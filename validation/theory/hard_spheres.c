/*
 * Pressure of hard spheres at equilibrium, of one size and of several, and what a soft contact makes of it
 *
 *     P/(n kT) = (1 + phi + phi^2 - phi^3)/(1 - phi)^3                                          fluid, phi below 0.49
 *     P/(n kT) = (6/(pi n)) [ z_0/(1 - z_3) + 3 z_1 z_2/(1 - z_3)^2 + (3 - z_3) z_2^3/(1 - z_3)^3 ]   mixture, z_m = (pi/6) sum n_i sigma_i^m
 *     sigma = 2 a - sqrt(pi kT/(2 k_n))                                                          diameter that kT sees
 *
 *     n spheres per volume [1/L^3], phi their volume fraction, k_n stiffness of U = k_n delta^2/2 [M/T^2]
 *
 * One k_n for all pairs shortens every a_i + a_j alike, so the thermal diameters of a mixture add as the radii do.
 * Source: Carnahan & Starling, J. Chem. Phys. 51 (1969) 635; Boublik, J. Chem. Phys. 53 (1970) 471 and Mansoori, Carnahan, Starling &
 * Leland, J. Chem. Phys. 54 (1971) 1523 for mixtures; Barker & Henderson, J. Chem. Phys. 47 (1967) 4714: sigma is the integral of
 * 1 - exp(-U(r)/kT) over r, here to relative order exp(-2 k_n a^2/kT). Second origins (tests/theory_pair_test.c): the virial
 * coefficients 4, 10, 18.365 of the hard-sphere fluid, the second one of a mixture from (2 pi/3) sigma_ij^3, and that integral by sums.
 */
#include "theory.h"

#include <math.h>

double theory_thermal_diameter(double radius, double stiffness, double kT)
{
    return 2.0 * radius - sqrt(0.5 * 3.14159265358979323846 * kT / stiffness);
}

double theory_carnahan_starling(double phi)
{
    return (1.0 + phi + phi * phi - phi * phi * phi) / pow(1.0 - phi, 3);
}

double theory_mixture_pressure(int species, const double density[], const double diameter[])
{
    double z[4] = { 0.0 }, n = 0.0;
    for (int i = 0; i < species; i++) {
        n += density[i];
        for (int m = 0; m < 4; m++)
            z[m] += 3.14159265358979323846 / 6.0 * density[i] * pow(diameter[i], m);
    }
    const double room = 1.0 - z[3];
    return 6.0 / (3.14159265358979323846 * n)
           * (z[0] / room + 3.0 * z[1] * z[2] / (room * room) + (3.0 - z[3]) * z[2] * z[2] * z[2] / (room * room * room));
}
