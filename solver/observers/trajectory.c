/*
 * Where every particle is: `trajectory.csv`, unwrapped positions, the velocity of that image, spins, species, and on request the
 * angle turned through (the time integral of the spin).
 */
#include "observers/observers.h"

#include <stdlib.h>

struct trajectory { struct observer base; struct table table; bool turn; };

static bool trajectory_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct table *t = &((struct trajectory *)self)->table;
    (void)s;
    if (!table_open(t, to, "trajectory.csv", e))
        return false;
    fprintf(t->file, "step,time,id,x,y,z,ux,uy,uz,wx,wy,wz,species%s\n", ((struct trajectory *)self)->turn ? ",turn_x,turn_y,turn_z" : "");
    return true;
}

static bool trajectory_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct table *t = &((struct trajectory *)self)->table;
    const struct particles *p = &s->particles;
    for (int i = 0; i < p->count; i++) {
        const vec3 off = box_unwrapped(&s->box, p->image[i]), x = plus(p->position[i], off);
        const vec3 u = plus(p->velocity[i], box_flow(&s->box, off)), w = p->spin ? p->spin[i] : vec(0, 0, 0);
        fprintf(t->file, "%lld,%.17g,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d", (long long)s->step, s->box.time, p->tag[i],
                x.x, x.y, x.z, u.x, u.y, u.z, w.x, w.y, w.z, p->species[i] + 1);
        if (((struct trajectory *)self)->turn)
            fprintf(t->file, ",%.17g,%.17g,%.17g", p->turn[i].x, p->turn[i].y, p->turn[i].z);
        fputc('\n', t->file);
    }
    return table_check(t, e);
}

static void trajectory_remember(struct observer *self, struct fields *f)
{
    table_remember(&((struct trajectory *)self)->table, "trajectory.csv", f);
}

static bool trajectory_close(struct observer *self, struct error *e)
{
    const bool good = table_close(&((struct trajectory *)self)->table, e);
    free(self->at);
    free(self);
    return good;
}

static bool read_steps(struct settings *s, struct observer *o, struct error *e)
{
    o->at_count = settings_length(s, "at", e);
    double *steps = calloc((size_t)o->at_count + 1, sizeof *steps);
    o->at = calloc((size_t)o->at_count + 1, sizeof *o->at);
    if (!steps || !o->at)
        error_out_of_memory(e);
    else
        settings_numbers(s, "at", steps, o->at_count, e);
    for (int k = 0; k < o->at_count && !error_raised(e); k++) {
        o->at[k] = (int64_t)steps[k];
        if ((double)o->at[k] != steps[k] || steps[k] < 0 || (k && o->at[k] <= o->at[k - 1]))
            settings_refuse(s, "at", e, "must list whole step numbers in ascending order");
    }
    free(steps);
    return !error_raised(e);
}

/* "states": { "every": 1000, "turn": true }  or  { "at": [0, 1, 2, 4, 8] } */
struct observer *trajectory_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct trajectory *o = calloc(1, sizeof *o);
    if (!o)
        return error_out_of_memory(e), NULL;
    o->base = (struct observer){ .open = trajectory_open, .observe = trajectory_observe, .remember = trajectory_remember, .close = trajectory_close };
    if (settings_has(s, "at"))
        read_steps(s, &o->base, e);
    else
        o->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    if (settings_flag_or(s, "turn", false, e)) {
        if (!of->rotates)
            settings_refuse(s, "turn", e, "needs a scene in which particles rotate");
        o->turn = true;
        of->particles.turn = calloc((size_t)of->particles.count + 1, sizeof(vec3));
    }
    return &o->base;
}
