/* From a scene file to a simulation: the only place that knows every constructor. */
#ifndef SCENE_H
#define SCENE_H

#include "protocols/protocols.h"
#include "simulation.h"

struct scene_options {
    const char *const *set;                     /* "path=value" replacements, `set_count` of them */
    int set_count;
    const char *states;                         /* take the start from this file instead of the scene's; NULL: the scene's */
    bool resume;                                /* go on from the checkpoint in the folder of the outputs */
    bool frozen;                                /* only forces will be asked for: no run, no outputs, no step limit */
};

/* How long the scene runs, and the observers and the checkpoint that its `output` names: outputs.c. */
bool run_build(struct settings *root, struct simulation *sim, struct error *e);
bool outputs_build(struct settings *root, struct simulation *sim, struct error *e);

/* Builds what the scene at `path` names. On failure nothing has been written anywhere. */
bool scene_build(const char *path, const struct scene_options *options, struct simulation *sim, struct error *e);

#endif
