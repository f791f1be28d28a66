#include "output/output.h"

#include <time.h>
#include <unistd.h>

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void progress_start(struct progress *p, int64_t first, int64_t last)
{
    p->started = p->shown = seconds_now();
    p->first = first;
    p->last = last;
    p->wanted = isatty(STDERR_FILENO);
}

void progress_show(struct progress *p, const struct suspension *s)
{
    if (!p->wanted || s->step % 64 != 0)
        return;
    const double now = seconds_now();
    if (now - p->shown < 0.25)
        return;
    p->shown = now;
    const double speed = (double)(s->step - p->first) / (now - p->started);
    fprintf(stderr, "\rstep %lld of %lld  time %.5g  strain %.4g  %.3g particle-steps/s  %.0f s left \033[K", (long long)s->step, (long long)p->last,
            s->box.time, box_strain(&s->box, s->start_time, s->box.time), speed * s->particles.count, (double)(p->last - s->step) / speed);
}

void progress_end(struct progress *p)
{
    if (p->wanted)
        fputs("\r\033[K", stderr);
}
