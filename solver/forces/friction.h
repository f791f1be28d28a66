/*
 * How far friction reaches: five laws, each a pure function of the normal load and the two species.
 *
 *     plain      cap = mu N
 *     critical   cap = mu N where N >= N_c, else no friction           rough surfaces that a repulsive layer keeps apart
 *     soft       cap = mu N min(1, N/N_c)                              the same, continuous: grows as N^2 up to N_c
 *     shifted    cap = mu max(0, N - N_c)                              the layer carries N_c, friction the rest
 *     binary     cap = mu N between two rough species, else no friction
 *
 *     mu     friction coefficient     [1]
 *     N      normal load, >= 0        [M L/T^2]
 *     N_c    critical load            [M L/T^2]
 *
 * Where there is no friction the contact has no history either: it starts from zero when friction comes back.
 * With N_c = 0 critical, soft and shifted are plain to the last bit.
 * Source: Seto et al. (2013), Mari et al. (2014), models of shear thickening by friction that begins at a load; shifted is the form in
 * which the critical load is subtracted.
 */
#ifndef FORCES_FRICTION_H
#define FORCES_FRICTION_H

#include "core/particles.h"
#include "core/settings.h"

struct friction_rule;
struct grip { double cap; bool lives; };            /* largest tangential force; whether there is a history at all */
typedef struct grip friction_law(const struct friction_rule *f, double load, int a, int b);

struct friction_rule {
    friction_law *law;
    double coefficient, critical_load;
    bool rough[MAX_SPECIES];
};

friction_law friction_plain, friction_critical, friction_soft, friction_shifted, friction_binary;

/* Keys `law`, and what that law needs: `critical_load`, or `rough` (a list of true or false, one per species). */
void friction_read(struct friction_rule *f, double coefficient, const struct particles *p, struct settings *s, struct error *e);

#endif
