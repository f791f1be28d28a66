/*
 * A candidate is any command that is called as `COMMAND CASE_DIR OUT_DIR` and writes its numbers to OUT_DIR. It is not
 * trusted: it gets its own process group, a time limit and an output limit, and whatever it does the gate goes on.
 */
#ifndef CANDIDATE_H
#define CANDIDATE_H

#include "capabilities.h"

#include <sys/types.h>

struct candidate_server;
struct offline;

struct candidate {
    const char *command;        /* a shell command line */
    double seconds;             /* time limit of one start */
    size_t bytes;               /* limit of what it may write to OUT_DIR */
    const struct capabilities *capabilities;    /* null: everything */
    struct candidate_server *server;            /* one start for all questions; null: one start each */
    struct offline *offline;                    /* the answers are files made elsewhere; null: ask */
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

/* Both folders must exist. Goes to the server if there is one. */
void candidate_run(const struct candidate *c, const char *case_dir, const char *out_dir, struct candidate_answer *answer);

/*
 * A candidate that was started once, as `COMMAND run-all`, and reads lines "CASE_DIR<tab>OUT_DIR". The process that starts it may hand it down to
 * forked ones; one that finds it dead starts another for itself.
 */
struct candidate_server { pid_t pid, owner; int in, out; char log[PATH_LENGTH], pending[512]; size_t held; };
void candidate_server_start(struct candidate_server *s, const struct candidate *c, const char *log);
bool candidate_server_alive(struct candidate_server *s);    /* asked by its owner */
void candidate_server_stop(struct candidate_server *s);     /* by its owner; at once if it does not end by itself */

/* From now on SIGINT, SIGTERM and SIGHUP end this process and the candidate it is running. */
void candidate_stop_with_us(void);

/*
 * Hash of the command line, of the program file behind its first word (found in PATH) and of the files that its other words name (the script of an
 * interpreter), as 16 hex digits. False if there is no such program.
 */
bool candidate_hash(const struct candidate *c, char hex[17]);

/* --- shared by the two ways to start one --- */

double candidate_now(void);                                             /* seconds */
bool candidate_floods(const struct candidate *c, const char *out_dir, const char *log);
void candidate_limits(const struct candidate *c);                       /* in the child: size of files, no core dumps */
void candidate_explain(const struct candidate *c, const char *log, struct candidate_answer *answer);   /* said and message */
bool candidate_failed(const struct candidate_answer *answer);           /* by itself: no limit, no exit 77 */
void candidate_running(pid_t group);                                    /* what to kill where we are stopped; 0: none */
void candidate_ask_server(const struct candidate *c, const char *case_dir, const char *out_dir, struct candidate_answer *answer);

#endif
