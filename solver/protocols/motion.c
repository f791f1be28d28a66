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

void species_motion(struct species *kind, int dimensions, struct settings *s, struct error *e)
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
