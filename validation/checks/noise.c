/*
 * Layer 2: the Brownian forces of a frozen configuration
 *
 *     <F F^T> = (2 kT/dt) R ,      <F> = 0 ,      <F(t) F(t + k dt)^T> = 0
 *
 *     F    force and torque of every sphere, 6 N numbers            R   resistance matrix, F_drag = - R u
 *     kT   thermal energy                                           dt  time step
 *
 * R is the candidate's own: one frozen state for each unit velocity and spin. So nothing here depends on a formula of ours; that R
 * is the declared model's is a separate result. Draws are whitened by R: on its range they must be independent standard normals,
 * on its null space (rigid translation, rolling, pairs out of reach) they must vanish.
 *
 * Source: Callen & Welton (1951), Ermak & McCammon (1978). For the pair noise of Li (2026): its eq 3.24 as printed has a plus
 * where fluctuation and dissipation need a minus; it changes no block but <T_1 T_2>, which therefore is tried by itself.
 */
#include "heatmap.h"
#include "noise.h"
#include "statistics.h"

#include <gsl/gsl_eigen.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const force_of[STREAMS] = { "drag", "lubrication" };
static const struct { const char *file, *name, *law; } kind_of[KINDS] = {
    { "noise_drag_noise.npy", "drag noise", "(2 kT/dt) R, R from the candidate's own drag" },
    { "noise_lubrication_noise.npy", "pair noise", "(2 kT/dt) R, R from the candidate's own lubrication" },
    { "friction.npy", "noise of the friction step", "kT (M - C M C^T), C from the candidate's own step without noise" },
};

static const double seen = NOISE_SEEN;

double noise_declared(const struct subject *s, const char *key)
{
    char path[64];
    snprintf(path, sizeof path, "declared.%s", key);
    return scene_number(s->run->gate_case->parameters, path, NAN);
}

/* "pair torque" and the like: unique result names in buffers that live as long as the call needs them. */
static const char *named(char text[96], int stream, const char *what)
{
    snprintf(text, 96, "%s: %s", kind_of[stream].name, what);
    return text;
}

/* --- the resistance matrix itself --- */

/* By how much a measured R fails to be what it must be: symmetric, and without negative eigenvalues. */
struct defects { double skew, least, most; size_t at; };    /* largest |R_ij - R_ji|, at ij; least and largest eigenvalue */

static struct defects measure_defects(const double *R, size_t n)
{
    struct defects d = { 0 };
    gsl_matrix *copy = gsl_matrix_alloc(n, n);
    gsl_vector *eigenvalue = gsl_vector_alloc(n);
    gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(n);
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const double difference = fabs(R[i * n + j] - R[j * n + i]);
            if (difference > d.skew) {
                d.skew = difference;
                d.at = i * n + j;
            }
            gsl_matrix_set(copy, i, j, 0.5 * (R[i * n + j] + R[j * n + i]));
        }
    gsl_eigen_symm(copy, eigenvalue, space);
    gsl_vector_minmax(eigenvalue, &d.least, &d.most);
    gsl_eigen_symm_free(space);
    gsl_vector_free(eigenvalue);
    gsl_matrix_free(copy);
    return d;
}

static void judge_resistance(const struct subject *s, int stream, const double *R)
{
    const double tolerance = s->run->gate_case->tolerance;
    const size_t n = s->size;
    const struct defects d = measure_defects(R, n);
    double largest = 0.0;
    char name[96], block[160];
    for (size_t k = 0; k < n * n; k++)
        largest = fmax(largest, fabs(R[k]));
    snprintf(name, sizeof name, "R of %s: symmetric", force_of[stream]);
    check_error(s->run, INVARIANT, name, R[d.at], R[d.at % n * n + d.at / n], d.skew / largest, tolerance,
                "the resistance measured from the candidate's own %s is not symmetric; worst block %s", force_of[stream],
                noise_block_name(block, s, d.at / n / 3, d.at % n / 3));
    snprintf(name, sizeof name, "R of %s: positive", force_of[stream]);
    check_error(s->run, INVARIANT, name, d.least, 0.0, d.most > 0.0 ? fmax(0.0, -d.least / d.most) : NAN, tolerance,
                "%s puts energy in: its resistance matrix has the eigenvalue %.6g (largest %.6g)", force_of[stream], d.least, d.most);
}

static void judge_model(const struct subject *s, const struct model *m)
{
    double *theory = malloc(s->size * s->size * sizeof *theory), largest = 0.0;
    char block[160];
    struct worst worst = WORST_NONE;
    theory_resistance(m, s->f, theory);
    for (size_t k = 0; k < s->size * s->size; k++)
        largest = fmax(largest, fabs(theory[k]));
    for (size_t k = 0; k < s->size * s->size; k++)
        worst_see(&worst, s->R[LUBRICATION][k], theory[k], largest, k);
    check_error(s->run, MODEL, "R of lubrication: declared model", worst.measured, worst.expected, worst.error,
                s->run->gate_case->tolerance, "the resistance matrix is not that of the declared lubrication: block %s has %s",
                noise_block_name(block, s, worst.at / s->size / 3, worst.at % s->size / 3), compare(&worst));
    free(theory);
}

/* --- covariance --- */

/* Correlation matrix of C, scaled by the expected variances; rows without variance are left out. */
static void scaled_by(const double *C, const double *R, size_t n, double *out)
{
    double most = 0.0;
    for (size_t i = 0; i < n; i++)
        most = fmax(most, R[i * (n + 1)]);
    for (size_t i = 0; i < n * n; i++) {
        const double a = R[i / n * (n + 1)], b = R[i % n * (n + 1)];
        out[i] = a > 1e-12 * most && b > 1e-12 * most ? C[i] / sqrt(a * b) : 0.0;
    }
}

static void draw_picture(const struct subject *s, int stream, const double *C, const struct block_finding *worst, bool mark,
                         struct result *r)
{
    const size_t n = s->size;
    double *panel = calloc(3 * n * n, sizeof *panel);
    if (!panel)
        return;
    char path[PATH_LENGTH], name[96], caption[200];
    snprintf(name, sizeof name, "covariance-%d%s.svg", stream, s->run->attempt > 1 ? "-rerun" : "");
    path_join(path, s->run->work, name);
    double *measured = panel, *expected = panel + n * n, *off = panel + 2 * n * n;
    scaled_by(C, s->R[stream], n, measured);
    scaled_by(s->R[stream], s->R[stream], n, expected);
    const double error = 1.0 / sqrt((double)s->draws);
    for (size_t k = 0; k < n * n; k++) {
        off[k] = (measured[k] - expected[k]) / (error * sqrt(1.0 + expected[k] * expected[k]));
        if (fabs(off[k]) < 3.0)
            off[k] = 0.0;
        if (fabs(measured[k]) < 4.0 * error)
            measured[k] = 0.0;
    }
    const struct heatmap_panel panels[3] = { { "measured covariance", measured, 1.0 },
                                             { "expected", expected, 1.0 },
                                             { "difference in standard errors", off, 12.0 } };
    snprintf(caption, sizeof caption,
             "%s, %zu draws; a square for each sphere: force x y z, torque x y z; scaled by expected variances. Right: only above 3.",
             kind_of[stream].name, s->draws);
    const struct heatmap map = { .size = n, .group = 6, .panel = panels, .panels = 3, .caption = caption,
                                 .marked_row = 3 * worst->a, .marked_column = 3 * worst->b, .marked_size = mark ? 3 : 0 };
    if (heatmap_write(path, &map))
        result_picture(r, name);
    free(panel);
}

/* The coarsest resolution over <T_i T_j> of neighbours that feel each other: what the sign of eq 3.24 is about. */
static double torque_resolution(const struct subject *s, int stream)
{
    double worst = NAN;
    for (size_t k = 0; k < s->f->pairs; k++) {
        const double r = statistics_block_resolution(s->R[stream], 2 * s->f->count, 2 * s->f->pair[k].i + 1,
                                                     2 * s->f->pair[k].j + 1, s->draws);
        if (isfinite(r))
            worst = isnan(worst) ? r : fmax(worst, r);
    }
    return worst;
}

static void judge_blocks(const struct subject *s, int stream, const double *C, const struct block_finding *w)
{
    char name[96], text[900];
    const bool pair = stream == LUBRICATION;
    struct result *r = check_p(s->run, INVARIANT, named(name, stream, "worst block"), w->ratio, isnan(w->ratio) ? NAN : 1.0, w->p,
                               pair ? torque_resolution(s, stream) : NAN, pair ? noise_declared(s, "torque_block") : NAN, "%s",
                               noise_blame(text, s, stream, kind_of[stream].name, C, w));
    char block[160];
    result_notes(r, "Most deviating of all 3 x 3 blocks: %s, measured over expected %.4g, z = %.3g; p is corrected for the search. "
                 "What it must see is a change of any <torque i, torque j> of neighbours.", noise_block_name(block, s, w->a, w->b),
                 w->ratio, w->z);
    draw_picture(s, stream, C, w, w->p < 1e-3, r);
}

/*
 * If the covariance is wrong, the other tests would all fail with it and say nothing. They are then made with the measured
 * covariance in place of the expected one, and keep their own meaning.
 */
static void whiten_by_itself(struct subject *s, int stream, const double *C)
{
    struct whitening own;
    if (!whitening_make(C, s->size, 1e-9, &own))
        return;
    double *z = malloc((s->draws * own.rank + 1) * sizeof *z);
    if (own.rank == 0 || !z) {
        free(z);
        whitening_free(&own);
        return;
    }
    whitening_apply(&own, s->draw[stream], s->draws, z);
    free(s->white[stream]);
    whitening_free(&s->whitening[stream]);
    s->white[stream] = z;
    s->whitening[stream] = own;
}

void noise_judge(struct subject *s, int stream, double stray)
{
    struct check_run *run = s->run;
    const size_t n = s->draws;
    const double count = (double)n;
    double *C = malloc(s->size * s->size * sizeof *C), wide = (double)s->whitening[stream].rank, ratio, fourth;
    char name[96], text[900];
    statistics_covariance(s->draw[stream], n, s->size, C);
    const struct block_finding worst = statistics_worst_block(C, s->R[stream], 2 * s->f->count, n);
    noise_blame(text, s, stream, kind_of[stream].name, C, &worst);

    check_error(run, INVARIANT, named(name, stream, "nothing outside the range of R"), stray, 0.0, stray, 1e-12,
                "the %s drives motions that the candidate's own friction does not resist (rigid translation, rolling, pairs out of "
                "reach): up to %.3g of the largest. Most deviating: %s", kind_of[stream].name, stray, text);

    const double size_p = statistics_scale_p(s->white[stream], n, s->whitening[stream].rank, &ratio);
    check_p(run, INVARIANT, named(name, stream, "size"), ratio, 1.0, size_p, seen * sqrt(2.0 / (count * wide)), noise_declared(s, "size"),
            "the variance of the %s is %.5g times %s.%s", kind_of[stream].name, ratio, kind_of[stream].law, noise_guess(s, ratio));

    /* n |S - 1|^2/2 (Frobenius) must reach `seen` standard deviations of chi-squared with p(p + 1)/2 degrees */
    const double covariance_p = statistics_identity_p(s->white[stream], n, s->whitening[stream].rank);
    check_p(run, INVARIANT, named(name, stream, "covariance"), NAN, NAN, covariance_p,
            sqrt(2.0 * seen * (wide + 0.5) / (count * wide)), noise_declared(s, "covariance"),
            "the covariance of the %s is not %s; %s", kind_of[stream].name, kind_of[stream].law, text);
    judge_blocks(s, stream, C, &worst);

    if (size_p < 1e-6 || covariance_p < 1e-6 || stray > 1e-6)
        whiten_by_itself(s, stream, C);
    free(C);
    const double *z = s->white[stream];
    const size_t p = s->whitening[stream].rank;
    wide = (double)p;

    check_p(run, INVARIANT, named(name, stream, "mean"), NAN, 0.0, statistics_mean_p(z, n, p),
            sqrt(seen * sqrt(2.0 / wide) / count), noise_declared(s, "mean"), "the %s has a mean: it pushes instead of only shaking",
            kind_of[stream].name);
    for (size_t lag = 1; lag <= 2; lag++) {
        char what[32];
        snprintf(what, sizeof what, "white, lag %zu", lag);
        check_p(run, INVARIANT, named(name, stream, what), NAN, 0.0, statistics_lag_p(z, n, p, lag), sqrt(seen * sqrt(2.0) / count),
                noise_declared(s, "lag"), "the %s remembers the draw %zu step%s before", kind_of[stream].name, lag, lag > 1 ? "s" : "");
    }
    const double fourth_p = statistics_fourth_moment_p(z, n, p, &fourth);
    check_p(run, MODEL, named(name, stream, "Gaussian"), fourth, 3.0, fourth_p, seen * sqrt(96.0 / (count * wide)) / 3.0,
            noise_declared(s, "fourth_moment"), "the fourth moment of the %s is %.4g, a Gaussian has 3 (uniform numbers: 1.8)",
            kind_of[stream].name, fourth);
}

/*
 * Pairs that are far apart draw independently. Each pair is whitened by its own measured covariance (rank 5 if it is right); the
 * correlations between all of them go into one sum. Two terms that share a pair have the covariance 2 r_a r_b r_c/n.
 */
static void judge_pairs(const struct subject *s)
{
    enum { MOST = 32 };
    const size_t n = s->draws;
    double *one = malloc(12 * n * sizeof *one), *z[MOST], block[144], sum = 0.0, mean = 0.0, variance = 0.0;
    size_t rank[MOST], used = 0;
    for (size_t k = 0; k < s->f->pairs && used < MOST; k++) {
        const size_t first = 6 * s->f->pair[k].i;      /* pairs of frozen_pairs follow each other: 12 numbers in a row */
        for (size_t t = 0; t < n; t++)
            memcpy(one + 12 * t, s->draw[LUBRICATION] + t * s->size + first, 12 * sizeof *one);
        statistics_covariance(one, n, 12, block);
        struct whitening w;
        if (!whitening_make(block, 12, 1e-9, &w))
            continue;
        if (w.rank > 0 && (z[used] = malloc(n * w.rank * sizeof(double))) != NULL) {
            whitening_apply(&w, one, n, z[used]);
            rank[used++] = w.rank;
        }
        whitening_free(&w);
    }
    const double count = (double)n;
    for (size_t a = 0; a < used; a++)
        for (size_t b = a + 1; b < used; b++) {
            const double terms = (double)(rank[a] * rank[b]);
            sum += statistics_cross_sum(z[a], rank[a], z[b], rank[b], n);
            mean += terms;
            variance += 2.0 * terms * (1.0 + (double)(rank[a] + rank[b] + 1) / count);
            for (size_t c = b + 1; c < used; c++)
                variance += 12.0 * terms * (double)rank[c] / count;
        }
    check_p(s->run, INVARIANT, "pair noise: pairs independent", NAN, 0.0, used > 1 ? statistics_matched_p(sum, mean, variance) : NAN,
            sqrt(seen * sqrt(2.0 * mean) / (0.2 * mean * count)), noise_declared(s, "lag"),
            "the noise of one isolated pair is correlated with that of another: pairs share random numbers");
    for (size_t k = 0; k < used; k++)
        free(z[k]);
    free(one);
}

/* Whether another realisation is independent of this one. */
static void judge_realisation(const struct subject *s, json_t *scene, const struct question *q, double unit)
{
    char out[PATH_LENGTH], name[96];
    json_object_set_new(scene, "realisation", json_integer(1));
    if (!check_ask(s->run, "other-realisation", q, out))
        return;
    for (int k = 0; k < STREAMS; k++) {
        double *draw = noise_draws(s->run, out, kind_of[k].file, s->draws, s->f, unit);
        const struct whitening *w = &s->whitening[k];
        double *z = draw ? malloc(s->draws * w->rank * sizeof *z) : NULL;
        if (z) {
            whitening_apply(w, draw, s->draws, z);
            check_p(s->run, INVARIANT, named(name, k, "realisations independent"), NAN, 0.0,
                    statistics_cross_p(s->white[k], w->rank, z, w->rank, s->draws), sqrt(seen * sqrt(2.0) / (double)s->draws),
                    noise_declared(s, "lag"), "realisations 0 and 1 of the %s are correlated: they are no independent samples",
                    kind_of[k].name);
        }
        free(z);
        free(draw);
    }
}

/*
 * Below which share of the largest eigenvalue of R there is no resistance: 1e-11, rounding of doubles. Where answers are rounded more (declared precision, level B)
 * the asymmetry and the negative eigenvalues of R tell how uncertain its eigenvalues are, but no more than may be expected of such answers; a direction is
 * kept if that is 1 % of its resistance or less.
 */
static double least_resistance(const struct subject *s, int stream)
{
    const double of_doubles = 1e-11, rounding = check_rounding(s->run, of_doubles);
    if (rounding == of_doubles)
        return of_doubles;
    const struct defects d = measure_defects(s->R[stream], s->size);
    return fmax(of_doubles, fmin(100.0 * fmax(d.skew, -d.least) / d.most, rounding));
}

bool noise_whiten(struct subject *s, int stream, double *stray)
{
    struct whitening *w = &s->whitening[stream];
    if (!whitening_make(s->R[stream], s->size, least_resistance(s, stream), w) || !(s->white[stream] = malloc((s->draws * w->rank + 1) * sizeof(double))))
        return false;
    check_progress(s->run, "%s, %zu draws", kind_of[stream].name, s->draws);
    *stray = whitening_apply(w, s->draw[stream], s->draws, s->white[stream]);
    if (w->rank == 0 || w->rank >= s->draws) {
        check_garbage(s->run, "the resistance matrix measured from the forces is empty");
        return false;
    }
    return true;
}

void subject_free(struct subject *s)
{
    for (int k = 0; k < KINDS; k++) {
        free(s->R[k]);
        free(s->draw[k]);
        free(s->white[k]);
        whitening_free(&s->whitening[k]);
    }
}

static void judge_noise(struct subject *s, json_t *scene, bool isolated)
{
    struct state_row row[64];
    for (size_t i = 0; i < s->f->count; i++) {
        row[i] = (struct state_row){ .state = 0, .id = (int)i + 1, .species = s->f->species[i] };
        memcpy(row[i].x, s->f->x[i], sizeof row[i].x);
    }
    const struct question q = { .protocol = "noise", .scene = scene, .state = row, .states = s->f->count, .draws = s->draws };
    const double unit = sqrt(2.0 * s->kT / s->dt);
    char out[PATH_LENGTH];
    if (!check_ask(s->run, "draws", &q, out))
        return;
    bool good = true;
    for (int k = 0; k < STREAMS && good; k++) {
        double stray;
        good = (s->draw[k] = noise_draws(s->run, out, kind_of[k].file, s->draws, s->f, unit)) != NULL && noise_whiten(s, k, &stray);
        if (good)
            noise_judge(s, k, stray);
    }
    if (!good)
        return;
    check_p(s->run, INVARIANT, "streams independent", NAN, 0.0,
            statistics_cross_p(s->white[DRAG], s->whitening[DRAG].rank, s->white[LUBRICATION], s->whitening[LUBRICATION].rank, s->draws),
            sqrt(seen * sqrt(2.0) / (double)s->draws), noise_declared(s, "lag"),
            "one-body and pair noise are correlated: they use the same random numbers");
    if (isolated)
        judge_pairs(s);
    judge_realisation(s, scene, &q, unit);
}

static void judge_frozen(struct check_run *run, const struct model *m, const struct frozen *f, bool isolated)
{
    json_t *scene = frozen_scene(run, f);
    struct subject s = { .run = run, .f = f, .size = 6 * f->count, .kT = scene_number(scene, "fluid.kT", NAN),
                         .dt = scene_number(scene, "dynamics.verlet.dt", NAN) };
    s.draws = (size_t)run->samples * (size_t)scene_number(run->gate_case->parameters, "draws", 0);
    for (int k = 0; k < STREAMS; k++)
        s.R[k] = malloc(s.size * s.size * sizeof(double));
    if (measure_resistance(run, "columns-of-R", scene, f, STREAMS, force_of, s.R)) {
        for (int k = 0; k < STREAMS; k++)
            judge_resistance(&s, k, s.R[k]);
        judge_model(&s, m);
        judge_noise(&s, scene, isolated);
    }
    subject_free(&s);
    json_decref(scene);
}

static void check_pairs(struct check_run *run)
{
    struct model m;
    struct frozen f;
    if (model_read(run, run->gate_case->scene, &m) && frozen_pairs(run, &m, &f))
        judge_frozen(run, &m, &f, true);
}

static void check_cluster(struct check_run *run)
{
    struct model m;
    struct frozen f;
    if (model_read(run, run->gate_case->scene, &m) && frozen_cluster(run, &m, &f))
        judge_frozen(run, &m, &f, false);
}

const struct check noise_checks[] = {
    { "noise-pairs", check_pairs },         { "noise-cluster", check_cluster },     { "noise-uniform", check_uniform },
    { "noise-images", check_noise_images }, { "noise-again", check_noise_again },   { "noise-again-pairs", check_noise_again_pairs },
    { NULL, NULL }
};
