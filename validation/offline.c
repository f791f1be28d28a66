/* See offline.h. */
#include "offline.h"

#include <dirent.h>
#include <ftw.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const question_files[] = { "case.json", "scene.json", "states.csv", "contacts.csv", "case.txt", "states.txt", "contacts.txt" };
enum { FILES = sizeof question_files / sizeof *question_files };

/* All that a candidate is given. A file that is not there leaves the hash as it is, so its name goes in as well. */
static uint64_t question_hash(const char *case_dir)
{
    uint64_t hash = HASH_START;
    for (int k = 0; k < FILES; k++) {
        char path[PATH_LENGTH];
        path_join(path, case_dir, question_files[k]);
        hash = (file_hash(path, hash) ^ (uint64_t)(k + 1)) * UINT64_C(1099511628211);
    }
    return hash;
}

/* Links everything in `from` into `to`; whether there was anything. */
static bool link_answer(const char *from, const char *to)
{
    DIR *folder = opendir(from);
    bool any = false;
    char whole[PATH_LENGTH], source[PATH_LENGTH], place[PATH_LENGTH];
    if (!folder || !realpath(from, whole)) {
        if (folder)
            closedir(folder);
        return false;
    }
    for (struct dirent *entry; (entry = readdir(folder));) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        path_join(source, whole, entry->d_name);
        path_join(place, to, entry->d_name);
        unlink(place);
        any = symlink(source, place) == 0 || any;
    }
    closedir(folder);
    return any;
}

/* What run.sh left of the exit code; a file that is missing means 0. */
static bool read_exit(const char *place, int *code)
{
    char path[PATH_LENGTH];
    path_join(path, place, "exit");
    FILE *file = fopen(path, "r");
    *code = 0;
    if (!file)
        return false;
    const bool good = fscanf(file, "%d", code) == 1;
    fclose(file);
    return good;
}

static void note(struct offline *o, const char *place, uint64_t hash)
{
    gsl_set_error_handler_off();    /* what comes now is computed from invented numbers: it may fail, it must not end the process */
    o->question = realloc(o->question, (o->missing + 1) * sizeof *o->question);
    struct missing *m = &o->question[o->missing++];
    *m = (struct missing){ .hash = hash };
    snprintf(m->place, sizeof m->place, "%s", place);
}

bool offline_find(struct offline *o, const char *work, const char *folder, const char *out, struct candidate_answer *answer)
{
    char asked[PATH_LENGTH], there[PATH_LENGTH], stored[PATH_LENGTH], path[PATH_LENGTH];
    const char *place = folder + strlen(work) + 1;
    snprintf(path, sizeof path, "%s/%s", o->gate_case, place);
    path_join(there, o->root, path);
    path_join(asked, folder, "case");
    path_join(stored, there, "case");
    const uint64_t hash = question_hash(asked);
    *answer = (struct candidate_answer){ .outcome = CANDIDATE_OK };
    int code;
    const bool ended = question_hash(stored) == hash && read_exit(there, &code);
    path_join(path, there, "out");
    if (question_hash(stored) != hash || (!link_answer(path, out) && !ended)) {
        note(o, place, hash);
        return false;
    }
    read_exit(there, &code);
    answer->detail = code > 128 ? code - 128 : code;
    answer->outcome = code == 0 ? CANDIDATE_OK : code == 77 ? CANDIDATE_UNSUPPORTED : code > 128 ? CANDIDATE_CRASHED : CANDIDATE_FAILED;
    path_join(path, there, "out.log");
    candidate_explain(&(struct candidate){ .command = "" }, path, answer);
    return true;
}

bool offline_waits(const struct candidate *c)
{
    return c && c->offline && c->offline->missing > 0;
}

void offline_free(struct offline *o)
{
    free(o->question);
    *o = (struct offline){ 0 };
}

static bool asked_again(const struct offline *o, const struct missing *m)
{
    for (size_t k = 0; k < o->missing; k++)
        if (o->question[k].hash == m->hash && strcmp(o->question[k].place, m->place) == 0)
            return true;
    return false;
}

/* The question from the work folder to the exported one, in place of whatever was there. */
static bool write_out(const struct offline *o, const char *work, const char *place, char why[WHY_LENGTH])
{
    char from[PATH_LENGTH], asked[PATH_LENGTH], name[PATH_LENGTH], there[PATH_LENGTH], to[PATH_LENGTH], source[PATH_LENGTH];
    snprintf(name, sizeof name, "%s/%s", o->gate_case, place);
    path_join(there, o->root, name);
    path_join(from, work, place);
    path_join(asked, from, "case");
    for (int k = 0; k < 4; k++) {
        static const char *const old[] = { "case", "out", "exit", "out.log" };
        path_join(to, there, old[k]);
        folder_remove(to);
    }
    path_join(to, there, "out");
    if (!folder_make(to, why))
        return false;
    path_join(to, there, "case");
    if (!folder_make(to, why))
        return false;
    for (int k = 0; k < FILES; k++) {
        path_join(source, asked, question_files[k]);
        path_join(to, there, "case");
        path_join(name, to, question_files[k]);
        if (access(source, R_OK) == 0 && link(source, name) != 0 && rename(source, name) != 0)
            return why_not(why, "cannot put %s to %s", source, name);
    }
    return true;
}

void offline_judge(struct check_run *run, const struct check *check, int p_values, unsigned seed_offset, const char *root)
{
    struct offline first = { .root = root, .gate_case = run->gate_case->name, .pass = 1 }, second = first;
    const struct candidate *own = run->candidate;
    struct candidate candidate = *own;
    char why[WHY_LENGTH];
    candidate.offline = &first;
    run->candidate = &candidate;
    check_judge(run, check, p_values, seed_offset);
    run->candidate = own;
    if (first.missing == 0)
        return;
    struct check_run again = { .gate_case = run->gate_case, .candidate = &candidate };
    path_join(again.work, run->work, "again");
    second.pass = 2;
    candidate.offline = &second;
    if (folder_make(again.work, why))
        check_judge(&again, check, p_values, seed_offset);
    if (run->attempt == 1)      /* else the first attempt is judged from answers, and what alarmed is inconclusive already */
        results_free(&run->results);
    size_t written = 0;
    for (size_t k = 0; k < first.missing; k++)
        if (asked_again(&second, &first.question[k])) {
            if (!write_out(&first, run->work, first.question[k].place, why)) {
                check_garbage(run, why);
                break;
            }
            written++;
        }
    check_inconclusive(run, "answers", "%zu question%s to be answered before this can be judged%s: run.sh asks them, then judge again", written,
                       written == 1 ? " has" : "s have", run->attempt == 1 ? "" : "; a first p below 1e-4 is asked once more with a fresh seed");
    folder_remove(again.work);
    results_free(&again.results);
    offline_free(&first);
    offline_free(&second);
}

/* --- what stands in the folder for people --- */

static FILE *listing;
static size_t found, unanswered, root_length;

static int list_one(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)status;
    const char *tail = "/case/case.json";
    const size_t n = strlen(path), t = strlen(tail);
    if (kind != FTW_F || n < t || strcmp(path + n - t, tail) != 0)
        return 0;
    char place[PATH_LENGTH], file[PATH_LENGTH];
    (void)where;
    snprintf(place, sizeof place, "%.*s", (int)(n - t), path);
    fprintf(listing, "%s/case\t%s/out\n", place + root_length + 1, place + root_length + 1);
    found++;
    path_join(file, place, "exit");
    if (access(file, R_OK) == 0)
        return 0;
    path_join(file, place, "out");
    DIR *out = opendir(file);
    int files = 0;
    while (out && readdir(out))
        files++;
    if (out)
        closedir(out);
    unanswered += files <= 2;
    return 0;
}

static const char run_script[] =
    "#!/bin/sh\n"
    "# sh run.sh ADAPTER [ARGUMENT ...]: asks what has no answer yet; the exit code of each goes to `exit`, what it says to `out.log`.\n"
    "root=$(cd \"$(dirname \"$0\")\" && pwd)\n"
    "[ $# -gt 0 ] || { echo \"usage: sh run.sh ADAPTER [ARGUMENT ...]\" >&2; exit 2; }\n"
    "tab=$(printf '\\t')\n"
    "asked=0\n"
    "while IFS=\"$tab\" read -r question answer; do\n"
    "    place=$root/${question%/case}\n"
    "    [ -e \"$place/exit\" ] && continue\n"
    "    \"$@\" \"$root/$question\" \"$root/$answer\" </dev/null >\"$place/out.log\" 2>&1\n"
    "    echo $? >\"$place/exit\"\n"
    "    asked=$((asked + 1))\n"
    "done <\"$root/questions.txt\"\n"
    "echo \"$asked questions asked; now: gate judge $root\"\n";

static const char read_me[] =
    "Questions of the gate, to be answered elsewhere (docs/adapter.md of sheargate).\n"
    "\n"
    "  questions.txt     a line per question: CASE_DIR<tab>OUT_DIR, relative to this folder\n"
    "  .../case          what is asked: case.json, scene.json, states.csv, and the same as case.txt, states.txt\n"
    "  .../out           where the answer goes\n"
    "  .../exit          the exit code: 0 answered (also if this file is missing), 77 not supported\n"
    "\n"
    "  sh run.sh ./my_adapter     answers all that have no answer yet, one after the other\n"
    "  gate judge DIR             the verdicts; what it asks on is added to questions.txt: run and judge again until nothing waits\n";

static bool write_text(const char *root, const char *name, const char *text, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    path_join(path, root, name);
    FILE *file = fopen(path, "w");
    const bool good = file && fputs(text, file) >= 0;
    return ((!file || fclose(file) == 0) && good) || why_not(why, "cannot write %s", path);
}

bool offline_list(const char *root, size_t *questions, size_t *waiting, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    path_join(path, root, "questions.txt");
    listing = fopen(path, "w");
    if (!listing)
        return why_not(why, "cannot write %s", path);
    found = unanswered = 0;
    root_length = strlen(root);
    nftw(root, list_one, 16, FTW_PHYS);
    *questions = found;
    *waiting = unanswered;
    return (fclose(listing) == 0 || why_not(why, "cannot write %s", path)) && write_text(root, "run.sh", run_script, why)
           && write_text(root, "README.txt", read_me, why);
}
