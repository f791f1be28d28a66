/*
 * Temperatures: `temperature.csv`
 *
 *     T_k = <m c_k^2>,   W_k = <I w_k^2>,   c = U - U_inf(x),   w = W - Omega_inf        [energy]; both are kT at equilibrium
 *
 * per axis, over all axes that the scene has (T, W), and per species (T_<name>, W_<name>); full-step velocities. No degree of
 * freedom is taken off, for drag holds the frame. With spins also `spin_neighbours`, the correlation of nearest neighbours
 *
 *     sum over i of w_i . w_j(i) / sum over i of w_i^2,   j(i) the neighbour at the smallest gap, if one is in range:
 *
 * 0 at equilibrium, negative where neighbours roll on each other, positive where they spin as one.
 */
#include "observers/temperature.h"
#include "observers/rows.h"

#include <stdlib.h>

int temperatures_of(const struct suspension *s, int species, double translation[3], double rotation[3])
{
    const struct particles *p = &s->particles;
    int count = 0;
    for (int k = 0; k < 3; k++)
        translation[k] = rotation[k] = 0.0;
    for (int i = 0; i < p->count; i++) {
        if ((species >= 0 && p->species[i] != species) || p->kind[p->species[i]].driven)
            continue;                                               /* driven ones have no temperature, and infinite mass */
        const vec3 c = minus(p->velocity[i], box_flow(&s->box, p->position[i]));
        const vec3 w = p->spin ? minus(p->spin[i], s->box.spin) : vec(0, 0, 0);
        const double m = mass_of(p, i), I = inertia_of(p, i);
        translation[0] += m * c.x * c.x, translation[1] += m * c.y * c.y, translation[2] += m * c.z * c.z;
        rotation[0] += I * w.x * w.x, rotation[1] += I * w.y * w.y, rotation[2] += I * w.z * w.z;
        count++;
    }
    for (int k = 0; k < 3 && count; k++) {
        translation[k] /= count;
        rotation[k] /= count;
    }
    return count;
}

struct nearest { int who; double gap; };

static double spin_correlation(const struct suspension *s, struct nearest *nearest)
{
    const struct particles *p = &s->particles;
    double together = 0.0, alone = 0.0;
    for (int i = 0; i < p->count; i++)
        nearest[i] = (struct nearest){ -1, INFINITY };
    for (int k = 0; k < s->neighbours.near.count; k++) {
        const struct pair *pair = &s->neighbours.near.pair[k];
        if (pair->gap < nearest[pair->i].gap)
            nearest[pair->i] = (struct nearest){ pair->j, pair->gap };
        if (pair->gap < nearest[pair->j].gap)
            nearest[pair->j] = (struct nearest){ pair->i, pair->gap };
    }
    for (int i = 0; i < p->count; i++) {
        if (nearest[i].who < 0)
            continue;
        const vec3 w = minus(p->spin[i], s->box.spin);
        together += dot(w, minus(p->spin[nearest[i].who], s->box.spin));
        alone += dot(w, w);
    }
    return alone > 0.0 ? together / alone : 0.0;
}

static bool temperature_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct rows *o = (struct rows *)self;
    const struct particles *p = &s->particles;
    if (!rows_open(o, to, (size_t)p->count * sizeof(struct nearest), e))
        return false;
    FILE *out = o->table.file;
    fprintf(out, "step,time,T_x,T_y,T_z,T%s", p->spin ? ",W_x,W_y,W_z,W" : "");
    for (int k = 0; k < p->species_count; k++) {
        fprintf(out, ",T_%s", p->kind[k].name);
        if (p->spin)
            fprintf(out, ",W_%s", p->kind[k].name);
    }
    fprintf(out, "%s\n", p->spin ? ",spin_neighbours" : "");
    return true;
}

static bool temperature_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct rows *o = (struct rows *)self;
    const struct particles *p = &s->particles;
    const double axes = s->dimensions, spin_axes = s->dimensions == 2 ? 1.0 : 3.0;
    double T[3], W[3];
    FILE *out = rows_begin(o, s);
    temperatures_of(s, -1, T, W);
    fprintf(out, ",%.17g,%.17g,%.17g,%.17g", T[0], T[1], T[2], (T[0] + T[1] + T[2]) / axes);
    if (p->spin)
        fprintf(out, ",%.17g,%.17g,%.17g,%.17g", W[0], W[1], W[2], (W[0] + W[1] + W[2]) / spin_axes);
    for (int k = 0; k < p->species_count; k++) {
        temperatures_of(s, k, T, W);
        fprintf(out, ",%.17g", (T[0] + T[1] + T[2]) / axes);
        if (p->spin)
            fprintf(out, ",%.17g", (W[0] + W[1] + W[2]) / spin_axes);
    }
    if (p->spin)
        fprintf(out, ",%.17g", spin_correlation(s, o->scratch));
    return rows_end(o, e);
}

/* "temperature": { "every": 100 } */
struct observer *temperature_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct rows *o = rows_new(sizeof *o, "temperature.csv", s, e);
    (void)of;
    if (!o)
        return NULL;
    o->base.open = temperature_open;
    o->base.observe = temperature_observe;
    o->base.reads_pairs = true;
    return &o->base;
}
