/* Scenes of the solver from text, for the unit tests. */
#ifndef SCENES_H
#define SCENES_H

#include "suite.h"

#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Builds a scene from text; `states` are rows after the usual header. */
static inline struct simulation *scene_from(const char *text, const char *states, struct error *e)
{
    char folder[] = "/tmp/shear-test-XXXXXX", scene[64], table[64];
    check_true(mkdtemp(folder) != NULL, "temporary folder");
    snprintf(scene, sizeof scene, "%s/scene.json", folder);
    snprintf(table, sizeof table, "%s/states.csv", folder);
    FILE *out = fopen(scene, "w");
    fputs(text, out);
    fclose(out);
    out = fopen(table, "w");
    fprintf(out, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n%s", states);
    fclose(out);
    struct simulation *sim = calloc(1, sizeof *sim);
    const struct scene_options options = { .set_count = 0 };
    scene_build(scene, &options, sim, e);
    remove(scene);
    remove(table);
    rmdir(folder);
    return sim;
}

static inline void drop(struct simulation *sim)
{
    struct error e = { 0 };
    simulation_close(sim, &e);
    free(sim);
}

static inline bool advance(struct simulation *sim, long steps, struct error *e)
{
    bool relisted;
    for (long k = 0; k < steps; k++)
        if (!sim->dynamics->step(sim->dynamics, &sim->suspension, &relisted, e))
            return false;
    return true;
}

#endif
