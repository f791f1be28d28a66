/* Layer 6, tables of a run: what their checks share (observers.c, observers_moment.c, observers_lags.c, observers_run.c). */
#ifndef OBSERVERS_CHECK_H
#define OBSERVERS_CHECK_H

#include "two_bodies.h"

/* `own`: a sphere and its own image; `told`: both are driven, which is no pair for forces, though one for g(r). */
struct near_pair { size_t i, j; double n[3], distance, gap; bool own, told; };
enum { FILM_PARTS = 5 };
struct film {
    struct check_run *run;
    json_t *scene;
    struct model m;
    double start[3][3];             /* rows: edges of the cell at time 0 */
    struct state_row *row;
    struct track track;
    struct near_pair **near;        /* of each frame, all images within `range` */
    size_t count, frames, *nears;
    int every;
    double begin;                   /* time of the first frame */
    struct theory_stage stage[STAGES];
    size_t stages;                  /* 0: steady */
    double (*flow)[3][3], (*turning)[3][3], (*strain)[3][3];    /* of each frame: G, that of spins where a rate jumps, the integral from time 0 on */
    double dt, kT, range;
    int axis[3];                    /* flow, gradient and vorticity of the fastest shear, of stages the first; x, y, z at rest */
    char out[PATH_LENGTH];
};

double film_radius(const struct film *f, size_t i);
double film_mass(const struct film *f, size_t i);
bool film_driven(const struct film *f, size_t i);
/* Velocity and spin without those of the flow of that frame. */
void film_peculiar(const struct film *f, size_t frame, const struct track_point *p, double c[3], double w[3]);
/* False where the candidate has not written the table (skipped) or it cannot be read (recorded). */
bool film_table(const struct film *f, const char *file, const char *columns, struct table *t);
/* The origins of stress that add to the viscosity, as the scene has them. Returns how many. */
int film_parts(const struct film *f, const char *part[FILM_PARTS]);
/* Columns ff, gg, vv, fg, gf of one origin of stress, by the axes of the fastest shear, of stages the first; and its rate in steady shear. */
void film_stress_columns(const struct film *f, const char *origin, char columns[400]);
double film_rate(const struct film *f);
/* The frame of a row whose first column is the step; f->frames where there is none. */
size_t film_frame(const struct film *f, const struct table *t, size_t row);
void film_judge(const struct film *f, const char *what, const struct worst *w);
/* Structural Brownian stress of a frame: shell over the radius, thermal depth. */
void film_structure(const struct film *f, size_t frame, double shell, double depth, double S[6]);
double film_depth(const struct film *f);
/* Kinetic energies by axis, of a species from 1 or of all (0): translation, then rotation. */
void film_temperatures(const struct film *f, size_t frame, int species, double T[6]);

/* What there is at each moment (observers_moment.c). */
void film_judge_driven(const struct film *f);
void film_judge_temperature(const struct film *f);
void film_judge_contacts(const struct film *f);
void film_judge_viscosity(const struct film *f);
void film_judge_kinetic(const struct film *f);
void film_judge_brownian(const struct film *f);

/* Those of lags (observers_lags.c). */
void film_judge_lags(const struct film *f);

/* The others that are written at the end, and those of stresses (observers_run.c). */
void film_judge_distribution(const struct film *f);
void film_judge_plane(const struct film *f);
void film_judge_stress_table(const struct film *f);
void film_judge_green_kubo(const struct film *f);
void film_judge_averages(const struct film *f);

#endif
