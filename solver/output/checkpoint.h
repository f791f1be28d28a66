/*
 * Checkpoints: a run that was stopped, by Ctrl-C, by the clock or by force, goes on bit for bit as if it never had been.
 *
 * `checkpoint.bin` holds all that the next step depends on. That is more than positions and velocities: the order
 * in which pair forces are summed is the order of the list of candidates, so the list itself is kept, with the time and
 * positions it was made at; and the sums that observers carry. Random numbers need nothing: they are a function of the step.
 * Tables are not copied; their lengths are kept, and what a run has written since is cut off.
 *
 * File: magic, version, byte order, fingerprint of the scene (its values without `run` and `output.checkpoint`), then for
 * each row of the table of fields its name, its size and its bytes; last the CRC-32 of everything before (ISO 3309).
 * It is written to a temporary name and renamed, so that at any moment there is one whole checkpoint or none.
 */
#ifndef OUTPUT_CHECKPOINT_H
#define OUTPUT_CHECKPOINT_H

#include "core/observer.h"

struct checkpoint {
    int64_t every;                              /* steps; 0: only when interrupted */
    uint64_t fingerprint;
    const struct destination *to;
    struct suspension *of;
    struct observer *const *observer;
    const int *observer_count;
    unsigned char *read;                        /* a checkpoint found sound, before it is put in place */
    size_t read_size;
};

/* From now on SIGINT, SIGTERM and SIGUSR1 (a queue's warning) let the step be finished, a checkpoint be written, and the run end with ERROR_INTERRUPTED. */
void checkpoint_watch(void);

bool checkpoint_wanted(void);       /* somebody wants the run to stop */

/* Reads and checks `checkpoint.bin` if the run is a resumed one; changes nothing else. */
bool checkpoint_read(struct checkpoint *c, struct error *e);
/* Puts what was read in place of the start; the observers are open. */
bool checkpoint_apply(struct checkpoint *c, struct error *e);
/* Writes one if it is due, if the run has come to its end, or if somebody wants it to stop (then an error says so). */
bool checkpoint_keep(struct checkpoint *c, bool last, struct error *e);
void checkpoint_free(struct checkpoint *c);

#endif
