#include "heatmap.h"

#include <math.h>
#include <stdio.h>

enum { LEVELS = 8, EDGE = 300, MARGIN = 16, TITLE = 34 };

/* -LEVELS .. LEVELS; 0 is not drawn. The square root lets small values show beside large ones. */
static int level(double value, double range)
{
    if (!isfinite(value))
        return LEVELS;
    const double x = fmin(1.0, fabs(value) / range), shown = sqrt(x);
    const int k = (int)lround(shown * LEVELS);
    return value < 0.0 ? -k : k;
}

static void colour(int k, char text[8])
{
    const double share = fabs((double)k) / LEVELS;
    const int pale = 235 - (int)(195.0 * share), strong = 245 - (int)(60.0 * share);
    snprintf(text, 8, "#%02x%02x%02x", (unsigned)(k > 0 ? strong : pale) & 255u, (unsigned)pale & 255u,
             (unsigned)(k > 0 ? pale : strong) & 255u);
}

/* One path per colour: cells of a row that follow each other are one rectangle. */
static void draw_cells(FILE *f, const struct heatmap_panel *panel, size_t size)
{
    for (int k = -LEVELS; k <= LEVELS; k++) {
        char fill[8];
        bool begun = false;
        if (k == 0)
            continue;
        colour(k, fill);
        for (size_t i = 0; i < size; i++)
            for (size_t j = 0; j < size; j++) {
                size_t run = 0;
                while (j + run < size && level(panel->value[i * size + j + run], panel->range) == k)
                    run++;
                if (run == 0)
                    continue;
                if (!begun)
                    fprintf(f, "<path fill=\"%s\" d=\"", fill);
                begun = true;
                fprintf(f, "M%zu %zuh%zuv1h-%zuz\n", j, i, run, run);
                j += run - 1;
            }
        if (begun)
            fputs("\"/>\n", f);
    }
}

static void draw_panel(FILE *f, const struct heatmap *map, size_t at)
{
    const size_t left = MARGIN + at * (EDGE + MARGIN);
    const double scale = (double)EDGE / (double)map->size, thin = 0.4 / scale;
    fprintf(f, "<text x=\"%zu\" y=\"22\" font-weight=\"600\">%s</text>\n", left, map->panel[at].title);
    fprintf(f, "<g transform=\"translate(%zu %d) scale(%.6g)\">\n", left, (int)TITLE, scale);
    fprintf(f, "<rect width=\"%zu\" height=\"%zu\" fill=\"#fff\" stroke=\"#999\" stroke-width=\"%.3g\"/>\n", map->size, map->size,
            2.0 * thin);
    if (map->group > 0) {
        fprintf(f, "<path stroke=\"#ddd\" stroke-width=\"%.3g\" fill=\"none\" d=\"", thin);
        for (size_t k = map->group; k < map->size; k += map->group)
            fprintf(f, "M%zu 0v%zuM0 %zuh%zu", k, map->size, k, map->size);
        fputs("\"/>\n", f);
    }
    draw_cells(f, &map->panel[at], map->size);
    if (map->marked_size > 0)
        for (int mirror = 0; mirror < 2; mirror++) {
            const size_t row = mirror ? map->marked_column : map->marked_row, column = mirror ? map->marked_row : map->marked_column;
            fprintf(f, "<rect x=\"%zu\" y=\"%zu\" width=\"%zu\" height=\"%zu\" fill=\"none\" stroke=\"#000\" stroke-width=\"%.3g\"/>\n",
                    column, row, map->marked_size, map->marked_size, 3.0 * thin);
        }
    fputs("</g>\n", f);
}

bool heatmap_write(const char *path, const struct heatmap *map)
{
    FILE *f = fopen(path, "w");
    if (!f)
        return false;
    const size_t width = MARGIN + map->panels * (EDGE + MARGIN);
    fprintf(f, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %zu %d\" font-family=\"sans-serif\" font-size=\"13\">\n", width,
            TITLE + EDGE + 34);
    fprintf(f, "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n");
    for (size_t at = 0; at < map->panels; at++)
        draw_panel(f, map, at);
    if (map->caption)
        fprintf(f, "<text x=\"%d\" y=\"%d\" fill=\"#555\">%s</text>\n", (int)MARGIN, TITLE + EDGE + 22, map->caption);
    fputs("</svg>\n", f);
    return fclose(f) == 0;
}
