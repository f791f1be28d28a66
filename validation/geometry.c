/* See geometry.h. Vectors of the cell are made as short as the lattice allows, so that one cell further in each direction is far enough to look. */
#include "geometry.h"

#include <math.h>
#include <string.h>

static int axis(const json_t *word)
{
    const char *name = json_string_value(word);
    return name && name[0] >= 'x' && name[0] <= 'z' ? name[0] - 'x' : 0;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool scene_cell(const json_t *scene, double cell[3][3], double gradient[3][3])
{
    const json_t *lengths = scene_get(scene, "box.lengths"), *vectors = scene_get(scene, "box.cell");
    const double time = scene_number(scene, "start.time", 0);
    size_t s;
    json_t *shear;
    memset(cell, 0, 9 * sizeof(double));
    memset(gradient, 0, 9 * sizeof(double));
    if (scene_get(scene, "stages") || (!lengths && !vectors) || scene_get(scene, "start.random"))
        return false;
    json_array_foreach(scene_get(scene, "shear"), s, shear)
        gradient[axis(json_object_get(shear, "flow"))][axis(json_object_get(shear, "gradient"))] += scene_number(shear, "rate", 0);
    for (size_t v = 0; v < 3; v++) {    /* each vector is carried by the flow, c' = G c; G^3 = 0 for superposed shears */
        double once[3], twice[3];
        for (size_t k = 0; k < 3; k++)
            cell[v][k] = vectors  ? json_number_value(json_array_get(json_array_get(vectors, v), k))
                         : v == k ? json_number_value(json_array_get(lengths, k))
                                  : 0;
        for (int k = 0; k < 3; k++)
            once[k] = dot(gradient[k], cell[v]);
        for (int k = 0; k < 3; k++)
            twice[k] = dot(gradient[k], once);
        for (int k = 0; k < 3; k++)
            cell[v][k] += time * once[k] + 0.5 * time * time * twice[k];
    }
    return true;
}

double species_number(const json_t *scene, int species, const char *key)
{
    return species < 1 ? NAN : scene_number(json_array_get(scene_get(scene, "species"), (size_t)species - 1), key, NAN);
}

double scene_reach(const json_t *scene)
{
    const double lubrication = 0.5 * scene_number(scene, "forces.lubrication.outer_gap", 0);
    const double repulsion = scene_number(scene, "forces.repulsion.cutoff", 0) * scene_number(scene, "forces.repulsion.kappa_factor", 0);
    return fmax(lubrication, repulsion);
}

/* Subtracts whole multiples of the other vectors until none gets shorter. */
static void shorten(double cell[3][3])
{
    for (int pass = 0, changed = 1; changed && pass < 50; pass++) {
        changed = 0;
        for (int v = 0; v < 3; v++)
            for (int o = 0; o < 3; o++) {
                const double times = o == v ? 0 : round(dot(cell[v], cell[o]) / dot(cell[o], cell[o]));
                for (int k = 0; k < 3; k++)
                    cell[v][k] -= times * cell[o][k];
                changed = changed || times != 0;
            }
    }
}

/* Rows of the inverse: their products with a vector count cells. */
static void invert(const double c[3][3], double inverse[3][3])
{
    for (int v = 0; v < 3; v++) {
        const double *p = c[(v + 1) % 3], *q = c[(v + 2) % 3];
        for (int k = 0; k < 3; k++)
            inverse[v][k] = p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3];
        const double volume = dot(inverse[v], c[v]);
        for (int k = 0; k < 3; k++)
            inverse[v][k] /= volume;
    }
}

struct lattice { double cell[3][3], inverse[3][3]; bool open[3]; };

static void see_images(const struct lattice *l, const struct state_row *row, struct near_pair pair, double reach,
                       void (*see)(void *, const struct near_pair *), void *context)
{
    double d[3];
    for (int k = 0; k < 3; k++)
        d[k] = row[pair.j].x[k] - row[pair.i].x[k];
    for (int v = 0; v < 3; v++) {
        const double cells = l->open[v] ? 0 : round(dot(l->inverse[v], d));
        for (int k = 0; k < 3; k++)
            d[k] -= cells * l->cell[v][k];
    }
    for (int image = 0; image < 27; image++) {
        const int shift[3] = { image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1 };
        double r[3] = { d[0], d[1], d[2] };
        bool there = pair.i != pair.j || image > 13;    /* of a sphere and its own images each pair once */
        for (int v = 0; v < 3; v++) {
            there = there && !(l->open[v] && shift[v]);
            for (int k = 0; k < 3; k++)
                r[k] += shift[v] * l->cell[v][k];
        }
        pair.gap = sqrt(dot(r, r)) - pair.a[0] - pair.a[1];
        if (there && pair.gap <= reach * (pair.a[0] + pair.a[1]))
            see(context, &pair);
    }
}

void near_pairs(const json_t *scene, const struct state_row *row, size_t rows, double reach,
                void (*see)(void *context, const struct near_pair *pair), void *context)
{
    struct lattice l;
    double gradient[3][3];
    if (!scene_cell(scene, l.cell, gradient))
        return;
    for (size_t v = 0; v < 3; v++)
        l.open[v] = json_is_false(json_array_get(scene_get(scene, "box.periodic"), v));
    shorten(l.cell);
    invert((const double (*)[3])l.cell, l.inverse);
    for (size_t first = 0, end; first < rows; first = end) {
        for (end = first; end < rows && row[end].state == row[first].state; end++)
            ;
        for (size_t i = first; i < end; i++)
            for (size_t j = i; j < end; j++)
                see_images(&l, row, (struct near_pair){ .first = first, .i = i, .j = j, .a = { species_number(scene, row[i].species, "radius"),
                                                                                             species_number(scene, row[j].species, "radius") } },
                           reach, see, context);
    }
}
