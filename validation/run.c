/*
 * Worker processes. A worker runs one case and leaves results.json in the case's work folder; the gate reads it when the
 * worker has ended. A worker that dies without it has found a mistake in the gate, and that is a failed case too.
 */
#include "judge.h"
#include "run.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

struct worker { pid_t pid; size_t at; double start; struct candidate_server server; };

static volatile sig_atomic_t interrupted;

static void interrupt(int signal_number)
{
    interrupted = signal_number;
}

/* In the worker process. */
static int work_on(const struct run_plan *plan, const struct gate_case *c, const char *work, struct candidate_server *server)
{
    candidate_stop_with_us();
    struct candidate candidate = plan->candidate;
    candidate.seconds = c->seconds * plan->patience;
    candidate.server = server->pid ? server : NULL;
    struct check_run run = { .gate_case = c, .candidate = &candidate, .keep = plan->keep };
    snprintf(run.work, sizeof run.work, "%s", work);
    judge_case(&run, check_find(c->check), plan->p_values, plan->seed_offset, plan->offline);
    if (server->pid && server->owner == getpid())
        candidate_server_stop(server);
    char path[PATH_LENGTH];
    path_join(path, work, "results.json");
    json_t *json = json_pack("{so sf}", "results", results_to_json(&run.results), "candidate_seconds", run.candidate_seconds);
    const int bad = json ? json_dump_file(json, path, JSON_INDENT(1) | JSON_REAL_PRECISION(17)) : 1;
    json_decref(json);
    results_free(&run.results);
    return bad != 0;
}

/* A candidate with run-all is started once per worker; one that has died is started anew. */
static void keep_server(const struct run_plan *plan, struct candidate_server *server, size_t w)
{
    char name[32], log[PATH_LENGTH];
    if (plan->offline || !plan->candidate.capabilities || !plan->candidate.capabilities->run_all || candidate_server_alive(server))
        return;
    snprintf(name, sizeof name, "run-all-%zu.log", w + 1);
    path_join(log, plan->work, name);
    candidate_server_stop(server);
    candidate_server_start(server, &plan->candidate, log);
}

static pid_t start_worker(const struct run_plan *plan, size_t at, struct finished_case *done, struct candidate_server *server)
{
    char why[WHY_LENGTH];
    *done = (struct finished_case){ .gate_case = plan->gate_case[at] };
    path_join(done->work, plan->work, plan->gate_case[at]->name);
    folder_remove(done->work);
    fflush(stdout);
    const pid_t pid = fork();
    if (pid == 0)
        _exit(folder_make(done->work, why) ? work_on(plan, plan->gate_case[at], done->work, server) : 1);
    return pid;
}

/* What a worker left; if nothing, a failure that says how it ended. */
static void collect(struct finished_case *done, int status)
{
    char path[PATH_LENGTH];
    path_join(path, done->work, "results.json");
    json_t *json = json_load_file(path, 0, NULL);
    if (!results_from_json(json_object_get(json, "results"), &done->results)) {
        struct check_run run = { 0 };
        check_error(&run, INVARIANT, "the gate itself", NAN, NAN, NAN, NAN, "the gate's own check ended without a result (%s %d)",
                    WIFSIGNALED(status) ? "signal" : "exit code", WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
        done->results = run.results;
    }
    done->candidate_seconds = scene_number(json, "candidate_seconds", 0);
    json_decref(json);
    done->verdict = results_verdict(&done->results);
}

/* "running lubrication-cluster: draw 2000 of 20000, 12 s", redrawn in place; only for people at a terminal. */
static void show_progress(const struct worker *workers, int jobs, const struct finished_case *done)
{
    char text[400] = "";
    for (int w = 0; w < jobs; w++) {
        const double elapsed = candidate_now() - workers[w].start;
        if (workers[w].pid == 0 || elapsed < 1)
            continue;
        char path[PATH_LENGTH], line[80] = "";
        path_join(path, done[workers[w].at].work, "progress");
        FILE *file = fopen(path, "r");
        if (file) {
            if (!fgets(line, sizeof line, file))
                line[0] = '\0';
            fclose(file);
        }
        const size_t used = strlen(text);
        snprintf(text + used, sizeof text - used, "  running %s%s%s, %.0f s", done[workers[w].at].gate_case->name,
                 line[0] ? ": " : "", line, elapsed);
    }
    printf("\r\033[K%.110s", text); /* cut, as a wrapped line could not be redrawn */
    fflush(stdout);
}

static void stop_all(struct worker *workers, int jobs)
{
    for (int w = 0; w < jobs; w++) {
        if (workers[w].pid > 0)
            kill(workers[w].pid, SIGTERM);
        if (workers[w].server.pid)
            candidate_server_stop(&workers[w].server);
    }
    while (wait(NULL) > 0)
        ;
}

/* Moves the cases that have ended to the front; returns how many. */
static size_t keep_finished(struct finished_case *done, const bool *ended, size_t count)
{
    size_t kept = 0;
    for (size_t k = 0; k < count; k++)
        if (ended[k])
            done[kept++] = done[k];
    return kept;
}

static void watch_for_interrupts(void)
{
    struct sigaction action = { .sa_handler = interrupt };
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

size_t run_all(const struct run_plan *plan, struct finished_case *done, void (*completed)(const struct finished_case *))
{
    const bool terminal = isatty(STDOUT_FILENO);
    struct worker *workers = calloc((size_t)plan->jobs, sizeof *workers);
    bool *ended = calloc(plan->count + 1, sizeof *ended);
    size_t next = 0, finished = 0;
    int red = 0;
    double shown = candidate_now();
    watch_for_interrupts();
    while (finished < plan->count && (!plan->stop_after || red < plan->stop_after)) {
        for (int w = 0; w < plan->jobs; w++) {
            int status;
            if (workers[w].pid > 0 && waitpid(workers[w].pid, &status, WNOHANG) == workers[w].pid) {
                struct finished_case *d = &done[workers[w].at];
                workers[w].pid = 0;
                if (status != 0 && workers[w].server.pid)
                    candidate_server_stop(&workers[w].server);      /* it may be in the middle of an answer */
                collect(d, status);
                known_settle(plan->known, d);
                d->seconds = candidate_now() - workers[w].start;
                if (terminal)
                    printf("\r\033[K");
                completed(d);
                ended[workers[w].at] = true;
                finished++;
                red += d->verdict == VERDICT_FAIL || d->verdict == VERDICT_INCONCLUSIVE;
            }
            if (workers[w].pid == 0 && next < plan->count) {
                workers[w].at = next;
                workers[w].start = candidate_now();
                keep_server(plan, &workers[w].server, (size_t)w);
                workers[w].pid = start_worker(plan, next, &done[next], &workers[w].server);
                next++;
            }
        }
        if (interrupted) {
            stop_all(workers, plan->jobs);
            fprintf(stderr, "\ngate: interrupted\n");
            exit(130);
        }
        if (terminal && candidate_now() - shown > 0.5) {
            show_progress(workers, plan->jobs, done);
            shown = candidate_now();
        }
        nanosleep(&(struct timespec){ .tv_nsec = 2000000 }, NULL);
    }
    stop_all(workers, plan->jobs);          /* servers, and workers where red cases ended the run */
    finished = keep_finished(done, ended, plan->count);
    free(workers);
    free(ended);
    return finished;
}
