/*
 * A candidate is any command that is called as `COMMAND CASE_DIR OUT_DIR` and writes its numbers to OUT_DIR. It is not
 * trusted: it gets its own process group, a time limit and an output limit, and whatever it does the gate goes on.
 */
#ifndef CANDIDATE_H
#define CANDIDATE_H

#include "tables.h"

struct candidate {
    const char *command;        /* a shell command line */
    double seconds;             /* time limit of one start */
    size_t bytes;               /* limit of what it may write to OUT_DIR */
};

enum candidate_outcome {
    CANDIDATE_OK,
    CANDIDATE_UNSUPPORTED,      /* exit code 77: it does not have the physics asked for */
    CANDIDATE_FAILED,           /* any other exit code */
    CANDIDATE_CRASHED,          /* killed by a signal of its own making */
    CANDIDATE_HUNG,             /* killed by us at the time limit */
    CANDIDATE_FLOODED           /* killed by us at the output limit */
};

struct candidate_answer {
    enum candidate_outcome outcome;
    int detail;                 /* exit code or signal */
    double seconds;             /* wall time */
    char said[2048];            /* the end of its stdout and stderr */
    char message[WHY_LENGTH];   /* one sentence: what became of it */
};

/* Both folders must exist. */
void candidate_run(const struct candidate *c, const char *case_dir, const char *out_dir, struct candidate_answer *answer);

/* From now on SIGINT, SIGTERM and SIGHUP end this process and the candidate it is running. */
void candidate_stop_with_us(void);

/*
 * Hash of the command line and of the program file behind its first word (found in PATH), as 16 hex digits. False if
 * there is no such program.
 */
bool candidate_hash(const struct candidate *c, char hex[17]);

#endif
