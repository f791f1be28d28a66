/* Reading known.json, and what it does to a verdict. */
#include "known.h"

#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* YYYY-MM-DD of a day that exists; then texts compare as dates do. */
static bool is_date(const char *text)
{
    struct tm day = { 0 }, again;
    char back[16];
    int used = 0;
    if (sscanf(text, "%4d-%2d-%2d%n", &day.tm_year, &day.tm_mon, &day.tm_mday, &used) != 3 || used != 10 || text[10] != '\0')
        return false;
    day.tm_year -= 1900;
    day.tm_mon -= 1;
    day.tm_hour = 12;
    again = day;
    if (mktime(&again) == (time_t)-1)       /* 30 February becomes 2 March, and is seen below */
        return false;
    strftime(back, sizeof back, "%Y-%m-%d", &again);
    return strcmp(back, text) == 0;
}

static bool only_known_keys(json_t *object, const char *const *keys, const char *where, char why[WHY_LENGTH])
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value)
    {
        size_t k = 0;
        while (keys[k] && strcmp(keys[k], key) != 0)
            k++;
        if (!keys[k])
            return why_not(why, "%s: unknown key '%s'", where, key);
        if (strcmp(key, "known") != 0 && !json_is_string(value))
            return why_not(why, "%s: '%s' must be text", where, key);
    }
    return true;
}

static bool names_a_case(const struct suite_of_cases *suite, const char *name)
{
    for (size_t k = 0; k < suite->count; k++)
        if (strcmp(suite->item[k].name, name) == 0)
            return true;
    return false;
}

static bool read_entry(json_t *json, const char *where, const struct suite_of_cases *suite, const char *today,
                       struct known_entry *e, char why[WHY_LENGTH])
{
    static const char *const keys[] = { "case", "quantity", "reason", "expires", NULL };
    if (!json_is_object(json))
        return why_not(why, "%s: is no object", where);
    if (!only_known_keys(json, keys, where, why))
        return false;
    *e = (struct known_entry){ .case_name = json_string_value(json_object_get(json, "case")),
                               .quantity = json_string_value(json_object_get(json, "quantity")),
                               .reason = json_string_value(json_object_get(json, "reason")),
                               .expires = json_string_value(json_object_get(json, "expires")) };
    if (!e->case_name || !e->reason || !*e->reason || !e->expires)
        return why_not(why, "%s: 'case', 'reason' and 'expires' are required", where);
    if (!names_a_case(suite, e->case_name))
        return why_not(why, "%s: there is no case '%s'; see gate list --tier full", where, e->case_name);
    if (!is_date(e->expires))
        return why_not(why, "%s: 'expires' is '%s', not a day written YYYY-MM-DD", where, e->expires);
    e->expired = strcmp(e->expires, today) < 0;
    return true;
}

bool known_load(const char *path, const struct suite_of_cases *suite, const char *today, struct known_list *list,
                char why[WHY_LENGTH])
{
    static const char *const keys[] = { "$schema", "about", "known", NULL };
    json_error_t error;
    size_t k;
    json_t *entry;
    *list = (struct known_list){ .json = json_load_file(path, JSON_REJECT_DUPLICATES, &error) };
    if (!list->json)
        return why_not(why, "%s:%d:%d: %s", path, error.line, error.column, error.text);
    json_t *entries = json_object_get(list->json, "known");
    if (!json_is_array(entries))
        return why_not(why, "%s: must be an object with a list 'known'", path);
    if (!only_known_keys(list->json, keys, path, why))
        return false;
    list->item = calloc(json_array_size(entries) + 1, sizeof *list->item);
    json_array_foreach(entries, k, entry)
    {
        char where[PATH_LENGTH + 32];
        snprintf(where, sizeof where, "%s: known[%zu]", path, k);
        if (!read_entry(entry, where, suite, today, &list->item[list->count++], why))
            return false;
    }
    return true;
}

void known_free(struct known_list *list)
{
    free(list->item);
    json_decref(list->json);
    *list = (struct known_list){ 0 };
}

/* What one entry does to a case: the standing it asks for, COUNTS if none, and a sentence. */
static enum standing apply_entry(const struct known_entry *e, struct finished_case *done, char remark[WHY_LENGTH])
{
    size_t named = 0, passed = 0, wrong = 0;
    for (size_t k = 0; k < done->results.count; k++) {
        struct result *r = &done->results.item[k];
        if (e->quantity && fnmatch(e->quantity, r->what, 0) != 0)
            continue;
        named++;
        passed += r->verdict == VERDICT_PASS;
        wrong += r->verdict >= VERDICT_INCONCLUSIVE;
        if (r->verdict >= VERDICT_INCONCLUSIVE && !e->expired)
            r->accepted = e->reason;
    }
    const char *quantity = e->quantity ? e->quantity : "*";
    if (done->verdict == VERDICT_SKIP)
        return COUNTS;                      /* the candidate was not asked: nothing is known of it */
    if (e->expired)
        return why_not(remark, "known.json accepted '%s' until %s, which is past (%s)", quantity, e->expires, e->reason), EXPIRED;
    if (named == 0) {
        const struct result *worst = results_worst(&done->results);
        return why_not(remark, "known.json accepts '%s', and no quantity of this case is called so; %s '%s'", quantity,
                       done->verdict >= VERDICT_INCONCLUSIVE ? "what is wrong is called" : "one is called", worst ? worst->what : ""), HEALED;
    }
    if (wrong == 0 && passed > 0)
        return why_not(remark, "known.json accepts '%s', and it passes now: take the entry out (it said: %s)", quantity, e->reason),
               HEALED;
    return wrong ? (why_not(remark, "known.json accepts '%s' until %s: %s", quantity, e->expires, e->reason), KNOWN) : COUNTS;
}

void known_settle(const struct known_list *list, struct finished_case *done)
{
    static const int weight[] = { [COUNTS] = 0, [KNOWN] = 1, [HEALED] = 2, [EXPIRED] = 3, [ADVISORY] = 0 };
    for (size_t k = 0; list && k < list->count; k++) {
        char remark[WHY_LENGTH];
        if (strcmp(list->item[k].case_name, done->gate_case->name) != 0)
            continue;
        const enum standing s = apply_entry(&list->item[k], done, remark);
        if (weight[s] <= weight[done->standing])
            continue;
        done->standing = s;
        free(done->remark);
        done->remark = strcpy(malloc(strlen(remark) + 1), remark);
    }
    const enum verdict rest = results_verdict(&done->results);
    if (done->standing == KNOWN && rest >= VERDICT_INCONCLUSIVE)
        done->standing = COUNTS;            /* something is wrong that is not accepted */
    if (done->standing != KNOWN)
        done->verdict = rest;
    if (done->standing == COUNTS && done->gate_case->advisory)
        done->standing = ADVISORY;
}
