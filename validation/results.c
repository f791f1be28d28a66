/* Results as JSON: how a worker process hands them to the gate, and what stays in the work folder for other tools. */
#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Finite numbers as numbers, others as words (JSON has no NaN). */
static json_t *number(double x)
{
    return isfinite(x) ? json_real(x) : json_string(isnan(x) ? "nan" : x > 0 ? "inf" : "-inf");
}

static double as_number(const json_t *j)
{
    if (json_is_number(j))
        return json_number_value(j);
    const char *word = json_string_value(j);
    return word && strcmp(word, "inf") == 0 ? INFINITY : word && strcmp(word, "-inf") == 0 ? -INFINITY : NAN;
}

static json_t *text(const char *t)
{
    json_t *j = t ? json_string(t) : NULL;
    return j ? j : t ? json_string("(text with broken characters)") : json_null();
}

static char *as_text(const json_t *j)
{
    const char *t = json_string_value(j);
    return t ? strcpy(malloc(strlen(t) + 1), t) : NULL;
}

json_t *results_to_json(const struct results *r)
{
    json_t *all = json_array();
    for (size_t k = 0; k < r->count; k++) {
        const struct result *i = &r->item[k];
        json_array_append_new(all, json_pack("{so si so so so so so so so so ss so so so}", "what", text(i->what), "judgement",
                                             (int)i->judgement, "measured", number(i->measured), "expected",
                                             number(i->expected), "error", number(i->error), "tolerance",
                                             number(i->tolerance), "p", number(i->p), "first_p", number(i->first_p), "resolution", number(i->resolution),
                                             "declared", number(i->declared), "verdict", verdict_word(i->verdict), "sentence",
                                             text(i->sentence), "picture", text(i->picture), "notes", text(i->notes)));
    }
    return all;
}

static enum verdict as_verdict(const json_t *j)
{
    for (enum verdict v = VERDICT_PASS; v < VERDICT_FAIL; v++)
        if (json_is_string(j) && strcmp(json_string_value(j), verdict_word(v)) == 0)
            return v;
    return VERDICT_FAIL;
}

bool results_from_json(const json_t *j, struct results *r)
{
    *r = (struct results){ 0 };
    if (!json_is_array(j))
        return false;
    r->item = calloc(json_array_size(j) + 1, sizeof *r->item);
    size_t k;
    json_t *i;
    json_array_foreach(j, k, i)
    {
        char *what = as_text(json_object_get(i, "what"));
        r->item[r->count++] = (struct result){
            .what = what ? what : calloc(1, 1),
            .judgement = (enum judgement)json_integer_value(json_object_get(i, "judgement")),
            .measured = as_number(json_object_get(i, "measured")),
            .expected = as_number(json_object_get(i, "expected")),
            .error = as_number(json_object_get(i, "error")),
            .tolerance = as_number(json_object_get(i, "tolerance")),
            .p = as_number(json_object_get(i, "p")),
            .first_p = as_number(json_object_get(i, "first_p")),
            .resolution = as_number(json_object_get(i, "resolution")),
            .declared = as_number(json_object_get(i, "declared")),
            .verdict = as_verdict(json_object_get(i, "verdict")),
            .sentence = as_text(json_object_get(i, "sentence")),
            .picture = as_text(json_object_get(i, "picture")),
            .notes = as_text(json_object_get(i, "notes")),
        };
    }
    return true;
}
