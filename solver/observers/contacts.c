/*
 * Contact numbers: `contacts.csv`
 *
 *     contacts   2 N_c/N, pairs of negative gap
 *     rattlers   particles that hold no place: fewer than 4 contacts (without friction; 3 in two dimensions) or 2 (with), counted again after each
 *                round of removals until none is left
 *     backbone   contact number among the others
 *     near       2 N_p/N, all pairs within range of some force of the scene
 */
#include "observers/rows.h"

#include <stdlib.h>
#include <string.h>

struct contacts { struct rows rows; };

struct held { int contacts; bool gone; };

static bool contacts_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct rows *o = (struct rows *)self;
    if (!rows_open(o, to, (size_t)s->particles.count * sizeof(struct held), e))
        return false;
    fputs("step,time,contacts,backbone,rattlers,near\n", o->table.file);
    return true;
}

/* Contacts of those that are left; returns their number. */
static int count_contacts(const struct near_pairs *near, struct held *held, int particles)
{
    int found = 0;
    for (int i = 0; i < particles; i++)
        held[i].contacts = 0;
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        if (pair->gap >= 0.0 || held[pair->i].gone || held[pair->j].gone)
            continue;
        held[pair->i].contacts++;
        held[pair->j].contacts++;
        found++;
    }
    return found;
}

static bool contacts_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct rows *o = (struct rows *)self;
    const struct near_pairs *near = &s->neighbours.near;
    const int N = s->particles.count, needed = s->neighbours.keeps_history ? 2 : s->dimensions + 1;
    struct held *held = o->scratch;
    memset(held, 0, (size_t)N * sizeof *held);
    const int all = count_contacts(near, held, N);
    int left = N, found = all;
    for (int before = left + 1; left < before;) {
        before = left;
        for (int i = 0; i < N; i++)
            if (!held[i].gone && held[i].contacts < needed) {
                held[i].gone = true;
                left--;
            }
        found = count_contacts(near, held, N);
    }
    fprintf(rows_begin(o, s), ",%.17g,%.17g,%d,%.17g", 2.0 * all / N, left ? 2.0 * found / left : 0.0, N - left, 2.0 * near->count / N);
    return rows_end(o, e);
}

/* "contacts": { "every": 100 } */
struct observer *contacts_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct contacts *o = rows_new(sizeof *o, "contacts.csv", s, e);
    if (!o)
        return NULL;
    o->rows.base.open = contacts_open;
    o->rows.base.observe = contacts_observe;
    o->rows.base.reads_pairs = true;
    double range = 0.0;                                 /* driven species have none among themselves */
    for (int a = 0; a < of->particles.species_count; a++)
        for (int b = 0; b < of->particles.species_count; b++)
            range = fmax(range, of->neighbours.range[a][b]);
    if (!error_raised(e) && !(range > 0.0))
        settings_refuse(s, "", e, "needs a force between pairs: without one nobody knows who touches");
    return &o->rows.base;
}
