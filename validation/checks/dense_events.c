/*
 * Layer 6: what happened on a path, so that a comparison of two paths says what it has tried
 *
 * Contacts are counted from the places in the reference's trajectory: contacts that come and go between two frames are not seen, so that the
 * counts are lower bounds. Slipping pairs are counted by the reference itself (slipping.csv): tangential force at the cap.
 */
#include "dense.h"

#include <math.h>
#include <stdlib.h>

struct watch { struct dense_events *e; bool *touched /* count x count, of the frame before */, first; };

static void see(void *to, const struct dense_start *s, const struct dense_snapshot *now)
{
    struct watch *w = to;
    double a[s->count];
    w->e->contacts = 0;
    for (size_t i = 0; i < s->count; i++)
        a[i] = dense_radius(s, i);
    for (size_t i = 0; i < s->count; i++)
        for (size_t j = i + 1; j < s->count; j++) {
            double d[3];
            dense_pair(s, now, i, j, d);
            bool *before = &w->touched[i * s->count + j];
            const bool touches = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) < a[i] + a[j];
            w->e->contacts += touches;
            w->e->made += !w->first && touches && !*before;
            w->e->lost += !w->first && !touches && *before;
            *before = touches;
        }
    w->e->remaps = (size_t)floor(fabs(s->rate) * now->time + 0.5);
    w->first = false;
}

bool dense_events_count(struct check_run *run, const struct dense_start *s, const char *out, struct dense_events *e)
{
    struct table t;
    char path[PATH_LENGTH], why[WHY_LENGTH];
    *e = (struct dense_events){ 0 };
    struct watch watch = { e, calloc(s->count * s->count, sizeof(bool)), true };
    const bool good = watch.touched && dense_snapshots(run, out, s, -1, see, &watch);
    free(watch.touched);
    if (!good)
        return false;
    path_join(path, out, "slipping.csv");
    if (!table_read(path, "step,contacts,slipping", &t, why)) {
        check_garbage(run, why);
        return false;
    }
    for (size_t r = 0; r < t.rows; r++) {
        e->slipping += (size_t)table_at(&t, r, 2);
        e->sticking += (size_t)(table_at(&t, r, 1) - table_at(&t, r, 2));
    }
    table_free(&t);
    return true;
}
