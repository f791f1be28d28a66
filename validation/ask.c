/*
 * Asking the candidate: what it does not have is not asked; what its level does not allow is asked in another way; the case folder of docs/adapter.md is
 * written, the candidate started, and whatever is not an answer recorded.
 */
#include "level_b.h"
#include "offline.h"
#include "plain.h"
#include "precision.h"

#include <ctype.h>
#include <dirent.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static bool write_json(const json_t *json, const char *folder, const char *name, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    path_join(path, folder, name);
    if (json_dump_file(json, path, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) != 0)
        return why_not(why, "cannot write %s", path);
    return true;
}

static json_t *describe(const struct check_run *run, const char *name, const struct question *q)
{
    const struct gate_case *c = run->gate_case;
    char full[256];
    snprintf(full, sizeof full, "%s/%s", c->name, name);
    json_t *json = json_pack("{ss ss ss ss ss ss sO}", "suite", "1.0", "contract", CONTRACT, "name", full, "about", c->about, "protocol", q->protocol,
                             "scene", "scene.json", "needs", c->needs);
    if (q->draws)
        json_object_set_new(json, "draws", json_integer((json_int_t)q->draws));
    if (q->pause)
        json_object_set_new(json, "pause", json_integer(q->pause));
    if (q->steps)
        json_object_set_new(json, "steps", json_integer((json_int_t)q->steps));
    if (q->stress)
        json_object_set_new(json, "stress", json_true());
    if (q->states)
        json_object_set_new(json, "states", json_string("states.csv"));
    if (q->contacts)
        json_object_set_new(json, "contacts", json_string("contacts.csv"));
    return json;
}

static bool write_case(const struct check_run *run, const char *name, const struct question *q, const char *folder, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    bool good = true;
    if (q->states) {
        path_join(path, folder, "states.csv");
        good = states_write(path, q->state, q->states, why) && plain_write_states(folder, q->state, q->states, why);
    }
    if (good && q->contacts) {
        path_join(path, folder, "contacts.csv");
        good = contacts_write(path, q->contact, q->contacts, why) && plain_write_contacts(folder, q->contact, q->contacts, why);
    }
    if (!json_object_get(q->scene, "about"))
        json_object_set_new(q->scene, "about", json_string(run->gate_case->about));
    json_t *json = describe(run, name, q);
    good = good && write_json(q->scene, folder, "scene.json", why) && write_json(json, folder, "case.json", why)
           && plain_write_case(folder, json, q->scene, why);
    json_decref(json);
    return good;
}

/* What the candidate must have written, so that a check never meets a file that is not there. */
static bool missing_file(const struct question *q, const char *out, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH], there[400] = "";
    const char *name = strcmp(q->protocol, "forces") == 0                                                 ? "forces"
                       : strcmp(q->protocol, "steps") == 0 || scene_get(q->scene, "output.states")        ? "trajectory"
                       : strcmp(q->protocol, "run") == 0 && scene_get(q->scene, "output.stress")          ? "stress"
                                                                                                          : NULL;
    if (!name || (snprintf(path, sizeof path, "%s/%s.csv", out, name), access(path, R_OK) == 0))
        return false;
    path_join(path, out, "velocities.npy");
    if (strcmp(q->protocol, "steps") == 0 && access(path, R_OK) == 0)
        return false;
    DIR *folder = opendir(out);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        if (entry->d_name[0] != '.' && strlen(there) + strlen(entry->d_name) + 3 < sizeof there)
            strcat(strcat(there, *there ? ", " : ""), entry->d_name);
    if (folder)
        closedir(folder);
    return !why_not(why, "%s/%s.csv (or %s.txt) is missing; the output folder %s%s", out, name, name, *there ? "holds only " : "is empty", there);
}

static void record_no_answer(struct check_run *run, const char *name, const struct candidate_answer *answer)
{
    struct result *r;
    if (answer->outcome == CANDIDATE_UNSUPPORTED)
        r = check_skip(run, name, "%s: %s", name, answer->message);
    else
        r = check_error(run, INVARIANT, name, NAN, NAN, NAN, NAN, "%s: %s", name, answer->message);
    if (answer->said[0])
        result_notes(r, "It said: %s", answer->said);
}

static size_t particles_of(const struct question *q)
{
    size_t n = 0;
    while (n < q->states && q->state[n].state == q->state[0].state)
        n++;
    return n ? n : 1;
}

/* `folder`: run->work/<name> or a part of it; `name` is for people. */
static bool ask(struct check_run *run, const char *folder, const char *name, const struct question *q, char out[PATH_LENGTH])
{
    char case_dir[PATH_LENGTH], asked[PATH_LENGTH], why[WHY_LENGTH];
    path_join(case_dir, folder, "case");
    path_join(out, folder, "out");
    path_join(asked, case_dir, "case.json");
    if (!run->candidate->offline && access(asked, F_OK) == 0) {    /* its answer would be mixed with the first one's */
        check_error(run, INVARIANT, "case folder", NAN, NAN, NAN, NAN, "the gate itself failed: two questions are called %s", name);
        return false;
    }
    if (!folder_make(case_dir, why) || !folder_make(out, why) || !write_case(run, name, q, case_dir, why)) {
        check_error(run, INVARIANT, "case folder", NAN, NAN, NAN, NAN, "the gate itself failed: %s", why);
        return false;
    }
    struct candidate_answer answer;
    if (run->candidate->offline) {
        if (!offline_find(run->candidate->offline, run->work, folder, out, &answer))
            return offline_pretend(run->candidate->offline, q, out);    /* not answered yet; the questions that follow are wanted as well */
    } else
        candidate_run(run->candidate, case_dir, out, &answer);
    run->candidate_seconds += answer.seconds;
    if (answer.outcome != CANDIDATE_OK) {
        record_no_answer(run, name, &answer);
        return false;
    }
    const struct plain_shape shape = { .protocol = q->protocol, .particles = particles_of(q), .turn = json_is_true(scene_get(q->scene, "output.states.turn")) };
    if (!plain_answers(out, &shape, why) || missing_file(q, out, why)) {
        check_garbage(run, why);
        return false;
    }
    return true;
}

static void folder_of(const struct check_run *run, const char *name, char folder[PATH_LENGTH])
{
    char question[128];
    snprintf(question, sizeof question, "%s%s", name, run->attempt > 1 ? "-rerun" : "");
    for (char *c = question; *c; c++) /* an adapter that forgets to quote its arguments should still work */
        *c = isalnum((unsigned char)*c) || *c == '.' ? *c : '-';
    path_join(folder, run->work, question);
}

bool check_ask_part(struct check_run *run, const char *name, const char *part, const struct question *q, char out[PATH_LENGTH])
{
    char folder[PATH_LENGTH], inner[PATH_LENGTH], full[160];
    folder_of(run, name, folder);
    path_join(inner, folder, part);
    snprintf(full, sizeof full, "%s/%s", name, part);
    return ask(run, inner, full, q, out);
}

bool check_ask(struct check_run *run, const char *name, const struct question *q, char out[PATH_LENGTH])
{
    const struct capabilities *c = run->candidate->capabilities;
    char folder[PATH_LENGTH], why[WHY_LENGTH];
    folder_of(run, name, folder);
    if (run->replaying) {
        path_join(out, folder, "out");
        return access(out, R_OK) == 0;
    }
    if (capabilities_lack(c, q->protocol, q->scene, q->contacts > 0, why)) {
        check_skip(run, name, "%s %s", name, why);
        return false;
    }
    const bool runs = strcmp(q->protocol, "run") == 0;
    if (c && c->level == LEVEL_C && !runs) {
        check_skip(run, name, "%s asks for %s of given particles, which level C does not give", name, strcmp(q->protocol, "forces") == 0 ? "forces" : "impulses");
        return false;
    }
    precision_allow(run, q);
    if (c && c->level == LEVEL_B && !runs)
        return level_b_ask(run, name, q, folder, out);
    return ask(run, folder, name, q, out);
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
