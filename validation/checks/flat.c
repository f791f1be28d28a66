/*
 * Layer 6: two dimensions
 *
 * Spheres with their centres in a plane, sheared in it (dimensions 2). With everything on that acts, noise too, nothing may leave the plane:
 *
 *     z = 0 ,   u_z = 0 ,   w_x = w_y = 0          exactly, at every step
 *
 * under each equation of motion (check_flat_dynamics), no stress points out of it, and tables count two ways to move and one to turn. Without noise the plane is a symmetry
 * of three dimensions too: the same spheres in a scene of three dimensions take the same path, to rounding. So 2D needs no reference: it is the
 * 3D code with the motions taken away that symmetry would not make.
 */
#include "two_bodies.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HALF_SUM, SUM, TRAPEZOIDS, SLOPE_OF_HALF, SLOPE_OF_SUM };      /* what a column says of the three before it */

/* Spheres of both species by turns on a square lattice with a little disorder, moving with the flow and at random, in the plane. */
static struct state_row *start_flat(struct check_run *run, const struct model *m, size_t across, double kT)
{
    struct state_row *row = calloc(across * across, sizeof *row);
    gsl_rng *random = pair_random(run);
    for (size_t i = 0; row && i < across * across; i++) {
        const size_t place[2] = { i % across, i / across };
        const int species = (int)((place[0] + place[1]) % 2);
        const double a = m->radius[species], mass = 4.0 / 3.0 * M_PI * m->density[species] * a * a * a;
        row[i] = (struct state_row){ .id = (int)i + 1, .species = species + 1 };
        for (int k = 0; k < 2; k++) {
            row[i].x[k] = ((double)place[k] + 0.5 + 0.02 * gsl_ran_gaussian(random, 1.0)) * m->cell[k][k] / (double)across;
            row[i].u[k] = gsl_ran_gaussian(random, sqrt(kT / mass));
        }
        row[i].u[0] += m->gradient[0][1] * row[i].x[1];
        row[i].w[2] = -0.5 * m->gradient[0][1] + gsl_ran_gaussian(random, sqrt(kT / (0.4 * mass * a * a)));
    }
    gsl_rng_free(random);
    return row;
}

static void judge_plane(struct check_run *run, const char *what, const struct track *t)
{
    double most = 0.0, motion = 0.0;
    size_t who = 0;
    for (size_t k = 0; k < t->steps * t->count; k++) {
        const struct track_point *p = &t->point[k];
        const double off[4] = { p->x[2], p->u[2], isfinite(p->w[0]) ? p->w[0] : 0.0, isfinite(p->w[1]) ? p->w[1] : 0.0 };
        motion = fmax(motion, fabs(p->u[1]));
        for (int c = 0; c < 4; c++)
            if (!(fabs(off[c]) <= most)) {
                most = fabs(off[c]);
                who = k % t->count;
            }
    }
    check_error(run, INVARIANT, what, most, 0.0, motion > 0.0 ? most : NAN, 0.0,
                "in two dimensions sphere %zu leaves the plane: z, u_z, w_x or w_y is %.3g and not exactly 0", who + 1, most);
}

/* Stresses are per volume of the cell in two dimensions too: times that, those of three. */
static void judge_stresses(struct check_run *run, const char *flat_run, double flat_volume, const char *full_run, double full_volume, size_t rows)
{
    static const char *const origins[] = { "contact_normal", "contact_tangential", "drag", "lubrication", "kinetic" };
    char columns[400] = "step", path[PATH_LENGTH], out[PATH_LENGTH], why[WHY_LENGTH];
    struct table t[2];
    struct worst w = WORST_NONE;
    for (int k = 0; k < 5; k++)
        snprintf(columns + strlen(columns), sizeof columns - strlen(columns), ",%s_xx,%s_xy,%s_yx,%s_yy", origins[k], origins[k], origins[k], origins[k]);
    for (int k = 0; k < 2; k++) {
        path_join(out, run->work, k ? full_run : flat_run);
        path_join(path, out, "out/stress.csv");
        if (!table_has(path, "lubrication_xx"))
            check_skip(run, "stresses of three dimensions", "the candidate writes no stress.csv by origin");
        else if (!table_read(path, columns, &t[k], why) || !table_expect_rows(&t[k], rows, why))
            check_garbage(run, why);
        else
            continue;
        if (k)
            table_free(&t[0]);
        return;
    }
    for (size_t k = 0; k < 20; k++) {
        double size = 0.0;
        for (size_t r = 0; r < t[1].rows; r++)
            for (size_t c = k / 4 * 4; c < k / 4 * 4 + 4; c++)
                size = fmax(size, fabs(table_at(&t[1], r, 1 + c)) * full_volume);
        for (size_t r = 0; r < rows; r++)
            worst_see(&w, table_at(&t[0], r, 1 + k) * flat_volume, table_at(&t[1], r, 1 + k) * full_volume, size, k);
    }
    table_free(&t[0]);
    table_free(&t[1]);
    check_error(run, INVARIANT, "stresses of three dimensions", w.measured, w.expected, w.error, run->gate_case->tolerance,
                "without noise the stress of %s times the volume of the cell is otherwise in two dimensions than in three: %s", origins[w.at / 4], compare(&w));
}

void check_flat(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t across = (size_t)scene_number(parameters, "across", 0), count = across * across;
    const int steps = (int)scene_number(parameters, "steps", 0);
    json_t *scene = json_deep_copy(run->gate_case->scene), *calm = json_deep_copy(run->gate_case->scene), *solid;
    const double kT = scene_number(scene, "fluid.kT", NAN);
    struct model m;
    struct track noisy, flat, full;
    int at[32];
    for (int k = 0; k < 32; k++)
        at[k] = steps / 32 * (k + 1);
    if (!model_read(run, scene, &m))
        return;
    struct state_row *row = start_flat(run, &m, across, kT);
    scene_set(calm, "fluid.kT", json_real(0.0));
    scene_set(calm, "output.stress", json_pack("{si}", "every", steps / 32));
    solid = json_deep_copy(calm);
    scene_set(solid, "dimensions", json_integer(3));
    /* In the plane spheres have no images above and below, however thin the cell is; in space the cell must be deep enough for that. */
    scene_set(solid, "box.lengths", json_pack("[fff]", m.cell[0][0], m.cell[1][1], scene_number(parameters, "depth", NAN)));
    if (row && track_ask(run, "with-noise", scene, row, count, at, 32, &noisy)) {
        judge_plane(run, "nothing leaves the plane", &noisy);
        track_free(&noisy);
    }
    if (row && track_ask(run, "two-dimensions", calm, row, count, at, 32, &flat)) {
        if (track_ask(run, "three-dimensions", solid, row, count, at, 32, &full)) {
            struct worst w = WORST_NONE;
            for (size_t k = 0; k < 32 * count; k++)
                worst_see_vector(&w, flat.point[k].x, full.point[k].x, 9, 1.0, k % count);
            check_error(run, INVARIANT, "the path of three dimensions", w.measured, w.expected, w.error, run->gate_case->tolerance,
                        "without noise spheres in a plane move otherwise in two dimensions than in three: sphere %zu has %s", w.at + 1, compare(&w));
            judge_stresses(run, "two-dimensions", m.volume, "three-dimensions", m.volume / m.cell[2][2] * scene_number(parameters, "depth", NAN), (size_t)(steps / (steps / 32)) + 1);
            track_free(&full);
        }
        track_free(&flat);
    }
    free(row);
    json_decref(scene);
    json_decref(calm);
    json_decref(solid);
}

/* Numbers of one row of a table that follow from its others in two dimensions: the mean over two axes, the one spin. */
static void judge_means(struct check_run *run, const char *out, const char *file, const char *columns, int of, const char *what)
{
    struct table t;
    struct worst w = WORST_NONE;
    double integral = 0.0, before = 0.0, lag = 0.0, size = 0.0;
    if (!check_table(run, out, file, columns, what, &t))
        return;
    for (size_t r = 0; r < t.rows; r++)
        size = fmax(size, fabs(table_at(&t, r, 4)));
    for (size_t r = 0; r < t.rows; r++) {
        const bool first = r == 0 || (of != HALF_SUM && table_at(&t, r, 0) < table_at(&t, r - 1, 0));
        const double mean = (table_at(&t, r, 1) + table_at(&t, r, 2) + table_at(&t, r, 3)) / (of == SUM || of == SLOPE_OF_SUM ? 1.0 : 2.0), now = table_at(&t, r, 0);
        integral = first ? 0.0 : integral + 0.5 * (before + mean) * (now - lag);
        const double slope = 0.5 * (first ? 0.0 : mean - before) / (first ? 1.0 : now - lag);
        if (of < SLOPE_OF_HALF || !first)
            worst_see(&w, table_at(&t, r, 4), of == TRAPEZOIDS ? integral : of >= SLOPE_OF_HALF ? slope : mean, size, r);
        before = mean;
        lag = now;
    }
    table_free(&t);
    check_error(run, INVARIANT, what, w.measured, w.expected, w.error, run->gate_case->tolerance, "%s: row %zu says %s: in two dimensions there are two ways "
                "to move and one to turn", what, w.at + 1, compare(&w));
}

/* Averages are those of the tables of temperature and viscosity beyond what is dropped. */
static void judge_averages(struct check_run *run, const char *out, const char *what)
{
    static const char *const names[3] = { "T", "W", "pressure" };
    struct table averages, table;
    struct worst w = WORST_NONE;
    if (!check_table(run, out, "averages.csv", "quantity$,mean,discarded", what, &averages))
        return;
    for (int k = 0; k < 3; k++) {
        if (!check_table(run, out, k < 2 ? "temperature.csv" : "viscosity.csv", names[k], what, &table))
            continue;
        for (size_t r = 0; r < averages.rows; r++) {
            const size_t first = (size_t)table_at(&averages, r, 2);
            double mean = 0.0;
            if (strcmp(table_word(&averages, r, 0), names[k]) != 0 || first >= table.rows)
                continue;
            for (size_t s = first; s < table.rows; s++)
                mean += table_at(&table, s, 0) / (double)(table.rows - first);
            worst_see(&w, table_at(&averages, r, 1), mean, fabs(mean), r);
        }
        table_free(&table);
    }
    table_free(&averages);
    check_error(run, INVARIANT, what, w.measured, w.expected, w.error, 1e-7, "%s: row %zu says %s, the mean of its own table", what, w.at + 1, compare(&w));
    /* written with nine digits */
}

/* A third of the trace, in two dimensions too: the third axis is there, with the stress that it has. */
static void judge_pressure(struct check_run *run, const char *out, const char *what)
{
    struct table stress, said;
    struct worst w = WORST_NONE;
    if (!check_table(run, out, "viscosity.csv", "pressure", what, &said))
        return;
    if (check_table(run, out, "stress.csv", "contact_normal_xx,contact_normal_yy,contact_normal_zz,contact_tangential_xx,contact_tangential_yy,contact_tangential_zz,"
                    "lubrication_xx,lubrication_yy,lubrication_zz,drag_xx,drag_yy,drag_zz", what, &stress)) {
        for (size_t r = 0; r < said.rows && r < stress.rows; r++) {
            double sum = 0.0, size = 0.0;
            for (size_t k = 0; k < 12; k++) {
                sum -= table_at(&stress, r, k) / 3.0;
                size += fabs(table_at(&stress, r, k));
            }
            worst_see(&w, table_at(&said, r, 0), sum, size, r);
        }
        table_free(&stress);
        check_error(run, INVARIANT, what, w.measured, w.expected, w.error, run->gate_case->tolerance, "%s: row %zu says %s; minus a third of the trace of its own "
                    "stresses is that", what, w.at + 1, compare(&w));
    }
    table_free(&said);
}

/* No force across the plane, so none in the stress, of whatever origin: its third row and column, but for its corner, are exactly zero. */
static void judge_stress(struct check_run *run, const char *out, const char *what)
{
    static const char *const origins[] = { "contact_normal", "contact_tangential", "lubrication", "lubrication_noise", "drag", "kinetic" };
    struct worst w = WORST_NONE;
    double in_plane = 0.0;
    for (size_t k = 0; k < sizeof origins / sizeof *origins; k++) {
        char columns[200];
        struct table t;
        const char *o = origins[k];
        snprintf(columns, sizeof columns, "%s_xx,%s_xy,%s_xz,%s_yz,%s_zx,%s_zy", o, o, o, o, o, o);
        if (!check_table(run, out, "stress.csv", columns, what, &t))
            return;
        for (size_t r = 0; r < t.rows; r++) {
            in_plane = fmax(in_plane, fabs(table_at(&t, r, 0)) + fabs(table_at(&t, r, 1)));
            for (size_t c = 2; c < 6; c++)
                worst_see(&w, table_at(&t, r, c), 0.0, 1.0, k);
        }
        table_free(&t);
    }
    check_error(run, INVARIANT, what, w.measured, w.expected, in_plane > 0.0 ? w.error : NAN, 0.0, "in two dimensions the %s stress has components across the plane, "
                "up to %.3g, where no force points there", origins[w.at], w.error);
}

/* g of centres in a plane: pairs found over those of an ideal gas of that area, in rings; in squares where the plane of shear is drawn. */
static void judge_distribution(struct check_run *run, const struct model *m, const char *out, size_t count, double snapshots, const char *what)
{
    struct table t;
    struct worst w = WORST_NONE;
    const double area = m->volume / m->cell[2][2], N = (double)count, half = 0.5 * N;      /* half of each species */
    if (!check_table(run, out, "pair_distribution.csv", "kind$,species_a,species_b,low,high,count,g", what, &t))
        return;
    for (size_t r = 0; r < t.rows; r++) {
        const int a = (int)table_at(&t, r, 1), b = (int)table_at(&t, r, 2);
        if (a < 1 || b < 1 || a > (int)m->species || b > (int)m->species) {
            worst_see(&w, NAN, 0.0, 1.0, r);
            continue;
        }
        const double touch = strcmp(table_word(&t, r, 0), "near") == 0 ? m->radius[a - 1] + m->radius[b - 1] : 0.0;
        const double ring = M_PI * (gsl_pow_2(touch + table_at(&t, r, 4)) - gsl_pow_2(touch + table_at(&t, r, 3)));
        const double g = table_at(&t, r, 5) / ((a == b ? 0.5 * half * (half - 1.0) : half * half) / area * ring * snapshots);
        worst_see(&w, table_at(&t, r, 6), g, fmax(g, 1.0), r);
    }
    table_free(&t);
    if (!check_table(run, out, "pair_plane.csv", "r_flow,count,g", what, &t))
        return;
    const double width = t.rows > 1 ? table_at(&t, 1, 0) - table_at(&t, 0, 0) : NAN;
    for (size_t r = 0; r < t.rows; r++) {
        const double g = table_at(&t, r, 1) / (N * (N - 1.0) / area * width * width * snapshots);
        worst_see(&w, table_at(&t, r, 2), g, fmax(g, 1.0), r);
    }
    table_free(&t);
    check_error(run, INVARIANT, what, w.measured, w.expected, w.error, 1e-7, "%s: row %zu: g is %s; the pairs found over those of an ideal gas in the plane give "
                "that", what, w.at + 1, compare(&w));       /* written with nine digits */
}

static void judge_tables(struct check_run *run, const char *name, const struct model *m, size_t count, double snapshots)
{
    static const struct { const char *what, *file, *columns; int of; } means[] = {
        { "temperature.csv: T", "temperature.csv", "time,T_x,T_y,T_z,T", HALF_SUM },
        { "temperature.csv: W", "temperature.csv", "time,W_x,W_y,W_z,W", SUM },
        { "temperature.csv: T by species", "temperature.csv", "time,T_small,T_large,T_z,T", HALF_SUM },      /* there are as many of each, and T_z, W_x are 0 */
        { "temperature.csv: W by species", "temperature.csv", "time,W_small,W_large,W_x,W", HALF_SUM },
        { "velocity_correlation.csv: integral", "velocity_correlation.csv", "lag,c_x,c_y,c_z,integral", TRAPEZOIDS },
        { "displacement.csv: D", "displacement.csv", "lag,msd_x,msd_y,msd_z,D", SLOPE_OF_HALF },
        { "displacement.csv: D_turn", "displacement.csv", "lag,turn_x,turn_y,turn_z,D_turn", SLOPE_OF_SUM },
    };
    char folder[PATH_LENGTH], out[PATH_LENGTH], what[96];
    path_join(folder, run->work, name);
    path_join(out, folder, "out");
    for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
        snprintf(what, sizeof what, "%s: %s", name, means[k].what);
        judge_means(run, out, means[k].file, means[k].columns, means[k].of, what);
    }
    snprintf(what, sizeof what, "%s: viscosity.csv: pressure", name);
    judge_pressure(run, out, what);
    snprintf(what, sizeof what, "%s: averages.csv: T, W, pressure", name);
    judge_averages(run, out, what);
    snprintf(what, sizeof what, "%s: stress across the plane", name);
    judge_stress(run, out, what);
    snprintf(what, sizeof what, "%s: pair_distribution.csv: g", name);
    judge_distribution(run, m, out, count, snapshots, what);
}

/* Under each equation of motion of parameters.dynamics, from a thermal start: with everything on that acts nothing leaves the plane. */
void check_flat_dynamics(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t across = (size_t)scene_number(parameters, "across", 0), count = across * across;
    const int at[2] = { 1, (int)scene_number(parameters, "steps", 0) };
    const char *name;
    json_t *dynamics;
    json_object_foreach((json_t *)json_object_get(parameters, "dynamics"), name, dynamics)
    {
        json_t *scene = json_deep_copy(run->gate_case->scene);
        struct model m;
        struct track track;
        scene_set(scene, "dynamics", json_deep_copy(dynamics));
        scene_set(scene, "start.thermal", json_true());
        scene_set(scene, "output.temperature", json_pack("{si}", "every", 3));
        scene_set(scene, "output.averages", json_pack("{si}", "every", 3));
        scene_set(scene, "output.stress", json_pack("{si}", "every", 3));
        scene_set(scene, "output.viscosity", json_pack("{si}", "every", 3));
        scene_set(scene, "output.pair_distribution", json_pack("{si sf si s{sf si} s{sf sf si}}", "every", 3, "range", 5.0, "bins", 10, "near", "gap", 0.4,
                                                               "bins", 8, "plane", "range", 4.0, "half_width", 0.7, "bins", 8));
        scene_set(scene, "output.displacement", json_pack("{si si}", "every", 3, "levels", 1));
        scene_set(scene, "output.velocity_correlation", json_pack("{si si}", "every", 3, "levels", 1));
        scene_set(scene, "seed", json_integer(run->seed));
        struct state_row *row = model_read(run, scene, &m) ? start_flat(run, &m, across, scene_number(scene, "fluid.kT", NAN)) : NULL;
        if (row && track_ask(run, name, scene, row, count, at, 2, &track)) {
            judge_plane(run, name, &track);
            judge_tables(run, name, &m, count, floor(at[1] / 3.0) + 1.0);
            track_free(&track);
        }
        free(row);
        json_decref(scene);
    }
}
