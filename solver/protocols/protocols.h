/* Ways of driving a suspension, and of starting one. */
#ifndef PROTOCOLS_H
#define PROTOCOLS_H

#include "core/settings.h"
#include "core/suspension.h"

/* The velocity gradient of the scene's list of simple shears (`root.shear`). */
mat3 steady_shear(struct settings *root, struct error *e);

/* A flow that changes with time (`root.stages`); NULL where the scene has none. */
struct flow *stages_new(struct settings *root, struct error *e);
/* What keeps all images of a particle alike while the flow changes: a force, for periodic cells. */
struct force *stages_inertia(struct error *e);

/* The suspension's box in the flow that the scene names, steady or not. */
bool driven_box(struct settings *root, struct suspension *s, const mat3 *cell, const bool periodic[3], struct error *e);

/* The scene's `start`: its time, and particles from a file (relative to the scene's) or at random; none if `states` will give them. */
bool suspension_start(struct settings *root, const char *scene_path, const char *states, struct suspension *s, struct error *e);

/* Non-overlapping spheres at random, in a box scaled to the volume fraction. */
bool random_start(struct settings *s, struct suspension *in, struct error *e);

/* Maxwellian velocities and spins at kT on top of what is there. */
void thermal_start(struct suspension *s);

/* Velocities that follow the flow, spins of half its vorticity. */
void follow_flow(struct suspension *s);

/* The scene's list of species: sizes, masses and motion. */
bool species_build(struct settings *root, struct particles *p, int dimensions, struct error *e);

/* Right after particles were placed: driven ones get their velocity and spin, tethered ones their anchors. */
void start_moving(struct particles *p);

/* Independent configurations read from one file. */
struct state_file;
struct state_file *state_file_read(const char *path, struct error *e);
void state_file_free(struct state_file *f);
int state_file_count(const struct state_file *f);
bool state_file_place(const struct state_file *f, int state, struct suspension *in, struct error *e);

#endif
