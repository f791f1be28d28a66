/* Every force: its constructor takes its part of the scene and the suspension it joins. */
#ifndef FORCES_H
#define FORCES_H

#include "core/settings.h"
#include "core/suspension.h"

struct force *contact_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *contact_laws_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *repulsion_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *applied_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *tether_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *drag_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *drag_noise_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *lubrication_new(struct settings *s, const struct suspension *in, struct error *e);
struct force *lubrication_noise_new(struct settings *s, const struct suspension *in, struct error *e);

#endif
