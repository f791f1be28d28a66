/*
 * Layer 3: runs that begin in the middle of a flow that changes with time
 *
 * What is summed since the start knows when it started: the strain, the way of spheres that the flow carries from the cell of that moment, and displacement.csv,
 * without the flow's part,
 *
 *     <|x(t') - x(t) - [S(t') - S(t)] x(t)|^2> = 0 ,   angles beyond half the integral of the vorticity from the angles of the same run
 */
#include "stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SPHERES = STAGES_SPHERES };

/* How far the flow itself turns a sphere until a time: the integral of half its vorticity. */
static void turned_by(const struct theory_stage *stage, size_t stages, double t, double turn[3])
{
    double S[3][3];
    stages_strain(stage, stages, t, S);
    for (int k = 0; k < 3; k++)
        turn[k] = 0.5 * (S[(k + 2) % 3][(k + 1) % 3] - S[(k + 1) % 3][(k + 2) % 3]);
}

enum { LATE_FRAMES = 49, LEVELS = 3, LONGEST = 16 };    /* samples of a run that begins in the middle; lags up to LONGEST have all samples as origins */

/* Mean square of the angle beyond that of the flow, from the angles of the trajectory. */
static void expected_turns(const struct theory_stage *stage, size_t stages, double begin, double every, const struct track *track, double expected[LONGEST + 1][3])
{
    double flow[LATE_FRAMES][3];
    for (size_t s = 0; s < LATE_FRAMES; s++)
        turned_by(stage, stages, begin + (double)s * every, flow[s]);
    for (size_t lag = 1; lag <= LONGEST; lag++)
        for (size_t k = 0; k < 3; k++) {
            double sum = 0.0, n = 0.0;
            for (size_t s = 0; s + lag < LATE_FRAMES; s++)
                for (size_t i = 0; i < SPHERES; i++, n += 1.0)
                    sum += gsl_pow_2(track_at(track, s + lag, i)->turn[k] - track_at(track, s, i)->turn[k] - flow[s + lag][k] + flow[s][k]);
            expected[lag][k] = sum / n;
        }
}

/* Spheres that follow the flow have no displacement of their own; their spins follow it with delay, so there is an angle. */
static void judge_displacement(struct check_run *run, const char *label, const char *out, double radius, double every, double expected[LONGEST + 1][3])
{
    struct worst own = WORST_NONE, turn = WORST_NONE;
    struct table t;
    double largest = 0.0;
    char what[96];
    snprintf(what, sizeof what, "%s: displacement beyond the flow's", label);
    if (!check_table(run, out, "displacement.csv", "lag,msd_x,msd_y,msd_z,turn_x,turn_y,turn_z", what, &t))
        return;
    char why[WHY_LENGTH];
    if (!table_expect_rows(&t, lags_due(LEVELS, LATE_FRAMES), why)) {
        check_garbage(run, why);
        table_free(&t);
        return;
    }
    for (size_t k = 0; k < 3; k++)
        largest = fmax(largest, expected[LONGEST][k]);
    for (size_t r = 0; r < t.rows; r++) {
        const size_t lag = (size_t)lround(table_at(&t, r, 0) / every);
        for (size_t k = 0; k < 3; k++) {
            worst_see(&own, table_at(&t, r, 1 + k), 0.0, gsl_pow_2(radius), r);
            if (lag >= 1 && lag <= LONGEST)
                worst_see(&turn, table_at(&t, r, 4 + k), expected[lag][k], largest, r);
        }
    }
    table_free(&t);
    check_error(run, MODEL, what, own.measured, own.expected, own.error, 1e-4, "spheres that follow the flow have a mean square displacement of %.3g of "
                "their own: what the flow does to the old place is not taken off as it should be", own.measured);
    snprintf(what, sizeof what, "%s: angle beyond the flow's", label);
    check_error(run, MODEL, what, turn.measured, turn.expected, turn.error, 1e-8, "row %zu of displacement.csv says a mean square angle of %s; the angles of its trajectory "
                "without the integral of the flow's rate of turning give that", turn.at + 1, compare(&turn));      /* sums of the same 17 digits */
}

/* Spheres that follow the flow are where it carries them from their start, in whatever cell that was. */
static void judge_carried(struct check_run *run, const char *label, const struct theory_stage *stage, size_t stages, double begin, double every, double radius,
                          const struct state_row start[SPHERES], const struct track *track)
{
    struct worst w = WORST_NONE;
    char what[128];
    double S[2][3][3];
    stages_strain(stage, stages, begin, S[0]);
    for (size_t s = 0; s < track->steps; s++) {
        stages_strain(stage, stages, begin + (double)s * every, S[1]);
        for (size_t i = 0; i < track->count; i++)
            for (int k = 0; k < 3; k++) {
                double x = start[i].x[k];
                for (int l = 0; l < 3; l++)
                    x += (S[1][k][l] - S[0][k][l]) * start[i].x[l];
                worst_see(&w, track_at(track, s, i)->x[k], x, radius, i);
            }
    }
    snprintf(what, sizeof what, "%s: place", label);
    check_error(run, MODEL, what, w.measured, w.expected, w.error, 1e-2, "%s: sphere %zu, which began with the flow, is at %s", label, w.at + 1, compare(&w));
}

/*
 * A run that begins in the middle: strain counts from its begin, and spheres that follow the flow have no displacement of their own, for the
 * deformation from one moment to another is that of the rates between them.
 */
bool stages_try_late(struct check_run *run, const json_t *drive, size_t number, double begin)
{
    const char *label = json_string_value(json_object_get(drive, "name"));
    const double dt = scene_number(run->gate_case->parameters, "dt", NAN);
    json_t *scene = variant_scene(run->gate_case, drive);
    struct theory_stage stage[STAGES];
    struct state_row start[SPHERES];
    struct model m;
    struct track track;
    char name[64], folder[PATH_LENGTH], out[PATH_LENGTH], what[96];
    const int every = (int)lround(1.2 / dt) / (LATE_FRAMES - 1);
    int at[LATE_FRAMES];
    double G[3][3], way;
    for (int s = 0; s < LATE_FRAMES; s++)
        at[s] = s * every;
    scene_set(scene, "stages", json_incref(json_object_get(drive, "stages")));
    scene_set(scene, "start.time", json_real(begin));
    scene_set(scene, "output.stress", json_pack("{si}", "every", every));
    scene_set(scene, "output.viscosity", json_pack("{si}", "every", every));
    scene_set(scene, "output.displacement", json_pack("{si si}", "every", every, "levels", LEVELS));
    const size_t stages = stages_read(json_object_get(drive, "stages"), stage);
    theory_driven_flow(stage, stages, begin, G, &way);
    if (model_read(run, scene, &m))
        stages_place(run, &m, stage, stages, 0.0, start);
    for (size_t i = 0; i < SPHERES; i++)
        apply(G, start[i].x, start[i].u);
    snprintf(name, sizeof name, "late-%zu", number);
    snprintf(what, sizeof what, "%s, from the middle on", label);
    const bool good = track_ask(run, name, scene, start, SPHERES, at, LATE_FRAMES, &track) && stages_judge_flow(run, what, name, &m, stage, stages, &(struct rows_of_run){ begin, dt, way, every, LATE_FRAMES });
    if (good) {
        judge_carried(run, what, stage, stages, begin, every * dt, m.radius[0], start, &track);
        double turns[LONGEST + 1][3] = { { 0 } };
        expected_turns(stage, stages, begin, every * dt, &track, turns);
        track_free(&track);
        path_join(folder, run->work, name);
        path_join(out, folder, "out");
        judge_displacement(run, label, out, m.radius[0], every * dt, turns);
    }
    json_decref(scene);
    return good;
}
