/*
 * Worker processes. A worker runs one case and leaves results.json in the case's work folder; the gate reads it when the
 * worker has ended. A worker that dies without it has found a mistake in the gate, and that is a failed case too.
 */
#include "run.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

struct worker { pid_t pid; size_t at; double start; };

static volatile sig_atomic_t interrupted;

static void interrupt(int signal_number)
{
    interrupted = signal_number;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* In the worker process. */
static int work_on(const struct run_plan *plan, const struct gate_case *c, const char *work)
{
    candidate_stop_with_us();
    struct candidate candidate = plan->candidate;
    candidate.seconds = c->seconds;
    struct check_run run = { .gate_case = c, .candidate = &candidate, .keep = plan->keep };
    snprintf(run.work, sizeof run.work, "%s", work);
    check_judge(&run, check_find(c->check), plan->p_values, plan->seed_offset);
    char path[PATH_LENGTH];
    path_join(path, work, "results.json");
    json_t *json = json_pack("{so sf}", "results", results_to_json(&run.results), "candidate_seconds", run.candidate_seconds);
    const int bad = json ? json_dump_file(json, path, JSON_INDENT(1) | JSON_REAL_PRECISION(17)) : 1;
    json_decref(json);
    results_free(&run.results);
    return bad != 0;
}

static pid_t start_worker(const struct run_plan *plan, size_t at, struct finished_case *done)
{
    char why[WHY_LENGTH];
    *done = (struct finished_case){ .gate_case = plan->gate_case[at] };
    path_join(done->work, plan->work, plan->gate_case[at]->name);
    folder_remove(done->work);
    fflush(stdout);
    const pid_t pid = fork();
    if (pid == 0)
        _exit(folder_make(done->work, why) ? work_on(plan, plan->gate_case[at], done->work) : 1);
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
        const double elapsed = now() - workers[w].start;
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

static void stop_all(const struct worker *workers, int jobs)
{
    for (int w = 0; w < jobs; w++)
        if (workers[w].pid > 0)
            kill(workers[w].pid, SIGTERM);
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
    double shown = now();
    watch_for_interrupts();
    while (finished < plan->count && (!plan->stop_after || red < plan->stop_after)) {
        for (int w = 0; w < plan->jobs; w++) {
            int status;
            if (workers[w].pid > 0 && waitpid(workers[w].pid, &status, WNOHANG) == workers[w].pid) {
                struct finished_case *d = &done[workers[w].at];
                workers[w].pid = 0;
                collect(d, status);
                known_settle(plan->known, d);
                d->seconds = now() - workers[w].start;
                if (terminal)
                    printf("\r\033[K");
                completed(d);
                ended[workers[w].at] = true;
                finished++;
                red += d->verdict == VERDICT_FAIL || d->verdict == VERDICT_INCONCLUSIVE;
            }
            if (workers[w].pid == 0 && next < plan->count) {
                workers[w] = (struct worker){ .at = next, .start = now() };
                workers[w].pid = start_worker(plan, next, &done[next]);
                next++;
            }
        }
        if (interrupted) {
            stop_all(workers, plan->jobs);
            fprintf(stderr, "\ngate: interrupted\n");
            exit(130);
        }
        if (terminal && now() - shown > 0.5) {
            show_progress(workers, plan->jobs, done);
            shown = now();
        }
        nanosleep(&(struct timespec){ .tv_nsec = 2000000 }, NULL);
    }
    stop_all(workers, plan->jobs);          /* there are some only where red cases ended the run */
    finished = keep_finished(done, ended, plan->count);
    free(workers);
    free(ended);
    return finished;
}
