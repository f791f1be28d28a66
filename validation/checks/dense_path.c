/*
 * Layer 6, a short path: the candidate against LAMMPS, particle by particle and stress by stress. Stock styles where they are exact; with
 * lubrication LAMMPS takes the resistances of validation/theory (tools/lammps/host.c) and keeps contacts, cell, images, lists and steps.
 *
 * Both start from the same random spheres and take the same steps of velocity Verlet in LAMMPS's convention: a half kick with
 * the last forces, a drift, forces from the new positions (cell and flow at the new time) and the HALF-STEP velocities, a half
 * kick. Then nothing but rounding is left between them, which grows by a factor e in a strain of about one. Two things are
 * commonly done otherwise, and show here: the cell lags one step behind (LAMMPS itself, unless it is told to start one
 * step ahead as our adapter does): positions differ by rate x edge x dt in the first step in which a pair meets across the face;
 * the drag uses the velocity of another moment: everything differs by O(dt) from the start. With noise the candidate must draw the random numbers
 * of docs/formats.md, as the reference does; one that draws others is told so, and skipped.
 */
#include "dense.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const path_columns = "step,id,x,y,z,ux,uy,uz,wx,wy,wz";

/*
 * Root mean square difference of velocities over that of the reference's velocities beyond the flow: 1.4 for two codes that draw
 * other random numbers. `found`: x, u, w of each particle, code by code.
 */
static double unlike(double *const found[2], const struct dense_start *s)
{
    double difference = 0, size = 0;
    for (size_t i = 0; i < s->count; i++)
        for (size_t k = 3; k < 6; k++) {
            const double *own = found[0] + 10 * i, *other = found[1] + 10 * i, flow = k == 3 ? s->rate * other[1] : 0;
            difference += (own[k] - other[k]) * (own[k] - other[k]);
            size += (other[k] - flow) * (other[k] - flow);
        }
    return sqrt(difference / size);
}

/* Largest differences of positions (radii), velocities (rate x edge) and spins (rate) at a step, and `unlike`; false if rows are missing. */
static bool compare_states(const struct table t[2], const struct dense_start *s, double radius, double step, double worst[3], double *apart)
{
    double *found[2];
    bool good = true;
    for (int code = 0; code < 2; code++) {
        found[code] = calloc(s->count * 10, sizeof(double));
        for (size_t r = 0; found[code] && r < t[code].rows; r++) {
            const double id = table_at(&t[code], r, 1);
            if (table_at(&t[code], r, 0) != step || id < 1 || id > (double)s->count)
                continue;
            double *row = found[code] + 10 * ((size_t)id - 1);
            row[9] = 1;
            for (size_t c = 0; c < 9; c++)
                row[c] = table_at(&t[code], r, 2 + c);
        }
        for (size_t i = 0; i < s->count; i++)
            good = good && found[code] && found[code][10 * i + 9] > 0;
    }
    const double unit[3] = { radius, fabs(s->rate) * s->edge, fabs(s->rate) };
    for (int what = 0; good && what < 3; what++) {
        worst[what] = 0;
        for (size_t i = 0; i < s->count; i++)
            for (int k = 3 * what; k < 3 * what + 3; k++)
                worst[what] = fmax(worst[what], fabs(found[0][10 * i + (size_t)k] - found[1][10 * i + (size_t)k]) / unit[what]);
    }
    *apart = good ? unlike(found, s) : NAN;
    free(found[0]);
    free(found[1]);
    return good;
}

/* Largest difference of any component of one origin over all steps, relative to the largest component of the reference. */
static bool compare_stress(struct check_run *run, char out[2][PATH_LENGTH], const char *origin, double *error)
{
    char columns[512] = "step", path[PATH_LENGTH], why[WHY_LENGTH];
    for (int k = 0; k < 9; k++)
        snprintf(columns + strlen(columns), sizeof columns - strlen(columns), ",%s_%c%c", origin, "xyz"[k / 3], "xyz"[k % 3]);
    struct table t[2];
    for (int code = 0; code < 2; code++) {
        path_join(path, out[code], "stress.csv");
        if (!table_read(path, columns, &t[code], why)) {
            check_garbage(run, why);
            if (code)
                table_free(&t[0]);
            return false;
        }
    }
    const bool good = table_expect_rows(&t[0], t[1].rows, why);
    double largest = 0, difference = 0;
    for (size_t r = 0; good && r < t[1].rows; r++)
        for (size_t c = 1; c < 10; c++) {
            largest = fmax(largest, fabs(table_at(&t[1], r, c)));
            difference = fmax(difference, fabs(table_at(&t[0], r, c) - table_at(&t[1], r, c)));
        }
    if (!good)
        check_garbage(run, why);
    *error = difference / largest;
    table_free(&t[0]);
    table_free(&t[1]);
    return good;
}

const char *dense_path_likely(double early)
{
    return early > 0.1 ? "so far apart so early is a force, not a step: layer pair names the term, but for what only motion shows, how histories grow and "
                         "velocities of images in friction"
                       : "a cell that lags one step or a drag at another moment's velocity would do that";
}

/* False: there is nothing to compare. */
static bool judge_states(struct check_run *run, const struct dense_start *s, char out[2][PATH_LENGTH], double steps, double every)
{
    static const char *const what[3] = { "positions", "velocities", "spins" };
    const double tolerance = run->gate_case->tolerance;
    const double radius = scene_number(json_array_get(json_object_get(s->scene, "species"), 0), "radius", 1);
    struct table t[2];
    char path[PATH_LENGTH], why[WHY_LENGTH], growth[512] = "";
    double worst[3] = { 0 }, apart, first_apart = 0, early = 0;
    for (int code = 0; code < 2; code++) {
        path_join(path, out[code], "trajectory.csv");
        if (!table_read(path, path_columns, &t[code], why)) {
            check_garbage(run, why);
            if (code)
                table_free(&t[0]);
            return false;
        }
    }
    bool good = true;
    for (double step = 0; good && step <= steps; step += every) {
        good = compare_states(t, s, radius, step, worst, &apart);
        first_apart = step == every ? apart : first_apart;
        early = step == every ? worst[0] : early;
        snprintf(growth + strlen(growth), sizeof growth - strlen(growth), "%s%.1g at step %.0f", step > 0 ? ", " : "", worst[0], step);
    }
    table_free(&t[0]);
    table_free(&t[1]);
    if (!good) {
        check_garbage(run, "trajectory.csv lacks a particle at one of the steps asked for");
        return false;
    }
    const bool noisy = scene_get(s->scene, "forces.drag_noise") && scene_number(s->scene, "fluid.kT", 0) > 0;
    /* Two independent draws give 1.4; the same but for the drag's numbers gives 0.69 here. A noise that is as wrong as that fails in layer noise. */
    if (noisy && first_apart > 0.5) {
        check_skip(run, "paths", "the velocities are other ones altogether (%.2g of their size after %.0f steps): the code draws other random numbers than "
                   "docs/formats.md says, so paths cannot be compared", first_apart, every);
        return false;
    }
    /* A code may leave out spins where nothing turns a sphere. */
    const int compared = scene_number(s->scene, "forces.contact.friction", 0) > 0 ? 3 : 2;
    const char *likely = dense_path_likely(early);
    for (int k = 0; k < compared; k++) {
        struct result *r = check_error(run, MODEL, what[k], worst[k], 0, worst[k], tolerance,
                                       "%s differ from LAMMPS's by %.2g after %.0f steps (positions in radii: %s); %s", what[k], worst[k],
                                       steps, growth, likely);
        result_notes(r, "largest difference of positions, in radii of the first species: %s", growth);
    }
    return true;
}

/* A path that makes, holds and loses no contact, or in which the cell is not remapped, would compare nothing of friction or of images. */
static void judge_events(struct check_run *run, const struct dense_start *s, const char *reference)
{
    struct dense_events e;
    if (!dense_events_count(run, s, reference, &e))
        return;
    const bool all = e.made && e.lost && e.slipping && e.sticking && e.remaps;
    struct result *r = check_error(run, INVARIANT, "what the path tries", all, 1, all ? 0 : 1, 0.5,
                                   "on the path %zu contacts are made, %zu lost, %zu slip and %zu stick in the frames looked at, and the cell is "
                                   "remapped %zu times: none of them may be 0", e.made, e.lost, e.slipping, e.sticking, e.remaps);
    result_notes(r, "contacts made %zu, lost %zu (seen between frames; more may come and go within), at the end %zu; slipping %zu times and sticking %zu "
                 "times in the frames looked at; the cell remapped %zu times", e.made, e.lost, e.contacts, e.slipping, e.sticking, e.remaps);
}

void dense_path(struct check_run *run)
{
    const json_t *par = run->gate_case->parameters;
    const double steps = scene_number(par, "steps", 1500), every = scene_number(par, "every", 500), watch = scene_number(par, "watch", 0);
    struct dense_start s;
    char out[2][PATH_LENGTH];
    if (!dense_start(run, run->seed, &s))
        return;
    scene_set(s.scene, "run", json_pack("{sI}", "steps", (json_int_t)steps));
    scene_set(s.scene, "output.states.every", json_integer((json_int_t)(watch > 0 ? watch : every)));
    scene_set(s.scene, "output.stress.every", json_integer((json_int_t)every / 10));
    if (dense_ask_both(run, "path", &s, out, NULL)) {
        const bool friction = scene_number(s.scene, "forces.contact.friction", 0) > 0;
        const char *const origin[4] = { "contact_normal", "kinetic", friction ? "contact_tangential" : NULL,
                                        scene_get(s.scene, "forces.lubrication") ? "lubrication" : NULL };
        double error;
        const bool alike = judge_states(run, &s, out, steps, every);
        if (watch > 0)
            judge_events(run, &s, out[1]);
        /* LAMMPS works a frictional pair out anew when it writes it, then with full-step velocities: dashpots spoil that stress. */
        const bool stress = alike && !json_is_false(json_object_get(par, "stress"));
        for (int o = 0; o < 4 && stress; o++)
            if (origin[o] && compare_stress(run, out, origin[o], &error))
                check_error(run, MODEL, origin[o], error, 0, error, run->gate_case->tolerance,
                            "the %s stress differs from LAMMPS's by %.2g of its largest component along the path", origin[o], error);
    }
    dense_start_free(&s);
}
