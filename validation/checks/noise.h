/*
 * Layer 2, shared parts: frozen configurations, the resistance matrix measured from the candidate's own drag, noise draws.
 *
 * Matrices and draws are in the order of noise_*.npy: for each sphere force x y z, then torque x y z.
 */
#ifndef NOISE_H
#define NOISE_H

#include "pair.h"
#include "statistics.h"

/* Spheres at rest at fixed places. Neighbours are told as pairs so that a verdict can speak of them. */
struct frozen {
    size_t count, sizes;
    double radius[64], x[64][3], size[64];              /* `size`: the different radii, one species each */
    int species[64];                                    /* from 1 */
    size_t pairs;
    struct { size_t i, j; double xi; } pair[256];      /* within the outer gap, or meant to be just outside */
};

/* Isolated pairs, one to a slot of a coarse grid over the cell, as parameters.pairs ([ratio, gap]) asks. */
bool frozen_pairs(struct check_run *run, const struct model *m, struct frozen *f);
/* A random cluster grown sphere by sphere at the gaps of parameters.gaps, in the middle of a cell corner. */
bool frozen_cluster(struct check_run *run, const struct model *m, struct frozen *f);

/* Copy of the case's scene with a species for each size of `f`; the caller owns it. */
json_t *frozen_scene(struct check_run *run, const struct frozen *f);

/*
 * R of each force named by columns, from a question called `name`; R[.][k] = -(F(unit velocity k) - F(rest)), for the force names given; each 6N x 6N. False after
 * recording what is wrong.
 */
bool measure_resistance(struct check_run *run, const char *name, json_t *scene, const struct frozen *f, size_t forces, const char *const force[],
                        double *R[]);
/* The same for lubrication from the declared model, all pairs and images. */
void theory_resistance(const struct model *m, const struct frozen *f, double *R);

/* Draws of an NPY file, draws x 6N, divided by `unit`. Null after recording what is wrong. Caller frees. */
double *noise_draws(struct check_run *run, const char *out, const char *file, size_t draws, const struct frozen *f, double unit);

/*
 * What is tested against what: draws of a frozen configuration, whitened by the covariance that they should have. One-body and pair noise
 * share a subject; the impulses of a friction step (friction_step.c) are a third kind.
 */
enum noise_stream { DRAG, LUBRICATION, STREAMS, FRICTION_STEP = STREAMS, KINDS };
struct subject {
    struct check_run *run;
    const struct frozen *f;
    size_t size, draws;             /* 6 N, number of draws */
    double dt, kT;
    double *R[KINDS], *draw[KINDS], *white[KINDS];      /* covariance asked for, in the unit of the draws; the draws; whitened by it */
    struct whitening whitening[KINDS];
};

/* Whitens the draws. False: out of memory, or there is nothing to whiten by (recorded). */
bool noise_whiten(struct subject *s, int stream, double *stray);
/* Size, covariance, blocks, mean, whiteness, fourth moment; what is outside the range of R. */
void noise_judge(struct subject *s, int stream, double stray);
/* Words for what is wrong (noise_words.c): "<force 1, torque 2> (radii .., gap ..)"; what a factor often means; the worst block and all kinds. */
const char *noise_block_name(char text[160], const struct subject *s, size_t a, size_t b);
const char *noise_guess(const struct subject *s, double ratio);
const char *noise_blame(char text[900], const struct subject *s, int stream, const char *name, const double *C,
                        const struct block_finding *w);
/* z that an effect must reach to be seen: 3.9 is the alarm (two-sided p = 1e-4), 2 more see it 39 times in 40. */
#define NOISE_SEEN 5.9
double noise_declared(const struct subject *s, const char *key);       /* parameters.declared.<key> */
void subject_free(struct subject *s);
void check_uniform(struct check_run *run);
void check_noise_images(struct check_run *run);
void check_noise_again(struct check_run *run);
void check_noise_again_pairs(struct check_run *run);

#endif
