/*
 * One start for all questions: `COMMAND run-all` reads a line per question and answers it with a line that holds the exit code. The same limits hold
 * for each line as for a start of its own; whatever breaks one costs it its life, and the next question gets a new process.
 */
#include "candidate.h"

#include <ctype.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const char ended_mark[] = "gate-ended ";     /* printed by the shell around the candidate, with its exit code */

static void become_server(const struct candidate *c, const int in[2], const int out[2], const char *log)
{
    char script[PATH_LENGTH + 80];
    snprintf(script, sizeof script, "exec 3>&1; %s run-all 3>&-; echo \"%s$?\" >&3", c->command, ended_mark);
    const int said = open(log, O_WRONLY | O_CREAT | O_APPEND, 0666);
    dup2(in[0], STDIN_FILENO);
    dup2(out[1], STDOUT_FILENO);
    dup2(said, STDERR_FILENO);
    candidate_limits(c);
    execl("/bin/sh", "sh", "-c", script, (char *)NULL);
    _exit(127);
}

static bool make_pipe(int ends[2])
{
    return pipe(ends) == 0 && fcntl(ends[0], F_SETFD, FD_CLOEXEC) == 0 && fcntl(ends[1], F_SETFD, FD_CLOEXEC) == 0;
}

void candidate_server_start(struct candidate_server *s, const struct candidate *c, const char *log)
{
    int in[2], out[2];
    *s = (struct candidate_server){ .owner = getpid(), .in = -1, .out = -1 };
    snprintf(s->log, sizeof s->log, "%s", log);
    if (!make_pipe(in) || !make_pipe(out))
        return;
    fflush(stdout);
    s->pid = fork();
    if (s->pid == 0) {
        setpgid(0, 0);
        become_server(c, in, out, log);
    }
    setpgid(s->pid, s->pid);
    close(in[0]);
    close(out[1]);
    s->in = in[1];
    s->out = out[0];
}

bool candidate_server_alive(struct candidate_server *s)
{
    return s->pid > 0 && waitpid(s->pid, NULL, WNOHANG) == 0;
}

static void close_pipes(struct candidate_server *s)
{
    if (s->in >= 0)
        close(s->in);
    if (s->out >= 0)
        close(s->out);
    s->in = s->out = -1;
}

void candidate_server_stop(struct candidate_server *s)
{
    if (s->pid <= 0)
        return;
    close_pipes(s);     /* the end of its input: it may end by itself */
    for (int k = 0; k < 50 && candidate_server_alive(s); k++)
        nanosleep(&(struct timespec){ .tv_nsec = 10000000 }, NULL);
    kill(-s->pid, SIGKILL);
    waitpid(s->pid, NULL, 0);
    s->pid = 0;
}

/* What it says beside exit codes goes to the log of the question. */
static void copy_said(const struct candidate_server *s, off_t from, FILE *log)
{
    char buffer[4096];
    FILE *said = fopen(s->log, "rb");
    if (!said || fseek(said, (long)from, SEEK_SET) != 0 || !log) {
        if (said)
            fclose(said);
        return;
    }
    for (size_t n; (n = fread(buffer, 1, sizeof buffer, said)) > 0;)
        fwrite(buffer, 1, n, log);
    fclose(said);
}

static bool only_a_number(const char *line, int *code)
{
    char *end;
    const long value = strtol(line, &end, 10);
    *code = (int)value;
    return end != line && end[strspn(end, " \t\r")] == '\0';
}

/* Takes whole lines out of what has come. 1: the exit code is there; -1: the candidate has ended (*code: how); 0: neither yet. */
static int take_lines(struct candidate_server *s, FILE *log, int *code)
{
    char *end;
    while ((end = memchr(s->pending, '\n', s->held)) || s->held == sizeof s->pending) {
        char line[sizeof s->pending + 1];
        const size_t n = end ? (size_t)(end - s->pending) : s->held;    /* a line too long is no exit code: taken in pieces */
        memcpy(line, s->pending, n);
        line[n] = '\0';
        s->held -= n + (end != NULL);
        memmove(s->pending, s->pending + n + (end != NULL), s->held);
        if (only_a_number(line, code))
            return 1;
        if (strncmp(line, ended_mark, strlen(ended_mark)) == 0) {
            *code = atoi(line + strlen(ended_mark));
            return -1;
        }
        if (log)
            fprintf(log, "%s\n", line);
    }
    return 0;
}

/* Until an answer, its end, or a limit. Returns as take_lines; 0: the limit is in answer->outcome. */
static int wait_for_code(const struct candidate *c, const char *out_dir, const char *log_path, FILE *log, double start, int *code,
                         struct candidate_answer *answer)
{
    struct candidate_server *s = c->server;
    double sized = start;
    size_t talked = 0;
    for (;;) {
        struct pollfd ready = { .fd = s->out, .events = POLLIN };
        poll(&ready, 1, 50);
        if (ready.revents) {
            const ssize_t n = read(s->out, s->pending + s->held, sizeof s->pending - s->held);
            if (n <= 0) {
                *code = 127;
                return -1;
            }
            s->held += (size_t)n;
            talked += (size_t)n;
            const int found = take_lines(s, log, code);
            if (found)
                return found;
        }
        const double t = candidate_now();
        if (t - start > c->seconds)
            answer->outcome = CANDIDATE_HUNG;
        else if (talked > c->bytes || (t - sized > 0.2 && candidate_floods(c, out_dir, log_path)))
            answer->outcome = CANDIDATE_FLOODED;
        if (answer->outcome != CANDIDATE_OK)
            return 0;
        sized = t - sized > 0.2 ? t : sized;
    }
}

static bool send_question(int to, const char *case_dir, const char *out_dir)
{
    char line[2 * PATH_LENGTH + 4];
    const int length = snprintf(line, sizeof line, "%s\t%s\n", case_dir, out_dir);
    const struct sigaction ignore = { .sa_handler = SIG_IGN };
    struct sigaction before;
    sigaction(SIGPIPE, &ignore, &before);
    const bool sent = write(to, line, (size_t)length) == length;
    sigaction(SIGPIPE, &before, NULL);
    return sent;
}

/* It has broken a limit or ended: nothing of it may live on; this process starts its own for the next question. */
static void end_server(struct candidate_server *s)
{
    kill(-s->pid, SIGKILL);
    if (s->owner == getpid())
        waitpid(s->pid, NULL, 0);
    close_pipes(s);
    s->pid = 0;
}

void candidate_ask_server(const struct candidate *c, const char *case_dir, const char *out_dir, struct candidate_answer *answer)
{
    struct candidate_server *s = c->server;
    char log_path[PATH_LENGTH + 8];
    struct stat said = { .st_size = 0 };
    int code = 0;
    snprintf(log_path, sizeof log_path, "%s.log", out_dir);
    if (s->pid == 0 || s->in < 0) {
        char log[PATH_LENGTH];
        strcpy(log, s->log);
        candidate_server_start(s, c, log);
    }
    stat(s->log, &said);
    FILE *log = fopen(log_path, "w");
    const double start = candidate_now();
    candidate_running(s->pid);
    const int found = send_question(s->in, case_dir, out_dir) ? wait_for_code(c, out_dir, log_path, log, start, &code, answer) : (code = 127, -1);
    candidate_running(0);
    answer->seconds = candidate_now() - start;
    copy_said(s, said.st_size, log);
    if (log)
        fclose(log);
    if (found == -1 && code > 128) {
        answer->detail = code - 128;
        answer->outcome = answer->detail == SIGXFSZ ? CANDIDATE_FLOODED : CANDIDATE_CRASHED;
    } else if (found == -1 || code != 0) {
        answer->detail = code;
        answer->outcome = found == 1 && code == 77 ? CANDIDATE_UNSUPPORTED : CANDIDATE_FAILED;
    }
    if (candidate_failed(answer) && candidate_floods(c, out_dir, log_path))
        answer->outcome = CANDIDATE_FLOODED;
    candidate_explain(c, log_path, answer);
    if (found == -1 && answer->outcome == CANDIDATE_FAILED && code == 0)
        snprintf(answer->message, sizeof answer->message, "candidate ended before it answered (run-all goes on until the end of its input)");
    if (found != 1)
        end_server(s);
}
