/*
 * What the checks of layer 1 share: books of frozen two-sphere states, the model that the scene declares, asking and
 * indexing answers, and remembering the worst of many comparisons.
 */
#ifndef PAIR_H
#define PAIR_H

#include "check.h"
#include "theory/theory.h"

#include <gsl/gsl_math.h>
#include <gsl/gsl_rng.h>

/* --- vectors --- */

static inline double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline double norm(const double a[3]) { return sqrt(dot(a, a)); }
static inline void cross(const double a[3], const double b[3], double out[3])
{
    const double c[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    for (int k = 0; k < 3; k++)
        out[k] = c[k];
}
void apply(double m[3][3], const double a[3], double out[3]);       /* out = m a; out may be a */

/* --- what a scene declares --- */

struct model {
    struct theory_lubrication lubrication;
    struct theory_contact contact;      /* masses and roughness are those of a pair: contact_between */
    struct theory_repulsion repulsion;
    bool has_lubrication, has_contact, has_drag, drag_torque;
    double viscosity, gradient[3][3], cell[3][3] /* rows: vectors at the evaluated time */, volume, time;
    bool open[3];       /* directions of the cell that are not periodic */
    size_t species;
    double radius[64], density[64];
    bool has_laws, rough[64];           /* a dashpot or a friction law beside the plain contact */
    bool driven[64];                    /* held species too */
    double velocity[64][3], spin[64][3];
};
/* False (with a recorded failure) if the case's scene lacks something; that is a mistake in the suite. */
bool model_read(struct check_run *run, const json_t *scene, struct model *m);
/* Part of model_read: dashpots, friction laws, repulsion, motion of species. */
void model_read_laws(const json_t *scene, struct model *m);
/* Constant force, then torque, that the scene applies to this species (from 0). */
void scene_applied(const json_t *scene, size_t kind, double load[6]);
/* The contact law of two spheres, told apart by their radii. */
struct theory_contact contact_between(const struct model *m, double a1, double a2);
/* The scene of the case with what a variant changes: "shear", "time", "lengths", "cell", "periodic". Caller owns the result. */
json_t *variant_scene(const struct gate_case *c, const json_t *variant);
int model_species(const struct model *m, double radius);            /* number from 1 of the species with this radius */

/* The scene in units of length, mass and time so many times as small; and what a number of this dimension is multiplied with. */
struct units { double length, mass, time; };
double unit_of(const struct units *u, int length, int mass, int time);
json_t *scene_in_units(const json_t *scene, const struct units *u);

/* --- states --- */

struct pair_state {
    struct theory_sphere s[2];
    double history[3];
    bool with_history, listed_backwards;    /* backwards: contacts.csv names (2, 1) and the opposite displacement */
    double xi;                              /* the gap asked for: 2 h/(a_1 + a_2) */
};
struct pair_book { struct pair_state *item; size_t count; };

struct pair_state *book_add(struct pair_book *book, const struct pair_state *s);
void book_free(struct pair_book *book);

gsl_rng *pair_random(const struct check_run *run);                   /* of this case and attempt; free with gsl_rng_free */
void random_vector(gsl_rng *random, double size, double v[3]);
void random_direction(gsl_rng *random, double n[3]);
void random_rotation(gsl_rng *random, double Q[3][3]);
/* Two spheres at dimensionless gap xi in a random direction, with random velocities and spins. */
struct pair_state random_pair(gsl_rng *random, double a1, double a2, double xi);
struct pair_state swapped(const struct pair_state *p);               /* the same pair with the labels exchanged */
double pair_geometry(const struct pair_state *p, double n[3], double *distance);    /* returns the gap h */
void parameter_list(const json_t *parameters, const char *key, double *value, size_t *count, size_t room);

/* --- asking --- */

struct pair_answer { struct forces forces; char out[PATH_LENGTH]; };
/* Two particles per state. `wanted`: forces that must be there. False: recorded already. */
bool book_ask(struct check_run *run, const char *name, json_t *scene, const struct pair_book *book, const char *wanted,
              struct pair_answer *answer);
/* Stress of one origin times the volume, [state][9]; null after recording what is wrong. Caller frees. */
double *answer_stress(struct check_run *run, const struct pair_answer *a, size_t states, const char *origin, double volume);

/* Force and torque on both spheres under a declared law, with the sizes that errors are measured against. */
struct expected { struct theory_pair pair; double force_scale, torque_scale; };
void expect_lubrication(const struct model *m, const struct pair_state *p, struct expected *e);
void expect_contact(const struct model *m, const struct pair_state *p, struct expected *e);

/* --- the worst of many --- */

struct worst { double error, measured, expected; size_t at; };
#define WORST_NONE { -1, NAN, NAN, 0 }
/* Error |measured - expected|/scale; a NaN is worse than anything. */
void worst_see(struct worst *w, double measured, double expected, double scale, size_t at);
void worst_see_vector(struct worst *w, const double *measured, const double *expected, int components, double scale, size_t at);
/* "radii 1.3 and 9.1, gap xi = 0.01, state 17", in a buffer of its own until the next call. */
const char *describe(const struct pair_state *p, size_t at);
/* A sentence about the size of what was seen: "0.5 of what is expected", "nothing where ... is expected". */
const char *compare(const struct worst *w);

#endif
