/* What travels between rank 0, which has everything, and the ranks, each of which has its share. */
#include "engine.h"

#include <stdlib.h>
#include <string.h>

enum { CHUNK = 20000 };                     /* particles or contacts that travel at a time */

static void *room_for(const struct engine *g, size_t count, size_t size)
{
    void *room = calloc(count + 1, size);
    struct error e = { 0 };
    if (!room) {
        error_out_of_memory(&e);
        engine_abort(g, &e);
    }
    return room;
}

/* ---- out ---- */

struct heading { struct box box; double start_time, dt; int64_t step; int total, contacts; bool turns; };

static void pack(const struct suspension *s, int i, struct traveller *t)
{
    const struct particles *p = &s->particles;
    memset(t, 0, sizeof *t);
    t->tag = p->tag[i];
    t->species = p->species[i];
    t->position = p->position[i];
    t->velocity = p->velocity[i];
    t->kept.force = p->force[i];
    if (p->spin) {
        t->spin = p->spin[i];
        t->kept.torque = p->torque[i];
    }
    if (p->turn)
        t->kept.turn = p->turn[i];
    if (p->anchor)
        t->kept.anchor = p->anchor[i];
    t->kept.crossed = vec(p->image[i][0], p->image[i][1], p->image[i][2]);     /* LAMMPS counts from here on */
}

static int histories(const struct suspension *s, struct contact_record *c)
{
    const struct neighbours *n = &s->neighbours;
    int count = 0;
    for (int k = 0; n->history && k < n->count; k++)
        if (dot(n->history[k], n->history[k]) > 0.0) {
            if (c)
                c[count] = (struct contact_record){ s->particles.tag[n->candidate[k].i], s->particles.tag[n->candidate[k].j], n->history[k] };
            count++;
        }
    return count;
}

static void share_particles(struct engine *g)
{
    struct traveller *t = room_for(g, CHUNK, sizeof *t);
    for (int first = 0; first < g->total; first += CHUNK) {
        const int count = g->total - first < CHUNK ? g->total - first : CHUNK;
        for (int k = 0; g->rank == 0 && k < count; k++)
            pack(g->scene, first + k, &t[k]);
        MPI_Bcast(t, count * (int)sizeof *t, MPI_BYTE, 0, g->world);
        host_place(g, t, count);
    }
    free(t);
}

static void share_contacts(struct engine *g, int total)
{
    struct contact_record *c = room_for(g, (size_t)(g->rank == 0 && total > CHUNK ? total : CHUNK), sizeof *c);
    if (g->rank == 0)
        histories(g->scene, c);
    for (int first = 0; first < total || first == 0; first += CHUNK) {
        const int count = total - first < CHUNK ? total - first : CHUNK;
        struct contact_record *chunk = g->rank == 0 ? c + first : c;
        MPI_Bcast(chunk, count * (int)sizeof *chunk, MPI_BYTE, 0, g->world);
        host_place_contacts(g, chunk, count);
    }
    free(c);
}

void engine_share(struct engine *g)
{
    struct suspension *s = g->scene;
    struct heading h;
    memset(&h, 0, sizeof h);
    if (g->rank == 0) {
        box_remap(&s->box);
        box_wrap(&s->box, &s->particles);
        h = (struct heading){ s->box, s->start_time, s->dt, s->step, s->particles.count, histories(s, NULL), s->particles.turn != NULL };
    }
    MPI_Bcast(&h, sizeof h, MPI_BYTE, 0, g->world);
    g->shared_box = s->box = h.box;
    s->start_time = h.start_time;
    s->dt = h.dt;
    s->step = h.step;
    g->total = h.total;
    if (h.turns && !s->particles.turn)
        s->particles.turn = room_for(g, 1, sizeof(vec3));       /* only says that angles are followed */
    host_start(g);
    g->own = 0;
    share_particles(g);
    share_contacts(g, h.contacts);
}

/* ---- back ---- */

/* `count` records of every rank, one rank after the other, on rank 0; how many in all. */
static int gather(const struct engine *g, const void *mine, int count, size_t size, void **all)
{
    int *counts = room_for(g, (size_t)g->ranks, sizeof *counts), *from = room_for(g, (size_t)g->ranks, sizeof *from), total = 0;
    MPI_Datatype record;
    MPI_Gather(&count, 1, MPI_INT, counts, 1, MPI_INT, 0, g->world);
    for (int r = 0; r < g->ranks; r++) {
        from[r] = total;
        total += counts[r];
    }
    *all = g->rank == 0 ? room_for(g, (size_t)total, size) : NULL;
    MPI_Type_contiguous((int)size, MPI_BYTE, &record);
    MPI_Type_commit(&record);
    MPI_Gatherv(mine, count, record, *all, counts, from, record, 0, g->world);
    MPI_Type_free(&record);
    free(counts);
    free(from);
    return total;
}

static void unpack(struct particles *p, const struct traveller *t)
{
    const int i = t->tag - 1;
    memcpy(p->image[i], t->image, sizeof t->image);
    p->position[i] = t->position;
    p->velocity[i] = t->velocity;
    p->force[i] = t->kept.force;
    if (p->spin) {
        p->spin[i] = t->spin;
        p->torque[i] = t->kept.torque;
    }
    if (p->turn)
        p->turn[i] = t->kept.turn;
}

static void collect_particles(struct engine *g)
{
    struct traveller *mine = room_for(g, (size_t)g->own, sizeof *mine);
    void *all;
    const int total = gather(g, mine, host_own(g, mine), sizeof *mine, &all);
    for (int k = 0; g->rank == 0 && k < total; k++)
        unpack(&g->scene->particles, (const struct traveller *)all + k);
    if (g->rank == 0 && total != g->total) {
        struct error e = { 0 };
        error_raise(&e, ERROR_RUN, "LAMMPS has lost %d of %d particles", g->total - total, g->total);
        engine_abort(g, &e);
    }
    free(mine);
    free(all);
}

static int by_tags(const void *left, const void *right)
{
    const struct contact_record *a = left, *b = right;
    return a->first != b->first ? (a->first > b->first) - (a->first < b->first) : (a->second > b->second) - (a->second < b->second);
}

/* Histories into the list of rank 0, made anew for these positions: from here a checkpoint or a new share takes them. */
static void collect_contacts(struct engine *g)
{
    struct contact_record *mine = room_for(g, (size_t)host_contacts(g, NULL), sizeof *mine);
    void *all;
    const int total = gather(g, mine, host_contacts(g, mine), sizeof *mine, &all);
    struct neighbours *n = &g->scene->neighbours;
    const int *tag = g->scene->particles.tag;
    if (g->rank == 0)
        qsort(all, (size_t)total, sizeof *mine, by_tags);
    for (int k = 0; g->rank == 0 && n->history && k < n->count; k++) {
        const struct contact_record key = { tag[n->candidate[k].i], tag[n->candidate[k].j], { 0, 0, 0 } };
        const struct contact_record *found = bsearch(&key, all, (size_t)total, sizeof key, by_tags);
        n->history[k] = found ? found->history : vec(0, 0, 0);
    }
    free(mine);
    free(all);
}

void engine_collect(struct engine *g, bool contacts)
{
    struct suspension *s = g->scene;
    struct error e = { 0 };
    bool relisted;
    collect_particles(g);
    MPI_Reduce(g->here.stress.sum, s->stress.sum, MAX_ORIGINS * 9, MPI_DOUBLE, MPI_SUM, 0, g->world);
    if (!contacts)
        return;
    if (g->rank == 0 && !neighbours_find(&s->neighbours, &s->box, &s->particles, &relisted, &e))
        engine_abort(g, &e);
    collect_contacts(g);
}
