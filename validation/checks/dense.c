/*
 * Layer 6, sheared viscosities: the candidate against stock LAMMPS on the same scene.
 *
 * Both codes start from the same random spheres, made by the gate, and shear them; the first strain is thrown away and the rest
 * averaged. A quantity is compared by the differences d_k = candidate - reference of the realisations k: starting alike, the two
 * share some of their statistical fluctuation, so that the mean of d_k is sharper than either mean. How much depends on the codes:
 * a difference grows about e-fold in a strain here, so two codes that take the same steps stay together particle by particle to the
 * end, and two that take other steps part on the way. Either way the spread of d_k says honestly what is known.
 *
 * "Agrees" is an equivalence test: the interval mean(d) +- 4 standard errors (99.7 % for 10 realisations, Student's t with 9 degrees
 * of freedom) must lie within 5 % of the reference. Two small quantities cannot be known so well in a minute and have wider margins in
 * the case: the kinetic part, and the normal stress differences, which are compared in units of the shear stress.
 */
#include "dense.h"
#include "flow.h"
#include "../offline.h"
#include "../packing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const quantity_name[FLOW_QUANTITIES] = {
    [VISCOSITY] = "relative viscosity", [CONTACT] = "contact viscosity", [KINETIC] = "kinetic viscosity", [PRESSURE] = "pressure",
    [N1] = "N1", [N2] = "N2", [DRAG] = "drag viscosity"
};
static const int compared[] = { VISCOSITY, CONTACT, KINETIC, PRESSURE, N1, N2 };
enum { COMPARED = sizeof compared / sizeof *compared };

bool dense_start_in(struct check_run *run, const json_t *scene, unsigned seed, struct dense_start *s)
{
    const json_t *par = run->gate_case->parameters;
    json_t *shear = json_array_get(json_object_get(scene, "shear"), 0);
    const json_t *species = json_object_get(scene, "species"), *counts = json_object_get(par, "counts");
    struct packing_species mix[8];
    const int kinds = (int)json_array_size(species);
    char why[WHY_LENGTH];
    *s = (struct dense_start){ .scene = json_deep_copy(scene), .phi = scene_number(par, "phi", 0.5),
                               .viscosity = scene_number(scene, "fluid.viscosity", 1),
                               .rate = scene_number(shear, "rate", 1) };
    for (int k = 0; k < kinds && k < 8; k++) {
        mix[k].radius = scene_number(json_array_get(species, (size_t)k), "radius", 1);
        mix[k].count = (int)json_integer_value(json_array_get(counts, (size_t)k));
        s->count += (size_t)mix[k].count;
    }
    s->row = calloc(s->count, sizeof *s->row);
    s->edge = packing_edge(mix, kinds, s->phi);
    if (!s->row || !packing_make(mix, kinds, s->edge, s->rate, seed, s->row, why)) {
        check_error(run, INVARIANT, "start", NAN, NAN, NAN, NAN, "the gate itself failed: %s", why);
        dense_start_free(s);
        return false;
    }
    scene_set(s->scene, "box", json_pack("{s[fff] s[bbb]}", "lengths", s->edge, s->edge, s->edge, "periodic", 1, 1, 1));
    scene_set(s->scene, "start.file", json_string("states.csv"));
    return true;
}

bool dense_start(struct check_run *run, unsigned seed, struct dense_start *s)
{
    return dense_start_in(run, run->gate_case->scene, seed, s);
}

void dense_start_free(struct dense_start *s)
{
    free(s->row);
    json_decref(s->scene);
}

bool dense_ask_both(struct check_run *run, const char *name, const struct dense_start *s, char out[2][PATH_LENGTH])
{
    const struct candidate *own = run->candidate;
    struct candidate reference = *own;
    const struct question q = { .protocol = "run", .scene = s->scene, .state = s->row, .states = s->count };
    const double seconds = run->candidate_seconds;
    char label[64];
    if (!check_ask(run, name, &q, out[0]))
        return false;
    const double after = run->candidate_seconds;
    if (offline_waits(own)) {           /* no answer yet: nothing will be judged, and the reference need not be run */
        memcpy(out[1], out[0], PATH_LENGTH);
        return true;
    }
    reference.server = NULL;            /* the reference is always started here: the candidate is not asked in its stead */
    reference.offline = NULL;
    reference.command = getenv("GATE_REFERENCE") ? getenv("GATE_REFERENCE") : "build/lammps-candidate --own reference";
    snprintf(label, sizeof label, "reference-%s", name);
    run->candidate = &reference;
    const bool good = check_ask(run, label, &q, out[1]);
    run->candidate = own;
    run->candidate_seconds = after > seconds ? after : seconds;
    if (!good && run->results.count) {  /* a missing reference is an error of the set-up, never a skip */
        struct result *r = &run->results.item[run->results.count - 1];
        char said[WHY_LENGTH + PATH_LENGTH];
        snprintf(said, sizeof said, "the reference, not the candidate, gave no answer ('%s', or name another in GATE_REFERENCE): %s",
                 reference.command, r->sentence);
        free(r->sentence);
        r->sentence = strdup(said);
        r->verdict = VERDICT_FAIL;
    }
    return good;
}

/* Mean over realisations and its standard error of plus[k] - minus[k] (`minus` may be null); offset: of the number in a flow_average. */
static double mean_at(const struct flow_average *plus, const struct flow_average *minus, size_t offset, int count, double *standard_error)
{
    double value[count];
    for (int k = 0; k < count; k++)
        value[k] = ((const double *)&plus[2 * k])[offset] - (minus ? ((const double *)&minus[2 * k])[offset] : 0);
    return mean_of(value, count, standard_error);
}

/* Contact viscosity against strain, both codes, and the steady averages, with error bars from the realisations. */
static void draw(struct check_run *run, struct result *r, const struct flow_average *a, int count, double discard, double strain)
{
    char path[PATH_LENGTH], command[PATH_LENGTH + 64];
    double error[2], value[2];
    path_join(path, run->work, "dense.gnuplot");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    fprintf(f, "set terminal svg size 960,400 enhanced font 'sans,12'\nset output 'dense.svg'\nset multiplot layout 1,2\n"
               "$bins << end\n");
    for (int b = 0; b < FLOW_BINS; b++) {
        for (int code = 0; code < 2; code++)
            value[code] = mean_at(a + code, NULL, FLOW_QUANTITIES + (size_t)b, count, &error[code]);
        fprintf(f, "%g %g %g %g %g\n", (b + 0.5) * strain / FLOW_BINS, value[0], error[0], value[1], error[1]);
    }
    fprintf(f, "end\n$steady << end\n");
    for (int c = 0; c < COMPARED; c++) {
        for (int code = 0; code < 2; code++)
            value[code] = mean_at(a + code, NULL, (size_t)compared[c], count, &error[code]);
        fprintf(f, "%d \"%s\" %g %g %g %g\n", c, quantity_name[compared[c]], value[0], error[0], value[1], error[1]);
    }
    fprintf(f, "end\nset xlabel 'strain'\nset ylabel 'contact viscosity / fluid viscosity'\nset yrange [0:*]\nset key bottom left\n"
               "set arrow from %g, graph 0 to %g, graph 1 nohead dashtype 2 lc 'gray'\n"
               "plot $bins using 1:2:3 with yerrorlines pt 7 ps 0.6 lc 'black' title 'candidate', \\\n"
               "     $bins using ($1+%g):4:5 with yerrorlines pt 6 ps 0.9 lc 'red' title 'LAMMPS (shifted sideways)'\n"
               "unset arrow\nunset xlabel\nset ylabel 'steady average / (fluid viscosity x rate)'\n"
               "set yrange [*:*]\nset xrange [-0.5:%d.5]\n"
               "set xtics rotate by -25\nset key top right\nset xzeroaxis\n"
               "plot $steady using 1:3:4:xtic(2) with yerrorbars pt 7 ps 0.6 lc 'black' title 'candidate', \\\n"
               "     $steady using ($1+0.15):5:6 with yerrorbars pt 6 ps 0.9 lc 'red' title 'LAMMPS'\n",
            discard, discard, strain / FLOW_BINS / 5, COMPARED - 1);
    fclose(f);
    snprintf(command, sizeof command, "cd '%s' && gnuplot dense.gnuplot 2>gnuplot.log", run->work);
    if (system(command) == 0)
        result_picture(r, "dense.svg");
}

/*
 * How far a mean may be from the reference's. Parts and pressure are held to a share of the shear stress, for that is what
 * they are parts of: a code that takes other steps, and so shares no scatter with the reference, can then be judged from these realisations.
 */
static double margin_of(const struct check_run *run, int quantity, double reference, double shear_stress)
{
    const json_t *par = run->gate_case->parameters;
    if (quantity == N1 || quantity == N2 || quantity == PRESSURE)
        return scene_number(par, "normal_stress_margin", 0.1) * shear_stress;
    if (quantity == KINETIC)
        return scene_number(par, "kinetic_margin", 0.2) * fabs(reference);
    return run->gate_case->tolerance * shear_stress;
}

static void judge(struct check_run *run, const struct dense_start *s, const struct flow_average *a, int count)
{
    double error, own_error, reference_error;
    const double shear_stress = fabs(mean_at(a + 1, NULL, VISCOSITY, count, &error));
    for (int c = 0; c < COMPARED; c++) {
        const int q = compared[c];
        const double difference = mean_at(a, a + 1, (size_t)q, count, &error);
        const double reference = mean_at(a + 1, NULL, (size_t)q, count, &reference_error);
        const double own = mean_at(a, NULL, (size_t)q, count, &own_error), margin = margin_of(run, q, reference, shear_stress);
        struct result *r = check_interval(run, MODEL, quantity_name[q], own, error, reference, margin,
                                          "%s is %.4g +- %.2g in the candidate and %.4g +- %.2g in LAMMPS, from the same %d starts; "
                                          "paired difference %.2g +- %.2g, margin %.2g",
                                          quantity_name[q], own, own_error, reference, reference_error, count, difference, error, margin);
        result_notes(r, "candidate %.5g +- %.2g, LAMMPS %.5g +- %.2g (one standard error from %d realisations); paired difference "
                     "%.2g +- %.2g, margin %.2g. In units of viscosity x rate.",
                     own, own_error, reference, reference_error, count, difference, error, margin);
    }
    const double drag = mean_at(a, NULL, DRAG, count, &error), expected = 2.5 * s->phi;
    check_error(run, MODEL, quantity_name[DRAG], drag, expected, fabs(drag / expected - 1), 1e-9,
                "the one-body stresslets add %.9g to the relative viscosity; Einstein's (5/2) phi is %.9g", drag, expected);
}

void dense_equivalence(struct check_run *run)
{
    const json_t *par = run->gate_case->parameters;
    const int count = (int)scene_number(par, "realisations", 8) * run->samples;
    const double discard = scene_number(par, "discard", 2), strain = scene_number(par, "strain", 12);
    struct flow_average *a = calloc(2 * (size_t)count, sizeof *a);   /* candidate and reference in turn */
    struct dense_start s = { 0 };
    bool good = a != NULL;
    for (int k = 0; good && k < count; k++) {
        char name[32], out[2][PATH_LENGTH];
        check_progress(run, "realisation %d of %d", k + 1, count);
        dense_start_free(&s);
        if (!dense_start(run, run->seed * 1000 + (unsigned)k, &s)) {
            s = (struct dense_start){ 0 };
            good = false;
            break;
        }
        scene_set(s.scene, "run", json_pack("{sf}", "strain", strain));
        scene_set(s.scene, "output.stress.every", json_integer((json_int_t)scene_number(par, "every", 20)));
        snprintf(name, sizeof name, "realisation-%d", k);
        good = dense_ask_both(run, name, &s, out);
        const struct flow flow = { .viscosity = s.viscosity, .rate = s.rate, .discard = discard, .strain = strain };
        for (int code = 0; good && code < 2; code++)
            good = flow_read(run, out[code], "contact_normal,kinetic,drag", &flow, &a[2 * k + code]);
    }
    if (good) {
        judge(run, &s, a, count);
        draw(run, &run->results.item[0], a, count, discard, strain);
    }
    dense_start_free(&s);
    free(a);
}

const struct check dense_checks[] = {
    { "dense-equivalence", dense_equivalence },
    { "dense-path", dense_path },
    { "dense-memory", dense_memory },
    { "equation-of-state", check_equation_of_state },
    { NULL, NULL },
};
