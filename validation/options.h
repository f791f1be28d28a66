/* The command line of `gate`: its options, and which cases they choose. */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "case.h"

enum { EXIT_USAGE = 2 };

extern const char options_help[];

struct options {
    const char *candidate, *layers, *cases, *needs, *report, *work, *table, *suite, *known, *keep, *capabilities, *level;
    const char *folder;         /* of export and judge */
    bool exporting;
    char suite_dir[PATH_LENGTH];
    enum tier tier;
    int jobs, stop_after;
    double patience;
    unsigned seed_offset, seeds;
    bool calibrating;
};

/* Prints "gate: " and the sentence on stderr; returns EXIT_USAGE. */
int usage(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* One option and its value (null: it was not given one). 0, or an exit code after a message. */
int options_parse(struct options *o, const char *name, const char *value);

bool options_want(const struct options *o, const struct gate_case *c);

/*
 * Every name in --layer, --case and --needs must mean something: a typing error must not make an empty run look like a pass. 0, or an exit
 * code after a message.
 */
int options_check(const struct options *o, const struct suite_of_cases *suite);

#endif
