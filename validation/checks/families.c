/* The families of checks: one row per file of this folder that defines a table. */
#include "check.h"

#include <string.h>

extern const struct check pair_checks[], noise_checks[], friction_step_checks[], single_checks[], two_bodies_checks[], collision_checks[],
    dilute_checks[], dense_checks[], published_shear_checks[], published_rest_checks[],
    scattered_checks[];

static const struct check *const families[] = { pair_checks, noise_checks, friction_step_checks, single_checks, two_bodies_checks,
                                               collision_checks, dilute_checks, dense_checks, published_shear_checks, published_rest_checks,
                                               scattered_checks };

const struct check *check_find(const char *name)
{
    for (size_t f = 0; f < sizeof families / sizeof *families; f++)
        for (const struct check *c = families[f]; c->name; c++)
            if (strcmp(c->name, name) == 0)
                return c;
    return NULL;
}
