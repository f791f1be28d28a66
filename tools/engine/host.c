/*
 * LAMMPS as the host of our forces.
 *
 * Timing. LAMMPS moves the cell at the end of a step, so forces, wrapping and ghosts of step n see the cell it had before. We
 * therefore give it the cell of one step ahead: at step n it works with H(t_n), as shear does. Nothing is evaluated before the
 * first step: forces at the start are those that rank 0 has, and the first callback puts them back.
 *
 * Pairs. LAMMPS's half list (newton off) names a pair of two own particles once, and a pair across a border on either side of it.
 * Where both ends belong to this rank (across a periodic face) one of the two is dropped and the image is ours: it moves with our
 * cell. Else the other end is a ghost and either rank books half the stress; forces on ghosts are left where they fall.
 *
 * Contact histories must be with the particle whenever LAMMPS may hand it to another rank, so each own end of a
 * contact carries a copy, written at the end of each evaluation.
 *
 * A new list is recognised by a mark that LAMMPS copies onto ghosts only when it makes them anew.
 */
#define LAMMPS_LIB_MPI
#include "host.h"

#include "core/step_limit.h"

#include <lammps/library.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void host_command(const struct engine *g, const char *format, ...)
{
    char text[400];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    lammps_command(g->lammps, text);
}

void *host_grown(const struct engine *g, void *array, size_t size)
{
    void *more = realloc(array, size + 1);
    struct error e = { 0 };
    if (!more) {
        error_out_of_memory(&e);
        engine_abort(g, &e);
    }
    return more;
}

/* ---- LAMMPS's arrays as ours ---- */

/* LAMMPS keeps three numbers per particle in one piece, which is an array of vec3. */
static vec3 *vectors(const struct engine *g, const char *name)
{
    double **rows = lammps_extract_atom(g->lammps, name);
    return rows ? (vec3 *)(void *)rows[0] : NULL;
}

static struct kept *kept_of(const struct engine *g)
{
    double **rows = lammps_extract_atom(g->lammps, "d2_kept");
    return rows ? (struct kept *)(void *)rows[0] : NULL;
}

static void look_at(struct engine *g, vec3 *force)
{
    struct particles *p = &g->here.particles;
    p->count = g->own = lammps_extract_setting(g->lammps, "nlocal");
    g->ghosts = lammps_extract_setting(g->lammps, "nghost");
    p->tag = lammps_extract_atom(g->lammps, "id");
    p->position = vectors(g, "x");
    p->velocity = vectors(g, "v");
    p->spin = g->here.rotates ? vectors(g, "omega") : NULL;
    p->torque = g->here.rotates ? vectors(g, "torque") : NULL;
    p->force = force;
    p->species = g->species;
}

/* Cells that an own particle has crossed, counted in the never-remapped lattice: before LAMMPS had it, and since. */
static void crossed_of(const struct engine *g, const int *packed, const struct kept *kept, int i, int crossed[3])
{
    const double before[3] = { kept[i].crossed.x, kept[i].crossed.y, kept[i].crossed.z };
    int cells[3];
    lammps_decode_image_flags(packed[i], cells);
    box_lattice_shift(&g->here.box, cells, crossed);
    for (int k = 0; k < 3; k++)
        crossed[k] += (int)before[k];
}

/* ---- contact histories: per own particle `slots` times (tag of the other, three numbers), ended by tag 0 ---- */

static double *slots_of(const struct engine *g, int i)
{
    return g->slots ? ((double **)lammps_extract_atom(g->lammps, "d2_contacts"))[i] : NULL;
}

static void no_slot(const struct engine *g, int i)
{
    struct error e = { 0 };
    error_raise(&e, ERROR_RUN, "particle %d has more than %d contacts with friction: there is no room for such an overlap of many",
                g->here.particles.tag[i], g->slots);
    engine_abort(g, &e);
}

static inline void carry(const struct engine *g, double *first, int i, int other, vec3 h)
{
    double *slot = first + ((size_t)i * (size_t)g->slots + (size_t)g->slots_used[i]) * 4;
    if (g->slots_used[i]++ == g->slots)
        no_slot(g, i);
    slot[0] = other;
    slot[1] = h.x;
    slot[2] = h.y;
    slot[3] = h.z;
}

static void carry_contacts(struct engine *g)
{
    const struct near_pairs *near = &g->here.neighbours.near;
    const int *tag = g->here.particles.tag;
    if (!g->slots || g->own == 0)
        return;
    double *first = slots_of(g, 0);
    memset(g->slots_used, 0, (size_t)g->own * sizeof *g->slots_used);
    for (int k = 0; k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        if (pair->gap >= 0.0 || dot(*pair->history, *pair->history) == 0.0)
            continue;
        if (pair->i < g->own)
            carry(g, first, pair->i, tag[pair->j], *pair->history);
        if (pair->j < g->own)
            carry(g, first, pair->j, tag[pair->i], *pair->history);
    }
    for (int i = 0; i < g->own; i++)
        if (g->slots_used[i] < g->slots)
            first[((size_t)i * (size_t)g->slots + (size_t)g->slots_used[i]) * 4] = 0.0;
}

static vec3 carried(const struct engine *g, const double *first, int i, int other)
{
    const double *slot = first + (size_t)i * (size_t)g->slots * 4;
    for (int k = 0; k < g->slots && slot[4 * k] > 0.0; k++)
        if (slot[4 * k] == other)
            return vec(slot[4 * k + 1], slot[4 * k + 2], slot[4 * k + 3]);
    return vec(0, 0, 0);
}

/* ---- the list ---- */

static int image_index(const int shift[3]) { return ((shift[2] + 1) * 3 + shift[1] + 1) * 3 + shift[0] + 1; }

static void take_candidate(struct engine *g, int i, int j, const int shift[3], double weight)
{
    struct neighbours *n = &g->here.neighbours;
    const struct particles *p = &g->here.particles;
    const double range = n->range[p->species[i]][p->species[j]];
    if (range <= 0.0)
        return;
    if (n->count == n->room) {
        n->room = n->room ? n->room + n->room / 2 : 1024;
        n->candidate = host_grown(g, n->candidate, (size_t)n->room * sizeof *n->candidate);
    }
    n->candidate[n->count++] = (struct candidate){ i, j, image_index(shift), 0, radius_of(p, i) + radius_of(p, j), range * range, weight };
}

/* One pair of LAMMPS's list: i is ours, j ours or a ghost. Smaller tag first. */
static void take_pair(struct engine *g, int i, int j)
{
    const struct particles *p = &g->here.particles;
    static const int none[3] = { 0, 0, 0 };
    const bool first = p->tag[i] < p->tag[j];
    if (j < g->own) {
        take_candidate(g, first ? i : j, first ? j : i, none, 1.0);
        return;
    }
    const int owner = g->index_of_tag[p->tag[j]];
    if (owner < 0 || owner >= g->own || p->tag[owner] != p->tag[j]) {
        take_candidate(g, first ? i : j, first ? j : i, none, 0.5);
        return;
    }
    if (!first)
        return;                                             /* seen from the other end too */
    const vec3 cells = mat3_times(&g->here.box.inverse, minus(p->position[j], p->position[owner]));
    const int shift[3] = { (int)lround(cells.x), (int)lround(cells.y), (int)lround(cells.z) };
    take_candidate(g, i, owner, shift, 1.0);
}

static void make_list(struct engine *g)
{
    struct neighbours *n = &g->here.neighbours;
    struct particles *p = &g->here.particles;
    const int all = g->own + g->ghosts, list = lammps_find_pair_neighlist(g->lammps, "zero", 1, 0, 0);
    const int *type = lammps_extract_atom(g->lammps, "type");
    const struct kept *kept = kept_of(g);
    if (all > g->room) {
        g->room = all + all / 4;
        p->species = g->species = host_grown(g, g->species, (size_t)g->room * sizeof *g->species);
        g->slots_used = host_grown(g, g->slots_used, (size_t)g->room * sizeof *g->slots_used);
        if (p->anchored) {
            p->anchor = host_grown(g, p->anchor, (size_t)g->room * sizeof *p->anchor);
            p->image = host_grown(g, p->image, (size_t)g->room * sizeof *p->image);
        }
    }
    for (int i = 0; i < all; i++)
        g->species[i] = type[i] - 1;
    for (int i = 0; i < g->own; i++) {
        g->index_of_tag[p->tag[i]] = i;
        if (p->anchored)
            p->anchor[i] = kept[i].anchor;
    }
    n->count = 0;
    for (int k = 0; k < lammps_neighlist_num_elements(g->lammps, list); k++) {
        int i, count, *other;
        lammps_neighlist_element_neighbors(g->lammps, list, k, &i, &count, &other);
        for (int m = 0; m < count; m++)
            take_pair(g, i, other[m] & 0x3FFFFFFF);         /* the two highest bits tell bonded neighbours: there are none */
    }
    if (n->count >= n->near.room) {
        n->near.room = n->count + n->count / 4 + 64;
        n->near.pair = host_grown(g, n->near.pair, (size_t)n->near.room * sizeof *n->near.pair);
        if (n->near.keeps_resistance)
            n->near.resistance = host_grown(g, n->near.resistance, (size_t)n->near.room * sizeof *n->near.resistance);
        if (n->keeps_history)
            n->history = host_grown(g, n->history, (size_t)n->near.room * sizeof *n->history);
    }
    const double *first = g->slots && g->own ? slots_of(g, 0) : NULL;
    for (int k = 0; n->keeps_history && k < n->count; k++) {
        const struct candidate *c = &n->candidate[k];
        n->history[k] = c->i < g->own ? carried(g, first, c->i, p->tag[c->j]) : carried(g, first, c->j, p->tag[c->i]);
    }
    for (int k = 0; k < n->offset_count; k++) {             /* where nothing flows the search does not move them */
        n->offset[k].position = box_offset(&g->here.box, n->offset[k].shift);
        n->offset[k].velocity = box_flow(&g->here.box, n->offset[k].position);
    }
}

/* Has LAMMPS made a list since the last look? Without ghosts nobody can tell, and a list is cheap. */
static bool is_new_list(const struct engine *g)
{
    int *mark = lammps_extract_atom(g->lammps, "i_mark");
    if (g->ghosts == 0 || mark[g->own] != 1) {
        if (g->ghosts > 0)
            mark[g->own] = 1;
        return true;
    }
    return false;
}

/* ---- the callback: everything physical ---- */

static void restore(struct engine *g)
{
    const struct particles *p = &g->here.particles;
    const struct kept *kept = kept_of(g);
    for (int i = 0; i < g->own; i++) {
        p->force[i] = kept[i].force;
        if (p->torque)
            p->torque[i] = kept[i].torque;
    }
}

static void check_sound(struct engine *g, bool relisted)
{
    struct suspension *s = &g->here;
    const struct near_pairs *near = &s->neighbours.near;
    struct error e = { 0 };
    if (near->deepest > s->overlap_limit)
        error_raise(&e, ERROR_RUN, "particles %d and %d overlap by %.3g of the smaller radius at time %.9g (step %lld); the limit is %g: "
                    "stiffen the contact, slow the flow or shorten dt", near->deepest_tag[0], near->deepest_tag[1], near->deepest,
                    s->box.time, (long long)s->step, s->overlap_limit);
    if (relisted && !error_raised(&e)) {
        s->particles.count = g->own + g->ghosts;            /* pairs name ghosts too; their own ranks judge those fully */
        step_is_allowed(s, "verlet", &e);
        s->particles.count = g->own;
    }
    if (error_raised(&e))
        engine_abort(g, &e);
}

void host_evaluate(void *engine, int64_t step, int own, int *id, double **x, double **host_force)
{
    struct engine *g = engine;
    struct suspension *s = &g->here;
    struct particles *p = &s->particles;
    struct error e = { 0 };
    bool unused;
    (void)own, (void)id, (void)x;
    look_at(g, host_force ? (vec3 *)(void *)host_force[0] : NULL);
    const bool relisted = is_new_list(g) && g->own + g->ghosts > 0;
    s->step = step;
    box_set_time(&s->box, s->start_time + (double)step * s->dt);
    if (relisted)
        make_list(g);
    if (g->restoring) {
        restore(g);
        g->restoring = false;
        return;
    }
    s->measuring = g->measures && step == g->last_step;
    if (g->own + g->ghosts == 0)
        return;
    memset(p->force, 0, (size_t)(g->own + g->ghosts) * sizeof *p->force);
    if (p->torque)
        memset(p->torque, 0, (size_t)(g->own + g->ghosts) * sizeof *p->torque);
    if (p->anchored) {
        const int *packed = lammps_extract_atom(g->lammps, "image");
        const struct kept *kept = kept_of(g);
        for (int i = 0; i < g->own; i++)
            crossed_of(g, packed, kept, i, p->image[i]);
    }
    if (!neighbours_find(&s->neighbours, &s->box, p, &unused, &e))
        engine_abort(g, &e);
    const struct moment now = moment_of(s, s->dt);
    suspension_add_forces(s, ALL_KINDS, &now);
    check_sound(g, relisted);
    carry_contacts(g);
    struct kept *kept = g->scene->particles.turn ? kept_of(g) : NULL;
    for (int i = 0; kept && i < g->own; i++)
        kept[i].turn = plus(kept[i].turn, scaled(p->spin[i], s->dt));
}

/* ---- dealing out ---- */

/* Of particles that all ranks are told of LAMMPS keeps those that lie here, behind those it has and in the same order. */
void host_place(struct engine *g, const struct traveller *t, int count)
{
    int *id = host_grown(g, NULL, (size_t)count * sizeof *id), *type = host_grown(g, NULL, (size_t)count * sizeof *type);
    double *x = host_grown(g, NULL, (size_t)count * sizeof(vec3)), *v = host_grown(g, NULL, (size_t)count * sizeof(vec3));
    for (int k = 0; k < count; k++) {
        id[k] = t[k].tag;
        type[k] = t[k].species + 1;
        memcpy(x + 3 * k, &t[k].position, sizeof(vec3));
        memcpy(v + 3 * k, &t[k].velocity, sizeof(vec3));
    }
    lammps_create_atoms(g->lammps, count, id, type, x, v, NULL, 0);
    const int before = g->own;
    look_at(g, NULL);
    struct particles *p = &g->here.particles;
    struct kept *kept = kept_of(g);
    double *radius = lammps_extract_atom(g->lammps, "radius"), *mass = lammps_extract_atom(g->lammps, "rmass");
    double *slots = g->slots && g->own ? slots_of(g, 0) : NULL;
    int *mark = lammps_extract_atom(g->lammps, "i_mark");
    vec3 *spin = vectors(g, "omega");
    for (int k = 0, i = before; k < count && i < g->own; k++) {
        if (p->tag[i] != t[k].tag)
            continue;
        const struct species *kind = &p->kind[t[k].species];
        radius[i] = kind->radius;
        mass[i] = kind->mass;                               /* infinite where driven: LAMMPS then keeps its velocity too */
        spin[i] = t[k].spin;
        kept[i] = t[k].kept;
        mark[i] = 0;
        /* Rounding may put a particle on the other side of a face: then it is the image there, with that image's velocity. */
        p->velocity[i] = plus(t[k].velocity, box_flow(&g->here.box, minus(p->position[i], t[k].position)));
        if (slots)
            slots[(size_t)i * (size_t)g->slots * 4] = 0.0;
        g->index_of_tag[p->tag[i]] = i;
        i++;
    }
    free(id);
    free(type);
    free(x);
    free(v);
}

void host_place_contacts(struct engine *g, const struct contact_record *c, int count)
{
    double *first = g->slots && g->own ? slots_of(g, 0) : NULL;
    g->slots_used = host_grown(g, g->slots_used, ((size_t)g->own + 1) * sizeof *g->slots_used);
    for (int k = 0; k < count && first; k++)
        for (int side = 0; side < 2; side++) {
            const int tag = side ? c[k].second : c[k].first, other = side ? c[k].first : c[k].second, i = g->index_of_tag[tag];
            if (i < 0)
                continue;
            double *slot = first + (size_t)i * (size_t)g->slots * 4;
            g->slots_used[i] = 0;
            while (g->slots_used[i] < g->slots && slot[4 * g->slots_used[i]] > 0.0)
                g->slots_used[i]++;
            carry(g, first, i, other, c[k].history);
            if (g->slots_used[i] < g->slots)
                slot[4 * g->slots_used[i]] = 0.0;
        }
    g->room = g->own;                                       /* as far as all arrays are long enough */
    g->species = host_grown(g, g->species, ((size_t)g->own + 1) * sizeof *g->species);
}

void host_advance(struct engine *g, int64_t to, bool measuring)
{
    const bool fresh = g->restoring;
    g->last_step = to;
    g->measures = measuring;
    stress_clear(&g->here.stress);
    host_command(g, "run %lld pre %s post no start %lld stop %lld", (long long)(to - g->here.step), fresh ? "yes" : "no", (long long)g->first_step,
            (long long)g->first_step + (1LL << 40));    /* farther than any run; a power of two does not round the tilt */
}

/* ---- looking ---- */

int host_own(const struct engine *g, struct traveller *t)
{
    const struct particles *p = &g->here.particles;
    const int *packed = lammps_extract_atom(g->lammps, "image");
    const struct kept *kept = kept_of(g);
    const vec3 *force = vectors(g, "f"), *spin = vectors(g, "omega");
    for (int i = 0; t && i < g->own; i++) {
        t[i] = (struct traveller){ .tag = p->tag[i], .species = p->species[i], .position = p->position[i], .velocity = p->velocity[i],
                                   .spin = spin[i], .kept = kept[i] };
        t[i].kept.force = force[i];
        if (p->torque)
            t[i].kept.torque = p->torque[i];
        crossed_of(g, packed, kept, i, t[i].image);
    }
    return g->own;
}

int host_contacts(const struct engine *g, struct contact_record *c)
{
    const struct near_pairs *near = &g->here.neighbours.near;
    const int *tag = g->here.particles.tag;
    int count = 0;
    for (int k = 0; g->slots && k < near->count; k++) {
        const struct pair *pair = &near->pair[k];
        if (pair->i >= g->own || pair->gap >= 0.0 || dot(*pair->history, *pair->history) == 0.0)
            continue;
        if (c)
            c[count] = (struct contact_record){ tag[pair->i], tag[pair->j], *pair->history };
        count++;
    }
    return count;
}

void host_stop(struct engine *g)
{
    struct suspension *s = &g->here;
    free(g->index_of_tag);
    free(g->species);
    free(g->slots_used);
    free(s->particles.anchor);
    free(s->particles.image);
    free(s->neighbours.candidate);
    free(s->neighbours.history);
    free(s->neighbours.offset);
    free(s->neighbours.near.pair);
    free(s->neighbours.near.resistance);
    if (g->lammps)
        lammps_close(g->lammps);
}
