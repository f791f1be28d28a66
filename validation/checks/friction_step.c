/*
 * Layer 2: friction and noise of one whole step, for schemes in which they are a step of their own
 *
 *     v' = C v + w ,        C kT M^-1 C^T + <w w^T> = kT M^-1
 *
 *     v    velocities and spins of all spheres at fixed places        M    masses and moments of inertia
 *     C    mean response of the step                                  w    its noise
 *
 * The second line is fluctuation and dissipation for a step of any length and any form: velocities drawn from Maxwell's distribution
 * must have it afterwards. C is the candidate's own, from a step of each unit velocity at kT = 0; so what its noise must be follows without
 * a formula of ours. Judged are the response (does a motion grow?), the covariance of the impulses M w from rest, and velocities that
 * start from Maxwell's distribution: they must keep it, and the noise must know nothing of them.
 *
 * That C is the declared form is a separate result. R is measured from the candidate's own forces:
 *
 *     global   C = (M + dt/2 R)^-1 (M - dt/2 R)
 *     sweeps   C = B P_1 ... P_K  P_K ... P_1 B ,   each factor of the same form over dt/2: B with the measured one-body R, P_k with
 *              the declared R of pair k, pairs in order of their smaller and then their larger id
 *
 * Everything is scaled by masses: y = M^1/2 v/sqrt(kT), so that Maxwell's distribution is the standard normal one.
 * Source: Callen & Welton (1951); Shardlow (2003) for sweeps.
 */
#include "noise.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Root of the mass or moment of inertia of each number. */
static void root_masses(const struct model *m, const struct frozen *f, double *root)
{
    for (size_t k = 0; k < 6 * f->count; k++) {
        const double a = f->radius[k / 6], mass = 4.0 / 3.0 * M_PI * m->density[0] * a * a * a;
        root[k] = sqrt(k % 6 < 3 ? mass : 0.4 * mass * a * a);
    }
}

static struct state_row *rest_states(const struct frozen *f, size_t states)
{
    struct state_row *row = calloc(states * f->count, sizeof *row);
    for (size_t k = 0; row && k < states * f->count; k++) {
        const size_t i = k % f->count;
        row[k] = (struct state_row){ .state = (int)(k / f->count), .id = (int)i + 1, .species = f->species[i] };
        memcpy(row[k].x, f->x[i], sizeof row[k].x);
    }
    return row;
}

static double *number_of(struct state_row *row, size_t component)
{
    return component < 3 ? &row->u[component] : &row->w[component - 3];
}

/* Impulses of `draws` steps from each state, each divided by the root of its mass: rows of 6 N numbers. Null: recorded. */
static double *ask_impulses(struct check_run *run, const char *name, json_t *scene, const struct frozen *f, const struct state_row *row,
                            size_t states, size_t draws, const double *root)
{
    const struct question q = { .protocol = "friction", .scene = scene, .state = row, .states = states * f->count, .draws = draws };
    char out[PATH_LENGTH];
    double *J = row && check_ask(run, name, &q, out) ? noise_draws(run, out, "friction.npy", states * draws, f, 1.0) : NULL;
    for (size_t k = 0; J && k < states * draws * 6 * f->count; k++)
        J[k] /= root[k % (6 * f->count)];
    return J;
}

/* C from steps of unit velocities without noise, less what a crowd at rest gets; scaled by masses. */
static gsl_matrix *measure_response(struct check_run *run, json_t *scene, const struct frozen *f, const double *root)
{
    const size_t n = 6 * f->count;
    struct state_row *row = rest_states(f, n + 1);
    json_t *cold = json_deep_copy(scene);
    scene_set(cold, "fluid.kT", json_real(0.0));
    for (size_t k = 0; row && k < n; k++)
        *number_of(&row[(k + 1) * f->count + k / 6], k % 6) = 1.0 / root[k];
    double *J = ask_impulses(run, "response", cold, f, row, n + 1, 1, root);
    gsl_matrix *C = J ? gsl_matrix_alloc(n, n) : NULL;
    for (size_t k = 0; C && k < n * n; k++)
        gsl_matrix_set(C, k % n, k / n, J[(k / n + 1) * n + k % n] - J[k % n] + (k / n == k % n));
    free(J);
    free(row);
    json_decref(cold);
    return C;
}

/* 1 - C C^T: what the noise must give back. */
static void noise_asked(const gsl_matrix *C, double *S)
{
    gsl_matrix_view view = gsl_matrix_view_array(S, C->size1, C->size1);
    gsl_matrix_set_identity(&view.matrix);
    gsl_blas_dgemm(CblasNoTrans, CblasTrans, -1.0, C, C, 1.0, &view.matrix);
}

static void judge_growth(struct check_run *run, const double *S, size_t n)
{
    gsl_matrix *copy = gsl_matrix_alloc(n, n);
    gsl_vector *eigenvalue = gsl_vector_alloc(n);
    gsl_eigen_symm_workspace *space = gsl_eigen_symm_alloc(n);
    memcpy(copy->data, S, n * n * sizeof *S);
    gsl_eigen_symm(copy, eigenvalue, space);
    const double least = gsl_vector_min(eigenvalue);
    check_error(run, INVARIANT, "no motion grows", 1.0 - least, 1.0, fmax(0.0, -least), run->gate_case->tolerance,
                "the friction step puts energy in: it multiplies the energy of some motion by %.6g", 1.0 - least);
    gsl_eigen_symm_free(space);
    gsl_vector_free(eigenvalue);
    gsl_matrix_free(copy);
}

/* X <- (1 + q)^-1 (1 - q) X on the rows `at`, q symmetric of size n, for a matrix of `columns` columns. */
static void cayley(const gsl_matrix *q, const size_t *at, gsl_matrix *X)
{
    const size_t n = q->size1;
    gsl_matrix *A = gsl_matrix_alloc(n, n), *before = gsl_matrix_alloc(n, X->size2), *after = gsl_matrix_alloc(n, X->size2);
    for (size_t r = 0; r < n; r++)
        memcpy(gsl_matrix_ptr(before, r, 0), gsl_matrix_ptr(X, at[r], 0), X->size2 * sizeof(double));
    gsl_matrix_memcpy(after, before);
    gsl_blas_dgemm(CblasNoTrans, CblasNoTrans, -1.0, q, before, 1.0, after);
    gsl_matrix_set_identity(A);
    gsl_matrix_add(A, q);
    gsl_linalg_cholesky_decomp1(A);
    for (size_t c = 0; c < X->size2; c++) {
        gsl_vector_view column = gsl_matrix_column(after, c);
        gsl_linalg_cholesky_svx(A, &column.vector);
    }
    for (size_t r = 0; r < n; r++)
        memcpy(gsl_matrix_ptr(X, at[r], 0), gsl_matrix_ptr(after, r, 0), X->size2 * sizeof(double));
    gsl_matrix_free(A);
    gsl_matrix_free(before);
    gsl_matrix_free(after);
}

/* The factor of pair (i, j), if it is resisted: X <- P X. */
static void pair_factor(const struct model *m, const struct frozen *f, size_t i, size_t j, double half, const double *root, gsl_matrix *X)
{
    double r[3], block[144];
    size_t at[12];
    gsl_matrix *q = gsl_matrix_alloc(12, 12);
    for (int k = 0; k < 3; k++) {
        r[k] = f->x[j][k] - f->x[i][k];
        r[k] -= m->cell[k][k] * round(r[k] / m->cell[k][k]);
    }
    theory_pair_resistance(&m->lubrication, f->radius[i], f->radius[j], r, block);
    for (size_t a = 0; a < 12; a++)                             /* order of the block: U_1 U_2 W_1 W_2 */
        at[a] = 6 * (a / 3 % 2 ? j : i) + 3 * (a / 6) + a % 3;
    for (size_t a = 0; a < 144; a++)
        gsl_matrix_set(q, a / 12, a % 12, half * block[a] / (root[at[a / 12]] * root[at[a % 12]]));
    if (gsl_matrix_max(q) > 0.0)
        cayley(q, at, X);
    gsl_matrix_free(q);
}

/* C as declared. R: measured, drag and lubrication. */
static gsl_matrix *declared_response(const struct model *m, const struct frozen *f, double *const R[], double dt, bool sweeps, const double *root)
{
    const size_t n = 6 * f->count, pairs = f->count * f->count;
    const double half = sweeps ? 0.25 * dt : 0.5 * dt;
    size_t *all = malloc(n * sizeof *all);
    gsl_matrix *q = gsl_matrix_alloc(n, n), *C = gsl_matrix_alloc(n, n);
    for (size_t k = 0; k < n; k++)
        all[k] = k;
    for (size_t k = 0; k < n * n; k++) {
        const size_t t = k % n * n + k / n;                     /* rounding apart R is symmetric: a result of layer 2 */
        const double drag = 0.5 * (R[DRAG][k] + R[DRAG][t]), pair = 0.5 * (R[LUBRICATION][k] + R[LUBRICATION][t]);
        gsl_matrix_set(q, k / n, k % n, half * (sweeps ? drag : drag + pair) / (root[k / n] * root[k % n]));
    }
    gsl_matrix_set_identity(C);
    cayley(q, all, C);
    for (size_t k = 0; sweeps && k < pairs; k++)
        if (k / f->count < k % f->count)
            pair_factor(m, f, k / f->count, k % f->count, half, root, C);
    for (size_t k = pairs; sweeps && k-- > 0;)
        if (k / f->count < k % f->count)
            pair_factor(m, f, k / f->count, k % f->count, half, root, C);
    if (sweeps)
        cayley(q, all, C);
    gsl_matrix_free(q);
    free(all);
    return C;
}

static void judge_form(struct check_run *run, const gsl_matrix *C, const gsl_matrix *declared, bool sweeps)
{
    struct worst worst = WORST_NONE;
    for (size_t k = 0; k < C->size1 * C->size1; k++)
        worst_see(&worst, C->data[k], declared->data[k], 1.0, k);
    const size_t i = worst.at / C->size1, j = worst.at % C->size1;
    check_error(run, MODEL, "response: declared form", worst.measured, worst.expected, worst.error, run->gate_case->tolerance,
                "the friction step does not answer as %s does: %s %c of sphere %zu to %s %c of sphere %zu, scaled by masses, is %.10g and not %.10g",
                sweeps ? "pair sweeps in order of tags" : "the midpoint step with the candidate's own resistance", i % 6 < 3 ? "velocity" : "spin",
                "xyz"[i % 3], i / 6 + 1, j % 6 < 3 ? "velocity" : "spin", "xyz"[j % 3], j / 6 + 1, worst.measured, worst.expected);
}

/* From Maxwell's distribution: one step from each of many states. */
static void judge_maxwell(struct subject *s, json_t *scene, const gsl_matrix *C, const double *root)
{
    struct check_run *run = s->run;
    const size_t n = s->size, states = s->draws;
    const double wide = (double)n, count = (double)states;
    struct state_row *row = rest_states(s->f, states);
    double *y = malloc(states * n * sizeof *y), *w = malloc(states * n * sizeof *w), *white = malloc(states * n * sizeof *white), ratio;
    gsl_rng *random = pair_random(run);
    for (size_t k = 0; row && y && k < states * n; k++) {
        y[k] = gsl_ran_gaussian(random, 1.0);
        *number_of(&row[k / 6], k % 6) = y[k] * sqrt(s->kT) / root[k % n];
    }
    gsl_rng_free(random);
    scene_set(scene, "realisation", json_integer(1));
    double *J = y && w && white ? ask_impulses(run, "maxwell", scene, s->f, row, states, 1, root) : NULL;
    if (J) {
        /* w = y' - C y: the noise of each step */
        gsl_matrix_view start = gsl_matrix_view_array(y, states, n), noise = gsl_matrix_view_array(w, states, n);
        for (size_t k = 0; k < states * n; k++)
            w[k] = J[k] = y[k] + J[k] / sqrt(s->kT);
        gsl_blas_dgemm(CblasNoTrans, CblasTrans, -1.0, &start.matrix, C, 1.0, &noise.matrix);
        const double size_p = statistics_scale_p(J, states, n, &ratio);
        check_p(run, INVARIANT, "Maxwell: temperature kept", ratio, 1.0, size_p, NOISE_SEEN * sqrt(2.0 / (count * wide)), noise_declared(s, "kept"),
                "velocities drawn at temperature kT have %.5g kT after one friction step", ratio);
        check_p(run, INVARIANT, "Maxwell: distribution kept", NAN, NAN, statistics_identity_p(J, states, n),
                sqrt(2.0 * NOISE_SEEN * (wide + 0.5) / (count * wide)), noise_declared(s, "kept_covariance"),
                "velocities drawn from Maxwell's distribution do not have it after one friction step: some motions are too hot, others too cold, or "
                "neighbours' velocities have become correlated");
        whitening_apply(&s->whitening[FRICTION_STEP], w, states, white);
        check_p(run, INVARIANT, "Maxwell: noise independent of velocities", NAN, 0.0,
                statistics_cross_p(y, n, white, s->whitening[FRICTION_STEP].rank, states), sqrt(NOISE_SEEN * sqrt(2.0) / count),
                noise_declared(s, "lag"), "what the friction step adds to its mean response depends on the velocities that it starts from");
    }
    free(J);
    free(row);
    free(y);
    free(w);
    free(white);
}

static void judge_step(struct check_run *run, const struct model *m, const struct frozen *f)
{
    static const char *const force[STREAMS] = { "drag", "lubrication" };
    json_t *scene = frozen_scene(run, f);
    const char *friction = json_string_value(scene_get(scene, "dynamics.split.friction"));
    const bool sweeps = friction && strcmp(friction, "sweeps") == 0;
    struct subject s = { .run = run, .f = f, .size = 6 * f->count, .kT = scene_number(scene, "fluid.kT", NAN),
                         .dt = scene_number(scene, "dynamics.split.dt", NAN) };
    double root[6 * 64];
    root_masses(m, f, root);
    s.draws = (size_t)run->samples * (size_t)scene_number(run->gate_case->parameters, "draws", 0);
    for (int k = 0; k < KINDS; k++)
        s.R[k] = malloc(s.size * s.size * sizeof(double));
    gsl_matrix *C = measure_response(run, scene, f, root);
    if (C && measure_resistance(run, "columns-of-R", scene, f, STREAMS, force, s.R)) {
        gsl_matrix *declared = declared_response(m, f, s.R, s.dt, sweeps, root);
        noise_asked(C, s.R[FRICTION_STEP]);
        judge_growth(run, s.R[FRICTION_STEP], s.size);
        judge_form(run, C, declared, sweeps);
        gsl_matrix_free(declared);
        struct state_row *row = s.draws > 0 ? rest_states(f, 1) : NULL;        /* no draws: the response alone */
        double stray, *J = s.draw[FRICTION_STEP] = row ? ask_impulses(run, "impulses", scene, f, row, 1, s.draws, root) : NULL;
        for (size_t k = 0; J && k < s.draws * s.size; k++)
            J[k] /= sqrt(s.kT);
        free(row);
        if (J && noise_whiten(&s, FRICTION_STEP, &stray)) {
            noise_judge(&s, FRICTION_STEP, stray);
            judge_maxwell(&s, scene, C, root);
        }
    }
    if (C)
        gsl_matrix_free(C);
    subject_free(&s);
    json_decref(scene);
}

static void check_step_pairs(struct check_run *run)
{
    struct model m;
    struct frozen f;
    if (model_read(run, run->gate_case->scene, &m) && frozen_pairs(run, &m, &f))
        judge_step(run, &m, &f);
}

static void check_step_cluster(struct check_run *run)
{
    struct model m;
    struct frozen f;
    if (model_read(run, run->gate_case->scene, &m) && frozen_cluster(run, &m, &f))
        judge_step(run, &m, &f);
}

const struct check friction_step_checks[] = { { "friction-step-pairs", check_step_pairs }, { "friction-step-cluster", check_step_cluster }, { NULL, NULL } };
