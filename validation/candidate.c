/*
 * Starting a candidate and surviving it. The child leads its own process group, so that a candidate that starts helpers
 * (a shell, mpirun) dies as a whole; what it says goes to a file in place of a pipe, so that it can never block on us.
 */
#include "candidate.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static volatile sig_atomic_t running; /* the candidate's process group, 0: none */

static void stop_candidate(int signal_number)
{
    if (running > 0)
        kill(-(pid_t)running, SIGKILL);
    _exit(128 + signal_number);
}

void candidate_stop_with_us(void)
{
    struct sigaction action = { .sa_handler = stop_candidate };
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    sigaction(SIGHUP, &action, NULL);
}

double candidate_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static size_t folder_bytes; /* nftw has no way to hand a pointer through; the gate's workers are single-threaded */

static int add_bytes(const char *path, const struct stat *status, int kind, struct FTW *where)
{
    (void)path;
    (void)where;
    if (kind == FTW_F)
        folder_bytes += (size_t)status->st_size;
    return 0;
}

static size_t folder_size(const char *path)
{
    folder_bytes = 0;
    nftw(path, add_bytes, 16, FTW_PHYS);
    return folder_bytes;
}

/* A file that has come to the limit exactly was stopped there by candidate_limits. */
bool candidate_floods(const struct candidate *c, const char *out_dir, const char *log)
{
    struct stat said;
    return folder_size(out_dir) >= c->bytes || (stat(log, &said) == 0 && (size_t)said.st_size >= c->bytes);
}

bool candidate_failed(const struct candidate_answer *a)
{
    return a->outcome == CANDIDATE_FAILED || a->outcome == CANDIDATE_CRASHED;
}

void candidate_limits(const struct candidate *c)
{
    const struct rlimit file = { .rlim_cur = c->bytes, .rlim_max = c->bytes }, core = { 0, 0 };
    signal(SIGXFSZ, SIG_DFL);           /* whoever started us may ignore it, and a candidate would inherit that */
    setrlimit(RLIMIT_FSIZE, &file);
    setrlimit(RLIMIT_CORE, &core);
}

void candidate_running(pid_t group)
{
    running = group;
}

/* In the child: does not return. `exec` in the script makes the candidate itself, not a shell, receive our signals. */
static void become_candidate(const struct candidate *c, const char *case_dir, const char *out_dir, const char *log)
{
    char script[PATH_LENGTH + 32];
    snprintf(script, sizeof script, "exec %s \"$1\" \"$2\"", c->command);
    const int in = open("/dev/null", O_RDONLY), out = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(in, STDIN_FILENO);
    dup2(out, STDOUT_FILENO);
    dup2(out, STDERR_FILENO);
    candidate_limits(c);
    execl("/bin/sh", "sh", "-c", script, "candidate", case_dir, out_dir, (char *)NULL);
    _exit(127);
}

/* Waits until the child ends or breaks a limit; returns its wait status. Polls fast at first: most starts are short. */
static int watch(const struct candidate *c, pid_t child, const char *out_dir, const char *log, double start,
                 struct candidate_answer *answer)
{
    int status = 0;
    double pause = 2e-4, sized = start;
    while (waitpid(child, &status, WNOHANG) == 0) {
        const double t = candidate_now();
        if (t - start > c->seconds)
            answer->outcome = CANDIDATE_HUNG;
        if (t - sized > 0.2) {
            sized = t;
            if (candidate_floods(c, out_dir, log))
                answer->outcome = CANDIDATE_FLOODED;
        }
        if (answer->outcome != CANDIDATE_OK) {
            kill(-child, SIGKILL);
            waitpid(child, &status, 0);
            break;
        }
        nanosleep(&(struct timespec){ .tv_nsec = (long)(1e9 * pause) }, NULL);
        pause = pause < 0.02 ? 1.3 * pause : pause;
    }
    kill(-child, SIGKILL); /* helpers that outlived it */
    return status;
}

static void read_tail(const char *log, char *said, size_t room)
{
    said[0] = '\0';
    FILE *file = fopen(log, "rb");
    if (!file)
        return;
    if (fseek(file, -(long)(room - 1), SEEK_END) != 0)
        rewind(file);
    const size_t n = fread(said, 1, room - 1, file);
    said[n] = '\0';
    for (size_t k = 0; k < n; k++) /* the report is XML and HTML: plain text only */
        if (((unsigned char)said[k] < 32 && said[k] != '\n' && said[k] != '\t') || (unsigned char)said[k] > 126)
            said[k] = '?';
    fclose(file);
}

static bool names_an_error(const char *line, size_t n)
{
    static const char *const words[] = { "error", "Error", "ERROR" };
    for (size_t at = 0; at + 5 <= n; at++)
        for (size_t k = 0; k < sizeof words / sizeof *words; k++)
            if (strncmp(line + at, words[k], 5) == 0)
                return true;
    return false;
}

/* The last line that is not empty; of a failure the last that speaks of an error, which some interpreters print before a version or a stack. */
static const char *telling_line(const char *said, bool failure, int *length)
{
    const char *found = said + strlen(said), *last = found;
    for (const char *line = said; *line;) {
        const size_t n = strcspn(line, "\n");
        last = n ? line : last;
        if (failure && names_an_error(line, n))
            found = line;
        line += n + (line[n] == '\n');
    }
    found = *found ? found : last;
    *length = (int)strcspn(found, "\n");
    return found;
}

/* A shell that sees a program of its own die ends with 128 and the number of the signal. */
static const char *signal_of_code(int code)
{
    static char text[80];
    text[0] = '\0';
    if (code > 128 && code <= 128 + SIGXFSZ)
        snprintf(text, sizeof text, " (a program that it started was ended by signal %d, %s)", code - 128, strsignal(code - 128));
    return text;
}

void candidate_explain(const struct candidate *c, const char *log, struct candidate_answer *a)
{
    int n;
    read_tail(log, a->said, sizeof a->said);
    const char *last = telling_line(a->said, a->outcome == CANDIDATE_FAILED, &n);
    switch (a->outcome) {
    case CANDIDATE_OK:
        snprintf(a->message, sizeof a->message, "answered");
        break;
    case CANDIDATE_UNSUPPORTED:
        snprintf(a->message, sizeof a->message, "does not support this (exit code 77)%s%.*s", n ? ": " : "", n, last);
        break;
    case CANDIDATE_FAILED:
        snprintf(a->message, sizeof a->message, "candidate ended with exit code %d%s%s%.*s%s%s%s", a->detail,
                 a->detail == 127 ? " (command not found?)" : signal_of_code(a->detail), n ? ": " : "", n, last,
                 n < (int)strlen(a->said) - 1 ? " (all that it said: " : "", n < (int)strlen(a->said) - 1 ? log : "",
                 n < (int)strlen(a->said) - 1 ? ")" : "");
        break;
    case CANDIDATE_CRASHED:
        snprintf(a->message, sizeof a->message, "candidate crashed with signal %d (%s)", a->detail, strsignal(a->detail));
        break;
    case CANDIDATE_HUNG:
        snprintf(a->message, sizeof a->message, "candidate hung: it was killed after %g s", c->seconds);
        break;
    case CANDIDATE_FLOODED:
        snprintf(a->message, sizeof a->message, "candidate wrote more than %zu MB and was killed", c->bytes >> 20);
        break;
    }
}

void candidate_run(const struct candidate *c, const char *case_dir, const char *out_dir, struct candidate_answer *answer)
{
    char log[PATH_LENGTH + 8];
    snprintf(log, sizeof log, "%s.log", out_dir);
    *answer = (struct candidate_answer){ .outcome = CANDIDATE_OK };
    if (c->server) {
        candidate_ask_server(c, case_dir, out_dir, answer);
        return;
    }
    const double start = candidate_now();
    const pid_t child = fork();
    if (child == 0) {
        setpgid(0, 0);
        become_candidate(c, case_dir, out_dir, log);
    }
    setpgid(child, child); /* in both processes: whichever comes first */
    running = child;
    const int status = watch(c, child, out_dir, log, start, answer);
    running = 0;
    answer->seconds = candidate_now() - start;
    if (answer->outcome == CANDIDATE_OK && WIFSIGNALED(status)) {
        answer->detail = WTERMSIG(status);
        answer->outcome = answer->detail == SIGXFSZ ? CANDIDATE_FLOODED : CANDIDATE_CRASHED;
    } else if (answer->outcome == CANDIDATE_OK && WEXITSTATUS(status) != 0) {
        answer->detail = WEXITSTATUS(status);
        answer->outcome = answer->detail == 77 ? CANDIDATE_UNSUPPORTED : CANDIDATE_FAILED;
    }
    if (candidate_failed(answer) && candidate_floods(c, out_dir, log))
        answer->outcome = CANDIDATE_FLOODED;        /* it ended because it was not allowed to write on */
    candidate_explain(c, log, answer);
}

/* The program file behind the first word of the command, as the shell would find it. */
static bool find_program(const char *command, char path[PATH_LENGTH])
{
    const bool quoted = *command == '\'' || *command == '"';
    const int n = (int)(quoted ? strcspn(command + 1, *command == '"' ? "\"" : "'") : strcspn(command, " \t"));
    command += quoted;
    snprintf(path, PATH_LENGTH, "%.*s", n, command);
    if (strchr(path, '/'))
        return access(path, X_OK) == 0;
    const char *folders = getenv("PATH");
    while (folders && *folders) {
        const int length = (int)strcspn(folders, ":");
        snprintf(path, PATH_LENGTH, "%.*s/%.*s", length, folders, n, command);
        if (access(path, X_OK) == 0)
            return true;
        folders += length + (folders[length] == ':');
    }
    return false;
}

bool candidate_hash(const struct candidate *c, char hex[17])
{
    uint64_t hash = HASH_START;
    char path[PATH_LENGTH];
    struct stat status;
    for (const char *p = c->command; *p; p++)
        hash = (hash ^ (unsigned char)*p) * UINT64_C(1099511628211);
    const bool found = find_program(c->command, path);
    if (found)
        hash = file_hash(path, hash);
    for (const char *at = c->command + strcspn(c->command, " \t"); *at; at += strcspn(at, " \t")) {
        at += strspn(at, " \t");
        snprintf(path, sizeof path, "%.*s", (int)strcspn(at, " \t"), at);
        if (stat(path, &status) == 0 && S_ISREG(status.st_mode))
            hash = file_hash(path, hash);
    }
    snprintf(hex, 17, "%016llx", (unsigned long long)hash);
    return found;
}
