/* Layer 1: many spheres at once, what all images of all pairs make of them (crowd.c), how it is judged (pair_crowd.c), and scenes drawn at random (pair_drawn.c). */
#ifndef CROWD_H
#define CROWD_H

#include "pair.h"

enum { CONTACT, LUBRICATION, DRAG, REPULSION, APPLIED, FORCES };
enum { CONTACT_NORMAL, CONTACT_TANGENTIAL, LUBRICATION_STRESS, DRAG_STRESS, REPULSION_STRESS, KINETIC, ORIGINS };

extern const char *const crowd_force[FORCES], *const crowd_origin[ORIGINS];

struct crowd_sphere { struct theory_sphere s; int species; };

struct crowd {
    struct model m;
    const json_t *scene;
    bool present[FORCES];
    size_t count;
    struct crowd_sphere *sphere;
    struct contact_row *history;
    size_t histories;
    double (*expected)[FORCES][6], (*scale)[FORCES][2];     /* by sphere */
    double stress[ORIGINS][9], stress_scale[ORIGINS];
    size_t pairs, self_pairs;
};

/* Reads what the scene declares; places are to be filled in. False: recorded already. */
bool crowd_of_scene(struct check_run *run, const json_t *scene, struct crowd *c);
void crowd_free(struct crowd *c);

/* Calls `visit` for every image of j (shift not zero, and one of each opposite two, if j is i) within `range`. */
typedef void crowd_visitor(struct crowd *c, size_t i, size_t j, const double shift[3], void *data);
void crowd_each_image(struct crowd *c, size_t i, size_t j, double range, crowd_visitor *visit, void *data);
/* How far the farthest force between i and j reaches [L]. */
double crowd_range(const struct crowd *c, size_t i, size_t j);
/* Gap over the sum of radii, if it is below *data (a double), goes there. */
void crowd_note_gap(struct crowd *c, size_t i, size_t j, const double shift[3], void *smallest);
/* Sphere k anywhere in the cell. */
void crowd_anywhere(struct crowd *c, gsl_rng *random, size_t k);
/* A random history of about this length times the radius for pairs that touch; every other one is listed as (j, i). */
void crowd_give_histories(struct crowd *c, gsl_rng *random, double length);

/* Pair force (contact, lubrication, repulsion) between i and an image of j, and the pair as it stands. */
void crowd_expect_pair(struct crowd *c, size_t i, size_t j, const double shift[3], int force, struct pair_state *p, struct expected *e);
struct state_row *crowd_rows(const struct crowd *c);                /* as a candidate is given them; caller frees */

/* What was seen worst, and the sentence about it. */
struct crowd_seen { struct worst w; char sentence[WHY_LENGTH]; };
struct crowd_verdict { struct crowd_seen force[FORCES], total, stress[ORIGINS]; bool right_at_rest[FORCES]; };
void crowd_verdict_start(struct crowd_verdict *v);
/* Works out what is expected, and asks for forces and stress. False: no answer; recorded already. */
bool crowd_ask(struct check_run *run, const char *name, json_t *scene, struct crowd *c, struct pair_answer *answer);
/* That, and adds what is seen to the verdict. */
bool crowd_see(struct check_run *run, const char *name, json_t *scene, struct crowd *c, struct crowd_verdict *v);
/* Records it all; `before`: the quantities' names begin with it. */
void crowd_judge(struct check_run *run, const struct crowd_verdict *v, const char *before);

/*
 * A scene of any physics with drawn numbers, and a crowd in it, with histories or not; caller frees both (json_decref, crowd_free).
 * Null: recorded already.
 */
json_t *drawn_crowd(struct check_run *run, gsl_rng *random, bool histories, struct crowd *c);

#endif
