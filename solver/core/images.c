#include "core/images.h"

#include <stdlib.h>

/* A vector of n_k cells along edge k is at least |n_k| widths long, whatever the lean: that bounds the search. The edges alone will not do. */
bool images_meet(const struct box *b, double distance)
{
    int most[3];
    for (int k = 0; k < 3; k++)
        most[k] = b->periodic[k] ? (int)fmin(distance / box_width(b, k), 2.0 * MOST_IMAGES) : 0;
    for (int x = -most[0]; x <= most[0]; x++)
        for (int y = -most[1]; y <= most[1]; y++)
            for (int z = -most[2]; z <= most[2]; z++)
                if ((x || y || z) && norm(box_offset(b, (const int[3]){ x, y, z })) < distance)
                    return true;
    return false;
}
