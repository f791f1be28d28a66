/* The solver as a candidate of the gate: one case folder in, its numbers out. docs/adapter.md has the formats. */
#ifndef EVALUATE_H
#define EVALUATE_H

#include "core/error.h"

bool evaluate_case(const char *case_folder, const char *out_folder, struct error *e);

#endif
