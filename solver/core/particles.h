/*
 * Particles: arrays over all, and species that give sizes and masses. Arrays that a scene does not need stay NULL.
 */
#ifndef CORE_PARTICLES_H
#define CORE_PARTICLES_H

#include "core/error.h"
#include "core/vec3.h"

enum { MAX_SPECIES = 16 };

struct species {
    char name[32];
    double radius;                  /* a              [L] */
    double density;                 /* rho            [M/L^3] */
    double mass;                    /* (4/3) pi rho a^3 [M] */
    double inertia;                 /* (2/5) m a^2    [M L^2] */
    bool driven;                    /* keeps velocity and spin whatever acts on it: mass and inertia are infinite */
    vec3 velocity, spin;            /* of a driven one; 0: held [L/T], [1/T] */
};

struct particles {
    int count;
    int species_count;
    struct species kind[MAX_SPECIES];
    int *tag;                       /* identity, from 1: keys of noise and history */
    int *species;                   /* index into kind */
    int *body;                      /* rigid body it belongs to, -1: none; NULL: no bodies in the scene */
    int (*image)[3];                /* cells it has crossed, counted in the never-remapped lattice */
    vec3 *position;                 /* x, inside or near the cell [L] */
    vec3 *velocity;                 /* U, laboratory        [L/T] */
    vec3 *force;                    /* F                    [M L/T^2] */
    vec3 *spin;                     /* W; NULL: the scene has no rotation [1/T] */
    vec3 *torque;                   /* T; NULL likewise     [M L^2/T^2] */
    bool anchored;                  /* a force reads `anchor` */
    vec3 *anchor;                   /* place at the start, unwrapped; NULL likewise [L] */
    vec3 *turn;                     /* time integral of W; NULL unless an output asks for it */
};

/* Arrays for `count` particles at rest in place of what was there; the species stay. */
bool particles_allocate(struct particles *p, int count, bool rotation, struct error *e);
void particles_free(struct particles *p);
/* False, saying which, where a place, a velocity or a spin is no number any more. */
bool particles_finite(const struct particles *p, double time, struct error *e);
struct species species_sphere(const char *name, double radius, double density);

static inline double radius_of(const struct particles *p, int i) { return p->kind[p->species[i]].radius; }
static inline double mass_of(const struct particles *p, int i) { return p->kind[p->species[i]].mass; }
static inline double inertia_of(const struct particles *p, int i) { return p->kind[p->species[i]].inertia; }

#endif
