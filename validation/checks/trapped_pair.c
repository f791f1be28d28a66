/*
 * Layer 4: potential of mean force of two Brownian spheres, resolved in the gap
 *
 *     p(r) dr ~ r exp(-[U(h) + (kappa/2) (r - r_0)^2]/kT) (1 - exp(-2 kappa r r_0/kT)) g(h) dr
 *
 *     U = k_n h^2/2 in overlap, 0 outside; h = r - 2 a            kappa = k/2, k the stiffness of the tether of each sphere
 *     r_0                        distance of the two anchors      g     what the scheme adds: 1 if it samples Boltzmann's distribution
 *
 * (the tether's Gaussian of the vector r, integrated over its directions). Both spheres are tethered where they start, near contact, so a pair
 * stays where its distribution is asked for and can be watched for as long as one likes: nothing leaks out of a shell (boltzmann.c).
 * Friction cannot appear in the distribution. In schemes that take it explicitly it does, by closed forms of eps(h) = X_A(h) dt/m_eff, for friction
 * that changes little in the displacement of one step:
 *
 *     verlet            g = 1 - eps/2                                half-step velocities, which move the particles, are hotter by 1/(1 - eps/2)
 *     predicted_verlet  g = (1 - eps)^(1/3) (1 + eps/2)^(2/3)        from the balance of momentum to first order in the gradient of friction
 *     split             g = 1
 *
 * Many pairs, each alone; per pair the share of its samples in each bin is one number, so standard errors need no correlation time.
 * Source: Li (2026) Fig 4.1 for the potential (flat outside contact, the spring inside).
 */
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 20000, BINS = 16, CURVE = 32 };

struct trap {
    struct model m;
    double radius, mass, inertia, stiffness, kappa, kT, centre /* gap of the anchors */, dt;
    const char *scheme;
    double low, width;                                  /* of the quadrature over the gap */
    double edge[BINS + 1];                              /* of the bins; the first reaches down, the last up to all */
    size_t bins;
};

static double bias(const struct trap *t, double h)
{
    double c[THEORY_SCALARS];
    theory_scalars(&t->m.lubrication, t->radius, t->radius, 2.0 * t->radius + h, c);
    const double eps = c[THEORY_XA] * t->dt / (0.5 * t->mass);
    if (strcmp(t->scheme, "verlet") == 0)
        return 1.0 - 0.5 * eps;
    return strcmp(t->scheme, "predicted_verlet") == 0 ? cbrt((1.0 - eps) * gsl_pow_2(1.0 + 0.5 * eps)) : 1.0;
}

static double weight(const struct trap *t, double h)
{
    const double r = 2.0 * t->radius + h, r_0 = 2.0 * t->radius + t->centre, U = h < 0.0 ? 0.5 * t->stiffness * h * h : 0.0;
    return r * exp(-(U + 0.5 * t->kappa * gsl_pow_2(r - r_0)) / t->kT) * (1.0 - exp(-2.0 * t->kappa * r * r_0 / t->kT));
}

/* Shares of all pairs between gaps, as Boltzmann says, or as the scheme is predicted to give. */
static double share_between(const struct trap *t, double from, double to, bool predicted)
{
    double sum = 0.0, all = 0.0;
    for (int k = 0; k < CELLS; k++) {
        const double h = t->low + (k + 0.5) * t->width, w = weight(t, h) * (predicted ? bias(t, h) : 1.0);
        all += w;
        sum += h >= from && h < to ? w : 0.0;
    }
    return sum / all;
}

static bool trap_make(struct check_run *run, const json_t *scene, struct trap *t)
{
    const json_t *p = run->gate_case->parameters;
    char path[64];
    if (!model_read(run, scene, &t->m))
        return false;
    const struct free_sphere sphere = free_sphere(&t->m);
    t->radius = sphere.radius;
    t->mass = sphere.mass;
    t->inertia = sphere.inertia;
    t->stiffness = t->m.contact.normal_stiffness;
    t->kT = scene_number(scene, "fluid.kT", NAN);
    t->kappa = 0.5 * scene_number(scene, "forces.tether.sphere.stiffness", NAN);
    t->centre = scene_number(p, "centre", NAN);
    t->scheme = json_object_iter_key(json_object_iter(scene_get(scene, "dynamics")));
    snprintf(path, sizeof path, "dynamics.%s.dt", t->scheme);
    t->dt = scene_number(scene, path, NAN);
    const double wide = sqrt(t->kT / t->kappa);
    t->low = -8.0 * sqrt(t->kT / t->stiffness);             /* a weight of e^-32 lies beyond either end */
    t->width = (t->centre + 8.0 * wide - t->low) / CELLS;
    parameter_list(p, "edges", t->edge + 1, &t->bins, BINS - 1);
    t->edge[0] = -INFINITY;
    t->edge[++t->bins] = INFINITY;
    return true;
}

static struct state_row *start_trapped(struct check_run *run, const struct trap *t, size_t pairs, double spacing, size_t across)
{
    struct state_row *row = calloc(2 * pairs, sizeof *row);
    gsl_rng *random = pair_random(run);
    for (size_t k = 0; row && k < 2 * pairs; k += 2) {
        const size_t cell[3] = { k / 2 % across, k / 2 / across % across, k / 2 / across / across };
        double n[3];
        random_direction(random, n);
        for (size_t side = 0; side < 2; side++) {
            struct state_row *r = &row[k + side];
            *r = (struct state_row){ .id = (int)(k + side) + 1, .species = 1 };
            for (int c = 0; c < 3; c++)
                r->x[c] = spacing * ((double)cell[c] + 0.5) + (side ? 0.5 : -0.5) * (2.0 * t->radius + t->centre) * n[c];
            random_vector(random, sqrt(t->kT / t->mass), r->u);
            random_vector(random, sqrt(t->kT / t->inertia), r->w);
        }
    }
    gsl_rng_free(random);
    return row;
}

/* Share of the samples of each pair between two gaps: mean over pairs and its standard error. */
static double share_seen(const struct track *track, const struct trap *t, double from, double to, double *error)
{
    const size_t pairs = track->count / 2;
    double sum = 0.0, squares = 0.0;
    for (size_t k = 0; k < pairs; k++) {
        double own = 0.0;
        for (size_t s = 0; s < track->steps; s++) {
            const struct track_point *p = track_at(track, s, 2 * k), *q = track_at(track, s, 2 * k + 1);
            const double r[3] = { q->x[0] - p->x[0], q->x[1] - p->x[1], q->x[2] - p->x[2] }, h = norm(r) - 2.0 * t->radius;
            own += h >= from && h < to ? 1.0 / (double)track->steps : 0.0;
        }
        sum += own;
        squares += own * own;
    }
    const double n = (double)pairs, mean = sum / n;
    *error = sqrt((squares / n - mean * mean) / (n - 1.0));
    return mean;
}

/* pmf.csv and its picture: -kT ln(share of a bin over the share that r dr and the tether alone would give it). */
static void draw_potential(struct check_run *run, const struct trap *t, const struct track *track)
{
    struct trap flat = *t;
    char path[PATH_LENGTH], command[PATH_LENGTH + 64];
    const double from = -2.5 * sqrt(t->kT / t->stiffness), width = (t->centre + 2.0 * sqrt(t->kT / t->kappa) - from) / CURVE;
    path_join(path, run->work, "pmf.csv");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    flat.stiffness = 0.0;
    const double gauge = share_between(&flat, 0.0, INFINITY, false) / share_between(t, 0.0, INFINITY, false);   /* U = 0 outside contact */
    fprintf(f, "# gate: %s, %s, dt %g, %zu pairs\ngap,potential_over_kT,error,predicted,spring\n", run->gate_case->name, t->scheme, t->dt, track->count / 2);
    for (int b = 0; b < CURVE; b++) {
        const double a = from + b * width, middle = a + 0.5 * width, boltzmann = share_between(t, a, a + width, false);
        const double ideal = share_between(&flat, a, a + width, false) / gauge, spring = -log(boltzmann / ideal);
        double error;
        const double seen = share_seen(track, t, a, a + width, &error);
        if (seen > 0.0)
            fprintf(f, "%.6g,%.6g,%.3g,%.6g,%.6g\n", middle, -log(seen / ideal), error / seen,
                    -log(share_between(t, a, a + width, true) / ideal), spring);
    }
    fclose(f);
    path_join(path, run->work, "pmf.gnuplot");
    if (!(f = fopen(path, "w")))
        return;
    fprintf(f, "set terminal svg size 640,400 enhanced font 'sans,12'\nset output 'pmf.svg'\nset datafile separator ','\nset key top right\n"
               "set xlabel 'gap'\nset ylabel 'potential of mean force / kT'\nplot 'pmf.csv' using 1:5 with lines title 'Boltzmann', "
               "'' using 1:4 with lines dt 2 title 'predicted for %s', '' using 1:2:3 with yerrorbars pt 7 ps 0.6 title 'candidate'\n", t->scheme);
    fclose(f);
    snprintf(command, sizeof command, "cd '%s' && gnuplot pmf.gnuplot 2>gnuplot.log", run->work);
    if (system(command) == 0 && run->results.count > 0)
        result_picture(&run->results.item[0], "pmf.svg");
}

static void judge_share(struct check_run *run, const struct trap *t, const struct track *track, double from, double to, double margin)
{
    char name[80];
    double error;
    const double boltzmann = share_between(t, from, to, false), predicted = share_between(t, from, to, true) / boltzmann;
    const double seen = share_seen(track, t, from, to, &error);
    if (isinf(from))
        snprintf(name, sizeof name, "pairs below gap %g", to);
    else if (isinf(to))
        snprintf(name, sizeof name, "pairs beyond gap %g", from);
    else
        snprintf(name, sizeof name, "pairs at gaps %g to %g", from, to);
    struct result *r = check_interval(run, INVARIANT, name, seen / boltzmann, error / boltzmann, predicted, margin,
                                      "%s are %.4g +- %.2g of Boltzmann's number; %s with this step should give %.4g", name, seen / boltzmann,
                                      error / boltzmann, t->scheme, predicted);
    result_notes(r, "%.4g of all samples, %.5g +- %.2g of Boltzmann's number; X_A dt/m_eff in contact is such that g there is %.4g before normalisation",
                 seen, seen / boltzmann, error / boltzmann, bias(t, 0.0));
}

void check_trapped_pair(struct check_run *run)
{
    const json_t *p = run->gate_case->parameters;
    const size_t pairs = (size_t)run->samples * (size_t)scene_number(p, "pairs", 0), across = (size_t)ceil(cbrt((double)pairs));
    const double spacing = scene_number(p, "spacing", NAN), edge = spacing * (double)across;
    const int first = (int)scene_number(p, "first", 0), every = (int)scene_number(p, "every", 1);
    enum { SAMPLES = 64 };
    int at[SAMPLES];
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct trap t;
    struct track track;
    for (int k = 0; k < SAMPLES; k++)
        at[k] = first + k * every;
    scene_set(scene, "seed", json_integer(run->seed));
    scene_set(scene, "box.lengths", json_pack("[fff]", edge, edge, edge));
    if (trap_make(run, scene, &t)) {
        struct state_row *start = start_trapped(run, &t, pairs, spacing, across);
        if (start && track_ask(run, "pairs", scene, start, 2 * pairs, at, SAMPLES, &track)) {
            const double near = t.edge[(int)scene_number(p, "near_bins", 1)], coarse = scene_number(p, "bin_margin", NAN);
            judge_share(run, &t, &track, -INFINITY, near, run->gate_case->tolerance);
            for (size_t b = 0; b < t.bins; b++)
                judge_share(run, &t, &track, t.edge[b], t.edge[b + 1], coarse);
            draw_potential(run, &t, &track);
            track_free(&track);
        }
        free(start);
    }
    json_decref(scene);
}
