/*
 * The engine: a scene of shear run inside LAMMPS, on any number of MPI processes (ranks).
 *
 * LAMMPS deals out the particles, copies those near a border ("ghosts"), makes neighbour lists, moves particles and the cell.
 * Every force is the very function of solver/forces/, called on views of LAMMPS's arrays. Rank 0 also holds the whole suspension:
 * it starts the run as shear does, and the observers and checkpoints of shear look at it.
 *
 *     share     rank 0 deals out all particles with their forces and contact histories; LAMMPS is set up anew from them
 *     advance   every rank runs LAMMPS to a step that somebody looks at
 *     collect   rank 0 gets everything back
 *
 * A cell that has been remapped, and a checkpoint that is resumed, are shared anew: one way in for all.
 */
#ifndef ENGINE_H
#define ENGINE_H

#include "refuse.h"
#include "scene.h"

#include <mpi.h>

/* What travels of a particle; `kept` of it stays with the particle in LAMMPS too. */
struct kept { vec3 force, torque, turn, anchor, crossed; };        /* crossed: cells, when shared */
struct traveller { int tag, species; int image[3]; vec3 position, velocity, spin; struct kept kept; };
/* A contact with a history: that of the smaller tag against the larger. */
struct contact_record { int first, second; vec3 history; };

enum { KEPT = sizeof(struct kept) / sizeof(double) };

struct engine {
    int rank, ranks;
    MPI_Comm world;
    void *lammps;                           /* NULL: not set up */
    struct simulation *sim;                 /* rank 0: the run */
    bool shared;                            /* LAMMPS has the particles */
    double pace;                            /* seconds per step, as measured last */
    struct suspension *scene;               /* rank 0: everything; others: forces, liquid and cell, no particles */
    struct suspension here;                 /* this rank's share; arrays are LAMMPS's, ghosts behind the own particles */
    int own, ghosts;                        /* of the present list */
    struct box shared_box;                  /* its lattice is LAMMPS's until particles are shared again */
    int slots;                              /* contact histories that a particle can carry */
    int *index_of_tag;                      /* own particles: last known index */
    int *species, *slots_used;
    int room, total;                        /* of the arrays above; particles in all */
    bool measures;                          /* somebody wants the stress of the last step of the present advance */
    bool restoring;                         /* the next evaluation puts back forces that are known */
    int64_t first_step, last_step;          /* of the present setup; of the present advance */
    double skin;
    char log[480];                          /* LAMMPS's own log; empty: none */
};

/* An error on one rank that the others cannot know of: says it and ends all of them. */
void engine_abort(const struct engine *g, const struct error *e) __attribute__((noreturn));

/* host_start.c and host.c: LAMMPS itself. `cell` is that of the step after the present one. */
void host_start(struct engine *g);
void host_place(struct engine *g, const struct traveller *t, int count);
void host_place_contacts(struct engine *g, const struct contact_record *c, int count);
void host_advance(struct engine *g, int64_t to, bool measuring);
int host_own(const struct engine *g, struct traveller *t);                  /* fills one per own particle; returns how many */
int host_contacts(const struct engine *g, struct contact_record *c);        /* NULL: only counts */
void host_stop(struct engine *g);

/* share.c: both are called by all ranks together. */
void engine_share(struct engine *g);
void engine_collect(struct engine *g, bool contacts);

/* roles.c: rank 0 steps; the others follow until it is done. */
void engine_lead(struct engine *g, struct simulation *sim);    /* from now on steps of `sim` are the engine's */
void engine_follow(struct engine *g);
void engine_dismiss(struct engine *g);

#endif
