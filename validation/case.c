/* Reading the cases of the suite. A wrong case is an error of the suite itself, so everything is checked, tersely. */
#include "case.h"
#include "versions.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const layers[] = { "pair", "noise", "single", "two-bodies", "dilute", "dense", "published" };
static const char *const tiers[] = { "fast", "standard", "full" };
enum { LAYERS = sizeof layers / sizeof *layers, TIERS = sizeof tiers / sizeof *tiers };

const char *layer_name(enum layer layer)
{
    return layers[layer - 1];
}

const char *tier_name(enum tier tier)
{
    return tiers[tier];
}

bool layer_parse(const char *text, enum layer *layer)
{
    for (int k = 0; k < LAYERS; k++)
        if (strcmp(text, layers[k]) == 0 || (text[0] == '1' + k && text[1] == '\0')) {
            *layer = (enum layer)(k + 1);
            return true;
        }
    return false;
}

bool tier_parse(const char *text, enum tier *tier)
{
    for (int k = 0; k < TIERS; k++)
        if (strcmp(text, tiers[k]) == 0) {
            *tier = (enum tier)k;
            return true;
        }
    return false;
}

bool case_lists(const json_t *words, const char *word)
{
    size_t k;
    json_t *item;
    json_array_foreach(words, k, item)
        if (json_is_string(item) && strcmp(json_string_value(item), word) == 0)
            return true;
    return false;
}

static const char *const known_keys[] = { "about", "layer",      "check",     "tier",     "order",   "needs", "flags",
                                          "scene", "parameters", "tolerance", "p_values", "seconds", "seed",  "since", "terms", "double" };

static bool only_known_keys(const struct gate_case *c, char why[WHY_LENGTH])
{
    const char *key;
    json_t *value;
    json_object_foreach(c->json, key, value)
    {
        bool known = false;
        for (size_t k = 0; k < sizeof known_keys / sizeof *known_keys; k++)
            known = known || strcmp(key, known_keys[k]) == 0;
        if (!known)
            return why_not(why, "%s/case.json: unknown key '%s'", c->folder, key);
    }
    return true;
}

static bool required_text(const struct gate_case *c, const char *key, const char **text, char why[WHY_LENGTH])
{
    *text = json_string_value(json_object_get(c->json, key));
    return *text ? true : why_not(why, "%s/case.json: '%s' is missing or no text", c->folder, key);
}

static bool parse_tolerance(struct gate_case *c, char why[WHY_LENGTH])
{
    const json_t *tolerance = json_object_get(c->json, "tolerance");
    c->tolerance = scene_number(tolerance, "value", NAN);
    c->reason = json_string_value(json_object_get(tolerance, "reason"));
    if (tolerance && (!(c->tolerance > 0) || !c->reason))
        return why_not(why, "%s/case.json: 'tolerance' needs a positive 'value' and a 'reason'", c->folder);
    return true;
}

/* {"X_A": ["X_A"], "third law": ["third law*"]}: at least one term, each with at least one pattern. */
static bool parse_terms(struct gate_case *c, char why[WHY_LENGTH])
{
    const char *term;
    json_t *patterns, *pattern;
    size_t k;
    c->terms = json_object_get(c->json, "terms");
    if (!json_is_object(c->terms) || json_object_size(c->terms) == 0)
        return why_not(why, "%s/case.json: 'terms' must say which physics terms the quantities judge", c->folder);
    json_object_foreach(c->terms, term, patterns)
    {
        if (!json_is_array(patterns) || json_array_size(patterns) == 0)
            return why_not(why, "%s/case.json: 'terms.%s' must be a list of patterns for quantities, [\"*\"] for all", c->folder, term);
        json_array_foreach(patterns, k, pattern)
            if (!json_is_string(pattern))
                return why_not(why, "%s/case.json: 'terms.%s' must be a list of words", c->folder, term);
    }
    return true;
}

static bool parse_case(struct gate_case *c, char why[WHY_LENGTH])
{
    const char *layer, *tier;
    if (!json_is_object(c->json))
        return why_not(why, "%s/case.json: is no JSON object", c->folder);
    if (!only_known_keys(c, why) || !required_text(c, "about", &c->about, why) || !required_text(c, "check", &c->check, why)
        || !required_text(c, "layer", &layer, why) || !required_text(c, "tier", &tier, why)
        || !required_text(c, "since", &c->since, why) || !parse_tolerance(c, why))
        return false;
    if (!layer_parse(layer, &c->layer))
        return why_not(why, "%s/case.json: there is no layer '%s'", c->folder, layer);
    if (!tier_parse(tier, &c->tier))
        return why_not(why, "%s/case.json: there is no tier '%s'", c->folder, tier);
    c->needs = json_object_get(c->json, "needs");
    c->flags = json_object_get(c->json, "flags");
    c->scene = json_object_get(c->json, "scene");
    c->parameters = json_object_get(c->json, "parameters");
    if (!json_is_array(c->needs) || !json_is_array(c->flags))
        return why_not(why, "%s/case.json: 'needs' and 'flags' must be lists of words", c->folder);
    const json_t *digits = json_object_get(c->json, "double");
    if (digits && !(c->doubles_only = json_string_value(digits)))
        return why_not(why, "%s/case.json: 'double' must be a text: why fewer digits cannot answer", c->folder);
    if (!suite_version_known(c->since))
        return why_not(why, "%s/case.json: 'since' is '%s', no version of the suite like 1.0", c->folder, c->since);
    if (!parse_terms(c, why))
        return false;
    const json_t *seed = json_object_get(c->json, "seed");
    if (!json_is_integer(seed))
        return why_not(why, "%s/case.json: 'seed' must be a whole number", c->folder);
    c->seed = (unsigned)json_integer_value(seed);
    c->p_values = (int)scene_number(c->json, "p_values", 0);
    c->seconds = scene_number(c->json, "seconds", 60);
    c->order = (int)scene_number(c->json, "order", 50);
    return true;
}

/* nftw has no way to hand a pointer through. */
static struct suite_of_cases *loading;
static char *loading_why;

static int load_one(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status;
    if (kind != FTW_F || strcmp(path + where->base, "case.json") != 0)
        return 0;
    loading->item = realloc(loading->item, (loading->count + 1) * sizeof *loading->item);
    struct gate_case *c = &loading->item[loading->count];
    *c = (struct gate_case){ 0 };
    snprintf(c->folder, sizeof c->folder, "%.*s", where->base - 1, path);
    const char *base = strrchr(c->folder, '/');
    snprintf(c->name, sizeof c->name, "%.95s", base ? base + 1 : c->folder);
    json_error_t error;
    c->json = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    loading->count++;
    if (!c->json)
        return why_not(loading_why, "%s:%d:%d: %s", path, error.line, error.column, error.text), 1;
    return parse_case(c, loading_why) ? 0 : 1;
}

static int by_layer_order_name(const void *a, const void *b)
{
    const struct gate_case *p = a, *q = b;
    if (p->layer != q->layer)
        return (int)p->layer - (int)q->layer;
    return p->order != q->order ? (p->order > q->order) - (p->order < q->order) : strcmp(p->name, q->name);
}

bool cases_load(const char *folder, struct suite_of_cases *suite, char why[WHY_LENGTH])
{
    *suite = (struct suite_of_cases){ 0 };
    loading = suite;
    loading_why = why;
    why[0] = '\0';
    if (nftw(folder, load_one, 16, 0) != 0)
        return why[0] ? false : why_not(why, "cannot read the folder of cases %s", folder);
    if (suite->count == 0)
        return why_not(why, "no case.json below %s", folder);
    qsort(suite->item, suite->count, sizeof *suite->item, by_layer_order_name);
    for (size_t k = 0; k < suite->count; k++)
        for (size_t other = 0; other < k; other++)
            if (strcmp(suite->item[other].name, suite->item[k].name) == 0)
                return why_not(why, "two cases are called '%s'", suite->item[k].name);
    return true;
}

void cases_free(struct suite_of_cases *suite)
{
    for (size_t k = 0; k < suite->count; k++)
        json_decref(suite->item[k].json);
    free(suite->item);
    *suite = (struct suite_of_cases){ 0 };
}
