/* Running cases in worker processes: one process per case, so that neither a candidate nor a check can take the run down. */
#ifndef RUN_H
#define RUN_H

#include "known.h"

struct run_plan {
    const struct gate_case **gate_case; /* in the order in which they start */
    size_t count;
    const char *work;                   /* absolute folder; each case gets a folder in it */
    struct candidate candidate;         /* `seconds` is set from each case */
    int jobs;
    int p_values;                       /* of the whole suite */
    unsigned seed_offset;
    double patience;                    /* time limits are those of the cases times this */
    int stop_after;                     /* the run ends once so many cases are red; 0: it goes through all */
    const char *keep;                   /* check.h */
    const struct known_list *known;     /* accepted failures; null: none */
    const char *offline;                /* the folder of exported questions, or null: ask the candidate */
};

/* Fills done[] in the order of the plan, calls `completed` as each case ends, and returns how many ended. */
size_t run_all(const struct run_plan *plan, struct finished_case *done, void (*completed)(const struct finished_case *));

#endif
