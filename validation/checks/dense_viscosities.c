/*
 * Layer 6, sheared viscosities: the candidate against LAMMPS on the same scenes, a table of points (sheared_point.h).
 *
 * Both codes start from the same random spheres, made by the gate, and shear them; the first strain is thrown away and the rest
 * averaged to one number per quantity and realisation. A quantity is compared by the differences d_k = candidate - reference of the realisations k:
 * starting alike, and with the same random numbers where there is noise, the two share their statistical fluctuation as long as their paths stay
 * together, so that the mean of d_k is sharper than either mean. Two codes that take the same steps stay together to rounding for
 * many strains, two that take other steps or draw other numbers part on the way. Either way the spread of d_k says honestly what is known.
 *
 * "Agrees" is an equivalence test: the interval mean(d) +- 4 standard errors (99 % for 5 realisations, Student's t with 4 degrees
 * of freedom) must lie within the margin. Margins: `margin` (else the case's tolerance) of the viscosity for it and its parts,
 * `normal_stress_margin` of it for pressure, N1 and N2; the same share as the viscosity's of itself for the contact number; `kinetic_margin` and
 * `temperature_margin` of themselves for kinetic stress and temperatures.
 *
 * With `gate run --keep DIR` every finished realisation is a line of DIR/<case>.csv and not computed again, and DIR/<case>-table.csv has
 * the means; a point with "dear" is listed with that text and not run.
 */
#include "kept.h"
#include "sheared_point.h"

#include <gsl/gsl_math.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* After the quantities of flow.h: contact number 2 N_c/N; <m c^2>/3 and <I w^2>/3 in kT, or in viscosity x rate x radius^3 without noise. */
enum { CONTACTS = FLOW_QUANTITIES, TEMPERATURE, SPIN, QUANTITIES };
enum { MOST_REALISATIONS = 256 };

static const struct { const char *column, *name; } quantity[QUANTITIES] = {
    [VISCOSITY] = { "viscosity", "relative viscosity" }, [CONTACT] = { "contact", "contact viscosity" },
    [LUBRICATION] = { "lubrication", "lubrication viscosity" }, [DRAG] = { "drag", "drag viscosity" },
    [KINETIC] = { "kinetic", "kinetic viscosity" }, [PRESSURE] = { "pressure", "pressure" }, [N1] = { "N1", "N1" }, [N2] = { "N2", "N2" },
    [CONTACTS] = { "contacts", "contact number" }, [TEMPERATURE] = { "temperature", "temperature" }, [SPIN] = { "spin_temperature", "temperature of spin" }
};

struct point {
    const json_t *json;
    const char *name;
    double x, phi, core_seconds[2];
    int count;                                          /* realisations */
    double value[2][QUANTITIES][MOST_REALISATIONS];    /* candidate, reference */
};

/* --- one run --- */

struct seen { double frames, contacts, temperature, spin; };

static void see(void *to, const struct dense_start *s, const struct dense_snapshot *now)
{
    struct seen *seen = to;
    double a[s->count], linear = 0, turning = 0;
    for (size_t i = 0; i < s->count; i++) {
        a[i] = dense_radius(s, i);
        const json_t *species = json_array_get(json_object_get(s->scene, "species"), (size_t)s->row[i].species - 1);
        const double m = 4 * M_PI / 3 * gsl_pow_3(a[i]) * scene_number(species, "density", 1);
        const double *u = now->u + 3 * i, *w = now->w + 3 * i, c = u[0] - s->rate * now->x[3 * i + 1], spin = w[2] + s->rate / 2;
        linear += m * (c * c + u[1] * u[1] + u[2] * u[2]);
        turning += 0.4 * m * a[i] * a[i] * (w[0] * w[0] + w[1] * w[1] + spin * spin);
    }
    size_t touching = 0;
    for (size_t i = 0; i < s->count; i++)
        for (size_t j = i + 1; j < s->count; j++) {
            double d[3];
            dense_pair(s, now, i, j, d);
            touching += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < (a[i] + a[j]) * (a[i] + a[j]);
        }
    seen->frames += 1;
    seen->contacts += 2.0 * (double)touching / (double)s->count;
    seen->temperature += linear / 3 / (double)s->count;
    seen->spin += turning / 3 / (double)s->count;
}

static bool read_run(struct check_run *run, const char *out, const struct dense_start *s, const struct flow *flow, double value[QUANTITIES])
{
    struct flow_average average, kinetic;
    struct seen seen = { 0 };
    char origins[128] = "contact_normal";
    if (scene_number(s->scene, "forces.contact.friction", 0) > 0)
        strcat(origins, ",contact_tangential");
    if (scene_get(s->scene, "forces.repulsion"))
        strcat(origins, ",repulsion");
    if (scene_get(s->scene, "forces.lubrication"))
        strcat(origins, ",lubrication");
    strcat(origins, ",drag");
    if (!flow_read(run, out, origins, flow, &average) || !flow_read(run, out, "kinetic", flow, &kinetic) ||
        !dense_snapshots(run, out, s, flow->discard, see, &seen))
        return false;
    memcpy(value, average.mean, sizeof average.mean);
    value[KINETIC] = kinetic.mean[KINETIC];
    const double kT = scene_number(s->scene, "fluid.kT", 0), unit = kT > 0 ? kT : s->viscosity * fabs(s->rate) * gsl_pow_3(dense_radius(s, 0));
    value[CONTACTS] = seen.contacts / seen.frames;
    value[TEMPERATURE] = seen.temperature / seen.frames / unit;
    value[SPIN] = seen.spin / seen.frames / unit;
    if (!scene_get(s->scene, "forces.lubrication") && !json_is_true(scene_get(s->scene, "forces.drag.torque")) &&
        !(scene_number(s->scene, "forces.contact.friction", 0) > 0))
        value[SPIN] = 0;    /* nothing turns the spheres: codes may leave their spins as they are or at zero */
    return true;
}

static bool run_point(struct check_run *run, struct point *p, int k, struct kept *kept)
{
    struct dense_start s;
    struct flow flow;
    char name[128], out[2][PATH_LENGTH], scene[17];
    double core[2], value[2][QUANTITIES];
    if (!point_start(run, p->json, k, &s, &flow))
        return false;
    p->phi = s.phi;
    kept_hash(s.scene, scene);
    bool good = true;
    if (!kept_find(kept, p->name, k, scene, core, value[0], value[1])) {
        snprintf(name, sizeof name, "%s-%d", p->name, k);
        good = dense_ask_both(run, name, &s, out, core);
        for (int code = 0; good && code < 2; code++) {
            good = read_run(run, out[code], &s, &flow, value[code]);
            folder_remove(out[code]);   /* tens of megabytes each */
        }
        if (good)
            kept_add(kept, p->name, k, scene, core, value[0], value[1]);
    }
    for (int code = 0; good && code < 2; code++) {
        p->core_seconds[code] += core[code];
        for (int q = 0; q < QUANTITIES; q++)
            p->value[code][q][k] = value[code][q];
    }
    dense_start_free(&s);
    return good;
}

/* --- judging --- */

/* Mean over realisations of the candidate's less the reference's, and its standard error. */
static double difference_of(const struct point *p, int q, double *standard_error)
{
    double d[MOST_REALISATIONS];
    for (int k = 0; k < p->count; k++)
        d[k] = p->value[0][q][k] - p->value[1][q][k];
    return mean_of(d, p->count, standard_error);
}

static double margin_of(const struct check_run *run, const struct point *p, int q, double reference, double viscosity)
{
    const double share = point_number(run, p->json, "margin", run->gate_case->tolerance);
    switch (q) {
    case N1: case N2: case PRESSURE:
        return point_number(run, p->json, "normal_stress_margin", 0.1) * viscosity;
    case KINETIC:
        return point_number(run, p->json, "kinetic_margin", 0.2) * fabs(reference);
    case TEMPERATURE: case SPIN:
        return point_number(run, p->json, "temperature_margin", 0.1) * fabs(reference);
    case CONTACTS:
        return share * reference;
    default:
        return share * viscosity;
    }
}

static void judge(struct check_run *run, const struct point *p, bool alone)
{
    const int count = p->count;
    double error, own_error, reference_error;
    char what[160];
    const double viscosity = mean_of(p->value[1][VISCOSITY], count, &error);
    for (int q = 0; q < QUANTITIES; q++) {
        const double own = mean_of(p->value[0][q], count, &own_error), reference = mean_of(p->value[1][q], count, &reference_error);
        if (q == DRAG || (own == 0 && reference == 0))
            continue;
        const double difference = difference_of(p, q, &error), margin = margin_of(run, p, q, reference, viscosity);
        snprintf(what, sizeof what, "%s%s%s", alone ? "" : p->name, alone ? "" : ": ", quantity[q].name);
        struct result *r = check_interval(run, MODEL, what, own, error, reference, margin,
                                          "%s is %.4g +- %.2g in the candidate and %.4g +- %.2g in LAMMPS, from the same %d starts; "
                                          "paired difference %.2g +- %.2g, margin %.2g",
                                          what, own, own_error, reference, reference_error, count, difference, error, margin);
        result_notes(r, "candidate %.5g +- %.2g, LAMMPS %.5g +- %.2g (one standard error from %d realisations); paired difference "
                     "%.2g +- %.2g, margin %.2g. Stresses in units of viscosity x rate.",
                     own, own_error, reference, reference_error, count, difference, error, margin);
    }
    const double drag = mean_of(p->value[0][DRAG], count, &error), expected = 2.5 * p->phi;
    snprintf(what, sizeof what, "%s%s%s", alone ? "" : p->name, alone ? "" : ": ", quantity[DRAG].name);
    check_error(run, MODEL, what, drag, expected, fabs(drag / expected - 1), 1e-9,
                "the one-body stresslets add %.9g to the relative viscosity; Einstein's (5/2) phi is %.9g", drag, expected);
}

/* --- table and picture --- */

static void write_table(const struct check_run *run, const char *path, const struct point *point, size_t points)
{
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    fprintf(f, "# %s\n# mean and standard error over the realisations; `difference`: candidate less reference, of pairs that start alike; `margin`: of the verdict\n"
               "# viscosities and stresses in units of viscosity x rate; temperatures in kT, without noise in viscosity x rate x radius^3\n"
               "# gate %s, seed %u; candidate: %s; reference: %s\n",
            run->gate_case->about, GATE_VERSION, run->seed, run->candidate->command, dense_reference());
    fprintf(f, "point,phi,x,realisations,quantity,candidate,candidate_error,reference,reference_error,difference,difference_error,margin,core_seconds,reference_core_seconds\n");
    for (size_t n = 0; n < points; n++) {
        const struct point *p = &point[n];
        const int count = p->count;
        double error[3];
        if (json_object_get(p->json, "dear"))
            continue;
        const double viscosity = mean_of(p->value[1][VISCOSITY], count, error);
        for (int q = 0; q < QUANTITIES; q++) {
            const double own = mean_of(p->value[0][q], count, &error[0]), reference = mean_of(p->value[1][q], count, &error[1]);
            const double difference = difference_of(p, q, &error[2]);
            fprintf(f, "%s,%g,%g,%d,%s,%.6g,%.2g,%.6g,%.2g,%.2g,%.2g,%.2g,%.1f,%.1f\n", p->name, p->phi, p->x, p->count, quantity[q].column, own, error[0], reference, error[1],
                    difference, error[2], q == DRAG ? 1e-9 * own : margin_of(run, p, q, reference, viscosity), p->core_seconds[0], p->core_seconds[1]);
        }
    }
    fclose(f);
}

/* Viscosity of all points, both codes, with error bars from the realisations. */
static void draw(struct check_run *run)
{
    char path[PATH_LENGTH], command[PATH_LENGTH + 64];
    path_join(path, run->work, "viscosities.gnuplot");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    fprintf(f, "set terminal svg size 760,420 enhanced font 'sans,12'\nset output 'viscosities.svg'\nset datafile separator comma\n"
               "set ylabel 'relative viscosity and its parts'\nset yrange [0:*]\nset key top left\nset offsets 0.5, 0.5, 0, 0\n"
               "set xtics rotate by -25\n"
               "parts = 'viscosity contact lubrication'\n"
               "plot for [q in parts] 'table.csv' using (column('point') eq '' || strcol('quantity') ne q ? 1/0 : floor(column(0)/%d)):'candidate':"
               "'candidate_error':xtic(strcol('point')) with yerrorbars pt 7 ps 0.6 title q, \\\n"
               "     for [q in parts] 'table.csv' using (strcol('quantity') ne q ? 1/0 : floor(column(0)/%d) + 0.15):'reference':'reference_error' "
               "with yerrorbars pt 6 ps 0.9 title q.', LAMMPS'\n", QUANTITIES, QUANTITIES);
    fclose(f);
    snprintf(command, sizeof command, "cd '%s' && gnuplot viscosities.gnuplot 2>gnuplot.log", run->work);
    if (system(command) == 0)
        result_picture(&run->results.item[0], "viscosities.svg");
}

static void columns(char text[512])
{
    text[0] = '\0';
    for (int q = 0; q < QUANTITIES; q++) {
        strcat(text, q ? "," : "");
        strcat(text, quantity[q].column);
    }
}

void dense_viscosities(struct check_run *run)
{
    const json_t *list = json_object_get(run->gate_case->parameters, "points"), *json;
    const size_t points = json_array_size(list);
    struct point *point = calloc(points, sizeof *point);
    struct kept kept;
    char path[PATH_LENGTH], names[512];
    size_t n;
    columns(names);
    bool good = point && kept_open(&kept, run, names, QUANTITIES);
    json_array_foreach (list, n, json) {
        if (!good)
            break;
        point[n] = (struct point){ .json = json, .name = json_string_value(json_object_get(json, "name")), .x = scene_number(json, "x", NAN) };
        const int count = point[n].count = GSL_MIN((int)point_number(run, json, "realisations", 5) * run->samples, MOST_REALISATIONS);
        const char *dear = json_string_value(json_object_get(json, "dear"));
        for (int k = 0; good && !dear && k < count; k++) {
            check_progress(run, "%s, realisation %d of %d", point[n].name, k + 1, count);
            good = run_point(run, &point[n], k, &kept);
        }
        if (good && dear)
            check_skip(run, point[n].name, "%s: not run, %s", point[n].name, dear);
        else if (good)
            judge(run, &point[n], points == 1);
    }
    if (good) {
        path_join(path, run->work, "table.csv");
        write_table(run, path, point, points);
        draw(run);
        if (run->keep) {
            char file[160];
            snprintf(file, sizeof file, "%s-table.csv", run->gate_case->name);
            path_join(path, run->keep, file);
            write_table(run, path, point, points);
        }
    }
    if (point)
        kept_close(&kept);
    free(point);
}
