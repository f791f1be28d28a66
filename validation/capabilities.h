/*
 * What a candidate says it is (docs/adapter.md, "Capabilities"): entry level, precision, physics, conventions. A candidate that says
 * nothing is asked everything.
 */
#ifndef CAPABILITIES_H
#define CAPABILITIES_H

#include "tables.h"

#define CONTRACT "1.0"

enum level { LEVEL_A, LEVEL_B, LEVEL_C };
enum integrator { INTEGRATOR_VERLET, INTEGRATOR_EULER, INTEGRATOR_OTHER };     /* of protocol `steps` */

struct capabilities {
    bool given;                 /* there was a file */
    char path[PATH_LENGTH], name[64], version[64], precision[24];
    enum level level;
    double roundoff;            /* unit roundoff beyond that of a double; 0: double */
    bool run_all;
    json_t *physics;            /* array of words; null: everything */
    json_t *model;              /* object; null: as the scene asks */
    enum integrator integrator;
};

/* Level A, double, everything. */
void capabilities_default(struct capabilities *c);
/* The file beside the program that `command` runs, if there is one: <program>.capabilities.json. */
bool capabilities_beside(const char *command, char path[PATH_LENGTH]);
/* False with file, line or key, value and rule, and the nearest known word. */
bool capabilities_read(const char *path, struct capabilities *c, char why[WHY_LENGTH]);
/*
 * `file`, or the one beside the program of `command` (may be null), or none; then the level to ask at, `level` (may be null), which must be one that the
 * declared one includes.
 */
bool capabilities_choose(const char *file, const char *command, const char *level, struct capabilities *c, char why[WHY_LENGTH]);
void capabilities_free(struct capabilities *c);
bool level_parse(const char *text, enum level *level);
const char *level_letter(enum level level);

/* Whether the candidate has this physics. */
bool capabilities_list(const struct capabilities *c, const char *word);
/*
 * What the candidate lacks for a question: a word of docs/adapter.md, or a model key that the scene sets otherwise than declared. False if it
 * lacks nothing; else the reason in `why`.
 */
bool capabilities_lack(const struct capabilities *c, const char *protocol, const json_t *scene, bool histories, char why[WHY_LENGTH]);
/* The declared conventions put into a scene. */
void capabilities_into_scene(const struct capabilities *c, json_t *scene);

#endif
