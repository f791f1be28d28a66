/*
 * Layer 7, published curves of sheared suspensions: what Li (2026), chapter 4, says of them, asked of the candidate.
 *
 * A case lists points, each its scene with some numbers changed, and claims about them. All points of a realisation start from the
 * same spheres; the first `discard` of strain is thrown away and the rest averaged to one number per quantity and realisation,
 * so that errors need no correlation time: they are the spread over realisations, and of a ratio R = <A>/<B> or a difference
 * that of the pairs A_k - R B_k, in which what the starts share cancels.
 *
 * A claim says that a quantity (its value, its ratio `over` another point or another quantity, or `less` that of another point) lies from
 * `low` to `high`: the interval of four standard errors must lie inside (an equivalence test). Published figures are pictures, so most claims
 * are orderings and have wide bounds on the far side; those on the near side are the statement.
 *
 * realisations.csv (written as the runs end), points.csv and structure.csv stay in the case's work folder.
 */
#include "published_shear.h"
#include "sheared_point.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_POINTS = 16, MOST_REALISATIONS = 64 };

static const char *const quantity_name[POINT_QUANTITIES] = {
    [VISCOSITY] = "viscosity", [CONTACT] = "contact", [LUBRICATION] = "lubrication", [DRAG] = "drag", [KINETIC] = "kinetic",
    [PRESSURE] = "pressure", [N1] = "N1", [N2] = "N2", [ANISOTROPY] = "anisotropy",
    [ANISOTROPY_CONTACT] = "anisotropy_contact", [FABRIC] = "fabric", [STRUCTURAL] = "structural",
    [STRUCTURAL_THIN] = "structural_thin", [STRUCTURAL_ZERO] = "structural_zero", [OVERLAP] = "overlap",
    [PEAK_11] = "peak_11", [PEAK_12] = "peak_12", [PEAK_22] = "peak_22"
};

struct point {
    const char *name;
    const json_t *json;
    double value[POINT_QUANTITIES][MOST_REALISATIONS];   /* NaN: not measured */
    double x, core_seconds;
    struct structure structure;
};

static bool run_point(struct check_run *run, struct point *p, int k)
{
    struct dense_start s;
    char name[128], out[PATH_LENGTH];
    double value[POINT_QUANTITIES];
    struct flow_average average;
    struct flow flow;
    if (!point_start(run, p->json, k, &s, &flow))
        return false;
    for (int q = 0; q < POINT_QUANTITIES; q++)
        value[q] = NAN;
    snprintf(name, sizeof name, "%s-%d", p->name, k);
    const struct question question = { .protocol = "run", .scene = s.scene, .state = s.row, .states = s.count };
    const double before = children_seconds();
    bool good = check_ask(run, name, &question, out);
    p->core_seconds += children_seconds() - before;
    const bool friction = scene_number(s.scene, "forces.contact.friction", 0) > 0;
    const char *origins = friction ? "contact_normal,contact_tangential,lubrication,drag" : "contact_normal,lubrication,drag";
    good = good && flow_read(run, out, origins, &flow, &average);
    for (int q = 0; good && q < FLOW_QUANTITIES; q++)
        value[q] = average.mean[q];
    good = good && flow_read(run, out, "kinetic", &flow, &average);
    value[KINETIC] = good ? average.mean[KINETIC] : NAN;
    if (good && point_number(run, p->json, "snapshots", 0) > 0)
        good = structure_read(run, out, &s, flow.discard, value, &p->structure);
    for (int q = 0; q < POINT_QUANTITIES; q++)
        p->value[q][k] = value[q];
    folder_remove(out);     /* tables of a long run: tens of megabytes each */
    dense_start_free(&s);
    return good;
}

/* --- tables --- */

static void provenance(FILE *f, const struct check_run *run, const char *what)
{
    fprintf(f, "# %s\n# gate %s, case %s, seed %u, candidate: %s\n", what, GATE_VERSION, run->gate_case->name, run->seed, run->candidate->command);
}

static void write_realisation(const struct check_run *run, const struct point *p, int k, bool first)
{
    char path[PATH_LENGTH];
    path_join(path, run->work, "realisations.csv");
    FILE *f = fopen(path, first ? "w" : "a");
    if (!f)
        return;
    if (first) {
        provenance(f, run, "steady averages of single realisations");
        fprintf(f, "point,x,realisation");
        for (int q = 0; q < POINT_QUANTITIES; q++)
            fprintf(f, ",%s", quantity_name[q]);
        fprintf(f, "\n");
    }
    fprintf(f, "%s,%g,%d", p->name, p->x, k);
    for (int q = 0; q < POINT_QUANTITIES; q++)
        fprintf(f, ",%.6g", p->value[q][k]);
    fprintf(f, "\n");
    fclose(f);
}

static void write_points(const struct check_run *run, const struct point *point, int points, int count)
{
    char path[PATH_LENGTH];
    path_join(path, run->work, "points.csv");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    provenance(f, run, "mean and standard error (spread over realisations); viscosities in units of the fluid's, stresses of viscosity x rate");
    fprintf(f, "point,x,realisations,core_seconds");
    for (int q = 0; q < POINT_QUANTITIES; q++)
        fprintf(f, ",%s,%s_error", quantity_name[q], quantity_name[q]);
    fprintf(f, "\n");
    for (int k = 0; k < points; k++) {
        fprintf(f, "%s,%g,%d,%.1f", point[k].name, point[k].x, count, point[k].core_seconds);
        for (int q = 0; q < POINT_QUANTITIES; q++) {
            double error;
            const double mean = mean_of(point[k].value[q], count, &error);
            fprintf(f, ",%.5g,%.2g", mean, error);
        }
        fprintf(f, "\n");
    }
    fclose(f);
}

static void write_structure(const struct check_run *run, const struct point *point, int points)
{
    char path[PATH_LENGTH];
    path_join(path, run->work, "structure.csv");
    FILE *f = points && point[0].structure.snapshots > 0 ? fopen(path, "w") : NULL;
    if (!f)
        return;
    provenance(f, run, "kind g: all pairs, at distance r in radii of the first species; kind ring: density of pairs nearer than xi = 0.05 against "
               "the angle from the flow in turns, 1 where all directions are alike");
    fprintf(f, "kind,at");
    for (int k = 0; k < points; k++)
        fprintf(f, ",%s", point[k].name);
    for (int b = 0; b < STRUCTURE_BINS; b++) {
        fprintf(f, "\ng,%.4g", (b + 0.5) * STRUCTURE_RANGE / STRUCTURE_BINS);
        for (int k = 0; k < points; k++)
            fprintf(f, ",%.4g", point[k].structure.g[b] / point[k].structure.snapshots);
    }
    for (int b = 0; b < STRUCTURE_ANGLES; b++) {
        fprintf(f, "\nring,%.4g", (b + 0.5) / STRUCTURE_ANGLES);
        for (int k = 0; k < points; k++)
            fprintf(f, ",%.4g", point[k].structure.ring[b] / point[k].structure.snapshots);
    }
    fprintf(f, "\n");
    fclose(f);
}

/* --- claims --- */

static int quantity_named(const char *name)
{
    for (int q = 0; name && q < POINT_QUANTITIES; q++)
        if (strcmp(name, quantity_name[q]) == 0)
            return q;
    return -1;
}

static const struct point *point_named(const struct point *point, int points, const char *name)
{
    for (int k = 0; name && k < points; k++)
        if (strcmp(name, point[k].name) == 0)
            return &point[k];
    return NULL;
}

static void judge(struct check_run *run, const json_t *claim, const struct point *point, int points, int count)
{
    const char *what = json_string_value(json_object_get(claim, "what")), *over = json_string_value(json_object_get(claim, "over"));
    const char *less = json_string_value(json_object_get(claim, "less")), *other = json_string_value(json_object_get(claim, "over_quantity"));
    const char *of = json_string_value(json_object_get(claim, "of"));
    const int q = quantity_named(json_string_value(json_object_get(claim, "quantity"))), r = other ? quantity_named(other) : q;
    const struct point *a = point_named(point, points, of);
    const struct point *b = over || less || other ? point_named(point, points, over ? over : less ? less : of) : NULL;
    const double low = scene_number(claim, "low", NAN), high = scene_number(claim, "high", NAN);
    if (!what || q < 0 || r < 0 || !a || ((over || less || other) && !b) || !(low < high)) {
        check_error(run, MODEL, what ? what : "claim", NAN, NAN, NAN, NAN,
                    "the case itself is wrong: this claim names no point or quantity, or no bounds");
        return;
    }
    double error, base_error, value[MOST_REALISATIONS], measured = mean_of(a->value[q], count, &error);
    const double base = b ? mean_of(b->value[r], count, &base_error) : NAN, alone = measured, alone_error = error;
    if (b && !less) {   /* <A>/<B>: to first order its scatter is that of (A_k - R B_k)/<B> */
        measured /= base;
        for (int k = 0; k < count; k++)
            value[k] = (a->value[q][k] - measured * b->value[r][k]) / base;
        mean_of(value, count, &error);
    } else if (b) {
        for (int k = 0; k < count; k++)
            value[k] = a->value[q][k] - b->value[r][k];
        measured = mean_of(value, count, &error);
    }
    struct result *result = check_interval(run, MODEL, what, measured, error, (low + high) / 2, (high - low) / 2,
                                           "%s: %.4g +- %.2g, stated from %.4g to %.4g", what, measured, error, low, high);
    if (b)
        result_notes(result, "%s %s: %.4g +- %.2g; %s %s: %.4g +- %.2g; %d realisations, one standard error", a->name, quantity_name[q], alone,
                     alone_error, b->name, quantity_name[r], base, base_error, count);
    else
        result_notes(result, "%s %s: %.4g +- %.2g from %d realisations, one standard error", a->name, quantity_name[q], alone, alone_error, count);
}

/* Viscosity and its parts against x, error bars from the realisations. */
static void draw(struct check_run *run)
{
    char path[PATH_LENGTH], command[PATH_LENGTH + 64];
    const char *label = json_string_value(json_object_get(run->gate_case->parameters, "x"));
    path_join(path, run->work, "flow.gnuplot");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    fprintf(f, "set terminal svg size 640,420 enhanced font 'sans,12'\nset output 'flow.svg'\nset datafile separator comma\n"
               "set logscale x\nset format x '10^{%%T}'\nset xlabel '%s'\nset ylabel 'viscosity / fluid viscosity'\nset yrange [0:*]\n"
               "set offsets graph 0.1, graph 0.1, 0, 0\nplot for [q in 'viscosity contact lubrication'] 'points.csv' using "
               "(column('x')):(column(q)):(column(q.'_error')) with yerrorbars pt 7 ps 0.7 title q\n", label ? label : "x");
    fclose(f);
    snprintf(command, sizeof command, "cd '%s' && gnuplot flow.gnuplot 2>gnuplot.log", run->work);
    if (system(command) == 0)
        result_picture(&run->results.item[0], "flow.svg");
}

static void published_shear(struct check_run *run)
{
    const json_t *list = json_object_get(run->gate_case->parameters, "points"), *claims = json_object_get(run->gate_case->parameters, "claims"), *json;
    const int points = (int)json_array_size(list), count = (int)scene_number(run->gate_case->parameters, "realisations", 4) * run->samples;
    struct point *point = calloc(MOST_POINTS, sizeof *point);
    size_t index;
    bool good = point && points <= MOST_POINTS && count <= MOST_REALISATIONS;
    json_array_foreach (list, index, json)
        if (good)
            point[index] = (struct point){ .name = json_string_value(json_object_get(json, "name")), .json = json, .x = scene_number(json, "x", NAN) };
    for (int k = 0; good && k < count; k++)
        for (int n = 0; good && n < points; n++) {
            check_progress(run, "realisation %d of %d, %s", k + 1, count, point[n].name);
            good = run_point(run, &point[n], k);
            write_realisation(run, &point[n], k, k == 0 && n == 0);
        }
    if (good) {
        write_points(run, point, points, count);
        write_structure(run, point, points);
        json_array_foreach (claims, index, json)
            judge(run, json, point, points, count);
        if (run->results.count)
            draw(run);
    }
    free(point);
}

const struct check published_shear_checks[] = {
    { "published-shear", published_shear },
    { NULL, NULL },
};
