/* Layer 1: the table of its checks; the files pair_*.c hold them. */
#include "check.h"

const struct check pair_checks[] = { { NULL, NULL } };
