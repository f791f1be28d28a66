#include "core/particles.h"

#include <stdlib.h>
#include <stdio.h>

bool particles_allocate(struct particles *p, int count, bool rotation, struct error *e)
{
    const size_t n = (size_t)count + 1;             /* never of size zero */
    particles_free(p);
    p->count = count;
    p->tag = calloc(n, sizeof *p->tag);
    p->species = calloc(n, sizeof *p->species);
    p->image = calloc(n, sizeof *p->image);
    p->position = calloc(n, sizeof(vec3));
    p->velocity = calloc(n, sizeof(vec3));
    p->force = calloc(n, sizeof(vec3));
    if (rotation) {
        p->spin = calloc(n, sizeof(vec3));
        p->torque = calloc(n, sizeof(vec3));
    }
    p->anchor = p->anchored ? calloc(n, sizeof(vec3)) : NULL;
    if ((p->anchored && !p->anchor) || !p->tag || !p->species || !p->image || !p->position || !p->velocity || !p->force || (rotation && (!p->spin || !p->torque)))
        return error_out_of_memory(e);
    for (int i = 0; i < count; i++)
        p->tag[i] = i + 1;
    return true;
}

void particles_free(struct particles *p)
{
    void *const arrays[] = { p->tag, p->species, p->body, p->image, p->position, p->velocity, p->force, p->spin, p->torque, p->anchor, p->turn };
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        free(arrays[k]);
    p->tag = p->species = p->body = NULL;
    p->image = NULL;
    p->position = p->velocity = p->force = p->spin = p->torque = p->anchor = p->turn = NULL;
}

bool particles_finite(const struct particles *p, double time, struct error *e)
{
    for (int i = 0; i < p->count; i++) {
        const vec3 x = p->position[i], u = p->velocity[i], w = p->spin ? p->spin[i] : vec(0, 0, 0);
        if (!isfinite(dot(x, x)) || !isfinite(dot(u, u)) || !isfinite(dot(w, w)))
            return error_raise(e, ERROR_RUN, "particle %d left the numbers at time %.9g: position (%g, %g, %g), velocity (%g, %g, %g), spin (%g, %g, %g)",
                               p->tag[i], time, x.x, x.y, x.z, u.x, u.y, u.z, w.x, w.y, w.z);
    }
    return true;
}

struct species species_sphere(const char *name, double radius, double density)
{
    struct species s = { .radius = radius, .density = density };
    snprintf(s.name, sizeof s.name, "%s", name);
    s.mass = 4.0 / 3.0 * M_PI * density * radius * radius * radius;
    s.inertia = 0.4 * s.mass * radius * radius;
    return s;
}
