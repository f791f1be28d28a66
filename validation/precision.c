/* See precision.h. */
#include "precision.h"

#include "geometry.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* A gap below this changes nothing any more: forces of overlaps are judged against that of a thousandth, lubrication ends at its inner gap. */
static double smallest_gap(const json_t *scene)
{
    double least = INFINITY;
    if (scene_get(scene, "forces.contact"))
        least = 1e-3;
    if (scene_get(scene, "forces.lubrication"))
        least = fmin(least, 0.5 * scene_number(scene, "forces.lubrication.inner_gap", 1e-3));
    if (scene_get(scene, "forces.repulsion"))
        least = fmin(least, scene_number(scene, "forces.repulsion.kappa_factor", 1e-3));
    return least;
}

struct condition { const struct state_row *row; double smallest, largest; };

static void see_pair(void *context, const struct near_pair *p)
{
    struct condition *c = context;
    const double h = fmax(fabs(p->gap), c->smallest * (p->a[0] + p->a[1]));
    const size_t sphere[2] = { p->i, p->j };
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++)
            c->largest = fmax(c->largest, (fabs(c->row[sphere[side]].x[k]) + p->a[side]) / h);
}

double question_condition(const json_t *scene, const struct state_row *row, size_t rows)
{
    struct condition c = { .row = row, .smallest = smallest_gap(scene), .largest = 1 };
    if (isfinite(c.smallest))
        near_pairs(scene, row, rows, scene_reach(scene), see_pair, &c);
    return c.largest;
}

void allow(struct check_run *run, double allowance, const char *reason, ...)
{
    va_list arguments;
    if (!(allowance > run->allowance))
        return;
    run->allowance = allowance;
    va_start(arguments, reason);
    vsnprintf(run->allowance_reason, sizeof run->allowance_reason, reason, arguments);
    va_end(arguments);
}

/* Spheres of a run come as close as they like; a hundredth of a radius is taken for what decides. */
static double run_condition(const json_t *scene, const struct state_row *row, size_t rows)
{
    double largest = 1;
    const bool pairs = scene_get(scene, "forces.contact") || scene_get(scene, "forces.lubrication") || scene_get(scene, "forces.repulsion");
    for (size_t r = 0; r < rows && pairs; r++)
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, 100 * (fabs(row[r].x[k]) / species_number(scene, row[r].species, "radius") + 1));
    return largest;
}

double question_dt(const json_t *scene)
{
    const char *name;
    json_t *integrator;
    double dt = NAN;
    json_object_foreach(scene_get(scene, "dynamics"), name, integrator)
        dt = scene_number(integrator, "dt", dt);
    return dt;
}

double question_steps(const json_t *scene)
{
    const double dt = question_dt(scene), rate = fabs(scene_number(json_array_get(scene_get(scene, "shear"), 0), "rate", NAN));
    const double steps = scene_number(scene, "run.steps", scene_number(scene, "run.time", scene_number(scene, "run.strain", NAN) / rate) / dt);
    return isfinite(steps) && steps > 1 ? round(steps) : 1e6;
}

void precision_allow(struct check_run *run, const struct question *q)
{
    const struct capabilities *c = run->candidate->capabilities;
    if (!c || c->roundoff == 0 || !json_is_object(scene_get(q->scene, "dynamics")))
        return;
    const bool moves = strcmp(q->protocol, "run") == 0;
    const double n = moves ? question_steps(q->scene) : 1;
    const double C = (moves ? run_condition : question_condition)(q->scene, q->state, q->states);
    if (moves)
        run->amplification = c->roundoff / 1.1e-16;
    allow(run, 4 * C * sqrt(n) * c->roundoff, "for %s: 4 x roundoff %.2g x condition %.3g%s", c->precision, c->roundoff, C,
          moves ? " x root of the number of steps" : "");
}

/* Of a list of gaps, or of pairs [ratio of sizes, gap]. */
static void leave_out(json_t *parameters, const char *key, double edge, double width)
{
    json_t *list = json_object_get(parameters, key);
    for (size_t k = json_array_size(list); k-- > 0;) {
        const json_t *item = json_array_get(list, k), *gap = json_array_size(item) == 2 ? json_array_get(item, 1) : item;
        if (json_is_number(gap) && fabs(json_number_value(gap) - edge) <= width)
            json_array_remove(list, k);
    }
}

json_t *precision_parameters(const struct capabilities *c, const json_t *parameters, const json_t *scene)
{
    json_t *mine = json_deep_copy(parameters);
    if (!c || c->roundoff == 0 || !mine)
        return mine;
    const double width = 40 * c->roundoff;      /* positions of up to ten sums of radii, each rounded twice */
    if (scene_get(scene, "forces.contact"))
        leave_out(mine, "xi", 0, width);
    if (scene_get(scene, "forces.lubrication")) {
        leave_out(mine, "xi", scene_number(scene, "forces.lubrication.outer_gap", NAN), width);
        leave_out(mine, "pairs", scene_number(scene, "forces.lubrication.outer_gap", NAN), width);
    }
    if (scene_get(scene, "forces.repulsion"))
        leave_out(mine, "kappas", scene_number(scene, "forces.repulsion.cutoff", NAN), width / scene_number(scene, "forces.repulsion.kappa_factor", NAN));
    return mine;
}
