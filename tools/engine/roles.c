/*
 * Rank 0 steps like any equation of motion of shear, only that one of its steps goes as far as the next that somebody looks at;
 * the other ranks do as they are told.
 */
#include "engine.h"

enum order { ORDER_SHARE, ORDER_ADVANCE, ORDER_COLLECT, ORDER_END };
struct orders { enum order what; int64_t to; bool flag; };

/* How far the cell may lean between two looks at whether it wants to be remapped, and how long Ctrl-C may have to wait. */
static const double most_strain = 0.05, most_seconds = 2.0;

static void obey(struct engine *g, struct orders o)
{
    switch (o.what) {
    case ORDER_SHARE:   engine_share(g); break;
    case ORDER_ADVANCE: host_advance(g, o.to, o.flag); break;
    case ORDER_COLLECT: engine_collect(g, o.flag); break;
    case ORDER_END:     break;
    }
}

static void tell(struct engine *g, enum order what, int64_t to, bool flag)
{
    struct orders o = { what, to, flag };
    MPI_Bcast(&o, sizeof o, MPI_BYTE, 0, g->world);
    obey(g, o);
}

void engine_follow(struct engine *g)
{
    struct orders o;
    do {
        MPI_Bcast(&o, sizeof o, MPI_BYTE, 0, g->world);
        obey(g, o);
    } while (o.what != ORDER_END);
}

void engine_dismiss(struct engine *g) { tell(g, ORDER_END, 0, false); }

/* ---- what rank 0 does ---- */

static bool is_due(const struct observer *o, int64_t step)
{
    bool due = o->every > 0 && step % o->every == 0;
    for (int k = 0; o->every == 0 && k < o->at_count; k++)
        due = due || o->at[k] == step;
    return due;
}

static int64_t next_due(const struct observer *o, int64_t after)
{
    int64_t next = INT64_MAX;
    if (o->every > 0)
        return after - after % o->every + o->every;
    for (int k = o->at_count - 1; k >= 0 && o->at[k] > after; k--)
        next = o->at[k];
    return next;
}

static int64_t sooner(int64_t a, int64_t b) { return a < b ? a : b; }

/* The next step that anybody looks at: observers, the checkpoint, the end. */
static int64_t next_look(const struct simulation *sim, int64_t after)
{
    const int64_t every = sim->checkpoint.every;
    int64_t next = every > 0 ? sooner(sim->last_step, after - after % every + every) : sim->last_step;
    for (int k = 0; k < sim->observer_count; k++)
        next = sooner(next, next_due(sim->observer[k], after));
    return next;
}

/* The cell is remapped at multiples of this only, so that no clock and no observer has a say in it. */
static int64_t steps_to_turn(const struct suspension *s)
{
    return s->box.rate > 0.0 ? (int64_t)fmin(fmax(1.0, most_strain / (s->box.rate * s->dt)), 1e15) : INT64_C(1) << 50;
}

/* At most so many steps at a time, in multiples of 64 so that the progress line is shown. */
static int64_t next_stop(const struct engine *g, int64_t after)
{
    const struct suspension *s = g->scene;
    const double most = g->pace > 0.0 ? most_seconds / g->pace : 64.0;
    const int64_t step = most < 64.0 ? (int64_t)fmax(1.0, most) : (int64_t)fmin(most / 64.0, 1e6) * 64, turn = steps_to_turn(s);
    return sooner(after - after % step + step, after - after % turn + turn);
}

static struct engine *leading;              /* there is one engine in a process */

static bool engine_step(const struct dynamics *self, struct suspension *s, bool *relisted, struct error *e)
{
    struct engine *g = leading;
    const struct simulation *sim = g->sim;
    const int64_t look = next_look(sim, s->step), to = sooner(look, next_stop(g, s->step)), every = sim->checkpoint.every;
    bool measures = false, pairs = every > 0 && (to % every == 0 || to == sim->last_step);
    (void)self, (void)e;
    for (int k = 0; k < sim->observer_count; k++)
        if (is_due(sim->observer[k], to)) {
            measures = measures || sim->observer[k]->measures;
            pairs = pairs || sim->observer[k]->reads_pairs;
        }
    if (!g->shared)
        tell(g, ORDER_SHARE, 0, false);
    g->shared = true;
    const double began = MPI_Wtime();
    tell(g, ORDER_ADVANCE, to, measures);
    g->pace = (MPI_Wtime() - began) / (double)(to - s->step);
    s->step = to;
    s->measuring = measures;
    box_set_time(&s->box, s->start_time + (double)to * s->dt);
    box_set_time(&g->shared_box, s->box.time);
    *relisted = false;                      /* every rank has judged the steps on its own */
    const bool remap = to % steps_to_turn(s) == 0 && box_wants_remap(&g->shared_box);
    if (to == look || remap || checkpoint_wanted())
        tell(g, ORDER_COLLECT, 0, pairs || remap || checkpoint_wanted());
    g->shared = !remap;
    return true;
}

void engine_lead(struct engine *g, struct simulation *sim)
{
    static struct dynamics stepped;
    leading = g;
    g->sim = sim;
    stepped = *sim->dynamics;               /* it begins as shear does: forces at the start are those of rank 0 */
    stepped.step = engine_step;
    sim->dynamics = &stepped;
}
