#include "core/noise.h"

const char *const noise_laws[] = { "gaussian", "uniform", 0 };
