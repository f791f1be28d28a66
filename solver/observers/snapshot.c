#include "observers/snapshot.h"

#include <stdlib.h>
#include <string.h>

static void *copy_of(const void *array, size_t size)
{
    void *copy = malloc(size + 1);
    if (copy)
        memcpy(copy, array, size);
    return copy;
}

bool snapshot_take(struct snapshot *at, const struct suspension *s, double distance, double gap, struct error *e)
{
    const struct particles *from = &s->particles;
    const size_t n = (size_t)from->count;
    bool relisted;
    memset(at, 0, sizeof *at);
    at->box = s->box;
    at->particles = *from;                      /* the search moves places, velocities and images; the rest is shared */
    at->particles.position = copy_of(from->position, n * sizeof *from->position);
    at->particles.velocity = copy_of(from->velocity, n * sizeof *from->velocity);
    at->particles.image = copy_of(from->image, n * sizeof *from->image);
    if (!at->particles.position || !at->particles.velocity || !at->particles.image)
        return error_out_of_memory(e);
    for (int a = 0; a < from->species_count; a++)
        for (int b = 0; b < from->species_count; b++)
            at->search.range[a][b] = fmax(distance, from->kind[a].radius + from->kind[b].radius + gap);
    return neighbours_start(&at->search, &at->particles, e) && neighbours_find(&at->search, &at->box, &at->particles, &relisted, e);
}

void snapshot_free(struct snapshot *at)
{
    free(at->particles.position);
    free(at->particles.velocity);
    free(at->particles.image);
    neighbours_free(&at->search);
}
