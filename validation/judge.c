/*
 * See judge.h. A convention is found by judging the same answers once more, with a scene that says otherwise: if everything then agrees, the
 * candidate has made no mistake but another choice.
 */
#include "judge.h"

#include "offline.h"
#include "precision.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct { const char *key, *path, *value[2]; } open_conventions[] = {
    { "lever", "forces.contact.lever", { "radius", "contact" } },
    { "rotation_correction", "forces.lubrication.rotation_correction", { "none", "exact" } },
};

/* No answer, or one that cannot be read, whatever else agrees. */
static bool some_unanswered(const struct results *r)
{
    for (size_t k = 0; k < r->count; k++)
        if (r->item[k].verdict == VERDICT_FAIL && isnan(r->item[k].error) && isnan(r->item[k].p))
            return true;
    return false;
}

/* Every result that failed must be there again and pass. A p-value has no second sample here: one that would raise an alarm agrees with nothing. */
static bool failures_are_gone(const struct results *before, const struct results *after)
{
    for (size_t k = 0; k < after->count; k++)
        if (!isnan(after->item[k].p) && !(after->item[k].p >= STAGE_ONE_ALARM))
            return false;
    for (size_t k = 0; k < before->count; k++) {
        bool gone = before->item[k].verdict != VERDICT_FAIL;
        for (size_t n = 0; n < after->count && !gone; n++)
            gone = strcmp(after->item[n].what, before->item[k].what) == 0 && after->item[n].verdict == VERDICT_PASS;
        if (!gone)
            return false;
    }
    return results_verdict(after) == VERDICT_PASS;
}

/* Whether the answers that are there agree with this value in the scene. */
static bool agrees_with(const struct check_run *run, const struct check *check, const char *path, const char *value)
{
    struct gate_case other = *run->gate_case;
    struct check_run again = *run;
    other.scene = json_deep_copy(run->gate_case->scene);
    scene_set(other.scene, path, json_string(value));
    again.gate_case = &other;
    again.results = (struct results){ 0 };
    again.replaying = true;
    check->run(&again);
    const bool good = failures_are_gone(&run->results, &again.results);
    results_free(&again.results);
    json_decref(other.scene);
    return good;
}

static void name_convention(struct check_run *run, const char *key, const char *asked, const char *followed)
{
    const struct capabilities *c = run->candidate->capabilities;
    const bool open = c && c->given && !json_object_get(c->model, key);
    for (size_t k = 0; k < run->results.count; k++) {
        struct result *r = &run->results.item[k];
        char text[3 * WHY_LENGTH];
        if (r->verdict != VERDICT_FAIL)
            continue;
        snprintf(text, sizeof text, "everything agrees with %s \"%s\" where the scene asks for \"%s\": another convention, no error in itself; a candidate that "
                 "follows it declares \"model\": { \"%s\": \"%s\" } (docs/adapter.md). Here: %s", key, followed, asked, key, followed, r->sentence);
        free(r->sentence);
        r->sentence = strdup(text);
        if (open)
            r->verdict = VERDICT_SKIP;
    }
}

static void look_for_conventions(struct check_run *run, const struct check *check)
{
    if (run->attempt != 1 || results_verdict(&run->results) != VERDICT_FAIL || some_unanswered(&run->results))
        return;
    for (size_t k = 0; k < sizeof open_conventions / sizeof *open_conventions; k++) {
        const char *asked = json_string_value(scene_get(run->gate_case->scene, open_conventions[k].path));
        if (!asked)
            continue;
        const char *other = open_conventions[k].value[strcmp(asked, open_conventions[k].value[0]) == 0];
        if (agrees_with(run, check, open_conventions[k].path, other)) {
            name_convention(run, open_conventions[k].key, asked, other);
            return;
        }
    }
}

/*
 * Of frozen pairs something is wrong by less than physics would make it: the first sentence says what it may be. Other errors beside it can have the same
 * cause, at gaps so close to the end of a force that rounded positions lie beyond.
 */
static void look_for_few_digits(struct check_run *run)
{
    const struct capabilities *c = run->candidate->capabilities;
    struct result *first = NULL;
    double least = FEW_DIGITS;
    for (size_t k = 0; k < run->results.count; k++) {
        struct result *r = &run->results.item[k];
        if (r->verdict != VERDICT_FAIL || isnan(r->error))
            continue;
        least = r->tolerance < 1e-8 ? fmin(least, r->error) : least;
        if (!first || r->judgement < first->judgement)
            first = r;
    }
    if (run->gate_case->layer != LAYER_PAIR || !first || !(least < FEW_DIGITS))
        return;
    char text[3 * WHY_LENGTH];
    snprintf(text, sizeof text, "an error of only %.1g is among what is wrong: numbers written with few digits (17 keep a double), a constant such as pi, or single "
             "precision%s? Here: %s", least, c && c->roundoff > 0 ? "" : ", which is declared as \"precision\" (docs/adapter.md)", first->sentence);
    free(first->sentence);
    first->sentence = strdup(text);
}

static bool has_needs(struct check_run *run)
{
    const struct capabilities *candidate = run->candidate->capabilities;
    size_t k;
    json_t *word;
    if (run->gate_case->doubles_only && candidate && candidate->roundoff > 0) {
        check_skip(run, "capabilities", "asks for doubles, and the candidate declares %s: %s", candidate->precision, run->gate_case->doubles_only);
        return false;
    }
    json_array_foreach(run->gate_case->needs, k, word)
        if (!capabilities_list(run->candidate->capabilities, json_string_value(word))) {
            check_skip(run, "capabilities", "needs \"%s\", which the candidate does not declare", json_string_value(word));
            return false;
        }
    return true;
}

void judge_case(struct check_run *run, const struct check *check, int p_values, unsigned seed_offset, const char *offline)
{
    const struct gate_case *c = run->gate_case;
    struct gate_case adapted = *c;
    if (!has_needs(run))
        return;
    adapted.scene = json_deep_copy(c->scene);
    capabilities_into_scene(run->candidate->capabilities, adapted.scene);
    adapted.parameters = precision_parameters(run->candidate->capabilities, c->parameters, adapted.scene);
    run->gate_case = &adapted;
    if (offline)
        offline_judge(run, check, p_values, seed_offset, offline);
    else
        check_judge(run, check, p_values, seed_offset);
    look_for_conventions(run, check);
    look_for_few_digits(run);
    run->gate_case = c;
    json_decref(adapted.scene);
    json_decref(adapted.parameters);
}
