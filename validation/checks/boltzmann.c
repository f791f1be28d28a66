/*
 * Layer 4: Brownian pairs near contact keep the Boltzmann distribution
 *
 *     p(r) dr ~ r^2 exp(-U(h)/kT) dr ,   U = k_n h^2/2 in overlap, 0 outside
 *
 * whatever the friction does with the gap. Friction cannot appear in an equilibrium distribution; in explicit schemes it does, since a
 * half step of velocity is hotter by 1/(1 - eps/2), eps = X_A(h) dt/m_eff, where the friction is larger, and pairs are
 * rarer there by 1 - eps/2 (a spurious repulsion). Noise of the wrong size or friction taken elsewhere than its noise do the same.
 *
 * Waiting for a pair to sample its potential takes a million steps. Instead thousands of pairs, each alone, start from the exact
 * distribution in a thin shell h < H, stratified, with Maxwell velocities; then nothing may change near contact. (At the edge the
 * shell loses pairs and gets none back; it is so thick that this does not reach the near zone in the time of the run.) Per pair the
 * time average of how near it is to contact, 1 in contact and less outside, is one number. Pairs are independent; neighbours in the
 * stratified order start at nearly the same gap, so half their mean square difference is the variance (a little too large).
 *
 * Judged: the mean nearness, and, less sharply, the share in contact, against Boltzmann's. The null band is 1 - eps/2 to 1, since an
 * explicit scheme may have its bias, which is small at the step of the case. What is not asked: the depletion at a large step. It takes
 * long to build up, and by then a shell leaks.
 */
#include "statistics.h"
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 4000 };     /* of the table of the distribution: midpoint rule, good to 1e-6 */

struct shell {
    struct model m;
    double radius, mass, inertia, stiffness, kT, low, high, width;  /* gaps from low to high in CELLS cells */
    double weight[CELLS + 1];                                       /* cumulative */
    double eps;
};

static double friction_at(const struct shell *s, double h)
{
    double c[THEORY_SCALARS];
    theory_scalars(&s->m.lubrication, s->radius, s->radius, 2.0 * s->radius + h, c);
    return c[THEORY_XA];
}

static double boltzmann(const struct shell *s, double h)
{
    const double r = 2.0 * s->radius + h, energy = h < 0.0 ? 0.5 * s->stiffness * h * h : 0.0;
    return r * r * exp(-energy / s->kT);
}

static bool shell_make(struct check_run *run, const json_t *scene, struct shell *s)
{
    if (!model_read(run, scene, &s->m))
        return false;
    const struct free_sphere sphere = free_sphere(&s->m);
    s->radius = sphere.radius;
    s->mass = sphere.mass;
    s->inertia = sphere.inertia;
    s->stiffness = s->m.contact.normal_stiffness;
    s->kT = scene_number(scene, "fluid.kT", NAN);
    s->eps = scene_number(run->gate_case->parameters, "eps", NAN);
    s->low = -7.0 * sqrt(s->kT / s->stiffness);     /* a weight of e^-24 lies beyond */
    s->high = scene_number(run->gate_case->parameters, "shell", NAN);
    s->width = (s->high - s->low) / CELLS;
    for (int k = 0; k < CELLS; k++)
        s->weight[k + 1] = s->weight[k] + boltzmann(s, s->low + (k + 0.5) * s->width);
    return true;
}

/*
 * How near to contact, 1 in contact to 0 at three quarters of the shell: as its friction, for that is how errors of a scheme or of the noise
 * are distributed. Nothing beyond counts, so that the
 * shell may lose pairs at its edge (in the case of the suite they cost the mean 0.3 %).
 */
static double nearness(const struct shell *s, double h)
{
    const double none = friction_at(s, 0.75 * s->high);
    return fmax(0.0, (friction_at(s, h) - none) / (friction_at(s, 0.0) - none));
}

static double in_contact(const struct shell *s, double h)
{
    (void)s;
    return h < 0.0 ? 1.0 : 0.0;
}

static double mean_over_shell(const struct shell *s, double (*of)(const struct shell *, double))
{
    double sum = 0.0;
    for (int k = 0; k < CELLS; k++) {
        const double h = s->low + (k + 0.5) * s->width;
        sum += of(s, h) * boltzmann(s, h);
    }
    return sum / s->weight[CELLS];
}

/* The gap below which a share u of the pairs lies. */
static double gap_at(const struct shell *s, double u)
{
    int low = 0, high = CELLS;
    const double wanted = u * s->weight[CELLS];
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        *(s->weight[middle] <= wanted ? &low : &high) = middle;
    }
    return s->low + s->width * (low + (wanted - s->weight[low]) / (s->weight[high] - s->weight[low]));
}

/* Pairs on a lattice of cells of their own, so far apart that they never meet. */
static struct state_row *start_pairs(struct check_run *run, const struct shell *s, size_t pairs, double spacing, size_t across)
{
    struct state_row *row = calloc(2 * pairs, sizeof *row);
    gsl_rng *random = pair_random(run);
    for (size_t k = 0; row && k < pairs; k++) {
        const size_t cell[3] = { k % across, k / across % across, k / across / across };
        const double h = gap_at(s, ((double)k + gsl_rng_uniform(random)) / (double)pairs);
        double n[3];
        random_direction(random, n);
        for (size_t side = 0; side < 2; side++) {
            struct state_row *r = &row[2 * k + side];
            *r = (struct state_row){ .id = (int)(2 * k + side) + 1, .species = 1 };
            for (int c = 0; c < 3; c++)
                r->x[c] = spacing * ((double)cell[c] + 0.5) + (side ? 0.5 : -0.5) * (2.0 * s->radius + h) * n[c];
            random_vector(random, sqrt(s->kT / s->mass), r->u);
            random_vector(random, sqrt(s->kT / s->inertia), r->w);
        }
    }
    gsl_rng_free(random);
    return row;
}

struct share { double mean, error; };

/* Mean over pairs of a number of each, and its error from neighbours in the stratified order. */
static struct share mean_of(const double *own, size_t pairs)
{
    double sum = 0.0, squares = 0.0;
    for (size_t k = 0; k < pairs; k++) {
        sum += own[k];
        squares += k ? 0.5 * gsl_pow_2(own[k] - own[k - 1]) : 0.0;
    }
    const double n = (double)pairs;
    return (struct share){ sum / n, sqrt(squares * n / (n - 1.0)) / n };
}

static void judge(struct check_run *run, const struct shell *s, const char *what, const char *key, const double *own, size_t pairs,
                  double exact)
{
    const double seen = 5.9;   /* standard deviations: 3.9 to alarm, 2 to be sure */
    const struct share share = mean_of(own, pairs);
    char path[64], name[64];
    snprintf(path, sizeof path, "declared.%s", key);
    snprintf(name, sizeof name, "pairs %s", what);
    const double ratio = share.mean / exact, error = share.error / exact;
    const double outside = ratio > 1.0 ? ratio - 1.0 : fmax(0.0, 1.0 - 0.5 * s->eps - ratio);
    struct result *r = check_p(run, INVARIANT, name, ratio, 1.0, statistics_normal_p(outside / error), 0.5 * s->eps + seen * error,
                               scene_number(run->gate_case->parameters, path, NAN),
                               "pairs %s are %.4g +- %.2g of Boltzmann's number: friction and noise push pairs %s; a wrong temperature of the "
                               "contact, noise taken at another place than friction, or a step that is too large does that", what, ratio, error,
                               ratio < 1.0 ? "apart" : "together");
    result_notes(r, "%zu pairs, mean %.4g; error as of %.0f independent looks at something that is so often there; eps = X_A dt/m_eff = %.3g",
                 pairs, share.mean, exact * (1.0 - exact) / gsl_pow_2(share.error), s->eps);
}

/* Per pair the time averages of how near it is and of being in contact. */
static void measure(struct check_run *run, const struct shell *s, const struct track *t)
{
    const size_t pairs = t->count / 2;
    double *near = calloc(pairs, sizeof *near), *touching = calloc(pairs, sizeof *touching);
    for (size_t k = 0; near && touching && k < pairs; k++)
        for (size_t step = 0; step < t->steps; step++) {
            const struct track_point *p = track_at(t, step, 2 * k), *q = track_at(t, step, 2 * k + 1);
            const double r[3] = { q->x[0] - p->x[0], q->x[1] - p->x[1], q->x[2] - p->x[2] }, h = norm(r) - 2.0 * s->radius;
            near[k] += nearness(s, h) / (double)t->steps;
            touching[k] += in_contact(s, h) / (double)t->steps;
        }
    if (near && touching) {
        judge(run, s, "near contact", "near", near, pairs, mean_over_shell(s, nearness));
        judge(run, s, "in contact", "contact", touching, pairs, mean_over_shell(s, in_contact));
    }
    free(near);
    free(touching);
}

/* Potential of mean force -ln(share of a bin/its share of r^2 dr), in kT, with the line of the spring. For people. */
static void draw(struct check_run *run, const struct shell *s, const struct track *t)
{
    enum { BINS = 40 };
    double found[BINS] = { 0 }, flat[BINS] = { 0 };
    char path[PATH_LENGTH], command[PATH_LENGTH + 64];
    const size_t pairs = t->count / 2, last = t->steps - 1;
    const double low = s->low / 2.0, width = (0.75 * s->high - low) / BINS;
    for (size_t k = 0; k < pairs; k++) {
        const struct track_point *p = track_at(t, last, 2 * k), *q = track_at(t, last, 2 * k + 1);
        const double r[3] = { q->x[0] - p->x[0], q->x[1] - p->x[1], q->x[2] - p->x[2] };
        const double bin = floor((norm(r) - 2.0 * s->radius - low) / width);
        if (bin >= 0 && bin < BINS)
            found[(int)bin] += 1.0;
    }
    for (int b = 0; b < BINS; b++)
        flat[b] = gsl_pow_2(2.0 * s->radius + low + (b + 0.5) * width) * width / s->width / s->weight[CELLS];
    path_join(path, run->work, "pmf.dat");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    for (int b = 0; b < BINS; b++)
        if (found[b] > 0)
            fprintf(f, "%g %g %g\n", low + (b + 0.5) * width, -log(found[b] / ((double)pairs * flat[b])), 1.0 / sqrt(found[b]));
    fclose(f);
    path_join(path, run->work, "pmf.gnuplot");
    f = fopen(path, "w");
    if (!f)
        return;
    fprintf(f, "set terminal svg size 640,400 enhanced font 'sans,12'\nset output 'pmf.svg'\nset xlabel 'gap'\nset ylabel 'potential of mean force / kT'\n"
               "plot [%g:%g] (x < 0 ? %g*x*x : 0) with lines title 'spring', 'pmf.dat' with yerrorbars pt 7 ps 0.6 title 'candidate'\n",
            low, 0.75 * s->high, 0.5 * s->stiffness / s->kT);
    fclose(f);
    snprintf(command, sizeof command, "cd '%s' && gnuplot pmf.gnuplot 2>gnuplot.log", run->work);
    if (system(command) == 0 && run->results.count > 0)
        result_picture(&run->results.item[0], "pmf.svg");
}

void check_boltzmann(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t pairs = (size_t)run->samples * (size_t)scene_number(parameters, "pairs", 0), across = (size_t)ceil(cbrt((double)pairs));
    const double spacing = scene_number(parameters, "spacing", NAN);
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct shell *s = calloc(1, sizeof *s);
    if (s && shell_make(run, scene, s)) {
        double list[64];
        int at[64];
        size_t times;
        parameter_list(parameters, "at", list, &times, 64);
        for (size_t t = 0; t < times; t++)
            at[t] = (int)list[t];
        scene_set(scene, "seed", json_integer(run->seed));
        scene_set(scene, "dynamics.verlet.dt", json_real(s->eps * 0.5 * s->mass / friction_at(s, 0.0)));
        const double edge = spacing * (double)across;
        scene_set(scene, "box.lengths", json_pack("[fff]", edge, edge, edge));
        struct state_row *start = start_pairs(run, s, pairs, spacing, across);
        struct track track;
        if (track_ask(run, "pairs", scene, start, 2 * pairs, at, times, &track)) {
            measure(run, s, &track);
            draw(run, s, &track);
            track_free(&track);
        }
        free(start);
    }
    free(s);
    json_decref(scene);
}
