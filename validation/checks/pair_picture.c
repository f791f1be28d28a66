/* SVG by hand: logarithmic axes with one tick per decade, sizes of values (signs are judged, not drawn). */
#include "pair_picture.h"

#include <math.h>
#include <stdio.h>

enum { WIDTH = 560, HEIGHT = 340, LEFT = 58, RIGHT = 70, TOP = 30, BOTTOM = 40 };

static const char *const colours[] = { "#1f5fa8", "#b3541e", "#2b7a4b", "#7d3c98", "#8a6d00", "#b3261e", "#3d4a5c" };

struct axis { double low, high; int from, to; };    /* in decades; place on the paper */

static double place(const struct axis *a, double value)
{
    const double at = (log10(fabs(value) + 1e-300) - a->low) / (a->high - a->low);
    return a->from + fmin(fmax(at, -0.05), 1.05) * (a->to - a->from);
}

static void ticks(FILE *f, const struct axis *a, bool horizontal)
{
    for (double decade = ceil(a->low); decade <= a->high + 1e-9; decade += 1) {
        const double at = place(a, pow(10, decade));
        if (horizontal)
            fprintf(f, "<path d='M%.1f %dV%d' stroke='#e3e6ea'/><text x='%.1f' y='%d' text-anchor='middle'>%g</text>\n", at, TOP,
                    HEIGHT - BOTTOM, at, HEIGHT - BOTTOM + 16, pow(10, decade));
        else
            fprintf(f, "<path d='M%d %.1fH%d' stroke='#e3e6ea'/><text x='%d' y='%.1f' text-anchor='end'>%g</text>\n", LEFT, at,
                    WIDTH - RIGHT, LEFT - 6, at + 4, pow(10, decade));
    }
}

/* The names at the right ends of the lines, from the lowest up, pushed apart where they would overlap. */
static void write_names(FILE *f, const struct axis *up, size_t points, const struct curve *curve, int curves)
{
    double floor_at = HEIGHT;
    for (unsigned done = 0; done != (1u << curves) - 1;) {
        int lowest = -1;
        for (int c = 0; c < curves; c++)
            if (!(done >> c & 1u)
                && (lowest < 0 || fabs(curve[c].line[points - 1]) < fabs(curve[lowest].line[points - 1])))
                lowest = c;
        floor_at = fmin(place(up, curve[lowest].line[points - 1]) + 4, floor_at - 14);
        fprintf(f, "<text x='%d' y='%.1f' fill='%s'>%s</text>\n", WIDTH - RIGHT + 8, floor_at, colours[lowest % 7],
                curve[lowest].name);
        done |= 1u << lowest;
    }
}

bool picture_curves(const char *path, const char *title, const char *x_name, const double *x, size_t points,
                    const struct curve *curve, int curves)
{
    struct axis across = { INFINITY, -INFINITY, LEFT, WIDTH - RIGHT }, up = { INFINITY, -INFINITY, HEIGHT - BOTTOM, TOP };
    for (size_t k = 0; k < points; k++) {
        across.low = fmin(across.low, log10(x[k]));
        across.high = fmax(across.high, log10(x[k]));
        for (int c = 0; c < curves; c++) {
            up.low = fmin(up.low, log10(fabs(curve[c].line[k]) + 1e-300));
            up.high = fmax(up.high, log10(fabs(curve[c].line[k]) + 1e-300));
        }
    }
    up.low = floor(2 * up.low) / 2;
    up.high = ceil(2 * up.high) / 2;
    FILE *f = fopen(path, "w");
    if (!f || points < 2)
        return false;
    fprintf(f, "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %d %d' width='%d' height='%d' font-family='sans-serif' "
               "font-size='12' fill='#3d4a5c'>\n<text x='%d' y='18' font-size='13'>%s (lines: model, points: candidate)</text>\n",
            WIDTH, HEIGHT, WIDTH, HEIGHT, LEFT, title);
    ticks(f, &across, true);
    ticks(f, &up, false);
    fprintf(f, "<text x='%d' y='%d' text-anchor='middle'>%s</text>\n", (LEFT + WIDTH - RIGHT) / 2, HEIGHT - 6, x_name);
    for (int c = 0; c < curves; c++) {
        const char *colour = colours[c % 7];
        fprintf(f, "<path fill='none' stroke-width='1.5' stroke='%s' d='", colour);
        for (size_t k = 0; k < points; k++)
            fprintf(f, "%c%.1f %.1f", k ? 'L' : 'M', place(&across, x[k]), place(&up, curve[c].line[k]));
        fprintf(f, "'/>\n");
        for (size_t k = 0; k < points; k++)
            fprintf(f, "<circle cx='%.1f' cy='%.1f' r='3.2' fill='#fff' stroke-width='1.5' stroke='%s'/>\n", place(&across, x[k]),
                    place(&up, curve[c].point[k]), colour);
    }
    write_names(f, &up, points, curve, curves);
    fprintf(f, "</svg>\n");
    return fclose(f) == 0;
}
