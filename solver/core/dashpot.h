/*
 * Dashpots of a contact: zeta = m_eff gamma [M/T], m_eff = m_i m_j/(m_i + m_j).
 *
 * A head-on collision is the oscillator m delta'' + zeta delta' + k delta = 0. With damping ratio b = zeta/(2 sqrt(m k)) it ends at
 * delta = 0 with the speed ratio e = exp(-pi b/sqrt(1 - b^2)); where tension is clipped it ends earlier, when k delta + zeta delta'
 * = 0, with e = exp(-2 b acos(b)/sqrt(1 - b^2)), acosh and b^2 - 1 above b = 1. Source: Schwager & Poeschel (2007).
 */
#ifndef CORE_DASHPOT_H
#define CORE_DASHPOT_H

#include <stdbool.h>

struct dashpot { double normal, tangential; };

double effective_mass(double m_i, double m_j);              /* infinite masses are held ones */
struct dashpot dashpot_of(double m_eff, double gamma_n, double gamma_t);
double restitution_of_damping_ratio(double ratio, bool clipped);
double damping_ratio_of_restitution(double e, bool clipped);        /* 0 < e <= 1 */

#endif
