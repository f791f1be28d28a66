/*
 * LAMMPS set up as host: cell, lists, the room that travels with a particle, and our callback for its forces. No particles yet.
 */
#define LAMMPS_LIB_MPI
#include "host.h"

#include <lammps/library.h>
#include <math.h>
#include <string.h>

/* A sphere cannot touch more spheres than caps of their size fit on it (with nothing between the caps). */
static int most_contacts(const struct particles *p)
{
    double small = INFINITY, large = 0.0;
    for (int k = 0; k < p->species_count; k++) {
        small = fmin(small, p->kind[k].radius);
        large = fmax(large, p->kind[k].radius);
    }
    const double sine = small / (small + large);
    return (int)ceil(2.0 / (1.0 - sqrt(1.0 - sine * sine)));
}

/* This rank's suspension: the scene's, but for particles and lists; room that is there already is used again. */
static void set_up_here(struct engine *g)
{
    struct suspension *s = &g->here;
    struct neighbours *n = &s->neighbours;
    const struct neighbours *scene = &g->scene->neighbours, before = *n;
    vec3 *const anchor = s->particles.anchor;
    int (*const image)[3] = s->particles.image;
    *s = *g->scene;
    s->particles = (struct particles){ .species_count = g->scene->particles.species_count, .anchored = g->scene->particles.anchored,
                                       .anchor = anchor, .image = image };
    memcpy(s->particles.kind, g->scene->particles.kind, sizeof s->particles.kind);
    *n = before;
    memcpy(n->range, scene->range, sizeof n->range);
    for (int k = 0; k < MAX_SPECIES * MAX_SPECIES; k++)
        n->largest_range = fmax(n->largest_range, n->range[k / MAX_SPECIES][k % MAX_SPECIES]);
    n->keeps_history = scene->keeps_history;
    n->near.keeps_resistance = scene->near.keeps_resistance;
    n->foreign = true;
    n->made = 1;
    n->offset_count = 27;
    n->offset = host_grown(g, n->offset, 27 * sizeof *n->offset);
    for (int k = 0; k < 27; k++)
        memcpy(n->offset[k].shift, (const int[3]){ k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1 }, sizeof n->offset[k].shift);
    g->slots = n->keeps_history ? most_contacts(&s->particles) : 0;
}

static void set_up_cell(struct engine *g)
{
    const struct suspension *s = &g->here;
    struct box ahead = s->box;
    box_set_time(&ahead, s->start_time + (double)(s->step + 1) * s->dt);
    const mat3 *H = &ahead.cell;
    host_command(g, "box tilt large");
    host_command(g, "region cell prism 0 %.17g 0 %.17g 0 %.17g %.17g %.17g %.17g units box", H->m[0][0], H->m[1][1], H->m[2][2], H->m[0][1],
            H->m[0][2], H->m[1][2]);
    host_command(g, "create_box %d cell", s->particles.species_count);
}

static void set_up_list(struct engine *g)
{
    const struct neighbours *n = &g->here.neighbours;
    const struct particles *p = &g->here.particles;
    double smallest = INFINITY;
    for (int a = 0; a < p->species_count; a++)
        smallest = fmin(smallest, p->kind[a].radius);
    /* The first list is made in the cell of the next step: its images are off by what a face moves in a step. */
    const mat3 *H = &g->here.box.cell;
    const double lead = g->here.box.rate * g->here.dt * (H->m[1][1] + H->m[2][2]);
    host_command(g, "pair_style zero %.17g", fmax(n->largest_range, 0.1 * smallest) + lead);
    host_command(g, "pair_coeff * *");
    for (int a = 0; a < p->species_count; a++)
        for (int b = a; b < p->species_count; b++)
            host_command(g, "pair_coeff %d %d %.17g", a + 1, b + 1, fmax(n->range[a][b], 0.1 * smallest) + lead);
    host_command(g, "neighbor %.17g bin", g->skin * smallest);
    host_command(g, "neigh_modify delay 0 every 1 check yes");
}

void host_start(struct engine *g)
{
    char *arguments[] = { "lammps", "-screen", "none", "-log", *g->log ? g->log : "none", "-echo", "none", "-nocite" };
    const struct suspension *s = &g->here;
    if (g->lammps)
        host_command(g, "clear");
    else
        g->lammps = lammps_open(sizeof arguments / sizeof *arguments, arguments, g->world, NULL);
    g->index_of_tag = host_grown(g, g->index_of_tag, ((size_t)g->total + 1) * sizeof *g->index_of_tag);
    memset(g->index_of_tag, -1, ((size_t)g->total + 1) * sizeof *g->index_of_tag);
    set_up_here(g);
    host_command(g, "units lj");
    host_command(g, "atom_style sphere");
    host_command(g, "boundary p p p");
    host_command(g, "newton off");
    host_command(g, "comm_modify vel yes");
    set_up_cell(g);
    set_up_list(g);
    host_command(g, "timestep %.17g", s->dt);
    host_command(g, "reset_timestep %lld", (long long)s->step);
    host_command(g, "fix kept all property/atom d2_kept %d", KEPT);
    if (g->slots)
        host_command(g, "fix contacts all property/atom d2_contacts %d", 4 * g->slots);
    host_command(g, "fix mark all property/atom i_mark ghost yes");
    host_command(g, "fix forces all external pf/callback 1 1");
    lammps_set_fix_external_callback(g->lammps, "forces", host_evaluate, g);
    host_command(g, "fix motion all nve/sphere");
    const mat3 *G = &s->box.gradient, *H = &s->box.cell;
    if (s->box.flowing)                                     /* C follows G too: where it leans along y its xz tilt grows by the xy flow */
        host_command(g, "fix flow all deform 1 xy erate %.17g xz erate %.17g yz erate %.17g remap v flip no", G->m[0][1],
                G->m[0][2] + G->m[0][1] * H->m[1][2] / H->m[2][2], G->m[1][2]);
    host_command(g, "thermo_style custom step");
    g->first_step = s->step;
    g->restoring = true;
}
