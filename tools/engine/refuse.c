#include "refuse.h"

#include "core/images.h"

#include <string.h>

static bool refuse(struct error *e, const char *what) { return error_raise(e, ERROR_INPUT, "%s; run this scene with shear", what); }

bool engine_can(const struct simulation *sim, struct error *e)
{
    const struct suspension *s = &sim->suspension;
    const struct box *b = &s->box;
    const mat3 *G = &b->gradient, *H = &b->start;
    if (strcmp(sim->dynamics->name, "verlet") != 0)
        return error_raise(e, ERROR_INPUT, "dynamics.%s: the engine moves particles by velocity Verlet alone; name verlet, or run this scene "
                                           "with shear", sim->dynamics->name);
    if (b->flow)
        return refuse(e, "stages: the engine has steady shear only");
    if (!b->periodic[0] || !b->periodic[1] || !b->periodic[2])
        return refuse(e, "box.periodic: the engine has periodic cells only, for LAMMPS loses what leaves an open face");
    if (H->m[1][0] != 0.0 || H->m[2][0] != 0.0 || H->m[2][1] != 0.0)
        return refuse(e, "box.cell: a cell of LAMMPS has A along x and B in the xy plane");
    if (G->m[1][0] != 0.0 || G->m[2][0] != 0.0 || G->m[2][1] != 0.0)
        return refuse(e, "shear: a cell of LAMMPS leans along x with y, along x with z, and along y with z only; name the axes so");
    if (images_meet(&s->box, 2.0 * s->neighbours.largest_range))
        return refuse(e, "box: an edge is below twice the farthest reach of the forces, so that a pair may meet through two faces at once");
    return true;
}
