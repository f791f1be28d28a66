/*
 * Layer 5: what few spheres add to the viscosity
 *
 *     drag:          sigma_xy = (5/2) phi eta rate                       Einstein (1906, 1911): factor, plane, units, sign
 *     lubrication:   sigma_xy = c phi^2 eta rate                         c of the truncated model: theory/dilute.c
 *     one crowd:     sum of F (x) r over pairs and images, divided by V  theory/crowd.c
 *
 * Everything is frozen and moves with the undisturbed flow, so there is nothing random in the verdicts: bookkeeping to rounding.
 * The second is a quadrature over many isolated pairs (Gauss points in ln of the gap, product rule over directions), in which each
 * stress is the candidate's; the points are exact for the direction and good to 1e-10 for the gap.
 */
#include "two_bodies.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Give a row the velocity and spin of the flow at its place. */
static void move_with_the_flow(const struct model *m, struct state_row *row)
{
    double gradient[3][3];
    memcpy(gradient, m->gradient, sizeof gradient);
    apply(gradient, row->x, row->u);
    for (int c = 0; c < 3; c++)
        row->w[c] = 0.5 * (gradient[(c + 2) % 3][(c + 1) % 3] - gradient[(c + 1) % 3][(c + 2) % 3]);
}

/* Ask for the stress of frozen states; [state][9], times nothing. Caller frees; null after recording. */
static double *ask_stress(struct check_run *run, const char *name, json_t *scene, const struct state_row *row, size_t rows, size_t states,
                          const char *origin)
{
    const struct question q = { .protocol = "forces", .scene = scene, .state = row, .states = rows };
    char out[PATH_LENGTH], path[PATH_LENGTH], why[WHY_LENGTH];
    double *stress = NULL;
    if (!check_ask(run, name, &q, out))
        return NULL;
    path_join(path, out, "stress.csv");
    if (!stress_read(path, states, origin, &stress, why)) {
        check_garbage(run, why);
        return NULL;
    }
    return stress;
}

static const char *stress_guess(double ratio)
{
    if (fabs(ratio + 1.0) < 1e-6)
        return " The sign is wrong: stress is positive in tension, F_i (x) (x_j - x_i).";
    if (fabs(ratio - 2.0) < 1e-6)
        return " A factor 2: each pair counted twice, or rate for rate/2.";
    if (fabs(ratio - 0.5) < 1e-6)
        return " A factor 1/2: halves that are counted once.";
    if (fabs(ratio - 1.0 / 3.0) < 1e-6)
        return " A factor 1/3: divided by the dimension.";
    if (fabs(ratio - 8.0) < 1e-6 || fabs(ratio - 0.125) < 1e-6)
        return " A factor 8: diameter and radius.";
    return "";
}

/* --- Einstein --- */

static void judge_einstein(struct check_run *run, const char *plane, const struct model *m, const double *stress, double phi)
{
    double rate = 0.0;
    struct worst others = WORST_NONE;
    char name[96];
    for (int k = 0; k < 9; k++)
        rate = fabs(m->gradient[k / 3][k % 3]) > fabs(rate) ? m->gradient[k / 3][k % 3] : rate;
    for (int k = 0; k < 9; k++) {
        const double expected = 2.5 * phi * m->viscosity * (m->gradient[k / 3][k % 3] + m->gradient[k % 3][k / 3]);
        worst_see(&others, stress[k], expected, 2.5 * phi * m->viscosity * fabs(rate), (size_t)k);
    }
    /* the slope: the component of the stress along the flow's strain rate */
    double slope = 0.0, strain = 0.0;
    for (int k = 0; k < 9; k++) {
        const double e = m->gradient[k / 3][k % 3] + m->gradient[k % 3][k / 3];
        slope += stress[k] * e;
        strain += e * e;
    }
    slope /= phi * m->viscosity * strain;
    snprintf(name, sizeof name, "Einstein's slope, %s", plane);
    check_error(run, MODEL, name, slope, 2.5, fmax(fabs(slope / 2.5 - 1.0), others.error), run->gate_case->tolerance,
                "one-body stresslets add %.8g phi to the viscosity in shear %s, %s; stress %c%c is %s.%s", slope, plane,
                fabs(slope / 2.5 - 1.0) <= run->gate_case->tolerance ? "which is right, but not symmetric, or not along the strain alone" : "not 2.5 phi",
                (int)(120 + others.at / 3), (int)(120 + others.at % 3), compare(&others), stress_guess(slope / 2.5));
}

static void check_einstein(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t count = (size_t)scene_number(parameters, "spheres", 0);
    size_t at;
    json_t *flow;
    struct state_row *row = calloc(count, sizeof *row);
    gsl_rng *random = pair_random(run);
    json_array_foreach(json_object_get(parameters, "flows"), at, flow)
    {
        json_t *scene = variant_scene(run->gate_case, flow);
        struct model m;
        double *stress = NULL, phi = 0.0;
        const char *plane = json_string_value(json_object_get(flow, "name"));
        if (model_read(run, scene, &m)) {
            for (size_t i = 0; i < count; i++) {
                row[i] = (struct state_row){ .id = (int)i + 1, .species = (int)(i % m.species) + 1 };
                for (int v = 0; v < 3; v++) {
                    const double share = gsl_rng_uniform(random);
                    for (int c = 0; c < 3; c++)
                        row[i].x[c] += share * m.cell[v][c];
                }
                move_with_the_flow(&m, &row[i]);
                phi += 4.0 / 3.0 * pi * pow(m.radius[i % m.species], 3) / m.volume;
            }
            stress = ask_stress(run, plane, scene, row, count, 1, "drag");
        }
        json_decref(scene);
        if (!stress)
            break;
        judge_einstein(run, plane, &m, stress, phi);
        free(stress);
    }
    gsl_rng_free(random);
    free(row);
}

/* --- phi^2 --- */

/* Points and weights for the integral over gaps from contact to the outer gap: frozen part, then Gauss-Legendre in ln xi. */
static size_t gap_points(const struct model *m, size_t points, double *xi, double *weight)
{
    const size_t frozen = 4;     /* polynomial of degree 4 in xi: two would do for 3, four are exact to 7 */
    const double inner = m->lubrication.inner_gap, outer = m->lubrication.outer_gap;
    gsl_integration_glfixed_table *few = gsl_integration_glfixed_table_alloc(frozen);
    gsl_integration_glfixed_table *many = gsl_integration_glfixed_table_alloc(points);
    for (size_t k = 0; k < frozen; k++)
        gsl_integration_glfixed_point(0.0, inner, k, &xi[k], &weight[k], few);
    for (size_t k = 0; k < points; k++) {
        double x, w;
        gsl_integration_glfixed_point(log(inner), log(outer), k, &x, &w, many);
        xi[frozen + k] = exp(x);
        weight[frozen + k] = w * xi[frozen + k];
    }
    gsl_integration_glfixed_table_free(few);
    gsl_integration_glfixed_table_free(many);
    return frozen + points;
}

static void check_phi2(struct check_run *run)
{
    enum { ANGLES = 6, COSINES = 3, MOST = 64 };
    struct model m;
    json_t *scene = json_deep_copy(run->gate_case->scene);
    double xi[MOST], gap_weight[MOST], *stress = NULL, *weight;
    if (!model_read(run, scene, &m)) {
        json_decref(scene);
        return;
    }
    const double a = m.radius[0];
    const size_t asked = (size_t)scene_number(run->gate_case->parameters, "gap_points", 0);
    const size_t gaps = gap_points(&m, asked < MOST - 4 ? asked : MOST - 4, xi, gap_weight), states = gaps * ANGLES * COSINES;
    struct state_row *row = calloc(2 * states, sizeof *row);
    weight = calloc(states, sizeof *weight);
    const double cosine[COSINES] = { -sqrt(0.6), 0.0, sqrt(0.6) }, cosine_weight[COSINES] = { 5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0 };
    for (size_t s = 0; s < states; s++) {
        const size_t g = s / (ANGLES * COSINES), c = s / ANGLES % COSINES;
        const double angle = 2.0 * pi * ((double)(s % ANGLES) + 0.3) / ANGLES, sine = sqrt(1.0 - cosine[c] * cosine[c]);
        const double r = a * (2.0 + xi[g]), n[3] = { sine * cos(angle), sine * sin(angle), cosine[c] };
        for (int side = 0; side < 2; side++) {
            struct state_row *sphere = &row[2 * s + (size_t)side];
            *sphere = (struct state_row){ .state = (int)s, .id = side + 1, .species = 1 };
            for (int k = 0; k < 3; k++)
                sphere->x[k] = 2.0 * a + 0.31 * k + (side ? 1.0 : -1.0) * 0.5 * r * n[k];
            move_with_the_flow(&m, sphere);
        }
        weight[s] = cosine_weight[c] * 2.0 * pi / ANGLES * r * r * a * gap_weight[g];
    }
    stress = ask_stress(run, "pairs", scene, row, 2 * states, states, "lubrication");
    if (stress) {
        /* (n^2/2) int d^3r V sigma, n = 3 phi/(4 pi a^3), along the strain rate of the flow */
        double sum = 0.0, strain = 0.0;
        for (size_t s = 0; s < states; s++)
            for (int k = 0; k < 9; k++)
                sum += weight[s] * stress[9 * s + (size_t)k] * (m.gradient[k / 3][k % 3] + m.gradient[k % 3][k / 3]);
        for (int k = 0; k < 9; k++)
            strain += pow(m.gradient[k / 3][k % 3] + m.gradient[k % 3][k / 3], 2);
        const double density = 3.0 / (4.0 * pi * a * a * a);
        const double c = 0.5 * density * density * sum * m.volume / (m.viscosity * strain);
        const double expected = theory_phi2_coefficient(m.lubrication.inner_gap, m.lubrication.outer_gap, NULL);
        struct result *r = check_error(run, MODEL, "phi^2 coefficient of lubrication", c, expected, fabs(c / expected - 1.0),
                                       run->gate_case->tolerance, "the lubrication stress of random pairs that move with the flow "
                                       "adds %.8g phi^2 to the viscosity, the declared model %.8g.%s", c, expected,
                                       stress_guess(c / expected));
        result_notes(r, "%zu isolated pairs: %zu gaps, %d directions each. Equal spheres at random, g = 1 beyond contact.", states, gaps,
                     ANGLES * COSINES);
    }
    free(stress);
    free(weight);
    free(row);
    json_decref(scene);
}

/* --- a crowd --- */

/*
 * Distance of two spheres in a cell whose widths exceed twice the distances of interest: the image whose fractional coordinates
 * are nearest is then the nearest one, if it is near at all.
 */
static double near_distance(const struct model *m, double inverse[3][3], const double a[3], const double b[3])
{
    double d[3], f[3], image[3] = { 0.0, 0.0, 0.0 };
    for (int c = 0; c < 3; c++)
        d[c] = b[c] - a[c];
    apply(inverse, d, f);
    for (int v = 0; v < 3; v++)
        for (int c = 0; c < 3; c++)
            image[c] += (f[v] - round(f[v])) * m->cell[v][c];
    return norm(image);
}

/* Random sequential addition in the cell of `m` at its own time: nobody overlaps anybody, images included. */
static size_t add_crowd(struct check_run *run, const struct model *m, size_t count, struct theory_sphere *s)
{
    double inverse[3][3];    /* rows: fractional coordinate v of x is inverse[v] . x */
    for (int v = 0; v < 3; v++) {
        cross(m->cell[(v + 1) % 3], m->cell[(v + 2) % 3], inverse[v]);
        const double volume = dot(inverse[v], m->cell[v]);
        for (int c = 0; c < 3; c++)
            inverse[v][c] /= volume;
    }
    gsl_rng *random = pair_random(run);
    size_t placed = 0;
    for (size_t tries = 0; placed < count && tries < 100 * count; tries++) {
        struct theory_sphere *one = &s[placed];
        bool free_place = true;
        *one = (struct theory_sphere){ .radius = m->radius[placed % m->species] };
        for (int v = 0; v < 3; v++) {
            const double share = gsl_rng_uniform(random);
            for (int c = 0; c < 3; c++)
                one->x[c] += share * m->cell[v][c];
        }
        for (size_t j = 0; j < placed && free_place; j++)
            free_place = near_distance(m, inverse, s[j].x, one->x) > one->radius + s[j].radius;
        placed += free_place;
    }
    gsl_rng_free(random);
    return placed;
}

static void check_crowd(struct check_run *run)
{
    struct model m;
    json_t *scene = json_deep_copy(run->gate_case->scene);
    const size_t count = (size_t)scene_number(run->gate_case->parameters, "spheres", 0);
    struct theory_sphere *s = calloc(count, sizeof *s);
    struct state_row *row = calloc(count, sizeof *row);
    double *stress = NULL;
    if (model_read(run, scene, &m)) {
        const size_t placed = add_crowd(run, &m, count, s);
        for (size_t i = 0; i < placed; i++) {
            row[i] = (struct state_row){ .id = (int)i + 1, .species = (int)(i % m.species) + 1 };
            memcpy(row[i].x, s[i].x, sizeof row[i].x);
            move_with_the_flow(&m, &row[i]);
            memcpy(s[i].u, row[i].u, sizeof s[i].u);
            memcpy(s[i].w, row[i].w, sizeof s[i].w);
        }
        stress = ask_stress(run, "crowd", scene, row, placed, 1, "lubrication");
        if (stress) {
            double expected[3][3], size = 0.0;
            struct worst worst = WORST_NONE;
            theory_crowd_stress(&m.lubrication, (int)placed, s, (const double (*)[3])m.cell, (const double (*)[3])m.gradient, expected);
            for (int k = 0; k < 9; k++)
                size = fmax(size, fabs(expected[k / 3][k % 3]) / m.volume);
            for (int k = 0; k < 9; k++)
                worst_see(&worst, stress[k], expected[k / 3][k % 3] / m.volume, size, (size_t)k);
            struct result *r = check_error(run, MODEL, "lubrication stress of a crowd", worst.measured, worst.expected, worst.error,
                                           run->gate_case->tolerance, "the lubrication stress of %zu spheres that move with the "
                                           "flow is not the sum over their pairs and images: %c%c is %s.%s", placed,
                                           (int)(120 + worst.at / 3), (int)(120 + worst.at % 3), compare(&worst),
                                           stress_guess(worst.measured / worst.expected));
            result_notes(r, "%zu spheres without overlap at random, all images summed by brute force.", placed);
        }
    }
    free(stress);
    free(row);
    free(s);
    json_decref(scene);
}

const struct check dilute_checks[] = {
    { "dilute-einstein", check_einstein }, { "dilute-phi2", check_phi2 }, { "dilute-crowd", check_crowd },
    { "sheared-pairs", check_sheared_pairs }, { NULL, NULL } };
