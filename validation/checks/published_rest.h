/* Layer 7: what Li (2026) says of suspensions at rest. */
#ifndef PUBLISHED_REST_H
#define PUBLISHED_REST_H

#include "check.h"

void check_published_green_kubo(struct check_run *run);
void check_published_friction(struct check_run *run);
void check_published_split(struct check_run *run);
void check_published_diffusion(struct check_run *run);

#endif
