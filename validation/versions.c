/*
 * Pinning a suite. The manifest holds a hash for each case of what decides a verdict: check, scene, parameters, tolerance,
 * seeds. Explanations (`about`, `flags`, `terms`, a tolerance's reason, the order of asking) may improve after a release and
 * are left out; numbers are hashed as the numbers they are, so that 1e-10 and 1.0E-10 are the same tolerance.
 */
#include "versions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* "1.0" as 1 and 0. */
static bool parse_version(const char *text, int number[2])
{
    char again[32];
    if (sscanf(text, "%d.%d", &number[0], &number[1]) != 2 || number[0] < 0 || number[1] < 0)
        return false;
    snprintf(again, sizeof again, "%d.%d", number[0], number[1]);
    return strcmp(again, text) == 0;
}

bool suite_version_known(const char *text)
{
    int number[2];
    return parse_version(text, number);
}

/* Whether version a is not after version b. */
static bool not_after(const char *a, const char *b)
{
    int p[2], q[2];
    return parse_version(a, p) && parse_version(b, q) && (p[0] != q[0] ? p[0] < q[0] : p[1] <= q[1]);
}

static void case_hash(const struct gate_case *c, char hex[17])
{
    static const char *const explanations[] = { "about", "flags", "terms", "order" };
    json_t *judged = json_deep_copy(c->json);
    for (size_t k = 0; k < sizeof explanations / sizeof *explanations; k++)
        json_object_del(judged, explanations[k]);
    json_object_del(json_object_get(judged, "tolerance"), "reason");
    char *text = json_dumps(judged, JSON_SORT_KEYS | JSON_COMPACT | JSON_REAL_PRECISION(17));
    uint64_t hash = HASH_START;
    for (const char *at = text; at && *at; at++)
        hash = (hash ^ (unsigned char)*at) * UINT64_C(1099511628211);
    snprintf(hex, 17, "%016llx", (unsigned long long)hash);
    free(text);
    json_decref(judged);
}

json_t *suite_manifest(const struct suite_of_cases *suite, const char *version)
{
    json_t *cases = json_object();
    for (size_t k = 0; k < suite->count; k++) {
        const struct gate_case *c = &suite->item[k];
        char hex[17];
        if (!not_after(c->since, version))
            continue;
        case_hash(c, hex);
        json_object_set_new(cases, c->name, isnan(c->tolerance) ? json_pack("{ss}", "hash", hex)
                                                                : json_pack("{ss sf}", "hash", hex, "tolerance", c->tolerance));
    }
    return json_pack("{ss so}", "suite", version, "cases", cases);
}

static const struct gate_case *find_case(const struct suite_of_cases *suite, const char *name)
{
    for (size_t k = 0; k < suite->count; k++)
        if (strcmp(suite->item[k].name, name) == 0)
            return &suite->item[k];
    return NULL;
}

bool suite_fits(const struct suite_of_cases *suite, const json_t *manifest, char why[WHY_LENGTH])
{
    const char *name, *version = json_string_value(json_object_get(manifest, "suite"));
    json_t *frozen, *cases = json_object_get(manifest, "cases");
    if (!version || !json_is_object(cases))
        return why_not(why, "the manifest has no 'suite' or no 'cases'");
    json_object_foreach(cases, name, frozen)
    {
        const struct gate_case *c = find_case(suite, name);
        char hex[17];
        const char *was = json_string_value(json_object_get(frozen, "hash"));
        const double tolerance = scene_number(frozen, "tolerance", NAN);
        if (!c)
            return why_not(why, "case '%s' of suite %s is not here any more", name, version);
        case_hash(c, hex);
        if (was && strcmp(was, hex) == 0)
            continue;
        if (c->tolerance != tolerance && !(isnan(c->tolerance) && isnan(tolerance)))
            return why_not(why, "case '%s' has the tolerance %g; in suite %s it is %g", name, c->tolerance, version, tolerance);
        return why_not(why, "case '%s' does not ask what it asks in suite %s", name, version);
    }
    for (size_t k = 0; k < suite->count; k++)
        if (not_after(suite->item[k].since, version) && !json_object_get(cases, suite->item[k].name))
            return why_not(why, "case '%s' says since %s, but suite %s was frozen without it", suite->item[k].name,
                           suite->item[k].since, version);
    return true;
}

static void manifest_path(char path[PATH_LENGTH], const char *suite_dir, const char *version)
{
    char name[64];
    snprintf(name, sizeof name, "suite-%s.json", version);
    path_join(path, suite_dir, name);
}

void suite_hash(const struct gate_case *const *gate_case, size_t count, char hash[17])
{
    uint64_t all = HASH_START;
    for (size_t k = 0; k < count; k++) {
        char text[128];
        snprintf(text, sizeof text, "%.95s ", gate_case[k]->name);
        case_hash(gate_case[k], text + strlen(text));
        for (const char *at = text; *at; at++)
            all = (all ^ (unsigned char)*at) * UINT64_C(1099511628211);
    }
    snprintf(hash, 17, "%016llx", (unsigned long long)all);
}

/* One number for everything that decides a verdict of the suite asked. */
static void hash_binding(const struct suite_of_cases *suite, char hash[17])
{
    const struct gate_case **binding = malloc((suite->count + 1) * sizeof *binding);
    size_t count = 0;
    for (size_t k = 0; k < suite->count; k++)
        if (!suite->item[k].advisory)
            binding[count++] = &suite->item[k];
    suite_hash(binding, count, hash);
    free(binding);
}

bool suite_choose(struct suite_of_cases *suite, const char *suite_dir, const char *asked, struct suite_choice *choice,
                  char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    json_error_t where;
    *choice = (struct suite_choice){ .pinned = asked != NULL };
    if (asked && !suite_version_known(asked))
        return why_not(why, "--suite '%s' is no version; say for example %s", asked, GATE_SUITE);
    snprintf(choice->version, sizeof choice->version, "%.15s", asked ? asked : GATE_SUITE);
    manifest_path(path, suite_dir, choice->version);
    json_t *manifest = json_load_file(path, 0, &where);
    if (asked && !manifest)
        return access(path, R_OK) == 0 ? why_not(why, "%s:%d:%d: %s", path, where.line, where.column, where.text)
                                       : why_not(why, "there is no suite %s: no file %s", asked, path);
    choice->as_frozen = manifest && suite_fits(suite, manifest, choice->changed);
    if (!manifest)
        why_not(choice->changed, "it was never frozen");
    suite->p_values = 0;
    for (size_t k = 0; k < suite->count; k++) {
        struct gate_case *c = &suite->item[k];
        c->advisory = asked ? !json_object_get(json_object_get(manifest, "cases"), c->name) : !not_after(c->since, GATE_SUITE);
        suite->p_values += c->advisory ? 0 : c->p_values;
    }
    hash_binding(suite, choice->hash);
    json_decref(manifest);
    if (asked && !choice->as_frozen)
        return why_not(why, "these are not the cases of suite %s: %s", asked, choice->changed);
    return true;
}

bool suite_freeze(const struct suite_of_cases *suite, const char *suite_dir, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    manifest_path(path, suite_dir, GATE_SUITE);
    json_t *manifest = suite_manifest(suite, GATE_SUITE);
    const bool good = json_dump_file(manifest, path, JSON_INDENT(1) | JSON_SORT_KEYS | JSON_REAL_PRECISION(17)) == 0;
    json_decref(manifest);
    return good ? true : why_not(why, "cannot write %s", path);
}
