/* Layer 1, shared parts: the keys of a scene beyond the plain contact, lubrication and drag (pair.h). */
#include "pair.h"

#include <string.h>

/* Number of the word in a list that ends with null; 0 where it is none of them. */
static int word_of(const json_t *scene, const char *path, const char *const words[])
{
    const char *word = json_string_value(scene_get(scene, path));
    for (int k = 0; word && words[k]; k++)
        if (strcmp(word, words[k]) == 0)
            return k;
    return 0;
}

static void read_motion(const json_t *species, size_t kind, struct model *m)
{
    const json_t *motion = json_object_get(species, "motion");
    const char *word = json_string_value(motion);
    m->driven[kind] = json_is_object(motion) || (word && strcmp(word, "held") == 0);
    for (size_t k = 0; k < 3 && json_is_object(motion); k++) {
        m->velocity[kind][k] = json_number_value(json_array_get(json_object_get(motion, "velocity"), k));
        m->spin[kind][k] = json_number_value(json_array_get(json_object_get(motion, "spin"), k));
    }
}

void model_read_laws(const json_t *scene, struct model *m)
{
    static const char *const laws[] = { "plain", "critical", "soft", "shifted", "binary", NULL };
    static const char *const loads[] = { "spring", "damped", "absolute", NULL }, *const tensions[] = { "allow", "clip", NULL };
    static const char *const forms[] = { "force", "energy", NULL };
    struct theory_contact *c = &m->contact;
    m->has_laws = scene_get(scene, "forces.contact.law") || scene_get(scene, "forces.contact.normal_damping")
                  || scene_get(scene, "forces.contact.restitution");
    c->law = (enum theory_law)word_of(scene, "forces.contact.law", laws);
    c->critical_load = scene_number(scene, "forces.contact.critical_load", 0);
    c->normal_damping = scene_number(scene, "forces.contact.normal_damping", 0);
    c->tangential_damping = scene_number(scene, "forces.contact.tangential_damping", 0);
    c->restitution = scene_number(scene, "forces.contact.restitution", 0);
    c->clip = word_of(scene, "forces.contact.tension", tensions) == 1;
    c->load = (enum theory_load)word_of(scene, "forces.contact.cap", loads);
    m->repulsion.by_energy = word_of(scene, "forces.repulsion.form", forms) == 1;
    m->repulsion.strength = scene_number(scene, m->repulsion.by_energy ? "forces.repulsion.energy" : "forces.repulsion.force", NAN);
    m->repulsion.kappa_factor = scene_number(scene, "forces.repulsion.kappa_factor", NAN);
    m->repulsion.cutoff = scene_number(scene, "forces.repulsion.cutoff", NAN);
    for (size_t k = 0; k < m->species; k++) {
        m->rough[k] = json_is_true(json_array_get(scene_get(scene, "forces.contact.rough"), k));
        read_motion(json_array_get(scene_get(scene, "species"), k), k, m);
    }
}

struct theory_contact contact_between(const struct model *m, double a1, double a2)
{
    struct theory_contact law = m->contact;
    for (int side = 0; side < 2; side++) {
        const double a = side ? a2 : a1;
        const int kind = model_species(m, a) - 1;
        law.rough[side] = m->rough[kind];
        law.mass[side] = m->driven[kind] ? (double)INFINITY : 4.0 / 3.0 * M_PI * m->density[kind] * a * a * a;
    }
    return law;
}
