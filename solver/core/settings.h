/*
 * What a constructor sees of the scene: named values, checked as they are read. It does not know the file format.
 *
 * Every getter raises an error naming the path, the value and the rule, and then returns something harmless, so that a
 * constructor may read all its keys and test the error once. `settings_done` refuses keys that nobody asked for.
 */
#ifndef CORE_SETTINGS_H
#define CORE_SETTINGS_H

#include "core/error.h"
#include "core/vec3.h"

#include <stdint.h>

enum { SETTINGS_KEYS = 24 };

struct settings {
    const void *node;                           /* the object in the file's own representation; NULL: absent */
    char path[160];                             /* "forces.lubrication" */
    const char *asked[SETTINGS_KEYS];           /* the keys that were asked for: the known ones */
    int asked_count;
};

/* The root object of a file, with "path=value" replacements applied. */
bool settings_load(struct settings *root, const char *path, const char *const *set, int set_count, struct error *e);
/* A number for all that the scene says but how long to run and when to write checkpoints. */
uint64_t settings_fingerprint(const struct settings *root);
/* Writes the whole as a file, numbers with 17 digits. */
bool settings_save(const struct settings *root, const char *path, struct error *e);
void settings_unload(struct settings *root);

bool settings_has(struct settings *s, const char *key);
bool settings_is_number(struct settings *s, const char *key);
bool settings_is_text(struct settings *s, const char *key, const char *text);
double settings_number(struct settings *s, const char *key, struct error *e);
double settings_positive(struct settings *s, const char *key, struct error *e);
double settings_at_least(struct settings *s, const char *key, double least, struct error *e);
double settings_number_or(struct settings *s, const char *key, double otherwise, struct error *e);
long long settings_whole(struct settings *s, const char *key, long long least, long long most, struct error *e);
long long settings_whole_or(struct settings *s, const char *key, long long otherwise, long long least, long long most, struct error *e);
bool settings_flag(struct settings *s, const char *key, struct error *e);
bool settings_flag_or(struct settings *s, const char *key, bool otherwise, struct error *e);
const char *settings_text(struct settings *s, const char *key, struct error *e);
int settings_choice(struct settings *s, const char *key, const char *const choices[], struct error *e);
int settings_numbers(struct settings *s, const char *key, double *value, int most, struct error *e);  /* how many, nested lists in order */
void settings_flags(struct settings *s, const char *key, bool *flag, int count, struct error *e);
int settings_length(struct settings *s, const char *key, struct error *e);                           /* of a list */

/* The object under a key, or an item of the list under a key; absent ones have no node. */
struct settings settings_child(struct settings *s, const char *key, struct error *e);
struct settings settings_item(struct settings *s, const char *key, int index, struct error *e);

/* A value of the scene broke a rule that only its reader knows. */
bool settings_refuse(const struct settings *s, const char *key, struct error *e, const char *rule, ...)
    __attribute__((format(printf, 4, 5)));
bool settings_done(const struct settings *s, struct error *e);

#endif
