/* What a run says of itself: before it runs, and in its files. */
#ifndef DESCRIBE_H
#define DESCRIBE_H

#include "scene.h"

/* Sizes, time scales, limits, for a reader of the scene; the pairs have been found. */
void describe_scene(const struct simulation *sim, struct error *e);

/* The comment lines at the top of every table: which program, scene, seed, step, and replaced values made it. */
void describe_provenance(struct simulation *sim, const char *scene, const struct scene_options *options);

/* A note on the terminal where noise and an explicit scheme bias the pairs near contact. */
void describe_bias(const struct simulation *sim);

#endif
