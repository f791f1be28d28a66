/*
 * Layer 7: diffusion of Brownian spheres at rest against volume fraction and inertia, Li (2026) fig 4.2b-d
 *
 *     t << all relaxation:  <dx^2> = (kT/m) t^2  per component, at every phi
 *     later:                D(phi)/D_0 falls with phi, and is a function of phi alone where tau_I/tau_B <= 0.17
 *
 * D = half the slope of <dx^2> against time; D_0 = kT/(6 pi eta a) (the source's D_0 is pi times larger than a^2/tau_B, its ratio D/D_0 is meant
 * between equal definitions); tau_I = rho a^2/eta, tau_B = eta a^3/kT. Time is counted in a^2/D_0.
 *
 * Only groups matter, so the three ratios are three kT, with contacts equally hard against kT (k_n a^2/kT, a parameter) and steps of
 * equal thermal displacement sqrt(kT/m) dt / a (a parameter too): each ratio is then the same problem but for inertia.
 *
 * The ballistic part cannot be seen at the steps of the long run: squeezed pairs relax in m_eff/X_A. A short run with tiny steps goes on from the
 * last state of each realisation; its <dx^2>/(<u(0)^2> t^2) hardly scatters and is multiplied by <u^2> m/kT over all states of the long run.
 * Errors: spread over blocks of origins, each twice as long as the lag, in all realisations.
 */
#include "published_rest.h"
#include "rest.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PER_TIME = 40, MIDDLE = PER_TIME / 2, POINTS = 24, BLOCKS = 512, SHORT = 4 };     /* states per a^2/D_0; lags in states */
static const int short_steps[SHORT] = { 1, 10, 100, 1000 };
static const double short_dt = 1e-6;                                    /* of tau_I */

struct estimate { double mean, error; };

struct diffusion {
    const char *label;
    double phi, ratio, kT, mass, unit_time /* a^2/D_0 */, inertia_time;
    double block[3][BLOCKS];                        /* D_middle/D_0, D_long/D_0, <u^2> m/kT of each block of origins */
    int blocks[3];
    double msd[4 * PER_TIME + 1], origins[4 * PER_TIME + 1];            /* pooled sums, by lag in states */
    double ballistic[SHORT], squares;               /* sums of dx^2/t^2 and of u(0)^2 in the short runs */
    double at_time[SHORT];
};

static struct estimate of_blocks(const double *value, int n)
{
    struct estimate e = { 0.0, 0.0 };
    for (int k = 0; k < n; k++)
        e.mean += value[k] / n;
    for (int k = 0; k < n; k++)
        e.error += gsl_pow_2(value[k] - e.mean);
    e.error = sqrt(e.error / (n - 1.0) / n);
    return e;
}

/* Mean of dx^2 per component from `origin` to `origin + lag`. */
static double square_between(const struct track *t, size_t origin, size_t lag)
{
    double sum = 0.0;
    for (size_t i = 0; i < t->count; i++)
        for (int c = 0; c < 3; c++)
            sum += gsl_pow_2(track_at(t, origin + lag, i)->x[c] - track_at(t, origin, i)->x[c]);
    return sum / (3.0 * (double)t->count);
}

/* Slopes between two lags, in blocks of origins. */
static void add_slopes(struct diffusion *d, int which, const struct track *t, size_t near, size_t far)
{
    const size_t length = which == 0 ? 2 * far : far;
    const double D0 = 1.0 / d->unit_time;           /* a = 1 */
    for (size_t first = 0; first + length + far <= t->steps && d->blocks[which] < BLOCKS; first += length) {
        double sum = 0.0;
        for (size_t o = first; o < first + length; o++)
            sum += square_between(t, o, far) - square_between(t, o, near);
        d->block[which][d->blocks[which]++] = sum / (double)length / (2.0 * (double)(far - near) * d->unit_time / PER_TIME) / D0;
    }
}

static void add_track(struct diffusion *d, const struct track *t)
{
    add_slopes(d, 0, t, PER_TIME / 20, MIDDLE);
    add_slopes(d, 1, t, PER_TIME, 2 * PER_TIME);
    for (size_t first = 0; first + PER_TIME <= t->steps && d->blocks[2] < BLOCKS; first += PER_TIME) {
        double sum = 0.0;
        for (size_t s = first; s < first + PER_TIME; s++)
            for (size_t i = 0; i < t->count; i++)
                sum += dot(track_at(t, s, i)->u, track_at(t, s, i)->u);
        d->block[2][d->blocks[2]++] = sum * d->mass / (3.0 * d->kT * (double)t->count * PER_TIME);
    }
    for (size_t lag = 1; lag <= 4 * PER_TIME && lag < t->steps; lag++)
        for (size_t o = 0; o + lag < t->steps; o++) {
            d->msd[lag] += square_between(t, o, lag);
            d->origins[lag] += 1.0;
        }
}

/* The short run: what it adds to the sums. */
static bool add_short_run(struct check_run *run, struct diffusion *d, struct rest *r, const char *name)
{
    struct track t;
    json_t *scene = json_deep_copy(r->scene);
    const double dt = short_dt * d->inertia_time;
    scene_set(scene, "dynamics.split.dt", json_real(dt));
    const bool good = track_ask(run, name, scene, r->row, r->count, short_steps, SHORT, &t);
    if (good) {
        for (size_t i = 0; i < r->count; i++) {
            d->squares += dot(r->row[i].u, r->row[i].u);
            for (int k = 0; k < SHORT; k++)
                for (int c = 0; c < 3; c++)
                    d->ballistic[k] += gsl_pow_2((track_at(&t, (size_t)k, i)->x[c] - r->row[i].x[c]) / (short_steps[k] * dt));
        }
        for (int k = 0; k < SHORT; k++)
            d->at_time[k] = short_steps[k] * short_dt;
        track_free(&t);
    }
    json_decref(scene);
    return good;
}

static bool measure(struct check_run *run, const json_t *point, struct diffusion *d)
{
    const json_t *parameters = run->gate_case->parameters;
    const int realisations = (int)scene_number(point, "realisations", 0), length = (int)(PER_TIME * scene_number(parameters, "length", 0));
    struct model m;
    if (!model_read(run, run->gate_case->scene, &m))
        return false;
    const struct free_sphere sphere = free_sphere(&m);
    d->label = json_string_value(json_object_get(point, "label"));
    d->phi = scene_number(point, "phi", NAN);
    d->ratio = scene_number(point, "ratio", NAN);
    d->inertia_time = m.density[0] * gsl_pow_2(m.radius[0]) / m.viscosity;
    d->kT = d->ratio * gsl_pow_2(m.viscosity) * m.radius[0] / m.density[0];
    d->mass = sphere.mass;
    d->unit_time = gsl_pow_2(m.radius[0]) * sphere.friction / d->kT;
    const double wanted = scene_number(parameters, "step", NAN) * m.radius[0] / sqrt(d->kT / d->mass);
    const int per_state = (int)ceil(d->unit_time / PER_TIME / wanted);
    const int settle = (int)(per_state * PER_TIME * scene_number(parameters, "settle", 0));
    json_t *scene = json_deep_copy(run->gate_case->scene);
    scene_set(scene, "fluid.kT", json_real(d->kT));
    const double stiffness = scene_number(parameters, "hardness", NAN) * d->kT / gsl_pow_2(m.radius[0]);
    scene_set(scene, "forces.contact.normal_stiffness", json_real(stiffness));
    scene_set(scene, "dynamics.split.dt", json_real(d->unit_time / PER_TIME / per_state));
    int *at = calloc((size_t)length, sizeof *at);
    bool good = at != NULL;
    for (int s = 0; good && s < length; s++)
        at[s] = per_state * (s + 1);
    for (int k = 0; k < realisations && good; k++) {
        char name[64], out[PATH_LENGTH];
        struct rest r;
        struct track t;
        check_progress(run, "%s: realisation %d of %d", d->label, k + 1, realisations);
        if (!(good = rest_start(run, scene, parameters, d->phi, (run->seed * 1000u + (unsigned)k) & 0x3fffffffu, &r)))
            break;
        snprintf(name, sizeof name, "%s-settle-%d", d->label, k);
        good = rest_settle(run, name, &r, settle);
        snprintf(name, sizeof name, "%s-%d", d->label, k);
        if (good && (good = rest_track(run, name, &r, at, (size_t)length, out, &t))) {
            add_track(d, &t);
            rest_carry_on(&r, &t);
            track_free(&t);
            snprintf(name, sizeof name, "%s-short-%d", d->label, k);
            good = add_short_run(run, d, &r, name);
        }
        rest_free(&r);
    }
    free(at);
    json_decref(scene);
    return good;
}

static void write_point(FILE *values, FILE *curves, const struct diffusion *d)
{
    const struct estimate middle = of_blocks(d->block[0], d->blocks[0]), far = of_blocks(d->block[1], d->blocks[1]);
    const struct estimate hot = of_blocks(d->block[2], d->blocks[2]);
    if (values) {
        fprintf(values, "%g,%g,%.5g,%.2g,%.5g,%.2g,%.5g,%.2g", d->phi, d->ratio, middle.mean, middle.error, far.mean, far.error, hot.mean,
                hot.error);
        for (int k = 0; k < SHORT; k++)
            fprintf(values, ",%.5g", d->ballistic[k] / d->squares * hot.mean);
        fputc('\n', values);
        fflush(values);
    }
    for (int k = 0; curves && k < SHORT; k++)       /* t/tau_I, t D_0/a^2, <dx^2>/a^2 */
        fprintf(curves, "%g,%g,%.5g,%.5g,%.5g\n", d->phi, d->ratio, d->at_time[k], d->at_time[k] * d->inertia_time / d->unit_time,
                d->ballistic[k] / d->squares * hot.mean * d->kT / d->mass * gsl_pow_2(d->at_time[k] * d->inertia_time));
    for (int lag = 1; curves && lag <= 4 * PER_TIME; lag++)
        if (d->origins[lag] > 0.0)
            fprintf(curves, "%g,%g,%.5g,%.5g,%.5g\n", d->phi, d->ratio, lag * d->unit_time / PER_TIME / d->inertia_time,
                    (double)lag / PER_TIME, d->msd[lag] / d->origins[lag]);
    if (curves)
        fflush(curves);
}

/* At one volume fraction: all ratios of times together, weighted by their errors, and each in the notes. */
static void judge_ballistic(struct check_run *run, const struct diffusion *d, size_t points, double phi)
{
    double sum = 0.0, weight = 0.0;
    char notes[1024] = "<dx^2>/((kT/m) t^2) at t/tau_I = 1e-6, 1e-5, 1e-4, 1e-3, and kinetic temperature:", text[128];
    for (size_t k = 0; k < points; k++) {
        if (d[k].phi != phi)
            continue;
        const struct estimate hot = of_blocks(d[k].block[2], d[k].blocks[2]);
        const double unit = hot.mean / d[k].squares, *b = d[k].ballistic;
        const size_t used = strlen(notes);
        snprintf(notes + used, sizeof notes - used, " tau_I/tau_B %g: %.4f, %.4f, %.4f, %.4f, %.4f +- %.4f kT;", d[k].ratio, b[0] * unit, b[1] * unit,
                 b[2] * unit, b[3] * unit, hot.mean, hot.error);
        sum += b[0] * unit / gsl_pow_2(hot.error);
        weight += 1.0 / gsl_pow_2(hot.error);
    }
    snprintf(text, sizeof text, "phi %g: ballistic part", phi);
    struct result *r = check_interval(run, MODEL, text, sum / weight, sqrt(1.0 / weight), 1.0,
                                      scene_number(run->gate_case->parameters, "ballistic_margin", 0.01),
                                      "at first the mean square displacement is %.4g of (kT/m) t^2", sum / weight);
    result_notes(r, "%s", notes);
}

static const struct diffusion *find(const struct diffusion *d, size_t points, double phi, double ratio)
{
    for (size_t k = 0; k < points; k++)
        if (d[k].phi == phi && d[k].ratio == ratio)
            return &d[k];
    return NULL;
}

/* D at this ratio against phi, points in ascending order. */
static void judge_fall(struct check_run *run, const struct diffusion *d, size_t points, double ratio)
{
    const struct diffusion *last = NULL;
    for (size_t k = 0; k < points; k++) {
        if (d[k].ratio != ratio)
            continue;
        if (last) {
            const struct estimate a = of_blocks(last->block[0], last->blocks[0]), b = of_blocks(d[k].block[0], d[k].blocks[0]);
            char text[128];
            snprintf(text, sizeof text, "tau_I/tau_B %g: D/D_0 at phi %g less that at %g", ratio, last->phi, d[k].phi);
            rest_exceeds(run, text, a.mean - b.mean, hypot(a.error, b.error), 0.0, "diffusion should slow down with volume fraction");
        }
        last = &d[k];
    }
}

/* D at `ratio` over that at `base`, same phi: weighted mean of the logarithm over phi, and each in the notes. */
static void judge_collapse(struct check_run *run, const struct diffusion *d, size_t points, double ratio, double base, double margin)
{
    double sum = 0.0, weight = 0.0;
    char notes[1024] = "D/D_0 at half of a^2/D_0, at phi:", text[128];
    for (size_t k = 0; k < points; k++) {
        const struct diffusion *other = d[k].ratio == base ? find(d, points, d[k].phi, ratio) : NULL;
        if (!other)
            continue;
        const struct estimate a = of_blocks(other->block[0], other->blocks[0]), b = of_blocks(d[k].block[0], d[k].blocks[0]);
        const double error = hypot(a.error / a.mean, b.error / b.mean), w = 1.0 / gsl_pow_2(error);
        sum += w * log(a.mean / b.mean);
        weight += w;
        const size_t used = strlen(notes);
        snprintf(notes + used, sizeof notes - used, " %g: %.4f +- %.4f and %.4f +- %.4f;", d[k].phi, a.mean, a.error, b.mean, b.error);
    }
    if (!(weight > 0.0))
        return;
    snprintf(text, sizeof text, "D/D_0 at tau_I/tau_B %g over that at %g", ratio, base);
    struct result *r = check_interval(run, MODEL, text, exp(sum / weight), sqrt(1.0 / weight), 1.0, margin,
                                      "the diffusion coefficient over that of a lone sphere depends on inertia: %s", notes);
    result_notes(r, "%s", notes);
}

void check_published_diffusion(struct check_run *run)
{
    const json_t *list = json_object_get(run->gate_case->parameters, "points");
    const size_t points = json_array_size(list) < POINTS ? json_array_size(list) : POINTS;
    struct diffusion *d = calloc(POINTS, sizeof *d);
    FILE *values = rest_table(run, "diffusion.csv", "phi,tau_I/tau_B,D_middle/D0,error,D_long/D0,error_long,T/kT,error_T,"
                                                    "ballistic_1e-6,ballistic_1e-5,ballistic_1e-4,ballistic_1e-3");
    FILE *curves = rest_table(run, "msd.csv", "phi,tau_I/tau_B,t/tau_I,t*D0/a^2,msd/a^2");
    bool good = d != NULL;
    for (size_t k = 0; k < points && good; k++)
        if ((good = measure(run, json_array_get(list, k), &d[k])))
            write_point(values, curves, &d[k]);
    if (values)
        fclose(values);
    if (curves)
        fclose(curves);
    if (good) {
        for (size_t k = 0; k < points; k++) {
            size_t first = 0;
            while (d[first].phi != d[k].phi)
                first++;
            if (first == k)
                judge_ballistic(run, d, points, d[k].phi);
        }
        judge_fall(run, d, points, 1.7);
        judge_fall(run, d, points, 0.17);
        judge_collapse(run, d, points, 0.017, 0.17, run->gate_case->tolerance);
    }
    free(d);
}
