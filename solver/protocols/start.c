#include "protocols/protocols.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

static void start_from_file(struct settings *start, const char *scene_path, struct suspension *s, struct error *e)
{
    const char *file = settings_text(start, "file", e), *slash = strrchr(scene_path, '/');
    char path[512];
    snprintf(path, sizeof path, "%.*s%s", *file == '/' || !slash ? 0 : (int)(slash - scene_path + 1), scene_path, file);
    struct state_file *states = error_raised(e) ? NULL : state_file_read(path, e);
    if (states)
        state_file_place(states, 0, s, e);
    state_file_free(states);
}

bool suspension_start(struct settings *root, const char *scene_path, const char *states, struct suspension *s, struct error *e)
{
    struct settings start = settings_child(root, "start", e);
    s->start_time = start.node ? settings_number_or(&start, "time", 0.0, e) : 0.0;
    if (s->box.flow)
        s->box.flow->rounding = 32.0 * DBL_EPSILON * (fabs(s->start_time) + s->box.flow->duration);
    box_set_time(&s->box, s->start_time);
    box_remap(&s->box);
    const bool thermal = start.node && settings_flag_or(&start, "thermal", false, e);
    const bool given = start.node && settings_has(&start, "file"), drawn = start.node && settings_has(&start, "random");
    if (states)
        return !error_raised(e);
    if (given == drawn)
        return error_raise(e, ERROR_INPUT, "start must have either file or random");
    if ((drawn || thermal) && !settings_has(root, "seed"))
        return error_raise(e, ERROR_INPUT, "seed is missing; it must be a whole number, for start draws random numbers");
    struct settings random = settings_child(&start, "random", e);
    if (random.node)
        random_start(&random, s, e);
    else if (given)
        start_from_file(&start, scene_path, s, e);
    settings_done(&start, e);
    if (thermal && !error_raised(e))
        thermal_start(s);
    return !error_raised(e);
}
