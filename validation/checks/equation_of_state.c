/*
 * Layer 6: pressure of Brownian spheres at rest
 *
 *     - tr(contact stress)/3 = n kT (Z - 1) ,   Z of Carnahan & Starling for one size, of Boublik and Mansoori et al. for a mixture
 *
 * at the thermal diameters (theory/hard_spheres.c). Equilibrium knows nothing of friction with the fluid, so this holds whatever the drag
 * and the lubrication, as long as their noise belongs to them and the integrator keeps the equilibrium; it sees the sum of everything: neighbour lists, images, the factor of the pair stress, the temperature that the contacts feel.
 *
 * Independent realisations, each from spheres placed at random without overlap with Maxwell velocities: collisions make an
 * equilibrium of that in some tens of collision times, which are discarded. One number per realisation, so that the standard
 * error needs no correlation time. The formula itself is good to 0.3 % below phi 0.45, the soft diameter to the square of its
 * correction; a realisation of N spheres has a pressure wrong by order 1/N.
 */
#include "dense.h"
#include "rest.h"
#include "statistics.h"

#include <stdlib.h>

/* Mean of - tr(contact)/3 after `discard` steps; NaN after recording what is wrong. */
static double mean_pressure(struct check_run *run, const char *out, double discard)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    struct table t;
    path_join(path, out, "stress.csv");
    if (!table_read(path, "step,contact_normal_xx,contact_normal_yy,contact_normal_zz", &t, why)) {
        check_garbage(run, why);
        return NAN;
    }
    double sum = 0.0, rows = 0.0;
    for (size_t r = 0; r < t.rows; r++)
        if (table_at(&t, r, 0) > discard) {
            sum -= (table_at(&t, r, 1) + table_at(&t, r, 2) + table_at(&t, r, 3)) / 3.0;
            rows += 1.0;
        }
    table_free(&t);
    if (rows == 0.0)
        check_garbage(run, "stress.csv ends before the transient does");
    return rows > 0.0 ? sum / rows : NAN;
}

void check_equation_of_state(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const int realisations = (int)scene_number(parameters, "realisations", 0);
    const double phi = scene_number(parameters, "phi", NAN), steps = scene_number(parameters, "steps", NAN);
    struct model m;
    double pressure[64], counts[8];
    size_t species;
    int answered = 0;
    parameter_list(parameters, "counts", counts, &species, 8);
    if (!model_read(run, run->gate_case->scene, &m) || realisations < 2 || realisations > 64 || species != m.species)
        return;
    struct rest rest = { 0 };
    double volume = NAN, kT = NAN;
    for (int k = 0; k < realisations; k++) {
        char name[32], out[PATH_LENGTH];
        if (!rest_start(run, run->gate_case->scene, parameters, phi, (run->seed + (unsigned)k) & 0xffffffffu, &rest))
            return;
        volume = rest.volume;
        kT = rest.kT;
        snprintf(name, sizeof name, "realisation-%d", k);
        check_progress(run, "realisation %d of %d", k + 1, realisations);
        scene_set(rest.scene, "run.steps", json_integer((json_int_t)steps));
        scene_set(rest.scene, "output.stress.every", json_integer((json_int_t)scene_number(parameters, "every", 1)));
        const struct question q = { .protocol = "run", .scene = rest.scene, .state = rest.row, .states = rest.count };
        if (check_ask(run, name, &q, out)) {
            pressure[k] = mean_pressure(run, out, scene_number(parameters, "discard", 0));
            answered += isfinite(pressure[k]);
        }
        rest_free(&rest);
        if (answered <= k)
            return;
    }
    double mean, sigma[8], density[8], n = 0.0, packed = 0.0;
    for (size_t k = 0; k < species; k++) {
        sigma[k] = theory_thermal_diameter(m.radius[k], m.contact.normal_stiffness, kT);
        density[k] = counts[k] / volume;
        n += density[k];
        packed += M_PI / 6.0 * density[k] * gsl_pow_3(sigma[k]);
    }
    const struct interval one = statistics_mean_interval(pressure, (size_t)realisations, 0.682689, &mean);   /* one standard error */
    const double expected = (species == 1 ? theory_carnahan_starling(packed) : theory_mixture_pressure((int)species, density, sigma)) - 1.0;
    const double measured = mean / (n * kT);
    struct result *r = check_interval(run, MODEL, "contact pressure", measured, 0.5 * (one.high - one.low) / (n * kT), expected,
                                      run->gate_case->tolerance * expected, "the contact pressure at rest is %.4g n kT; %s give %.4g at the "
                                      "thermal diameters", measured, species == 1 ? "Carnahan and Starling" : "Boublik and Mansoori et al.", expected);
    result_notes(r, "%d realisations of %.0f spheres at phi %.3g (%.4g with the thermal diameters): %.4g +- %.2g", realisations, n * volume, phi, packed,
                 measured, 0.5 * (one.high - one.low) / (n * kT));
}
