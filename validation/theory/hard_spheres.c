/*
 * Pressure of equal hard spheres at equilibrium, and what a soft contact makes of it
 *
 *     P/(n kT) = (1 + phi + phi^2 - phi^3)/(1 - phi)^3                                          fluid, phi below 0.49
 *     sigma = 2 a - sqrt(pi kT/(2 k_n))                                                          diameter that kT sees
 *
 *     n spheres per volume [1/L^3], phi their volume fraction, k_n stiffness of U = k_n delta^2/2 [M/T^2]
 *
 * Source: Carnahan & Starling, J. Chem. Phys. 51 (1969) 635; Barker & Henderson, J. Chem. Phys. 47 (1967) 4714: sigma is the integral of
 * 1 - exp(-U(r)/kT) over r, here to relative order exp(-2 k_n a^2/kT). Second origins (tests/theory_pair_test.c): the virial
 * coefficients 4, 10, 18.365 of the hard-sphere fluid, and that integral by sums.
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
