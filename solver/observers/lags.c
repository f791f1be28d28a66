#include "observers/lags.h"

#include <stdlib.h>
#include <string.h>

bool lags_new(struct lags *l, int levels, int values, struct error *e)
{
    *l = (struct lags){ .levels = levels, .values = values };
    l->ring = calloc((size_t)levels * LAG_WIDTH * (size_t)values + 1, sizeof *l->ring);
    return l->ring || error_out_of_memory(e);
}

int lags_rows(const struct lags *l) { return 1 + LAG_WIDTH + (l->levels - 1) * LAG_WIDTH / 2; }

int64_t lags_of_row(int row)
{
    if (row <= LAG_WIDTH)
        return row;
    const int past = row - LAG_WIDTH - 1, half = LAG_WIDTH / 2;
    return (int64_t)(half + 1 + past % half) << (past / half + 1);
}

void lags_push(struct lags *l, const double *now, lags_visit visit, void *owner)
{
    const size_t size = (size_t)l->values;
    visit(owner, 0, now, now);
    for (int level = 0; level < l->levels && l->taken % (INT64_C(1) << level) == 0; level++) {
        const int64_t number = l->taken >> level;
        double *ring = l->ring + (size_t)level * LAG_WIDTH * size;
        for (int k = level ? LAG_WIDTH / 2 + 1 : 1; k <= LAG_WIDTH && k <= number; k++) {
            const int row = level ? LAG_WIDTH + (level - 1) * LAG_WIDTH / 2 + k - LAG_WIDTH / 2 : k;
            visit(owner, row, ring + (size_t)((number - k) % LAG_WIDTH) * size, now);
        }
        memcpy(ring + (size_t)(number % LAG_WIDTH) * size, now, size * sizeof *now);
    }
    l->taken++;
}

void lags_free(struct lags *l)
{
    free(l->ring);
    l->ring = NULL;
}
