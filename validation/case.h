/*
 * A case of the suite: one folder with a case.json that says what is asked, of which physics, how strictly and why.
 * The folder of a case is for people and for the gate; what a candidate sees is written by the check (check.h).
 */
#ifndef CASE_H
#define CASE_H

#include "tables.h"

enum layer { LAYER_PAIR = 1, LAYER_NOISE, LAYER_SINGLE, LAYER_TWO_BODIES, LAYER_DILUTE, LAYER_DENSE, LAYER_PUBLISHED };
enum tier { TIER_FAST, TIER_STANDARD, TIER_FULL };

struct gate_case {
    json_t *json;               /* the whole of case.json */
    char name[96];              /* folder name, unique in the suite */
    char folder[PATH_LENGTH];
    const char *about;          /* one sentence: what is asked */
    const char *check;          /* name of the check function */
    const char *since;          /* version of the suite from which on it is binding */
    bool advisory;              /* newer than the suite that is asked: shown, never red (versions.h) */
    enum layer layer;
    enum tier tier;
    int order;                  /* within its layer: cases that name a term come before those that only see it */
    json_t *needs, *flags;      /* arrays of words */
    json_t *terms;              /* physics term -> list of patterns for the quantities that judge it (terms.json) */
    json_t *scene;              /* scene template; copy before changing: json_deep_copy */
    json_t *parameters;         /* anything the check wants */
    double tolerance;           /* with "reason"; NaN where the case has none */
    const char *reason;
    const char *doubles_only;           /* why candidates of declared fewer digits are not asked; or null */
    unsigned seed;
    int p_values;               /* how many statistical results the case gives at most; 0: deterministic */
    double seconds;             /* time limit of one start of the candidate; default 60 */
};

struct suite_of_cases { struct gate_case *item; size_t count; int p_values; /* of the binding cases */ };

const char *layer_name(enum layer layer);
bool layer_parse(const char *text, enum layer *layer);  /* "1" or "pair" */
bool tier_parse(const char *text, enum tier *tier);
const char *tier_name(enum tier tier);
bool case_lists(const json_t *words, const char *word);

/* Reads every case.json below `folder`, sorted by layer, order, name; any error in any case is an error of the suite. */
bool cases_load(const char *folder, struct suite_of_cases *suite, char why[WHY_LENGTH]);
void cases_free(struct suite_of_cases *suite);

#endif
