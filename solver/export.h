/*
 * A scene for another code: `shear SCENE.json --export lammps DIR`.
 *
 * Hands the scene with the starting states that it makes to tools/lammps (a program beside this one, which shares no source with the
 * solver): a deck and a data file where every part has an exact equivalent among LAMMPS's stock styles, a refusal (exit code 77) where not.
 */
#ifndef EXPORT_H
#define EXPORT_H

#include "scene.h"

bool export_scene(const char *scene, const struct scene_options *options, const char *format, const char *folder, struct error *e);

#endif
