/* Layer 6: what its checks share. Two codes, the candidate and a reference (stock LAMMPS), run one scene from one start. */
#ifndef DENSE_H
#define DENSE_H

#include "check.h"

struct dense_start {
    struct state_row *row;
    size_t count;
    double edge, viscosity, rate, phi;
    json_t *scene;          /* ready to run but for its length and its output */
};

/* The case's spheres at random without overlap, moving with the flow. Records a failure and returns false if there are none. */
bool dense_start(struct check_run *run, unsigned seed, struct dense_start *s);
/* The same in another scene than the case's own, "phi" and "counts" from `parameters`. */
bool dense_start_in(struct check_run *run, const json_t *scene, const json_t *parameters, unsigned seed, struct dense_start *s);
void dense_start_free(struct dense_start *s);

/*
 * Run the scene of `s` in the candidate and in the reference: the command in GATE_REFERENCE, else build/lammps-candidate --own reference, which
 * is stock LAMMPS where its styles are exact and else LAMMPS with the resistances of validation/theory. False
 * if either has no answer; it has been recorded then. `core_seconds`, unless null: processor time of each. A reference that is missing or refuses is a failure of the set-up.
 */
bool dense_ask_both(struct check_run *run, const char *name, const struct dense_start *s, char out[2][PATH_LENGTH], double core_seconds[2]);
const char *dense_reference(void);      /* that command */

/* A frame of trajectory.csv: three numbers per particle, in order of id. */
struct dense_snapshot { double time; const double *x, *u, *w; };
/*
 * Shows `see` every whole frame of out/trajectory.csv beyond `discard` of strain. False, and recorded, if there is none.
 */
bool dense_snapshots(struct check_run *run, const char *out, const struct dense_start *s, double discard,
                     void (*see)(void *to, const struct dense_start *s, const struct dense_snapshot *now), void *to);
/* From particle i to the nearest image of j, in the shear u_x = rate y of a cubic cell: right for pairs nearer than half an edge. */
void dense_pair(const struct dense_start *s, const struct dense_snapshot *now, size_t i, size_t j, double d[3]);
double dense_radius(const struct dense_start *s, size_t i);

/* What happened on a path of spheres in shear along x, gradient y, and how often: summed over the frames of trajectory.csv and slipping.csv. False: recorded already. */
struct dense_events { size_t made, lost, slipping, sticking, contacts /* in the last frame */, remaps /* cell tilted past half its edge */; };
bool dense_events_count(struct check_run *run, const struct dense_start *s, const char *out, struct dense_events *e);

/* What it may be that two paths are so many radii apart where they are first compared. */
const char *dense_path_likely(double early);

void dense_viscosities(struct check_run *run);
void dense_path(struct check_run *run);
void contact_path(struct check_run *run);
void dense_memory(struct check_run *run);
void check_equation_of_state(struct check_run *run);

#endif
