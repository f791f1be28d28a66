/*
 * Layer 5: the phi^2 coefficient of the stress in steady shear, from encounters
 *
 *     c = (n^2/2)/(eta phi^2) int dy dz |y| int dt V sigma          theory/encounters.c
 *
 * The candidate runs encounters of two equal spheres, each alone in its box, started just within their range R with the flow; the gate
 * adds up stress.csv over time and, with Gauss points in z/R and (for the weight y) in y/sqrt(R^2 - z^2), over the plane of impact. By symmetry y > 0 and z > 0
 * do for all. What it expects it integrates in polar coordinates, with its own encounters. Slow ones last longest, R/(rate y), unless
 * lubrication takes the pair round; at the end of a run no stress may be left, or the sum is not complete. Where lubrication keeps some of the
 * pairs from touching, the contact part has a kink in the plane of impact, and the points of both sides are good to per cents there.
 */
#include "two_bodies.h"

#include <gsl/gsl_integration.h>
#include <stdio.h>

static const char *const parts[2] = { "contact_normal", "lubrication" }, *const kinds[3] = { "xy", "N1", "N2" };

/* Add a weight x the integral of sigma over time, [contact, lubrication][xy, N1, N2]; false after recording what is wrong. */
static bool add_run(struct check_run *run, const char *out, const struct model *m, double weight, double sum[2][3])
{
    char path[PATH_LENGTH], why[WHY_LENGTH], columns[400];
    path_join(path, out, "stress.csv");
    for (int part = 0; part < 2; part++) {
        struct table t;
        if (!(part ? m->has_lubrication : m->has_contact))
            continue;
        snprintf(columns, sizeof columns, "time,%s_xx,%s_yy,%s_zz,%s_xy,%s_yx", parts[part], parts[part], parts[part], parts[part], parts[part]);
        if (!table_read(path, columns, &t, why)) {
            check_garbage(run, why);
            return false;
        }
        for (size_t r = 1; r < t.rows; r++)      /* trapezoids: a pair starts within range, where the stress is not small */
            for (size_t side = 0; side < 2; side++) {
                const double since = 0.5 * weight * (table_at(&t, r, 0) - table_at(&t, r - 1, 0)), *s = &t.value[t.columns * (r - side)];
                sum[part][0] += since * 0.5 * (s[4] + s[5]);
                sum[part][1] += since * (s[1] - s[2]);
                sum[part][2] += since * (s[2] - s[3]);
            }
        double left = 0.0;
        for (size_t c = 1; t.rows && c < 6; c++)
            left += fabs(table_at(&t, t.rows - 1, c));
        const bool over = t.rows > 1 && left == 0.0;
        table_free(&t);
        if (!over) {
            check_error(run, INVARIANT, "encounters end", left, 0, 1, 0, "pairs that the flow parts are still held together at the end of the run: %s "
                        "stress is left", parts[part]);
            return false;
        }
    }
    return true;
}

/* One encounter, coming at (y, z). */
static bool ask_encounter(struct check_run *run, const char *name, const struct model *m, double reach, double y, double z, double weight,
                          double sum[2][3])
{
    const json_t *given = run->gate_case->scene;
    const double rate = m->gradient[0][1], longest = scene_number(run->gate_case->parameters, "longest", INFINITY);
    const double duration = fmin(reach / (rate * y), longest) + 6.0 / rate, r[3] = { -sqrt(reach * reach - y * y - z * z) * (1.0 - 1e-9), y, z };
    const double edges[3] = { 2.0 * reach * (rate * duration + 3.0), 4.0 * reach, 3.7 * reach };
    struct state_row row[2];
    for (int side = 0; side < 2; side++) {
        struct state_row *s = &row[side];
        *s = (struct state_row){ .id = side + 1, .species = 1 };
        for (int c = 0; c < 3; c++)
            s->x[c] = (side ? 0.5 : -0.5) * r[c];
        s->u[0] = rate * s->x[1];
        s->w[2] = -0.5 * rate;
    }
    json_t *scene = json_deep_copy(given);
    scene_set(scene, "box.lengths", json_pack("[fff]", edges[0], edges[1], edges[2]));
    scene_set(scene, "start.file", json_string("states.csv"));
    char step[96];
    step_key(given, step);
    scene_set(scene, "run.steps", json_integer((json_int_t)(duration / scene_number(given, step, NAN))));
    scene_set(scene, "output.stress.every", json_integer((json_int_t)scene_number(run->gate_case->parameters, "every", 1)));
    const struct question q = { .protocol = "run", .scene = scene, .state = row, .states = 2 };
    char out[PATH_LENGTH];
    const bool good = check_ask(run, name, &q, out) && add_run(run, out, m, weight * edges[0] * edges[1] * edges[2], sum);
    json_decref(scene);
    return good;
}

/* All of them: int dy dz y = int dz (R^2 - z^2) int dx x, y = x sqrt(R^2 - z^2). */
static bool ask_all(struct check_run *run, const struct model *m, double reach, double sum[2][3])
{
    double points[8];
    size_t two;
    parameter_list(run->gate_case->parameters, "points", points, &two, 2);
    const size_t across = (size_t)points[0], along = (size_t)points[1];
    gsl_integration_fixed_workspace *in_y = gsl_integration_fixed_alloc(gsl_integration_fixed_jacobi, across, 0.0, 1.0, 0.0, 1.0);
    gsl_integration_glfixed_table *in_z = gsl_integration_glfixed_table_alloc(along);
    bool good = in_y && in_z;
    for (size_t k = 0; good && k < across * along; k++) {
        char name[32];
        double z, wz;
        const double x = gsl_integration_fixed_nodes(in_y)[k / along], wx = gsl_integration_fixed_weights(in_y)[k / along];
        gsl_integration_glfixed_point(0.0, reach, k % along, &z, &wz, in_z);
        const double square = reach * reach - z * z;
        snprintf(name, sizeof name, "encounter-%zu", k);
        check_progress(run, "encounter %zu of %zu", k + 1, across * along);
        good = ask_encounter(run, name, m, reach, x * sqrt(square), z, wx * wz * square, sum);
    }
    gsl_integration_fixed_free(in_y);
    gsl_integration_glfixed_table_free(in_z);
    return good;
}

void check_sheared_pairs(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    struct model m;
    double sum[2][3] = { { 0 } }, expected[2][3], gauss[8];
    size_t two;
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    parameter_list(parameters, "gauss", gauss, &two, 2);
    const double a = m.radius[0], reach = a * (2.0 + (m.has_lubrication ? m.lubrication.outer_gap : 0.0)), density = 3.0 / (4.0 * M_PI * a * a * a);
    const struct theory_motion motion = bodies_motion(&m, a, a);
    if (!ask_all(run, &m, reach, sum))
        return;
    if (!theory_sheared_pairs(&motion, (size_t)gauss[0], (size_t)gauss[1], expected)) {
        check_garbage(run, "some encounter of the gate's own does not end; this is a mistake in the suite");
        return;
    }
    const double weight = 0.5 * density * density * 4.0 / m.viscosity;     /* both signs of y and of z; the rate drops out with eta rate */
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < 3 && (part ? m.has_lubrication : m.has_contact); k++) {
            char name[64];
            const double c = weight * sum[part][k], scale = fmax(fabs(expected[part][k]), 0.2 * fabs(expected[part][0]));
            snprintf(name, sizeof name, "%s %s", parts[part], kinds[k]);
            check_error(run, MODEL, name, c, expected[part][k], fabs(c - expected[part][k]) / scale,
                        part || !m.has_lubrication ? run->gate_case->tolerance : scene_number(parameters, "kink", NAN),
                        "encounters in steady shear add %.5g phi^2 to %s of the %s stress over eta rate; the declared model adds %.5g", c, kinds[k],
                        parts[part], expected[part][k]);
        }
}
