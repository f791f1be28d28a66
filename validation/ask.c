/* Asking the candidate: writes the case folder of docs/formats.md, starts it, and records whatever is not an answer. */
#include "check.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static bool write_json(const json_t *json, const char *folder, const char *name, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    path_join(path, folder, name);
    if (json_dump_file(json, path, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) != 0)
        return why_not(why, "cannot write %s", path);
    return true;
}

static bool write_case(const struct check_run *run, const char *name, const struct question *q, const char *folder,
                       char why[WHY_LENGTH])
{
    const struct gate_case *c = run->gate_case;
    char full[256], path[PATH_LENGTH];
    snprintf(full, sizeof full, "%s/%s", c->name, name);
    json_t *json = json_pack("{ss ss ss ss ss sO}", "suite", "1.0", "name", full, "about", c->about, "protocol", q->protocol,
                             "scene", "scene.json", "needs", c->needs);
    if (q->draws)
        json_object_set_new(json, "draws", json_integer((json_int_t)q->draws));
    if (q->pause)
        json_object_set_new(json, "pause", json_integer(q->pause));
    bool good = true;
    if (q->states) {
        json_object_set_new(json, "states", json_string("states.csv"));
        path_join(path, folder, "states.csv");
        good = states_write(path, q->state, q->states, why);
    }
    if (good && q->contacts) {
        json_object_set_new(json, "contacts", json_string("contacts.csv"));
        path_join(path, folder, "contacts.csv");
        good = contacts_write(path, q->contact, q->contacts, why);
    }
    if (!json_object_get(q->scene, "about"))
        json_object_set_new(q->scene, "about", json_string(c->about));
    good = good && write_json(q->scene, folder, "scene.json", why) && write_json(json, folder, "case.json", why);
    json_decref(json);
    return good;
}

bool check_ask(struct check_run *run, const char *name, const struct question *q, char out[PATH_LENGTH])
{
    char question[128], ask[PATH_LENGTH], folder[PATH_LENGTH], why[WHY_LENGTH];
    snprintf(question, sizeof question, "%s%s", name, run->attempt > 1 ? "-rerun" : "");
    for (char *c = question; *c; c++) /* an adapter that forgets to quote its arguments should still work */
        *c = isalnum((unsigned char)*c) || *c == '.' ? *c : '-';
    path_join(ask, run->work, question);
    path_join(folder, ask, "case");
    path_join(out, ask, "out");
    if (!folder_make(folder, why) || !folder_make(out, why) || !write_case(run, name, q, folder, why)) {
        check_error(run, INVARIANT, "case folder", NAN, NAN, NAN, NAN, "the gate itself failed: %s", why);
        return false;
    }
    struct candidate_answer answer;
    candidate_run(run->candidate, folder, out, &answer);
    run->candidate_seconds += answer.seconds;
    if (answer.outcome == CANDIDATE_OK)
        return true;
    struct result *r;
    if (answer.outcome == CANDIDATE_UNSUPPORTED)
        r = check_skip(run, name, "%s: %s", name, answer.message);
    else
        r = check_error(run, INVARIANT, name, NAN, NAN, NAN, NAN, "%s: %s", name, answer.message);
    if (answer.said[0])
        result_notes(r, "It said: %s", answer.said);
    return false;
}

/* A small file that the gate's main process reads; its loss would not matter. */
void check_progress(struct check_run *run, const char *format, ...)
{
    char path[PATH_LENGTH];
    path_join(path, run->work, "progress");
    FILE *file = fopen(path, "w");
    if (!file)
        return;
    va_list arguments;
    va_start(arguments, format);
    vfprintf(file, format, arguments);
    va_end(arguments);
    fclose(file);
}
