/*
 * Brownian spheres at rest: independent realisations, each from spheres placed at random without overlap with Maxwell velocities,
 * which collisions and friction bring to equilibrium. What happens before that is thrown away.
 */
#ifndef REST_H
#define REST_H

#include "single.h"

#include <stdio.h>

struct rest {
    json_t *scene;                      /* ready to run but for its length and its output */
    struct state_row *row;              /* start */
    size_t count;
    double edge, volume, kT, radius[8];
};

/*
 * `parameters`: `spheres` (one species) or `counts` (one number per species). Maxwell velocities; spins too where the scene's drag turns
 * spheres. False: recorded already, and nothing is left to free.
 */
bool rest_start(struct check_run *run, const json_t *scene, const json_t *parameters, double phi, unsigned seed, struct rest *r);
/* Run to at[steps - 1] with what the scene's output asks for besides, and read the states at the steps of `at`. */
bool rest_track(struct check_run *run, const char *name, struct rest *r, const int *at, size_t steps, char out[PATH_LENGTH], struct track *t);
/* Run for `steps` and go on from there: `row` becomes the last state. */
bool rest_settle(struct check_run *run, const char *name, struct rest *r, int steps);
void rest_carry_on(struct rest *r, const struct track *t);             /* the same from a track that is there already */
void rest_free(struct rest *r);
FILE *rest_table(const struct check_run *run, const char *name, const char *header);      /* in the work folder; null if it cannot be */

/* Means over one realisation: pressures in n kT, temperatures in kT, and the Brownian stress correlation at rest. */
enum { REST_CONTACT, REST_LUBRICATION, REST_TEMPERATURE, REST_SPIN_TEMPERATURE, REST_WIDE, REST_STRUCTURAL, REST_VARIANCE, REST_VALUES };
extern const char *const rest_value_name[REST_VALUES];
enum { REST_LAGS = 256, REST_REALISATIONS = 64, REST_POINTS = 16 };
struct rest_sample {
    double value[REST_VALUES];
    size_t lags;                        /* of green_kubo.csv; 0 where it was not asked for */
    double lag[REST_LAGS], correlation[REST_LAGS];
};
/*
 * One point of a figure. `json`: `label`, `phi`, `steps`, `settle` (steps), `realisations`, `every` (steps between stresses),
 * `frames` (states looked at), optionally `correlate` { `every`, `levels` } and `set`: changes to the scene by path.
 */
struct rest_point {
    const json_t *json;
    const char *label;
    double phi, density /* number */, kT, viscosity, volume, stiffness;
    int count;                          /* of realisations */
    struct rest_sample *sample;
};

/* Measure all points of the case, writing points.csv and correlation.csv into the work folder as they come. Null: recorded. */
struct rest_point *rest_measure(struct check_run *run, size_t *points);
void rest_points_free(struct rest_point *point, size_t points);
/* Mean of one value over the realisations and its standard error. */
double rest_mean(const struct rest_point *p, int value, double *standard_error);

/* One-sided: passes if measured - 4 standard errors lies above the bound, fails if measured + 4 lies below, else inconclusive. */
struct result *rest_exceeds(struct check_run *run, const char *what, double measured, double standard_error, double bound,
                            const char *sentence);

#endif
