/*
 * Which version of the suite is asked. A case says in `since` from which version on it is binding; a file suite-VERSION.json
 * ("manifest") freezes what a version asks and how strictly, so that a pinned suite cannot change under anybody's feet.
 */
#ifndef VERSIONS_H
#define VERSIONS_H

#include "case.h"

/* The version that the cases of this source tree make up, released or not. */
#define GATE_SUITE "1.0"

struct suite_choice {
    char version[16];
    bool pinned;                /* asked for by --suite: cases that the manifest does not have are advisory */
    bool as_frozen;             /* the binding cases are those of the manifest, to the last number */
    char changed[WHY_LENGTH];   /* otherwise: the first difference, in a sentence */
    char hash[17];              /* over the binding cases: what they ask and how strictly, not their explanations */
};

/* "1.0" and the like; false for anything else. */
bool suite_version_known(const char *text);

/* {"suite": VERSION, "cases": {name: {"hash": .., "tolerance": ..}}}; new reference. Only cases binding in VERSION. */
json_t *suite_manifest(const struct suite_of_cases *suite, const char *version);

/* Whether the cases are those of a manifest; `why` names the case and, where it is one, the tolerance that changed. */
bool suite_fits(const struct suite_of_cases *suite, const json_t *manifest, char why[WHY_LENGTH]);

/*
 * Marks cases as binding or advisory, counts the p-values of the binding ones, and fills `choice`. `asked`: the version of
 * --suite, or null for the cases as they are. False with a sentence: no such suite, or one that has been changed.
 */
bool suite_choose(struct suite_of_cases *suite, const char *suite_dir, const char *asked, struct suite_choice *choice,
                  char why[WHY_LENGTH]);

/* One number for what these cases ask and how strictly, in this order. */
void suite_hash(const struct gate_case *const *gate_case, size_t count, char hash[17]);

/* Writes suite-GATE_SUITE.json: done once when a version is released, `make suite-manifest`. */
bool suite_freeze(const struct suite_of_cases *suite, const char *suite_dir, char why[WHY_LENGTH]);

#endif
