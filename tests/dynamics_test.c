/* Equations of motion: their order of convergence, what they conserve, and the solver of the implicit friction step. */
#include "suite.h"

#include "core/conjugate.h"
#include "core/friction.h"
#include "scenes.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_vector.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Two unequal lubricated spheres with drag in shear; the second may touch the first. `scheme` is the text of dynamics. */
static struct simulation *pair_scene(const char *scheme, double kT, const char *states)
{
    char folder[] = "/tmp/shear-dynamics-XXXXXX", scene[80], table[80];
    struct error e = { 0 };
    check_true(mkdtemp(folder) != NULL, "temporary folder");
    snprintf(scene, sizeof scene, "%s/scene.json", folder);
    snprintf(table, sizeof table, "%s/states.csv", folder);
    FILE *out = fopen(scene, "w");
    fprintf(out, "{\"about\":\"test\",\"seed\":5,\"fluid\":{\"viscosity\":0.7,\"kT\":%g},\"box\":{\"lengths\":[9.1,8.3,8.7],\"periodic\":[true,true,true]},"
                 "\"shear\":[{\"flow\":\"x\",\"gradient\":\"y\",\"rate\":-0.4}],"
                 "\"species\":[{\"name\":\"a\",\"radius\":1.3,\"density\":2.0},{\"name\":\"b\",\"radius\":0.9,\"density\":2.0}],"
                 "\"start\":{\"file\":\"states.csv\"},\"forces\":{\"contact\":{\"normal_stiffness\":1e3,\"friction\":0},\"drag\":{\"torque\":true},"
                 "\"drag_noise\":{\"distribution\":\"gaussian\"},\"lubrication_noise\":{\"distribution\":\"gaussian\"},"
                 "\"lubrication\":{\"inner_gap\":1e-3,\"outer_gap\":0.5,\"rotation_correction\":\"none\"}},\"dynamics\":{%s},\"run\":{\"steps\":1}}", kT, scheme);
    fclose(out);
    out = fopen(table, "w");
    fprintf(out, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n%s", states);
    fclose(out);
    struct simulation *sim = calloc(1, sizeof *sim);
    const struct scene_options options = { .set_count = 0 };
    check_true(scene_build(scene, &options, sim, &e) && simulation_begin(sim, &e), e.text);
    remove(scene);
    remove(table);
    rmdir(folder);
    return sim;
}

/* Where sphere 1 and its spin are after time 0.4 with this scheme and step. */
static void go(const char *name, double dt, double kT, vec3 *x, vec3 *w)
{
    char scheme[80];
    struct error e = { 0 };
    bool relisted;
    snprintf(scheme, sizeof scheme, "\"%s\":{\"dt\":%.17g}", name, dt);
    struct simulation *sim = pair_scene(scheme, kT, "1,1,4,4,4,0.3,0,0,0,0.2,0\n2,2,6.35,4.2,4,-0.2,0.1,0,0,0,0.3\n");
    for (long k = 0; k < lround(0.4 / dt) && !error_raised(&e); k++)
        sim->dynamics->step(sim->dynamics, &sim->suspension, &relisted, &e);
    check_true(!error_raised(&e), e.text);
    *x = sim->suspension.particles.position[0];
    *w = sim->suspension.particles.spin[0];
    drop(sim);
}

static void converges(const char *name, double dt, double order, double spread)
{
    vec3 x[4], w[4];
    for (int k = 0; k < 4; k++)
        go(name, dt / (1 << k), 0.0, &x[k], &w[k]);
    for (int k = 0; k < 2; k++) {
        const double in_place = log2(norm(minus(x[k], x[k + 1])) / norm(minus(x[k + 1], x[k + 2])));
        const double in_spin = log2(norm(minus(w[k], w[k + 1])) / norm(minus(w[k + 1], w[k + 2])));
        check_close(in_place, order, spread, "order of the place, from successive halvings");
        check_close(in_spin, order, spread, "order of the spin");
    }
}

static void verlet_is_first_order(void) { converges("verlet", 1.6e-3, 1.0, 0.15); }
static void predicted_is_second_order(void) { converges("predicted_verlet", 0.8e-3, 2.0, 0.2); }
static void split_is_second_order(void) { converges("split", 1.6e-3, 2.0, 0.2); }

static void all_schemes_agree(void)
{
    static const char *const names[] = { "verlet", "predicted_verlet", "split" };
    vec3 fine[3], w[3];
    for (int k = 0; k < 3; k++)
        go(names[k], 1.25e-5, 0.0, &fine[k], &w[k]);
    check_close(norm(minus(fine[1], fine[2])), 0, 1e-8, "second-order schemes at dt 1.25e-5: (dt/0.02)^2 of 0.1");
    check_close(norm(minus(fine[0], fine[2])), 0, 2e-4, "first-order scheme: dt/0.02 of 0.1");
}

/* Conjugate gradients on the friction matrix of a touching pair against a direct solution. */
static void friction_is_solved(void)
{
    struct simulation *sim = pair_scene("\"split\":{\"dt\":0.05,\"residual\":1e-13}", 0.3, "1,1,4,4,4,0.3,0,0,0,0.2,0\n2,2,6.201,4.05,4,-0.2,0.1,0,0,0,0.3\n");
    struct friction f;
    struct error e = { 0 };
    memset(&f, 0, sizeof f);
    check_true(friction_gather(&f, &sim->suspension, 0.05, &e) && f.links == 1 && f.width == 6, e.text);
    gsl_matrix *A = gsl_matrix_alloc(12, 12);
    gsl_vector *b = gsl_vector_alloc(12), *x = gsl_vector_alloc(12);
    for (size_t c = 0; c < 12; c++) {
        double unit[12] = { 0.0 }, column[12];
        unit[c] = 1.0;
        friction_apply(&f, unit, column);
        for (size_t r = 0; r < 12; r++)
            gsl_matrix_set(A, r, c, column[r]);
    }
    double asymmetry = 0.0;
    for (size_t r = 0; r < 12; r++)
        for (size_t c = 0; c < 12; c++)
            asymmetry = fmax(asymmetry, fabs(gsl_matrix_get(A, r, c) - gsl_matrix_get(A, c, r)));
    check_close(asymmetry, 0, 1e-12, "symmetry");
    for (int i = 0; i < 2; i++) {
        sim->suspension.particles.force[i] = vec(1 + i, -2, 0.3);
        sim->suspension.particles.torque[i] = vec(0.2, i, -0.7);
    }
    check_true(friction_solve(&f, &sim->suspension, 1e-13, &e), e.text);
    for (size_t k = 0; k < 12; k++)
        gsl_vector_set(b, k, f.rhs[k]);
    gsl_linalg_cholesky_decomp1(A);
    gsl_linalg_cholesky_solve(A, b, x);
    for (size_t k = 0; k < 12; k++)
        check_close(f.change[k], gsl_vector_get(x, k), 1e-10 * gsl_blas_dnrm2(x), "solution: residual 1e-13 times the condition number");
    gsl_matrix_free(A);
    gsl_vector_free(b);
    gsl_vector_free(x);
    friction_free(&f);
    drop(sim);
}

static void diagonal_apply(const void *context, const double *x, double *y)
{
    const double *d = context;
    for (int k = 0; k < 5; k++)
        y[k] = d[k] * x[k];
}

static void solver_gives_up_honestly(void)
{
    const double d[5] = { 1, 2, 3, 4, 5 }, ones[5] = { 1, 1, 1, 1, 1 };
    double x[5] = { 0 }, work[15];
    struct linear_system s = { 5, diagonal_apply, d, ones, work, 1e-14, 1 };
    check_close(conjugate_solve(&s, ones, x), -1, 0, "one iteration is not enough for five eigenvalues");
    memset(x, 0, sizeof x);
    s.most_iterations = 6;
    check_true(conjugate_solve(&s, ones, x) >= 0, "five are");
    check_close(x[4], 0.2, 1e-13, "solution");
}

/* Pair friction and its noise exchange momentum but make none; far beyond the explicit limit nothing grows. */
static void split_keeps_momentum_at_any_step(void)
{
    struct simulation *sim = pair_scene("\"split\":{\"dt\":0.02}", 0.3, "1,1,4,4,4,0.3,0,0,0,0.2,0\n2,2,6.201,4.05,4,-0.2,0.1,0,0,0,0.3\n");
    struct suspension *s = &sim->suspension;
    struct error e = { 0 };
    bool relisted;
    for (int k = 0; k < s->force_count; k++)                        /* leave lubrication and its noise alone */
        if (strncmp(s->force[k]->name, "drag", 4) == 0) {
            free(s->force[k]);
            memmove(&s->force[k], &s->force[k + 1], (size_t)(--s->force_count - k) * sizeof s->force[0]);    /* the order matters */
            k--;
        }
    const struct particles *p = &s->particles;
    const vec3 before = plus(scaled(p->velocity[0], mass_of(p, 0)), scaled(p->velocity[1], mass_of(p, 1)));
    double most = 0.0;
    for (int k = 0; k < 500 && !error_raised(&e); k++) {
        check_true(sim->dynamics->step(sim->dynamics, s, &relisted, &e), e.text);
        most = fmax(most, norm(p->velocity[0]));
    }
    const vec3 after = plus(scaled(p->velocity[0], mass_of(p, 0)), scaled(p->velocity[1], mass_of(p, 1)));
    check_close(norm(minus(after, before)), 0, 1e-9, "momentum: residual of 500 solutions");
    check_true(most < 10 * sqrt(0.3 / mass_of(p, 0)) + 1, "velocities stay thermal at eight times the explicit limit");
    drop(sim);
}

/* A sphere alone with drag, rate g of its spin: predicted_verlet diverges above g dt = 1, verlet above 2. Refused just there. */
static void diverging_steps_are_refused(void)
{
    const double spin_rate = 15 * 0.7 / (2.0 * 1.3 * 1.3);     /* 8 pi eta a^3 over (2/5) m a^2 */
    static const struct { const char *name; double most; } scheme[] = { { "verlet", 2.0 }, { "predicted_verlet", 1.0 } };
    for (int k = 0; k < 4; k++) {
        char text[600];
        struct error e = { 0 };
        snprintf(text, sizeof text, "{\"about\":\"test\",\"fluid\":{\"viscosity\":0.7},\"box\":{\"lengths\":[9,8,8],\"periodic\":[true,true,true]},"
                 "\"species\":[{\"name\":\"a\",\"radius\":1.3,\"density\":2.0}],\"start\":{\"file\":\"states.csv\"},\"forces\":{\"drag\":{\"torque\":true}},"
                 "\"dynamics\":{\"%s\":{\"dt\":%.17g}},\"run\":{\"steps\":1}}", scheme[k / 2].name, (k % 2 ? 1.01 : 0.99) * scheme[k / 2].most / spin_rate);
        struct simulation *sim = scene_from(text, "1,1,4,4,4,0.3,0,0,0,0.2,0\n", &e);
        check_true(!error_raised(&e), e.text);
        const double before = sim->suspension.particles.spin[0].y;
        if (k % 2)
            check_true(!simulation_begin(sim, &e), "a diverging step is refused");
        else {
            check_true(simulation_begin(sim, &e) && advance(sim, 2000, &e), e.text);
            check_true(fabs(sim->suspension.particles.spin[0].y) < 1e-3 * before, "a step that is allowed decays");
        }
        drop(sim);
    }
}

static const struct unit_test tests[] = {
    { "verlet is first order in friction", verlet_is_first_order },
    { "predicted_verlet is second order", predicted_is_second_order },
    { "split is second order", split_is_second_order },
    { "steps that diverge are refused, and no others", diverging_steps_are_refused },
    { "all schemes converge to the same motion", all_schemes_agree },
    { "the friction step is solved: against a direct solution", friction_is_solved },
    { "conjugate gradients give up honestly", solver_gives_up_honestly },
    { "split keeps momentum at any step", split_keeps_momentum_at_any_step },
    { NULL, NULL }
};
const struct suite dynamics_suite = { "dynamics", tests };
