/* Brownian spheres at rest: starts, runs and means (rest.h). */
#include "rest.h"
#include "packing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const rest_value_name[REST_VALUES] = { "contact_pressure", "lubrication_pressure", "temperature", "spin_temperature",
                                                   "structural_pressure_wide", "structural_pressure", "structural_shear_square" };

bool rest_start(struct check_run *run, const json_t *scene, const json_t *parameters, double phi, unsigned seed, struct rest *r)
{
    struct packing_species kind[8];
    struct model m;
    char why[WHY_LENGTH] = "the gate is out of memory";
    *r = (struct rest){ .kT = scene_number(scene, "fluid.kT", NAN) };
    if (!model_read(run, scene, &m))
        return false;
    const int kinds = m.species < 8 ? (int)m.species : 8;
    const json_t *counts = json_object_get(parameters, "counts");
    for (int k = 0; k < kinds; k++) {
        kind[k].radius = r->radius[k] = m.radius[k];
        kind[k].count = counts ? (int)json_integer_value(json_array_get(counts, (size_t)k)) : (int)scene_number(parameters, "spheres", 0);
        r->count += (size_t)kind[k].count;
    }
    r->edge = packing_edge(kind, kinds, phi);
    r->volume = gsl_pow_3(r->edge);
    r->row = calloc(r->count, sizeof *r->row);
    if (!r->row || !packing_make(kind, kinds, r->edge, 0.0, seed, r->row, why)) {
        check_garbage(run, why);
        free(r->row);
        return false;
    }
    gsl_rng *random = pair_random(run);
    gsl_rng_set(random, seed);
    for (int turning = 0; turning <= m.drag_torque; turning++)
        for (size_t i = 0; i < r->count; i++) {
            const double a = m.radius[r->row[i].species - 1], mass = 4.0 / 3.0 * M_PI * m.density[r->row[i].species - 1] * gsl_pow_3(a);
            if (turning)
                random_vector(random, sqrt(r->kT / (0.4 * mass * a * a)), r->row[i].w);
            else
                random_vector(random, sqrt(r->kT / mass), r->row[i].u);
        }
    gsl_rng_free(random);
    r->scene = json_deep_copy(scene);
    scene_set(r->scene, "seed", json_integer(seed));
    scene_set(r->scene, "box.lengths", json_pack("[fff]", r->edge, r->edge, r->edge));
    scene_set(r->scene, "start.file", json_string("states.csv"));
    return true;
}

void rest_free(struct rest *r)
{
    free(r->row);
    json_decref(r->scene);
    *r = (struct rest){ 0 };
}

/* The last state of the track as rows; spheres that do not turn have no spin. */
void rest_carry_on(struct rest *r, const struct track *t)
{
    for (size_t i = 0; i < r->count; i++) {
        const struct track_point *p = track_at(t, t->steps - 1, i);
        for (int c = 0; c < 3; c++) {
            r->row[i].x[c] = p->x[c];
            r->row[i].u[c] = p->u[c];
            r->row[i].w[c] = isfinite(p->w[c]) ? p->w[c] : 0.0;
        }
    }
}

bool rest_settle(struct check_run *run, const char *name, struct rest *r, int steps)
{
    struct track t;
    json_t *scene = json_deep_copy(r->scene);
    const bool good = track_ask(run, name, scene, r->row, r->count, &steps, 1, &t);
    if (good) {
        rest_carry_on(r, &t);
        track_free(&t);
    }
    json_decref(scene);
    const json_int_t seed = json_integer_value(scene_get(r->scene, "seed"));
    scene_set(r->scene, "seed", json_integer((seed + 0x40000000) & 0xffffffff));        /* not the same noise again */
    return good;
}

bool rest_track(struct check_run *run, const char *name, struct rest *r, const int *at, size_t steps, char out[PATH_LENGTH], struct track *t)
{
    char path[PATH_LENGTH];
    track_want(r->scene, at, steps);
    const struct question q = { .protocol = "run", .scene = r->scene, .state = r->row, .states = r->count };
    if (!check_ask(run, name, &q, out) || !track_load(run, out, at, steps, r->count, t))
        return false;
    path_join(path, out, "trajectory.csv");
    remove(path);                       /* tens of megabytes, read once */
    return true;
}

/* Contact and lubrication pressure, in n kT. */
static bool read_pressures(struct check_run *run, const char *out, const struct rest *r, double value[REST_VALUES])
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    struct table t;
    path_join(path, out, "stress.csv");
    static const char *const columns = "step,contact_normal_xx,contact_normal_yy,contact_normal_zz,lubrication_xx?,lubrication_yy?,lubrication_zz?";
    if (!table_read(path, columns, &t, why)) {
        check_garbage(run, why);
        return false;
    }
    double sum[2] = { 0 }, rows = 0.0;
    for (size_t row = 0; row < t.rows; row++)
        if (table_at(&t, row, 0) > 0.0) {
            for (size_t c = 0; c < 6; c++)
                sum[c / 3] -= table_at(&t, row, 1 + c) / 3.0;
            rows += 1.0;
        }
    table_free(&t);
    value[REST_CONTACT] = sum[0] / rows * r->volume / ((double)r->count * r->kT);
    value[REST_LUBRICATION] = sum[1] / rows * r->volume / ((double)r->count * r->kT);
    return true;
}

/* What can be read from states alone: temperatures and the structural Brownian stress. */
static void read_frames(const struct track *t, const struct rest *r, const struct model *m, double value[REST_VALUES])
{
    const double shell[2] = { 0.05, 0.02 }, depth = sqrt(M_PI * r->kT / (2.0 * m->contact.normal_stiffness));
    double (*x)[3] = malloc(r->count * sizeof *x), *radius = malloc(r->count * sizeof *radius);
    double pressure[2] = { 0 }, square = 0.0, hot[2] = { 0 };
    for (size_t s = 0; s < t->steps; s++) {
        for (size_t i = 0; i < r->count; i++) {
            const struct track_point *p = track_at(t, s, i);
            const double a = m->radius[r->row[i].species - 1], mass = 4.0 / 3.0 * M_PI * m->density[r->row[i].species - 1] * gsl_pow_3(a);
            memcpy(x[i], p->x, sizeof x[i]);
            radius[i] = a;
            hot[0] += mass * dot(p->u, p->u) / 3.0;
            hot[1] += 0.4 * mass * a * a * dot(p->w, p->w) / 3.0;
        }
        for (int k = 0; k < 2; k++) {
            double S[6];
            theory_structural_stress((int)r->count, (const double (*)[3])x, radius, r->edge, r->kT, shell[k], depth, S);
            pressure[k] -= (S[0] + S[1] + S[2]) / 3.0;
            if (k == 0)
                square += (S[3] * S[3] + S[4] * S[4] + S[5] * S[5]) / 3.0;
        }
    }
    const double states = (double)t->steps, unit = states * (double)r->count * r->kT;
    value[REST_TEMPERATURE] = hot[0] / unit;
    value[REST_SPIN_TEMPERATURE] = hot[1] / unit;
    value[REST_WIDE] = pressure[0] * r->volume / unit;
    value[REST_STRUCTURAL] = (shell[0] * pressure[1] - shell[1] * pressure[0]) / (shell[0] - shell[1]) * r->volume / unit;
    value[REST_VARIANCE] = square / states;
    free(x);
    free(radius);
}

static bool read_correlation(struct check_run *run, const char *out, struct rest_sample *s)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    struct table t;
    path_join(path, out, "green_kubo.csv");
    if (!table_read(path, "lag,samples,C_xy,C_xz,C_yz", &t, why)) {
        check_garbage(run, why);
        return false;
    }
    for (size_t row = 0; row < t.rows && row < REST_LAGS; row++, s->lags++) {
        s->lag[row] = table_at(&t, row, 0);
        s->correlation[row] = (table_at(&t, row, 2) + table_at(&t, row, 3) + table_at(&t, row, 4)) / 3.0;
    }
    table_free(&t);
    return true;
}

static bool measure(struct check_run *run, const struct rest_point *p, json_t *scene, int k, struct rest_sample *s)
{
    const json_t *parameters = run->gate_case->parameters, *correlate = json_object_get(p->json, "correlate");
    const int steps = (int)scene_number(p->json, "steps", 0), settle = (int)scene_number(p->json, "settle", 0);
    const int frames = (int)scene_number(p->json, "frames", 1);
    char name[64], out[PATH_LENGTH];
    struct rest r;
    struct model m;
    struct track t;
    if (!model_read(run, scene, &m) || !rest_start(run, scene, parameters, p->phi, (run->seed * 1000u + (unsigned)k) & 0x3fffffffu, &r))
        return false;
    int *at = calloc((size_t)frames, sizeof *at);
    for (int f = 0; f < frames; f++)
        at[f] = (int)((double)steps * (f + 1) / frames);
    snprintf(name, sizeof name, "%s-settle-%d", p->label, k);
    bool good = settle <= 0 || rest_settle(run, name, &r, settle);
    scene_set(r.scene, "output.stress.every", json_integer((json_int_t)scene_number(p->json, "every", 10)));
    if (correlate)
        scene_set(r.scene, "output.green_kubo", json_deep_copy(correlate));
    snprintf(name, sizeof name, "%s-%d", p->label, k);
    if (good && (good = rest_track(run, name, &r, at, (size_t)frames, out, &t))) {
        read_frames(&t, &r, &m, s->value);
        track_free(&t);
        good = read_pressures(run, out, &r, s->value) && (!correlate || read_correlation(run, out, s));
    }
    free(at);
    rest_free(&r);
    return good;
}

static json_t *scene_of(const struct check_run *run, const json_t *point)
{
    json_t *scene = json_deep_copy(run->gate_case->scene), *value;
    const char *path;
    json_object_foreach(json_object_get(point, "set"), path, value)
        scene_set(scene, path, json_deep_copy(value));
    return scene;
}

FILE *rest_table(const struct check_run *run, const char *name, const char *header)
{
    char path[PATH_LENGTH];
    path_join(path, run->work, name);
    FILE *f = fopen(path, "w");
    if (f)
        fprintf(f, "%s\n", header);
    return f;
}

static void write_sample(FILE *values, FILE *correlation, const struct rest_point *p, int k)
{
    const struct rest_sample *s = &p->sample[k];
    if (values) {
        fprintf(values, "%s,%g,%d", p->label, p->phi, k);
        for (int v = 0; v < REST_VALUES; v++)
            fprintf(values, ",%.8g", s->value[v]);
        fputc('\n', values);
        fflush(values);
    }
    for (size_t l = 0; correlation && l < s->lags; l++)
        fprintf(correlation, "%s,%g,%d,%.8g,%.8g\n", p->label, p->phi, k, s->lag[l], s->correlation[l]);
    if (correlation)
        fflush(correlation);
}

/* means.csv: every value of every point with its standard error. */
static void write_means(const struct check_run *run, const struct rest_point *point, size_t points)
{
    char header[512] = "point,phi,realisations";
    for (int v = 0; v < REST_VALUES; v++)
        snprintf(header + strlen(header), sizeof header - strlen(header), ",%s,error", rest_value_name[v]);
    FILE *f = rest_table(run, "means.csv", header);
    for (size_t i = 0; i < points && f; i++) {
        fprintf(f, "%s,%g,%d", point[i].label, point[i].phi, point[i].count);
        for (int v = 0; v < REST_VALUES; v++) {
            double error;
            const double mean = rest_mean(&point[i], v, &error);
            fprintf(f, ",%.5g,%.2g", mean, error);
        }
        fputc('\n', f);
    }
    if (f)
        fclose(f);
}

struct rest_point *rest_measure(struct check_run *run, size_t *points)
{
    const json_t *list = json_object_get(run->gate_case->parameters, "points");
    struct rest_point *point = calloc(REST_POINTS, sizeof *point);
    char header[256] = "point,phi,realisation";
    bool good = point != NULL;
    for (int v = 0; v < REST_VALUES; v++)
        snprintf(header + strlen(header), sizeof header - strlen(header), ",%s", rest_value_name[v]);
    FILE *values = rest_table(run, "points.csv", header), *correlation = rest_table(run, "correlation.csv", "point,phi,realisation,lag,correlation");
    *points = json_array_size(list) < REST_POINTS ? json_array_size(list) : REST_POINTS;
    for (size_t i = 0; i < *points && good; i++) {
        struct rest_point *p = &point[i];
        p->json = json_array_get(list, i);
        p->label = json_string_value(json_object_get(p->json, "label"));
        p->phi = scene_number(p->json, "phi", NAN);
        p->count = (int)scene_number(p->json, "realisations", 4);
        p->count = p->count < REST_REALISATIONS ? p->count : REST_REALISATIONS;
        p->sample = calloc((size_t)p->count, sizeof *p->sample);
        json_t *scene = scene_of(run, p->json);
        p->kT = scene_number(scene, "fluid.kT", NAN);
        p->viscosity = scene_number(scene, "fluid.viscosity", NAN);
        p->stiffness = scene_number(scene, "forces.contact.normal_stiffness", NAN);
        struct rest one;
        good = p->label && p->sample && rest_start(run, scene, run->gate_case->parameters, p->phi, 1, &one);
        if (good) {
            p->volume = one.volume;
            p->density = (double)one.count / one.volume;
            rest_free(&one);
        }
        for (int k = 0; k < p->count && good; k++) {
            check_progress(run, "%s: realisation %d of %d", p->label, k + 1, p->count);
            good = measure(run, p, scene, k, &p->sample[k]);
            if (good)
                write_sample(values, correlation, p, k);
        }
        json_decref(scene);
    }
    if (values)
        fclose(values);
    if (correlation)
        fclose(correlation);
    if (good)
        write_means(run, point, *points);
    else if (point) {
        rest_points_free(point, *points);
        point = NULL;
    }
    return point;
}

void rest_points_free(struct rest_point *point, size_t points)
{
    for (size_t i = 0; i < points; i++)
        free(point[i].sample);
    free(point);
}

double rest_mean(const struct rest_point *p, int value, double *standard_error)
{
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < p->count; k++)
        sum += p->sample[k].value[value];
    for (int k = 0; k < p->count; k++)
        squares += gsl_pow_2(p->sample[k].value[value] - sum / p->count);
    *standard_error = sqrt(squares / (p->count - 1) / p->count);
    return sum / p->count;
}

struct result *rest_exceeds(struct check_run *run, const char *what, double measured, double standard_error, double bound,
                            const char *sentence)
{
    struct result *r = check_error(run, MODEL, what, measured, bound, bound - (measured - 4.0 * standard_error), 0.0,
                                   "%s: %.4g +- %.2g, bound %.4g", sentence, measured, standard_error, bound);
    if (r->verdict == VERDICT_FAIL && measured + 4.0 * standard_error > bound)
        r->verdict = VERDICT_INCONCLUSIVE;
    return r;
}
