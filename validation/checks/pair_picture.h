/* A small log-log picture: candidate's points on the model's lines. */
#ifndef PAIR_PICTURE_H
#define PAIR_PICTURE_H

#include <stdbool.h>
#include <stddef.h>

struct curve { const char *name; const double *point, *line; };
bool picture_curves(const char *path, const char *title, const char *x_name, const double *x, size_t points,
                    const struct curve *curve, int curves);

#endif
