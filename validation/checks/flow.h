/* What checks of sheared crowds share: viscosities and normal stresses from a run's stress table, and means over realisations. */
#ifndef FLOW_H
#define FLOW_H

#include "check.h"

/* Viscosities are relative to the fluid's, pressure and normal stress differences in units of viscosity x |rate|. */
enum { VISCOSITY, CONTACT, LUBRICATION, DRAG, KINETIC, PRESSURE, N1, N2, FLOW_QUANTITIES };

struct flow { double viscosity, rate, discard, strain; };   /* of the scene; strains that are thrown away and that are run in all */

/* One run: averages over the steady window. */
struct flow_average { double mean[FLOW_QUANTITIES]; };

/*
 * Read out/stress.csv of a run in shear u_x = rate y. `origins` ("contact_normal,kinetic,drag") must all be there. The viscosity is
 *     1 + (symmetric xy stress of these origins)/(viscosity rate),    contact: normal, tangential and repulsion together
 * Origins that are not asked for count as zero: the impulses of noise, whose mean is zero, are never asked for. False: recorded.
 */
bool flow_read(struct check_run *run, const char *out, const char *origins, const struct flow *flow, struct flow_average *a);

/* Mean and its standard error, from the spread of n numbers. */
double mean_of(const double *value, int n, double *standard_error);

#endif
