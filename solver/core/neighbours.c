#include "core/neighbours.h"
#include "core/history.h"
#include "core/images.h"

#include <stdlib.h>
#include <string.h>

bool neighbours_start(struct neighbours *n, const struct particles *p, struct error *e)
{
    double smallest = INFINITY;
    n->count = 0, n->made = n->steps_since = 0;
    for (int a = 0; a < p->species_count; a++) {
        smallest = fmin(smallest, p->kind[a].radius);
        for (int b = 0; b < p->species_count; b++)
            n->largest_range = fmax(n->largest_range, n->range[a][b]);
    }
    n->skin = 0.1 * smallest;
    free(n->listed_at);
    n->listed_at = malloc(((size_t)p->count + 1) * sizeof *n->listed_at);
    return n->listed_at || error_out_of_memory(e);
}

void neighbours_free(struct neighbours *n)
{
    free(n->candidate);
    free(n->history);
    free(n->offset);
    free(n->listed_at);
    free(n->near.pair);
    free(n->near.resistance);
}

/* Has the crowd moved so far that a pair outside the list may be within range? NaN counts as moved. */
static bool outdated(const struct neighbours *n, const struct box *box, const struct particles *p)
{
    if (n->made == 0 || box_wants_remap(box))
        return true;
    const mat3 F = box_deformation(box, n->listed_time, box->time);
    double shear = 0.0;
    for (int k = 0; k < 9; k++)
        shear += (F.m[k / 3][k % 3] - (k % 4 == 0)) * (F.m[k / 3][k % 3] - (k % 4 == 0));
    shear = sqrt(shear);
    const double allowed = 0.5 * (n->skin * (1.0 - shear) - shear * n->largest_range);
    if (allowed <= 0.0)
        return true;
    for (int i = 0; i < p->count; i++) {
        const vec3 moved = minus(p->position[i], box->flowing ? mat3_times(&F, n->listed_at[i]) : n->listed_at[i]);
        if (!(dot(moved, moved) <= allowed * allowed))
            return true;
    }
    return false;
}

/* ---- making a list: cells of at least range + skin, whose neighbours hold all neighbours ---- */

struct grid { int cells[3], reach[3], span[3]; int *first, *next, (*cell)[3]; };    /* particles of a cell as a linked list */

static bool grid_new(struct grid *g, const struct box *box, const struct particles *p, double distance, struct error *e)
{
    size_t total = 1;
    for (int k = 0; k < 3; k++) {
        const double most = cbrt((double)p->count) * 2.0 + 1.0;                /* more cells than that would be empty */
        g->cells[k] = (int)fmax(1.0, fmin(most, floor(box_width(box, k) / distance)));
        /* An open direction sees no images, so its own cells and the next are enough even where they are few. */
        g->reach[k] = box->periodic[k] ? (int)ceil(distance * g->cells[k] / box_width(box, k)) : 1;
        g->span[k] = box->periodic[k] ? (g->reach[k] + g->cells[k] - 1) / g->cells[k] : 0;      /* farthest image seen */
        if (box->periodic[k] && !(distance < MOST_IMAGES * box_width(box, k)))
            return error_raise(e, ERROR_RUN, "at time %.9g the cell is %g thin, too thin for a range of %g; it stays compact in shear if the edge "
                               "along each flow lies along its axis", box->time, box_width(box, k), distance);
        total *= (size_t)g->cells[k];
    }
    g->first = malloc(total * sizeof *g->first);
    g->next = malloc(((size_t)p->count + 1) * sizeof *g->next);
    g->cell = malloc(((size_t)p->count + 1) * sizeof *g->cell);
    if (!g->first || !g->next || !g->cell)
        return error_out_of_memory(e);
    memset(g->first, -1, total * sizeof *g->first);
    for (int i = p->count - 1; i >= 0; i--) {
        const vec3 inside = mat3_times(&box->inverse, p->position[i]);
        const double fraction[3] = { inside.x, inside.y, inside.z };
        for (int k = 0; k < 3; k++)     /* clamped: neighbours stay within one cell of each other outside an open cell too */
            g->cell[i][k] = (int)fmin(fmax(floor(fraction[k] * g->cells[k]), 0.0), g->cells[k] - 1.0);
        int *head = &g->first[(g->cell[i][2] * g->cells[1] + g->cell[i][1]) * g->cells[0] + g->cell[i][0]];
        g->next[i] = *head;
        *head = i;
    }
    return true;
}

/* Index of an image in the table of offsets, which spans -span..span in each direction. */
static int offset_index(const int shift[3], const int span[3])
{
    return ((shift[2] + span[2]) * (2 * span[1] + 1) + shift[1] + span[1]) * (2 * span[0] + 1) + shift[0] + span[0];
}

static void offsets_move(struct neighbours *n, const struct box *box)
{
    for (int k = 0; k < n->offset_count; k++) {
        n->offset[k].position = box_offset(box, n->offset[k].shift);
        n->offset[k].velocity = mat3_times(&box->image_gradient, n->offset[k].position);
    }
}

static bool offsets_new(struct neighbours *n, const struct box *box, const int span[3], struct error *e)
{
    n->offset_count = (2 * span[0] + 1) * (2 * span[1] + 1) * (2 * span[2] + 1);
    struct image_offset *table = realloc(n->offset, (size_t)n->offset_count * sizeof *table);
    if (!table)
        return error_out_of_memory(e);
    n->offset = table;
    memset(table, 0, (size_t)n->offset_count * sizeof *table);      /* padding too: checkpoints hold the bytes */
    for (int k = 0; k < n->offset_count; k++) {
        const int x = 2 * span[0] + 1, y = 2 * span[1] + 1;
        const int shift[3] = { k % x - span[0], k / x % y - span[1], k / (x * y) - span[2] };
        memcpy(table[k].shift, shift, sizeof shift);
    }
    offsets_move(n, box);
    return true;
}

static void list_pair(struct neighbours *n, const struct box *box, const struct particles *p, int i, int j, const int shift[3],
                      const int span[3], struct error *e)
{
    const vec3 r = minus(plus(p->position[j], n->offset[offset_index(shift, span)].position), p->position[i]);
    const double range = n->range[p->species[i]][p->species[j]], listed = range + n->skin;
    if (dot(r, r) > listed * listed || range <= 0.0)
        return;
    if (p->body && p->body[i] >= 0 && p->body[i] == p->body[j])
        return;                                                     /* a rigid body does not press on itself */
    if (n->count == n->room) {
        n->room = n->room ? 2 * n->room : 1024;
        struct candidate *more = realloc(n->candidate, (size_t)n->room * sizeof *more);
        if (!more) {
            n->room = n->count;
            error_out_of_memory(e);
            return;
        }
        n->candidate = more;
    }
    /* Cells of the never-remapped lattice between i and this image of j: invariant under wrapping and remap. */
    int lattice[3];
    box_lattice_shift(box, shift, lattice);
    for (int k = 0; k < 3; k++)
        lattice[k] += p->image[i][k] - p->image[j][k];
    /* One orientation for each pair, whatever the search order: smaller tag first; a self-image by the sign of its lattice shift. */
    const int first = lattice[0] ? lattice[0] : lattice[1] ? lattice[1] : lattice[2];
    const int sign = p->tag[i] > p->tag[j] || (i == j && first < 0) ? -1 : 1;
    const int to[3] = { sign * shift[0], sign * shift[1], sign * shift[2] };
    /* Fifteen bits tell apart images that can be near at the same time: counts modulo 32 in each direction. */
    const uint32_t key = ((uint32_t)(sign * lattice[0]) & 31u) | ((uint32_t)(sign * lattice[1]) & 31u) << 5 |
                         ((uint32_t)(sign * lattice[2]) & 31u) << 10;
    n->candidate[n->count++] = (struct candidate){ sign > 0 ? i : j, sign > 0 ? j : i, offset_index(to, span), key,
                                                   radius_of(p, i) + radius_of(p, j), range * range, 1.0 };
}

/* Pairs of particle i with all of one cell. In its own cell, unshifted, each pair once: those later in the list. */
static void list_cell(struct neighbours *n, const struct box *box, const struct particles *p, const struct grid *g, int i,
                      const int step[3], struct error *e)
{
    int shift[3], cell[3];
    for (int k = 0; k < 3; k++) {
        const int at = g->cell[i][k] + step[k];
        shift[k] = box->periodic[k] ? (int)floor((double)at / g->cells[k]) : 0;
        cell[k] = at - shift[k] * g->cells[k];
        if (cell[k] < 0 || cell[k] >= g->cells[k])
            return;                                                 /* outside an open cell */
    }
    const bool own = !step[0] && !step[1] && !step[2];
    int j = own ? g->next[i] : g->first[(cell[2] * g->cells[1] + cell[1]) * g->cells[0] + cell[0]];
    for (; j >= 0; j = g->next[j])
        list_pair(n, box, p, i, j, shift, g->span, e);
}

static void list_all(struct neighbours *n, const struct box *box, const struct particles *p, struct error *e)
{
    struct grid g = { .first = NULL };
    n->count = 0;
    if (grid_new(&g, box, p, n->largest_range + n->skin, e) && offsets_new(n, box, g.span, e))
        for (int i = 0; i < p->count; i++)
            for (int z = 0; z <= g.reach[2]; z++)                   /* half of all cells around: the other half sees us */
                for (int y = z ? -g.reach[1] : 0; y <= g.reach[1]; y++)
                    for (int x = z || y ? -g.reach[0] : 0; x <= g.reach[0]; x++)
                        list_cell(n, box, p, &g, i, (const int[3]){ x, y, z }, e);
    free(g.first);
    free(g.next);
    free(g.cell);
}

/* ---- the list ---- */

static bool near_room(struct near_pairs *near, int room, struct error *e)
{
    if (room < near->room)
        return true;
    near->room = room + room / 4 + 64;
    free(near->pair);
    free(near->resistance);
    near->pair = malloc((size_t)near->room * sizeof *near->pair);
    near->resistance = near->keeps_resistance ? malloc((size_t)near->room * sizeof *near->resistance) : NULL;
    return (near->pair && (near->resistance || !near->keeps_resistance)) || error_out_of_memory(e);
}

static bool make_list(struct neighbours *n, struct box *box, struct particles *p, struct error *e)
{
    if (!particles_finite(p, box->time, e))
        return false;
    /* A list that lives less than ten steps costs more than the pairs of a thicker skin, and the other way round. */
    if (n->made && n->steps_since < 10)
        n->skin = fmin(1.5 * n->skin, 0.25 * n->largest_range);
    else if (n->made && n->steps_since > 200)
        n->skin = fmax(0.8 * n->skin, 0.01 * n->largest_range);
    box_remap(box);
    box_wrap(box, p);
    int kept = 0;
    struct remembered *old = n->keeps_history ? history_remember(n, &kept, e) : NULL;
    if (n->largest_range > 0.0 && !error_raised(e))
        list_all(n, box, p, e);
    if (old && !error_raised(e))
        history_recall(n, old, kept, e);
    free(old);
    memcpy(n->listed_at, p->position, (size_t)p->count * sizeof *p->position);
    n->listed_time = box->time;
    n->steps_since = 0;
    n->made++;
    return !error_raised(e) && near_room(&n->near, n->count, e);
}

/* ---- each step ---- */
bool neighbours_find(struct neighbours *n, struct box *box, struct particles *p, bool *relisted, struct error *e)
{
    struct near_pairs *near = &n->near;
    *relisted = false;
    near->count = 0;
    near->deepest = 0.0;
    if (n->largest_range <= 0.0 && !box_wants_remap(box) && n->made && ++n->steps_since < 100)
        return true;                                                /* no pair force: only keep particles near the cell */
    *relisted = !n->foreign && outdated(n, box, p);
    if (*relisted && !make_list(n, box, p, e))
        return false;
    n->steps_since++;
    if (box->flowing)
        offsets_move(n, box);
    n->many_images = images_meet(box, 2.0 * n->largest_range);      /* farther apart, only one can be within range */
    for (int k = 0; k < n->count; k++) {
        const struct candidate *c = &n->candidate[k];
        const struct image_offset *offset = &n->offset[c->offset];
        const vec3 r = minus(plus(p->position[c->j], offset->position), p->position[c->i]);
        const double square = dot(r, r);
        if (square > c->reach) {
            if (n->history)
                n->history[k] = vec(0, 0, 0);
            continue;
        }
        const double distance = sqrt(square), gap = distance - c->touch;
        if (gap < 0.0) {
            const double overlap = -gap / fmin(radius_of(p, c->i), radius_of(p, c->j));
            if (overlap > near->deepest) {
                near->deepest = overlap;
                near->deepest_tag[0] = p->tag[c->i], near->deepest_tag[1] = p->tag[c->j];
            }
            if (!(distance > 1e-12 * c->touch))
                return error_raise(e, ERROR_RUN, "particles %d and %d have the same centre at time %.9g: their normal is undefined",
                                   p->tag[c->i], p->tag[c->j], box->time);
        }
        near->pair[near->count++] = (struct pair){ .i = c->i, .j = c->j, .normal = scaled(r, 1.0 / distance), .distance = distance,
            .gap = gap, .image_velocity = offset->velocity, .weight = c->weight, .history = n->history ? &n->history[k] : NULL,
            .image = n->many_images ? c->image : 0 };
    }
    return true;
}
