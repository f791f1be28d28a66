/*
 * Held and driven species
 *
 * A driven particle keeps the velocity and spin that the scene gives its species. It feels forces and exerts them, like a wall or
 * a rotor does. To every equation it is a body of infinite mass: F/m = 0, and the effective mass of a pair is that of the other.
 * Two driven particles are no pair. In the stress a driven particle has no kinetic part.
 *
 * In a sheared periodic cell it is the particle itself, followed without wrapping, that keeps its velocity; its images move
 * with the flow's difference, as those of every particle.
 */
#include "protocols/protocols.h"

#include <ctype.h>
#include <string.h>

static void read_motion(struct species *kind, int dimensions, struct settings *s, struct error *e)
{
    if (!settings_has(s, "motion") || settings_is_text(s, "motion", "free"))
        return;
    if (!settings_is_text(s, "motion", "held")) {
        double velocity[3] = { 0.0 }, spin[3] = { 0.0 };
        struct settings motion = settings_child(s, "motion", e);
        if (!motion.node)
            settings_refuse(s, "motion", e, "must be \"free\", \"held\", or an object with velocity and spin");
        if (!error_raised(e) && (settings_numbers(&motion, "velocity", velocity, 3, e) != 3 || settings_numbers(&motion, "spin", spin, 3, e) != 3))
            settings_refuse(s, "motion", e, "must have velocity and spin, three numbers each");
        if (!error_raised(e) && dimensions == 2 && (velocity[2] != 0.0 || spin[0] != 0.0 || spin[1] != 0.0))
            settings_refuse(s, "motion", e, "must stay in the plane: in two dimensions velocity[2], spin[0] and spin[1] are 0");
        settings_done(&motion, e);
        kind->velocity = vec(velocity[0], velocity[1], velocity[2]);
        kind->spin = vec(spin[0], spin[1], spin[2]);
    }
    kind->driven = true;
    kind->mass = kind->inertia = INFINITY;
}

/* Columns of tables and keys of forces are called after species. */
static void check_name(const char *name, const struct particles *p, struct settings *s, struct error *e)
{
    for (const char *c = name; *c && !error_raised(e); c++)
        if (*c == ',' || *c == '"' || iscntrl((unsigned char)*c))
            settings_refuse(s, "name", e, "must have no comma, quote or line break");
    if (!error_raised(e) && strlen(name) >= sizeof p->kind->name)
        settings_refuse(s, "name", e, "must have at most %zu letters", sizeof p->kind->name - 1);
    for (int k = 0; k < p->species_count && !error_raised(e); k++)
        if (strcmp(name, p->kind[k].name) == 0)
            settings_refuse(s, "name", e, "is the name of species %d already", k + 1);
}

/* "species": [ { "name": "small", "radius": 1.0, "density": 0.1, "motion": "free" } ] */
bool species_build(struct settings *root, struct particles *p, int dimensions, struct error *e)
{
    const int kinds = settings_length(root, "species", e);
    if (!error_raised(e) && (kinds < 1 || kinds > MAX_SPECIES))
        settings_refuse(root, "species", e, "must list 1 to %d species", MAX_SPECIES);
    for (int k = 0; k < kinds && !error_raised(e); k++) {
        struct settings kind = settings_item(root, "species", k, e);
        const char *name = settings_text(&kind, "name", e);
        const double radius = settings_positive(&kind, "radius", e), density = settings_positive(&kind, "density", e);
        if (!error_raised(e))
            check_name(name, p, &kind, e);
        if (error_raised(e))
            return false;
        p->kind[p->species_count] = species_sphere(name, radius, density);
        read_motion(&p->kind[p->species_count++], dimensions, &kind, e);
        settings_done(&kind, e);
    }
    return !error_raised(e);
}

void start_moving(struct particles *p)
{
    for (int i = 0; i < p->count; i++) {
        const struct species *kind = &p->kind[p->species[i]];
        if (kind->driven)
            p->velocity[i] = kind->velocity;
        if (kind->driven && p->spin)
            p->spin[i] = kind->spin;
        if (p->anchor)
            p->anchor[i] = p->position[i];
    }
}
