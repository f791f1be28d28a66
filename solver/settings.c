/* The scene's values out of JSON (jansson): see core/settings.h for the manners. */
#include "core/settings.h"

#include <jansson.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *look_up(struct settings *s, const char *key)
{
    bool known = false;
    for (int k = 0; k < s->asked_count; k++)
        known = known || strcmp(s->asked[k], key) == 0;
    if (!known && s->asked_count < SETTINGS_KEYS)
        s->asked[s->asked_count++] = key;
    return json_object_get(s->node, key);
}

bool settings_is_number(struct settings *s, const char *key) { return json_is_number(look_up(s, key)); }

bool settings_is_text(struct settings *s, const char *key, const char *text)
{
    const json_t *value = look_up(s, key);
    return json_is_string(value) && strcmp(json_string_value(value), text) == 0;
}

static void path_of(const struct settings *s, const char *key, char path[224])
{
    snprintf(path, 224, "%s%s%s", s->path, *s->path && *key ? "." : "", key);
}

/* "forces.drag.torque is 3; it must be ..." */
static bool refuse_value(const struct settings *s, const char *key, const json_t *value, struct error *e, const char *rule)
{
    char path[224];
    path_of(s, key, path);
    if (!value)
        return error_raise(e, ERROR_INPUT, "%s is missing; it must be %s", path, rule);
    char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(9));
    error_raise(e, ERROR_INPUT, "%s is %.60s; it must be %s", path, text ? text : "?", rule);
    free(text);
    return false;
}

bool settings_refuse(const struct settings *s, const char *key, struct error *e, const char *rule, ...)
{
    char path[224], text[300];
    va_list arguments;
    va_start(arguments, rule);
    vsnprintf(text, sizeof text, rule, arguments);
    va_end(arguments);
    path_of(s, key, path);
    json_t *value = *key ? json_object_get(s->node, key) : NULL;
    char *shown = value ? json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(9)) : NULL;
    if (shown)
        error_raise(e, ERROR_INPUT, "%s is %.60s; it %s", path, shown, text);
    else
        error_raise(e, ERROR_INPUT, "%s %s", path, text);
    free(shown);
    return false;
}

bool settings_has(struct settings *s, const char *key) { return look_up(s, key) != NULL; }

double settings_number(struct settings *s, const char *key, struct error *e)
{
    const json_t *value = look_up(s, key);
    if (!json_is_number(value))
        return refuse_value(s, key, value, e, "a number"), 0.0;
    return json_number_value(value);
}

double settings_positive(struct settings *s, const char *key, struct error *e)
{
    const double value = settings_number(s, key, e);
    if (!error_raised(e) && !(value > 0.0))
        refuse_value(s, key, look_up(s, key), e, "above 0");
    return value;
}

double settings_at_least(struct settings *s, const char *key, double least, struct error *e)
{
    const double value = settings_number(s, key, e);
    if (!error_raised(e) && !(value >= least))
        settings_refuse(s, key, e, "must be at least %g", least);
    return value;
}

double settings_number_or(struct settings *s, const char *key, double otherwise, struct error *e)
{
    return look_up(s, key) ? settings_number(s, key, e) : otherwise;
}

long long settings_whole(struct settings *s, const char *key, long long least, long long most, struct error *e)
{
    const json_t *value = look_up(s, key);
    char rule[80];
    snprintf(rule, sizeof rule, "a whole number from %lld to %lld", least, most);
    if (!json_is_integer(value) || json_integer_value(value) < least || json_integer_value(value) > most)
        return refuse_value(s, key, value, e, rule), least;
    return json_integer_value(value);
}

long long settings_whole_or(struct settings *s, const char *key, long long otherwise, long long least, long long most, struct error *e)
{
    return look_up(s, key) ? settings_whole(s, key, least, most, e) : otherwise;
}

bool settings_flag(struct settings *s, const char *key, struct error *e)
{
    const json_t *value = look_up(s, key);
    if (!json_is_boolean(value))
        return refuse_value(s, key, value, e, "true or false");
    return json_is_true(value);
}

bool settings_flag_or(struct settings *s, const char *key, bool otherwise, struct error *e)
{
    return look_up(s, key) ? settings_flag(s, key, e) : otherwise;
}

const char *settings_text(struct settings *s, const char *key, struct error *e)
{
    const json_t *value = look_up(s, key);
    if (!json_is_string(value) || !*json_string_value(value))
        return refuse_value(s, key, value, e, "a text"), "";
    return json_string_value(value);
}

int settings_choice(struct settings *s, const char *key, const char *const choices[], struct error *e)
{
    const json_t *value = look_up(s, key);
    char rule[200] = "one of";
    for (int k = 0; choices[k]; k++) {
        if (json_is_string(value) && strcmp(json_string_value(value), choices[k]) == 0)
            return k;
        snprintf(rule + strlen(rule), sizeof rule - strlen(rule), "%s \"%s\"", k ? "," : "", choices[k]);
    }
    return refuse_value(s, key, value, e, rule), 0;
}

int settings_length(struct settings *s, const char *key, struct error *e)
{
    const json_t *value = look_up(s, key);
    if (!json_is_array(value))
        return refuse_value(s, key, value, e, "a list"), 0;
    return (int)json_array_size(value);
}

/* Numbers of a list, and of lists in it, in order. */
static int flatten(const json_t *list, double *numbers, int most)
{
    int found = 0;
    size_t k;
    const json_t *item;
    json_array_foreach(list, k, item) {
        if (json_is_number(item) && found < most)
            numbers[found++] = json_number_value(item);
        else if (json_is_array(item) && found <= most) {
            const int more = flatten(item, numbers + found, most - found);
            found = more < 0 ? most + 1 : found + more;
        } else
            return -1;
    }
    return found;
}

int settings_numbers(struct settings *s, const char *key, double *numbers, int most, struct error *e)
{
    const int found = settings_length(s, key, e) > 0 ? flatten(look_up(s, key), numbers, most) : 0;
    if (found < 0 || found > most) {
        settings_refuse(s, key, e, "must be a list of at most %d numbers", most);
        return 0;
    }
    return found;
}

void settings_flags(struct settings *s, const char *key, bool *flag, int count, struct error *e)
{
    const json_t *list = look_up(s, key);
    for (int k = 0; k < count; k++) {
        const json_t *item = json_array_get(list, (size_t)k);
        if (json_array_size(list) != (size_t)count || !json_is_boolean(item)) {
            settings_refuse(s, key, e, "must be a list of %d times true or false", count);
            return;
        }
        flag[k] = json_is_true(item);
    }
}

struct settings settings_child(struct settings *s, const char *key, struct error *e)
{
    const json_t *value = look_up(s, key);
    struct settings child = { .node = json_is_object(value) ? value : NULL };
    char path[224];
    path_of(s, key, path);
    snprintf(child.path, sizeof child.path, "%.150s", path);
    if (value && !child.node)
        refuse_value(s, key, value, e, "an object");
    return child;
}

struct settings settings_item(struct settings *s, const char *key, int index, struct error *e)
{
    const json_t *value = json_array_get(look_up(s, key), (size_t)index);
    struct settings item = { .node = json_is_object(value) ? value : NULL };
    char path[224];
    path_of(s, key, path);
    snprintf(item.path, sizeof item.path, "%.140s[%d]", path, index);
    if (!item.node)
        error_raise(e, ERROR_INPUT, "%s must be an object", item.path);
    return item;
}

/* Number of letters to change, add or drop to make one word the other (Levenshtein 1966). */
static int distance_between(const char *a, const char *b)
{
    int row[64];
    const int length = (int)strlen(b) < 63 ? (int)strlen(b) : 63;
    for (int k = 0; k <= length; k++)
        row[k] = k;
    for (int r = 1; *a; a++, r++) {
        int diagonal = row[0];
        row[0] = r;
        for (int k = 1; k <= length; k++) {
            const int change = diagonal + (*a != b[k - 1]), drop = 1 + (row[k] < row[k - 1] ? row[k] : row[k - 1]);
            diagonal = row[k];
            row[k] = change < drop ? change : drop;
        }
    }
    return row[length];
}

bool settings_done(const struct settings *s, struct error *e)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)s->node, key, value) {
        const char *nearest = NULL;
        int least = 1000;
        for (int k = 0; k < s->asked_count && least > 0; k++) {
            const int d = distance_between(key, s->asked[k]);
            if (d < least) {
                least = d;
                nearest = s->asked[k];
            }
        }
        if (least > 0)
            return error_raise(e, ERROR_INPUT, "%s%s%.80s is not a known key%s%s%s", s->path, *s->path ? "." : "", key,
                               nearest ? "; the nearest is \"" : "", nearest ? nearest : "", nearest ? "\"" : "");
    }
    return !error_raised(e);
}

/* ---- the file, and values given on the command line ---- */

/* Puts `value` (JSON, or else a text) at a dotted path with [index] parts. */
static bool set_value(json_t *root, const char *assignment, struct error *e)
{
    char path[256];
    const char *equals = strchr(assignment, '=');
    if (!equals || equals == assignment || equals - assignment >= (long)sizeof path)
        return error_raise(e, ERROR_INPUT, "--set %.80s: must be path=value, such as fluid.kT=0.017", assignment);
    snprintf(path, sizeof path, "%.*s", (int)(equals - assignment), assignment);
    json_t *value = json_loads(equals + 1, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, NULL), *at = root;
    if (!value)
        value = json_string(equals + 1);
    char *rest = path, *part = strtok_r(rest, ".[]", &rest);
    while (part && at) {
        char *next = strtok_r(rest, ".[]", &rest);
        if (json_is_array(at)) {
            const size_t index = (size_t)strtoul(part, NULL, 10);
            if (index >= json_array_size(at) || strspn(part, "0123456789") != strlen(part))
                break;
            if (!next && json_array_set(at, index, value) == 0)
                return json_decref(value), true;
            at = json_array_get(at, index);
        } else if (json_is_object(at)) {
            if (!next && json_object_set(at, part, value) == 0)
                return json_decref(value), true;
            if (!json_object_get(at, part))
                json_object_set_new(at, part, json_object());
            at = json_object_get(at, part);
        } else
            break;
        part = next;
    }
    json_decref(value);
    return error_raise(e, ERROR_INPUT, "--set %.80s: the scene has no such place", assignment);
}

bool settings_load(struct settings *root, const char *path, const char *const *set, int set_count, struct error *e)
{
    json_error_t where;
    json_t *node = json_load_file(path, JSON_REJECT_DUPLICATES, &where);
    *root = (struct settings){ .node = node };
    if (!node && where.line < 1)
        return error_raise(e, ERROR_INPUT, "%s cannot be read: %s", path, where.text);
    if (!node)
        return error_raise(e, ERROR_INPUT, "%s:%d:%d: %s", path, where.line, where.column, where.text);
    if (!json_is_object(node))
        error_raise(e, ERROR_INPUT, "%s: must be one JSON object", path);
    for (int k = 0; k < set_count && !error_raised(e); k++)
        set_value(node, set[k], e);
    if (error_raised(e))
        settings_unload(root);
    return !error_raised(e);
}

bool settings_save(const struct settings *root, const char *path, struct error *e)
{
    if (json_dump_file(root->node, path, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) != 0)
        return error_raise(e, ERROR_RUN, "%s cannot be written", path);
    return true;
}

void settings_unload(struct settings *root)
{
    json_decref((json_t *)(uintptr_t)root->node);
    root->node = NULL;
}

/* Of the text with sorted keys and 17 digits: FNV-1a, 64 bits (Fowler, Noll & Vo 1991). */
uint64_t settings_fingerprint(const struct settings *root)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    json_t *rest = json_deep_copy((json_t *)(uintptr_t)root->node);
    json_object_del(rest, "run");
    json_object_del(json_object_get(rest, "output"), "checkpoint");
    char *text = json_dumps(rest, JSON_SORT_KEYS | JSON_COMPACT | JSON_REAL_PRECISION(17));
    for (const char *c = text; c && *c; c++)
        hash = (hash ^ (unsigned char)*c) * UINT64_C(1099511628211);
    free(text);
    json_decref(rest);
    return hash;
}
