/*
 * Where neighbours are: `pair_distribution.csv` and, on request, `pair_plane.csv`
 *
 *     g_ab = (pairs found) / (pairs of an ideal gas),   ideal: N_a N_b/V (a = b: N_a (N_a - 1)/(2 V)) times the shell's volume
 *     U = -kT ln g                                                                       potential of mean force [energy]
 *
 * by pairs of species, in bins of the centre distance r (kind `far`) and in fine bins of the gap h around contact (kind `near`,
 * shells at r = a_a + a_b + h). Every image of a partner within the range is counted, so the shell is whole also where it
 * is wider than half the cell: no correction for corners is due, as a minimum-image count would need. A particle's own images,
 * which are a property of the lattice, are not counted. In two dimensions V is the area of the cell, shells are rings.
 *
 * The plane is that of shear: g over (r_f, r_g) for pairs with |r_v| < half_width, from both ends of each pair.
 */
#include "observers/observers.h"
#include "observers/plane.h"
#include "observers/snapshot.h"

#include <stdlib.h>

struct pair_distribution {
    struct observer base;
    double range, near_gap, plane_range, half_width;
    int bins, near_bins, plane_bins;
    int64_t snapshots;
    int64_t *far, *near, *plane;                /* [species a <= b][bin], [row][column] */
    const struct suspension *of;
    const struct destination *to;
};

static int kinds(const struct pair_distribution *o) { return o->of->particles.species_count; }
static size_t far_size(const struct pair_distribution *o) { return (size_t)(kinds(o) * kinds(o) * o->bins); }
static size_t near_size(const struct pair_distribution *o) { return (size_t)(kinds(o) * kinds(o) * o->near_bins); }
static size_t plane_size(const struct pair_distribution *o) { return (size_t)(o->plane_bins * o->plane_bins); }

static bool distribution_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct pair_distribution *o = (struct pair_distribution *)self;
    o->of = s;
    o->to = to;
    o->far = calloc(far_size(o) + 1, sizeof *o->far);
    o->near = calloc(near_size(o) + 1, sizeof *o->near);
    o->plane = calloc(plane_size(o) + 1, sizeof *o->plane);
    return (o->far && o->near && o->plane) || error_out_of_memory(e);
}

static void count_in_plane(struct pair_distribution *o, const struct plane *p, vec3 r)
{
    const double x[3] = { r.x, r.y, r.z };
    if (!(fabs(x[p->vorticity]) < o->half_width))
        return;
    for (int end = -1; end <= 1; end += 2) {
        const double column = floor((end * x[p->flow] / o->plane_range + 1.0) * 0.5 * o->plane_bins);
        const double row = floor((end * x[p->gradient] / o->plane_range + 1.0) * 0.5 * o->plane_bins);
        if (column >= 0 && column < o->plane_bins && row >= 0 && row < o->plane_bins)
            o->plane[(int)row * o->plane_bins + (int)column]++;
    }
}

static bool distribution_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct pair_distribution *o = (struct pair_distribution *)self;
    const struct plane plane = plane_of(&s->box);
    const double corner = o->plane_bins ? sqrt(2.0 * o->plane_range * o->plane_range + o->half_width * o->half_width) : 0.0;
    struct snapshot at;
    const bool found = snapshot_take(&at, s, fmax(o->range, corner), o->near_gap, e);
    for (int k = 0; found && k < at.search.near.count; k++) {
        const struct pair *pair = &at.search.near.pair[k];
        const int one = at.particles.species[pair->i], two = at.particles.species[pair->j];
        const int type = (one < two ? one : two) * kinds(o) + (one < two ? two : one);
        if (pair->i == pair->j)
            continue;
        if (pair->distance < o->range)
            o->far[type * o->bins + (int)fmin(pair->distance / o->range * o->bins, o->bins - 1)]++;
        if (o->near_bins && fabs(pair->gap) < o->near_gap)
            o->near[type * o->near_bins + (int)fmin((pair->gap / o->near_gap + 1.0) * 0.5 * o->near_bins, o->near_bins - 1)]++;
        if (o->plane_bins)
            count_in_plane(o, &plane, scaled(pair->normal, pair->distance));
    }
    o->snapshots++;
    snapshot_free(&at);
    return found;
}

static void distribution_remember(struct observer *self, struct fields *f)
{
    struct pair_distribution *o = (struct pair_distribution *)self;
    fields_add(f, "pairs.snapshots", &o->snapshots, sizeof o->snapshots);
    fields_add(f, "pairs.far", o->far, far_size(o) * sizeof *o->far);
    fields_add(f, "pairs.near", o->near, near_size(o) * sizeof *o->near);
    fields_add(f, "pairs.plane", o->plane, plane_size(o) * sizeof *o->plane);
}

static void write_bins(const struct pair_distribution *o, FILE *out, const char *kind, int a, int b, const int64_t *count, int bins, double from, double width)
{
    const struct particles *p = &o->of->particles;
    double number[MAX_SPECIES] = { 0.0 };
    for (int i = 0; i < p->count; i++)
        number[p->species[i]] += 1.0;
    const double pairs = a == b ? 0.5 * number[a] * (number[a] - 1.0) : number[a] * number[b];
    for (int k = 0; k < bins; k++) {
        const double low = from + k * width, high = low + width, touch = *kind == 'n' ? p->kind[a].radius + p->kind[b].radius : 0.0;
        const double shell = o->of->dimensions == 3 ? 4.0 / 3.0 * M_PI * (pow(touch + high, 3) - pow(touch + low, 3))
                                                    : M_PI * (pow(touch + high, 2) - pow(touch + low, 2));
        const double ideal = pairs / room_of(o->of) * shell * (double)o->snapshots, g = ideal > 0.0 ? (double)count[k] / ideal : 0.0;
        fprintf(out, "%s,%d,%d,%.17g,%.17g,%lld,%.9g", kind, a + 1, b + 1, low, high, (long long)count[k], g);
        if (o->of->kT > 0.0)
            fprintf(out, ",%.9g", -o->of->kT * log(g));
        fputc('\n', out);
    }
}

static void write_all(const struct pair_distribution *o, FILE *out)
{
    fprintf(out, "kind,species_a,species_b,low,high,count,g%s\n", o->of->kT > 0.0 ? ",U" : "");
    for (int a = 0; a < kinds(o); a++)
        for (int b = a; b < kinds(o); b++) {
            const int type = a * kinds(o) + b;
            write_bins(o, out, "far", a, b, o->far + type * o->bins, o->bins, 0.0, o->range / o->bins);
            if (o->near_bins)
                write_bins(o, out, "near", a, b, o->near + type * o->near_bins, o->near_bins, -o->near_gap, 2.0 * o->near_gap / o->near_bins);
        }
}

static void write_plane(const struct pair_distribution *o, FILE *out)
{
    const double N = o->of->particles.count, width = 2.0 * o->plane_range / o->plane_bins;
    const double across = o->of->dimensions == 3 ? 2.0 * o->half_width : 1.0;           /* all centres lie in one plane, or in a slab */
    const double ideal = N * (N - 1.0) / room_of(o->of) * width * width * across * (double)o->snapshots;
    fputs("r_flow,r_gradient,count,g\n", out);
    for (int row = 0; row < o->plane_bins; row++)
        for (int column = 0; column < o->plane_bins; column++) {
            const long long count = (long long)o->plane[row * o->plane_bins + column];
            fprintf(out, "%.9g,%.9g,%lld,%.9g\n", (column + 0.5) * width - o->plane_range, (row + 0.5) * width - o->plane_range, count, (double)count / ideal);
        }
}

static bool distribution_close(struct observer *self, struct error *e)
{
    struct pair_distribution *o = (struct pair_distribution *)self;
    struct table table = { .file = NULL };
    if (o->plane && o->snapshots > 0 && table_open_whole(&table, o->to, "pair_distribution.csv", e)) {
        write_all(o, table.file);
        table_place(&table, e);
    }
    if (o->plane && o->snapshots > 0 && o->plane_bins && table_open_whole(&table, o->to, "pair_plane.csv", e)) {
        write_plane(o, table.file);
        table_place(&table, e);
    }
    free(o->far);
    free(o->near);
    free(o->plane);
    free(o);
    return !error_raised(e);
}

/* "pair_distribution": { "every": 100, "range": 6, "bins": 300, "near": { "gap": 0.1, "bins": 2000 }, "plane": { "range": 4, "half_width": 0.5, "bins": 80 } } */
struct observer *pair_distribution_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct pair_distribution *o = calloc(1, sizeof *o);
    (void)of;
    if (!o)
        return error_out_of_memory(e), NULL;
    o->base = (struct observer){ .open = distribution_open, .observe = distribution_observe, .remember = distribution_remember,
                                 .close = distribution_close };
    o->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    o->range = settings_positive(s, "range", e);
    o->bins = (int)settings_whole(s, "bins", 1, 1000000, e);
    struct settings near = settings_child(s, "near", e), plane = settings_child(s, "plane", e);
    if (near.node) {
        o->near_gap = settings_positive(&near, "gap", e);
        o->near_bins = (int)settings_whole(&near, "bins", 1, 1000000, e);
        settings_done(&near, e);
    }
    if (plane.node) {
        o->plane_range = settings_positive(&plane, "range", e);
        o->half_width = settings_positive(&plane, "half_width", e);
        o->plane_bins = (int)settings_whole(&plane, "bins", 1, 4000, e);
        settings_done(&plane, e);
    }
    return &o->base;
}
