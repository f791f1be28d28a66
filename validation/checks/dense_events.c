/*
 * Layer 6: what happened on a path, so that a comparison of two paths says what it has tried
 *
 * Contacts are counted from the places in the reference's trajectory, in the cell that the flow has made by then: a pair touches when
 * some image of it is nearer than the sum of the radii. Contacts that come and go between two frames are not seen, so that the
 * counts are lower bounds. Slipping pairs are counted by the reference itself (slipping.csv): tangential force at the cap.
 */
#include "dense.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct frame { const double *x, *radius; size_t count; double edge, shift; };

static double image_distance(const struct frame *f, size_t i, size_t j)
{
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = f->x[3 * j + (size_t)k] - f->x[3 * i + (size_t)k];
    const double row = round(d[1] / f->edge);   /* a cell further along the gradient is shifted along the flow */
    d[0] -= row * f->shift;
    d[1] -= row * f->edge;
    d[0] -= f->edge * round(d[0] / f->edge);
    d[2] -= f->edge * round(d[2] / f->edge);
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/* Contacts of this frame; those made and lost since the frame before are added. `touched`: count x count, of the frame before. */
static size_t count_frame(const struct frame *f, bool first, bool *touched, struct dense_events *e)
{
    size_t contacts = 0;
    for (size_t i = 0; i < f->count; i++)
        for (size_t j = i + 1; j < f->count; j++) {
            bool *before = &touched[i * f->count + j];
            const bool now = image_distance(f, i, j) < f->radius[i] + f->radius[j];
            contacts += now;
            e->made += !first && now && !*before;
            e->lost += !first && !now && *before;
            *before = now;
        }
    return contacts;
}

static bool count_slipping(const char *out, struct dense_events *e, char why[WHY_LENGTH])
{
    struct table t;
    char path[PATH_LENGTH];
    path_join(path, out, "slipping.csv");
    if (!table_read(path, "step,contacts,slipping", &t, why))
        return false;
    for (size_t r = 0; r < t.rows; r++) {
        e->slipping += (size_t)table_at(&t, r, 2);
        e->sticking += (size_t)(table_at(&t, r, 1) - table_at(&t, r, 2));
    }
    table_free(&t);
    return true;
}

bool dense_events_count(const struct dense_start *s, const char *out, double dt, struct dense_events *e, char why[WHY_LENGTH])
{
    struct table t;
    char path[PATH_LENGTH];
    path_join(path, out, "trajectory.csv");
    *e = (struct dense_events){ 0 };
    if (!table_read(path, "step,id,x,y,z", &t, why))
        return false;
    const size_t n = s->count, frames = t.rows / n;
    double *x = calloc(3 * n, sizeof *x), *radius = calloc(n, sizeof *radius);
    bool *touched = calloc(n * n, sizeof *touched), good = x && radius && touched;
    for (size_t i = 0; good && i < n; i++)
        radius[i] = scene_number(json_array_get(json_object_get(s->scene, "species"), (size_t)s->row[i].species - 1), "radius", 1);
    for (size_t f = 0; good && f < frames; f++) {
        for (size_t r = f * n; r < (f + 1) * n; r++) {
            const size_t id = (size_t)table_at(&t, r, 1);
            for (size_t k = 0; id >= 1 && id <= n && k < 3; k++)
                x[3 * (id - 1) + k] = table_at(&t, r, 2 + k);
        }
        const double step = table_at(&t, f * n, 0);
        const struct frame now = { x, radius, n, s->edge, s->rate * step * dt * s->edge };
        e->contacts = count_frame(&now, f == 0, touched, e);
        e->remaps = (size_t)floor(fabs(s->rate) * step * dt + 0.5);
    }
    free(x);
    free(radius);
    free(touched);
    table_free(&t);
    return good && count_slipping(out, e, why);
}
