/*
 * Trajectory for pictures: LAMMPS text dump of the triclinic cell, read by OVITO, VMD, ParaView and MDAnalysis.
 *
 * The format knows only cells with A along x and B in the xy plane; a flow that makes another cell is refused at the start.
 */
#include "output/output.h"

#include <stdlib.h>
#include <string.h>

struct dump { struct observer base; struct table table; };

static bool dump_open(struct observer *self, const struct suspension *s, const struct destination *to, struct error *e)
{
    struct destination bare = *to;
    bare.provenance[0] = 0;                                         /* readers of dumps take no comments */
    (void)s;
    return table_open(&((struct dump *)self)->table, &bare, "dump.lammpstrj", e);
}

static bool dump_observe(struct observer *self, const struct suspension *s, struct error *e)
{
    struct table *t = &((struct dump *)self)->table;
    const struct particles *p = &s->particles;
    const mat3 *H = &s->box.cell;
    const double xy = H->m[0][1], xz = H->m[0][2], yz = H->m[1][2];
    const double low = fmin(fmin(0.0, xy), fmin(xz, xy + xz)), high = fmax(fmax(0.0, xy), fmax(xz, xy + xz));
    fprintf(t->file, "ITEM: TIMESTEP\n%lld\nITEM: NUMBER OF ATOMS\n%d\nITEM: BOX BOUNDS xy xz yz", (long long)s->step, p->count);
    for (int k = 0; k < 3; k++)
        fprintf(t->file, " %s", s->box.periodic[k] ? "pp" : "ff");
    fprintf(t->file, "\n%.9g %.9g %.9g\n%.9g %.9g %.9g\n0 %.9g %.9g\n", low, H->m[0][0] + high, xy, fmin(0.0, yz), H->m[1][1] + fmax(0.0, yz),
            xz, H->m[2][2], yz);
    fputs("ITEM: ATOMS id type x y z vx vy vz omegax omegay omegaz radius\n", t->file);
    for (int i = 0; i < p->count; i++) {
        const vec3 x = p->position[i], u = p->velocity[i], w = p->spin ? p->spin[i] : vec(0, 0, 0);
        fprintf(t->file, "%d %d %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", p->tag[i], p->species[i] + 1, x.x, x.y, x.z,
                u.x, u.y, u.z, w.x, w.y, w.z, radius_of(p, i));
    }
    return table_check(t, e);
}

static void dump_remember(struct observer *self, struct fields *f)
{
    table_remember(&((struct dump *)self)->table, "dump.lammpstrj", f);
}

static bool dump_close(struct observer *self, struct error *e)
{
    const bool good = table_close(&((struct dump *)self)->table, e);
    free(self);
    return good;
}

/* "dump": { "every": 1000 } */
struct observer *dump_new(struct settings *s, struct suspension *of, struct error *e)
{
    struct dump *d = calloc(1, sizeof *d);
    if (!d)
        return error_out_of_memory(e), NULL;
    d->base = (struct observer){ .open = dump_open, .observe = dump_observe, .remember = dump_remember, .close = dump_close };
    d->base.every = settings_whole(s, "every", 1, INT64_MAX, e);
    const mat3 *H = &of->box.start;
    bool tilts[3][3];
    memcpy(tilts, of->box.tilts, sizeof tilts);
    if (!error_raised(e) && (tilts[1][0] || tilts[2][0] || tilts[2][1] || H->m[1][0] != 0.0 || H->m[2][0] != 0.0 || H->m[2][1] != 0.0))
        settings_refuse(s, "", e, "cannot show this cell: a LAMMPS dump needs A along x and B in the xy plane");
    return &d->base;
}
