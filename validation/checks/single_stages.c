/*
 * Layer 3: free spheres in flows that change with time: ramp, reversal, oscillation, rest, two shears at once
 *
 *     places, velocities and spins against theory/driven_sphere.c, extrapolated from dt, dt/2, dt/4 as two_bodies.c does
 *     stress of the drag = (5 phi) eta E(t), strain = the way travelled, at every single step
 *     rate and shear stress in the plane of the first shear that the first stage names
 *
 * The second sees what vanishes with dt: a flow that turns one step too early or too late. Stages end on steps of the coarsest run; at the very
 * steps at which a rate jumps the flow before and the flow after are right, and nothing else. Half of the spheres start with the flow and stay with it, half
 * are thrown, and all pass the faces of the cell, which the flow deforms there and back.
 */
#include "stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SPHERES = STAGES_SPHERES, REFINED = 3 };

static int axis_of(const json_t *shear, const char *key)
{
    const char *word = json_string_value(json_object_get(shear, key));
    return word ? word[0] - 'x' : 0;
}

size_t stages_read(const json_t *list, struct theory_stage stage[STAGES])
{
    size_t n, k;
    json_t *one, *shear;
    json_array_foreach(list, n, one)
    {
        struct theory_stage *at = &stage[n];
        *at = (struct theory_stage){ .duration = scene_number(one, "duration", NAN) };
        json_array_foreach(json_object_get(one, "shear"), k, shear)
        {
            const json_t *rate = json_object_get(shear, "rate"), *ramp = json_object_get(rate, "ramp");
            struct theory_rate *r = &at->shear[at->shears++];
            *r = (struct theory_rate){ .flow = axis_of(shear, "flow"), .gradient = axis_of(shear, "gradient") };
            r->mean = json_is_number(rate) ? json_number_value(rate) : scene_number(rate, "mean", 0);
            if (k == 0 && json_object_get(one, "strain"))
                at->duration = scene_number(one, "strain", NAN) / fabs(r->mean);
            r->amplitude = scene_number(rate, "amplitude", 0);
            r->frequency = scene_number(rate, "angular_frequency", 0);
            r->phase = scene_number(rate, "phase", 0);
            if (ramp) {
                r->mean = json_number_value(json_array_get(ramp, 0));
                r->slope = (json_number_value(json_array_get(ramp, 1)) - r->mean) / at->duration;
            }
        }
    }
    return json_array_size(list);
}

void stages_place(struct check_run *run, const struct model *m, const struct theory_stage *stage, size_t stages, double speed, struct state_row start[SPHERES])
{
    gsl_rng *random = pair_random(run);
    double G[3][3], way;
    theory_driven_flow(stage, stages, 0.0, G, &way);
    for (int i = 0; i < SPHERES; i++) {
        start[i] = (struct state_row){ .id = i + 1, .species = 1 };
        for (int c = 0; c < 3; c++)
            start[i].x[c] = (gsl_rng_uniform(random) + (speed > 0.0 || m->open[c] ? 0.0 : i % 5 - 2)) * m->cell[c][c];
        apply(G, start[i].x, start[i].u);
        for (int c = 0; c < 3; c++) {
            start[i].u[c] += i % 2 ? speed * (2.0 * gsl_rng_uniform(random) - 1.0) : 0.0;
            start[i].w[c] = 0.5 * (G[(c + 2) % 3][(c + 1) % 3] - G[(c + 1) % 3][(c + 2) % 3]) * (i % 2 ? -0.3 : 1.0);
        }
    }
    gsl_rng_free(random);
}

/* The flow of a row: where rates jump, that of before or after, whichever is nearer to the `count` entries that the row says. */
static void flow_of_row(const struct theory_stage *stage, size_t stages, double time, double dt, const double *said, size_t count, double unit, double G[3][3],
                        double *way)
{
    double edge = 0.0, least = INFINITY, from = time, to = time;
    for (size_t n = 0; n < stages; n++) {
        edge += stage[n].duration;
        if (fabs(time - edge) < 0.01 * dt)
            from = edge - 1e-9 * dt, to = edge + 1e-9 * dt;
    }
    for (int side = 0; side < 2; side++) {
        double flow[3][3], off = 0.0;
        theory_driven_flow(stage, stages, side ? to : from, flow, way);
        for (size_t k = 0; k < count; k++)
            off += fabs(said[k] - unit * (flow[k / 3][k % 3] + flow[k % 3][k / 3]));
        if (off < least) {
            least = off;
            memcpy(G, flow, sizeof flow);
        }
    }
}

bool stages_judge_flow(struct check_run *run, const char *drive, const char *name, const struct model *m, const struct theory_stage *stage, size_t stages,
                       const struct rows_of_run *of)
{
    const double dt = of->dt, travelled = of->travelled;
    char path[PATH_LENGTH], out[PATH_LENGTH], why[WHY_LENGTH], what[96];
    struct table t;
    struct worst stress = WORST_NONE, strain = WORST_NONE, plane = WORST_NONE;
    path_join(out, run->work, name);
    path_join(path, out, "out/stress.csv");
    if (!table_read(path, "time,strain,drag_xx,drag_xy,drag_xz,drag_yx,drag_yy,drag_yz,drag_zx,drag_zy,drag_zz", &t, why)) {
        check_garbage(run, why);
        return false;
    }
    bool good = table_expect_rows(&t, of->rows, why);
    for (size_t r = 0; r < t.rows && good; r++) {
        const double time = of->begin + (double)r * of->every * dt;
        if (!time_is(table_at(&t, r, 0), time, dt))
            good = why_not(why, "%s: row %zu is of time %g where %g is due", t.path, r + 1, table_at(&t, r, 0), time);
    }
    if (!good) {
        check_garbage(run, why);
        table_free(&t);
        return false;
    }
    const double phi = SPHERES * 4.0 / 3.0 * M_PI * gsl_pow_3(m->radius[0]) / m->volume, unit = 2.5 * phi * m->viscosity;
    double (*flow)[3][3] = calloc(t.rows + 1, sizeof *flow);
    for (size_t r = 0; r < t.rows; r++) {
        double said[9], way;
        for (size_t k = 0; k < 9; k++)
            said[k] = table_at(&t, r, 2 + k);
        flow_of_row(stage, stages, table_at(&t, r, 0), dt, said, 9, unit, flow[r], &way);
        worst_see(&strain, table_at(&t, r, 1), way - travelled, 1.0, r);
        for (size_t k = 0; k < 9; k++)
            worst_see(&stress, said[k], unit * (flow[r][k / 3][k % 3] + flow[r][k % 3][k / 3]), phi * m->viscosity, r);
    }
    const double rounding = 1e-9, pieces = 1e-5;       /* where rates jump, the flow 1e-9 dt before or after; the way is added up in pieces */
    snprintf(what, sizeof what, "%s: stress of the drag", drive);
    check_error(run, MODEL, what, stress.measured, stress.expected, stress.error, rounding, "at row %zu (time %g) the stress of the drag is %s; the flow of "
                "that moment gives that", stress.at, table_at(&t, stress.at, 0), compare(&stress));
    snprintf(what, sizeof what, "%s: strain", drive);
    check_error(run, MODEL, what, strain.measured, strain.expected, strain.error, pieces, "at row %zu (time %g) the way travelled is %s", strain.at,
                table_at(&t, strain.at, 0), compare(&strain));
    const size_t rows = t.rows;
    table_free(&t);
    path_join(path, out, "out");
    snprintf(what, sizeof what, "%s: rate and stress in the plane", drive);
    if (check_table(run, path, "viscosity.csv", "rate,shear_drag,shear", what, &t)) {
        const struct theory_rate *first = &stage[0].shear[0];
        for (size_t r = 0; r < rows; r++) {
            if (r >= t.rows) {
                worst_see(&plane, NAN, 0.0, 1.0, r);            /* a row is missing */
                break;
            }
            const double rate = flow[r][first->flow][first->gradient], shear = unit * (rate + flow[r][first->gradient][first->flow]);
            worst_see(&plane, table_at(&t, r, 0), rate, 1.0, r);
            worst_see(&plane, table_at(&t, r, 1), shear, phi * m->viscosity, r);
            worst_see(&plane, table_at(&t, r, 2), shear, phi * m->viscosity, r);
        }
        table_free(&t);
        check_error(run, MODEL, what, plane.measured, plane.expected, plane.error, rounding, "at row %zu the rate or the shear stress of viscosity.csv is %s; tables "
                    "speak of the plane of the shear that is named first", plane.at, compare(&plane));
    }
    free(flow);
    return true;
}

struct moments { const struct theory_stage *stage; size_t stages; const bool *open; double tau, spin_tau, dt, speed, rate; };

/* Places, velocities, spins, extrapolated to dt = 0. */
static bool see_all(const struct moments *o, const struct state_row *start, const int *at, const struct track track[REFINED], struct worst w[3])
{
    for (size_t s = 0; s < track[0].steps; s++)
        for (size_t i = 0; i < SPHERES; i++) {
            struct theory_sphere first = { 0 }, now;
            memcpy(first.x, start[i].x, sizeof first.x);
            memcpy(first.u, start[i].u, sizeof first.u);
            memcpy(first.w, start[i].w, sizeof first.w);
            if (!theory_driven_sphere(o->stage, o->stages, o->open, o->tau, o->spin_tau, at[s] * o->dt, &first, &now))
                return false;
            for (int c = 0; c < 9; c++) {
                const double expected = c < 3 ? now.x[c] : c < 6 ? now.u[c - 3] : now.w[c - 6], scale = c < 3 ? o->speed * o->tau : c < 6 ? o->speed : o->rate;
                double q[REFINED];
                for (int r = 0; r < REFINED; r++) {
                    const struct track_point *p = track_at(&track[r], s, i);
                    q[r] = c < 3 ? p->x[c] : c < 6 ? p->u[c - 3] : p->w[c - 6];
                }
                if (isfinite(q[0]))
                    worst_see(&w[c / 3], (4.0 * (2.0 * q[2] - q[1]) - (2.0 * q[1] - q[0])) / 3.0, expected, scale, i);
            }
        }
    return true;
}

static bool try_drive(struct check_run *run, const json_t *drive, size_t number)
{
    static const char *const names[3] = { "place", "velocity", "spin" };
    const char *label = json_string_value(json_object_get(drive, "name"));
    const json_t *parameters = run->gate_case->parameters;
    json_t *scene = variant_scene(run->gate_case, drive);
    struct theory_stage stage[STAGES];
    struct track track[REFINED] = { { 0 } };
    struct state_row start[SPHERES];
    struct worst w[3] = { WORST_NONE, WORST_NONE, WORST_NONE };
    struct model m;
    double list[16];
    int at[16];
    size_t steps;
    scene_set(scene, "stages", json_incref(json_object_get(drive, "stages")));
    const size_t stages = stages_read(json_object_get(drive, "stages"), stage);
    bool good = model_read(run, scene, &m) && stages <= STAGES;
    const struct free_sphere sphere = free_sphere(&m);
    const struct moments o = { stage, stages, m.open, sphere.mass / sphere.friction, sphere.inertia / sphere.spin_friction,
                               scene_number(parameters, "dt", NAN), scene_number(parameters, "speed", NAN), scene_number(parameters, "rate", NAN) };
    parameter_list(parameters, "at", list, &steps, 16);
    stages_place(run, &m, stage, stages, o.speed, start);
    for (int r = 0; good && r < REFINED; r++) {
        char name[64];
        for (size_t k = 0; k < steps; k++)
            at[k] = (int)list[k] << r;
        snprintf(name, sizeof name, "drive-%zu-dt-%d", number, 1 << r);
        scene_set(scene, "dynamics.verlet.dt", json_real(ldexp(o.dt, -r)));
        scene_set(scene, "output.stress", json_pack("{si}", "every", 1));
        scene_set(scene, "output.viscosity", json_pack("{si}", "every", 1));
        good = track_ask(run, name, scene, start, SPHERES, at, steps, &track[r]) && (r || stages_judge_flow(run, label, name, &m, stage, stages, &(struct rows_of_run){ 0.0, o.dt, 0.0, 1, (size_t)at[steps - 1] + 1 }));
    }
    for (size_t k = 0; k < steps; k++)
        at[k] = (int)list[k];
    if (good && !see_all(&o, start, at, track, w))
        check_garbage(run, "the reference solution did not reach its end; this is a mistake in the suite");
    for (int q = 0; good && q < 3; q++) {
        char what[96];
        snprintf(what, sizeof what, "%s: %s", label, names[q]);
        if (w[q].error < 0)
            check_skip(run, what, "trajectory.csv gives no spins (wx, wy, wz)");
        else
            check_error(run, MODEL, what, w[q].measured, w[q].expected, w[q].error, run->gate_case->tolerance,
                        "sphere %zu, %s: the %s extrapolated to dt = 0 is %s", w[q].at + 1, label, names[q], compare(&w[q]));
    }
    for (int r = 0; r < REFINED; r++)
        track_free(&track[r]);
    json_decref(scene);
    return good;
}

void stages_strain(const struct theory_stage *stage, size_t stages, double t, double S[3][3])
{
    memset(S, 0, 9 * sizeof(double));
    for (size_t n = 0; n < stages && t > 0.0; t -= stage[n++].duration)
        for (size_t k = 0; k < stage[n].shears; k++) {
            const struct theory_rate *r = &stage[n].shear[k];
            const double s = fmin(t, stage[n].duration);
            S[r->flow][r->gradient] += r->mean * s + 0.5 * r->slope * s * s;
            if (r->amplitude != 0.0)
                S[r->flow][r->gradient] += r->amplitude / r->frequency * (cos(r->phase) - cos(r->frequency * s + r->phase));
        }
}

void check_stages(struct check_run *run)
{
    size_t k;
    json_t *drive;
    json_array_foreach(json_object_get(run->gate_case->parameters, "drives"), k, drive) {
        if (!try_drive(run, drive, k + 1))
            return;
        if (json_object_get(drive, "late"))
            stages_try_late(run, drive, k + 1, scene_number(run->gate_case->parameters, "late", NAN));
    }
}
