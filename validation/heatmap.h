/*
 * Matrices side by side as a picture (SVG): signed values as colour, blue below zero, red above. For people who look at a
 * measured covariance beside the expected one; the verdict does not depend on it.
 */
#ifndef HEATMAP_H
#define HEATMAP_H

#include <stdbool.h>
#include <stddef.h>

struct heatmap_panel { const char *title; const double *value; /* size x size */ double range; /* full colour at +-range */ };

struct heatmap {
    size_t size;                    /* rows and columns of each matrix */
    size_t group;                   /* a grid line every so many rows */
    const struct heatmap_panel *panel;
    size_t panels;
    const char *caption;            /* below the panels; may be null */
    size_t marked_row, marked_column, marked_size;     /* a frame around this square block and its mirror; size 0: none */
};

bool heatmap_write(const char *path, const struct heatmap *map);

#endif
