#include "core/history.h"

#include <stdlib.h>

static int by_pair(const void *left, const void *right)
{
    const struct candidate *a = left, *b = right;
    return a->i != b->i ? (a->i > b->i) - (a->i < b->i)
         : a->j != b->j ? (a->j > b->j) - (a->j < b->j) : (a->image > b->image) - (a->image < b->image);
}

struct remembered *history_remember(const struct neighbours *n, int *kept, struct error *e)
{
    struct remembered *old = malloc(((size_t)n->count + 1) * sizeof *old);
    *kept = 0;
    for (int k = 0; old && n->made && k < n->count; k++)
        if (dot(n->history[k], n->history[k]) > 0.0)
            old[(*kept)++] = (struct remembered){ n->candidate[k], n->history[k] };
    if (old)
        qsort(old, (size_t)*kept, sizeof *old, by_pair);
    else
        error_out_of_memory(e);
    return old;
}

void history_recall(struct neighbours *n, const struct remembered *old, int kept, struct error *e)
{
    vec3 *fresh = realloc(n->history, ((size_t)n->room + 1) * sizeof *fresh);
    if (!fresh) {
        error_out_of_memory(e);
        return;
    }
    n->history = fresh;
    for (int k = 0; k < n->count; k++) {
        const struct remembered *found = bsearch(&n->candidate[k], old, (size_t)kept, sizeof *old, by_pair);
        n->history[k] = found ? found->history : vec(0, 0, 0);
    }
}
