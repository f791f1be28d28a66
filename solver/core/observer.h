/*
 * What an observer is: something that looks at the suspension at its own times and never changes it.
 *
 * It is made from the scene without touching a file; `open` comes once the start has been found sound.
 */
#ifndef CORE_OBSERVER_H
#define CORE_OBSERVER_H

#include "core/fields.h"
#include "core/suspension.h"

/* Where a run writes, what it says of itself at the top of each file, and whether it goes on with files that are there. */
struct destination { char folder[400]; char provenance[1500]; bool resuming; };

struct observer {
    int64_t every;                              /* due at every so many steps, step 0 included; 0: at the steps of `at` */
    int64_t *at;                                /* ascending, NULL unless every is 0 */
    int at_count, at_next;
    bool reads_pairs;                           /* needs the near pairs of the moment */
    bool measures;                              /* needs the stress of the evaluation just made */
    bool (*open)(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e);
    bool (*observe)(struct observer *self, const struct suspension *s, struct error *e);
    void (*remember)(struct observer *self, struct fields *f);  /* what a checkpoint must hold of it; NULL: nothing */
    bool (*close)(struct observer *self, struct error *e);      /* flushes and frees; false if anything was not written */
};

#endif
