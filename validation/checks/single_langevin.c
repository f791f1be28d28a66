/*
 * Layer 3: a Brownian sphere alone, from ballistic to diffusive
 *
 *     <dx(t)^2> = 2 (kT/m) tau^2 [ t/tau - 1 + exp(-t/tau) ] ,   <u(0) u(t)> = (kT/m) exp(-t/tau) ,   tau = m/(6 pi eta a)
 *
 * per component; the same for the angle turned through and the spin with I and 8 pi eta a^3. Source: Uhlenbeck & Ornstein (1930),
 * Li (2026) eq 4.1, 4.2; see theory/langevin.c.
 *
 * The gate draws the starting velocities from the Maxwell distribution itself. All spheres are in one small box and pass through each
 * other and through its faces: 3 N independent realisations of one component, so that the sum of squares over them is
 * chi-squared. Where the scene has a contact they start apart: a dilute suspension, to which the closed form is applied
 * by Li (2026), fig 4.2a. Explicit steps make an error: velocity Verlet with the drag of the half-step velocity (LAMMPS) starts with the
 * ballistic part wrong by eps/2, eps = dt/tau, and keeps D and the full-step temperature exact. The allowance is eps, for any
 * reasonable first-order scheme, and p-values are for the band 1 +- eps.
 */
#include "single.h"
#include "statistics.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double seen = 5.9;      /* standard deviations an effect must have to be seen: 3.9 to alarm, 2 to be sure */

/* Translation or rotation: the same equations in other letters. */
struct kind { const char *name, *velocity, *path; double mass, friction; bool turning; };

struct ensemble {
    struct check_run *run;
    const struct track *track;
    const struct state_row *start;
    const double *time;
    double kT, dt;
    const char *label;               /* "kT 0.31" */
    FILE *plot;                      /* t/tau, measured, expected, error of each mean square displacement; NULL: not drawn */
};

static double velocity_at(const struct ensemble *e, const struct kind *k, size_t step, size_t sphere, int c)
{
    const struct track_point *p = track_at(e->track, step, sphere);
    return k->turning ? p->w[c] : p->u[c];
}

static double velocity_at_start(const struct ensemble *e, const struct kind *k, size_t sphere, int c)
{
    return k->turning ? e->start[sphere].w[c] : e->start[sphere].u[c];
}

static double path_at(const struct ensemble *e, const struct kind *k, size_t step, size_t sphere, int c)
{
    const struct track_point *p = track_at(e->track, step, sphere);
    return k->turning ? p->turn[c] : p->x[c] - e->start[sphere].x[c];
}

static double declared(const struct ensemble *e, const char *key)
{
    char path[64];
    snprintf(path, sizeof path, "declared.%s", key);
    return scene_number(e->run->gate_case->parameters, path, NAN);
}

static const char *titled(char text[128], const struct ensemble *e, const char *what)
{
    snprintf(text, 128, "%s: %s", e->label, what);
    return text;
}

/* What a diffusion that is off by this factor often means. */
static const char *guess(double ratio, bool turning)
{
    if (fabs(ratio - 4.0 / 3.0) < 0.05 && turning)
        return " A factor 4/3: 6 pi where rotation has 8 pi.";
    if (fabs(ratio - 2.0) < 0.1)
        return " A factor 2: noise added twice, or 4 kT where 2 kT belongs.";
    if (fabs(ratio - 0.5) < 0.03)
        return " A factor 1/2: kT where 2 kT belongs.";
    if (fabs(ratio - 1.0 / 3.0) < 0.02)
        return " A factor 1/3: uniform numbers on (-1, 1) without the factor 3 of their variance.";
    return "";
}

/* Mean square displacement at every time; one p: the smallest times the number of times. */
static void judge_msd(const struct ensemble *e, const struct kind *k, double eps)
{
    const size_t n = 3 * e->track->count;
    double least = 1.0, ratio_of_least = NAN, table[64][2];
    size_t at = 0;
    char notes[1024] = "t/tau measured/expected:", name[128];
    for (size_t s = 0; s < e->track->steps; s++) {
        double sum = 0.0;
        for (size_t i = 0; i < e->track->count; i++)
            for (int c = 0; c < 3; c++)
                sum += gsl_pow_2(path_at(e, k, s, i, c));
        table[s][0] = sum / (double)n;
        table[s][1] = theory_langevin_msd(e->kT, k->mass, k->friction, e->time[s]);
        if (e->plot && !k->turning)
            fprintf(e->plot, "%g %g %g %g\n", e->time[s] * k->friction / k->mass, table[s][0], table[s][1], table[s][0] * sqrt(2.0 / (double)n));
        const double ratio = table[s][0] / table[s][1], p = statistics_variance_p(ratio, (double)n, eps);
        if (!(p >= least) || s == 0) {
            least = p;
            at = s;
            ratio_of_least = ratio;
        }
        const size_t used = strlen(notes);
        snprintf(notes + used, sizeof notes - used, " %.3g %.4f;", e->time[s] * k->friction / k->mass, ratio);
    }
    char what[64];
    snprintf(what, sizeof what, "mean square %s", k->path);
    struct result *r = check_p(e->run, MODEL, titled(name, e, what), table[at][0], table[at][1],
                               fmin(1.0, least * (double)e->track->steps), eps + seen * sqrt(2.0 / (double)n), declared(e, "msd"),
                               "the mean square %s at t = %.3g tau is %.4g times that of a Langevin sphere (%s regime).%s", k->path,
                               e->time[at] * k->friction / k->mass, ratio_of_least,
                               e->time[at] * k->friction < 0.3 * k->mass   ? "ballistic"
                               : e->time[at] * k->friction > 3.0 * k->mass ? "diffusive"
                                                                           : "crossover", guess(ratio_of_least, k->turning));
    result_notes(r, "%s", notes);
}

/* Velocity autocorrelation: given the starting velocities the estimate sum u(t) u(0)/sum u(0)^2 is normal. */
static void judge_vacf(const struct ensemble *e, const struct kind *k, double eps)
{
    double squares = 0.0, least = 1.0, measured = NAN, expected = NAN, coarsest = 0.0;
    size_t at = 0;
    char name[128], what[64];
    for (size_t i = 0; i < e->track->count; i++)
        for (int c = 0; c < 3; c++)
            squares += gsl_pow_2(velocity_at_start(e, k, i, c));
    for (size_t s = 0; s < e->track->steps; s++) {
        double sum = 0.0;
        for (size_t i = 0; i < e->track->count; i++)
            for (int c = 0; c < 3; c++)
                sum += velocity_at(e, k, s, i, c) * velocity_at_start(e, k, i, c);
        const double rho = theory_langevin_vacf(e->kT, k->mass, k->friction, e->time[s]) * k->mass / e->kT;
        const double error = sqrt((1.0 - rho * rho) * e->kT / k->mass / squares);
        const double p = statistics_normal_p(fmax(0.0, fabs(sum / squares - rho) - eps) / error);
        coarsest = fmax(coarsest, eps + seen * error);
        if (!(p >= least) || s == 0) {
            least = p;
            at = s;
            measured = sum / squares;
            expected = rho;
        }
    }
    snprintf(what, sizeof what, "%s autocorrelation", k->velocity);
    check_p(e->run, MODEL, titled(name, e, what), measured, expected, fmin(1.0, least * (double)e->track->steps), coarsest,
            declared(e, "vacf"), "the %s autocorrelation at t = %.3g tau is %.4g, exp(-t/tau) is %.4g: %s relaxes %s than %s says",
            k->velocity, e->time[at] * k->friction / k->mass, measured, expected, k->velocity, measured > expected ? "slower" : "faster",
            k->turning ? "I/(8 pi eta a^3)" : "m/(6 pi eta a)");
}

/* Kinetic temperature from the late steps that lie three relaxation times apart, so that their squares are independent to 0.3 %. */
static void judge_temperature(const struct ensemble *e, const struct kind *k, double eps)
{
    const double tau = k->mass / k->friction;
    double sum = 0.0, last = 0.0, dof = 0.0;
    for (size_t s = 0; s < e->track->steps; s++) {
        if (e->time[s] < last + 3.0 * tau)
            continue;
        last = e->time[s];
        dof += 3.0 * (double)e->track->count;
        for (size_t i = 0; i < e->track->count; i++)
            for (int c = 0; c < 3; c++)
                sum += gsl_pow_2(velocity_at(e, k, s, i, c));
    }
    const double ratio = sum * k->mass / (e->kT * dof);
    char name[128], what[64];
    snprintf(what, sizeof what, "equipartition of %s", k->name);
    check_p(e->run, INVARIANT, titled(name, e, what), ratio * e->kT, e->kT, statistics_variance_p(ratio, dof, eps),
            eps + seen * sqrt(2.0 / dof), declared(e, "temperature"), "the kinetic temperature of %s is %.4g kT%s", k->name, ratio,
            k->turning && fabs(ratio - 1.0) < 0.03 ? "" : ": noise and friction do not balance");
}

/*
 * No drift: the mean displacement over all spheres against the spread that they have themselves (a wrong diffusion is told
 * elsewhere). Spheres that share noise show here too: it adds up.
 */
static void judge_drift(const struct ensemble *e, const struct kind *k)
{
    const size_t s = e->track->steps - 1;
    const double n = (double)e->track->count;
    double along = 0.0, squares = 0.0;
    for (int c = 0; c < 3; c++) {
        double sum = 0.0;
        for (size_t i = 0; i < e->track->count; i++) {
            sum += path_at(e, k, s, i, c);
            squares += gsl_pow_2(path_at(e, k, s, i, c));
        }
        along += sum * sum / n;
    }
    const double chi2 = 3.0 * n * along / squares;    /* the 3 N numbers in the denominator are too many to matter */
    char name[128], what[64];
    snprintf(what, sizeof what, "no drift of %s", k->name);
    check_p(e->run, INVARIANT, titled(name, e, what), sqrt(along / n), 0.0, statistics_chi2_p(chi2, 3.0), sqrt(seen * sqrt(6.0) / n),
            declared(e, "drift"), "the spheres as a whole have moved by %.3g root mean squares of one: they drift, or they share their "
            "noise", sqrt(chi2 / n));
}

/* Translation against rotation of the same sphere, at the last step: 9 correlations (one random number for both shows here). */
static void judge_independence(const struct ensemble *e, const struct kind kinds[2])
{
    const size_t n = e->track->count, s = e->track->steps - 1;
    double *u = malloc(3 * n * sizeof *u), *w = malloc(3 * n * sizeof *w);
    char name[128];
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++) {
            u[3 * i + (size_t)c] = velocity_at(e, &kinds[0], s, i, c) / sqrt(e->kT / kinds[0].mass);
            w[3 * i + (size_t)c] = velocity_at(e, &kinds[1], s, i, c) / sqrt(e->kT / kinds[1].mass);
        }
    check_p(e->run, INVARIANT, titled(name, e, "velocity and spin independent"), NAN, 0.0, statistics_cross_p(u, 3, w, 3, n),
            sqrt(seen * sqrt(2.0) / (double)n), declared(e, "correlation"),
            "velocity and spin of the same sphere are correlated: force and torque use the same random numbers");
    free(u);
    free(w);
}

static bool touches_one_before(const struct state_row *row, size_t i, const double edge[3], double diameter)
{
    for (size_t j = 0; j < i; j++) {
        double square = 0.0;
        for (int c = 0; c < 3; c++) {
            const double d = row[i].x[c] - row[j].x[c];
            square += gsl_pow_2(d - edge[c] * nearbyint(d / edge[c]));
        }
        if (square < gsl_pow_2(diameter))
            return true;
    }
    return false;
}

/* `which`: number of the temperature; each has its own seed, else all would see the same numbers in other units. */
static void judge_temperature_of(struct check_run *run, const struct model *m, const struct free_sphere *sphere, double kT, unsigned which,
                                 FILE *plot)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t count = (size_t)run->samples * (size_t)scene_number(parameters, "spheres", 0);
    double list[64], time[64];
    int at[64];
    size_t steps;
    parameter_list(parameters, "at", list, &steps, 64);
    json_t *scene = json_deep_copy(run->gate_case->scene);
    const double eps = scene_number(parameters, "eps", NAN), dt = eps * sphere->mass / sphere->friction;
    scene_set(scene, "seed", json_integer((run->seed + which) & 0xffffffffu));
    scene_set(scene, "fluid.kT", json_real(kT));
    scene_set(scene, "dynamics.verlet.dt", json_real(dt));
    for (size_t k = 0; k < steps; k++) {
        at[k] = (int)list[k];
        time[k] = list[k] * dt;
    }
    struct state_row *start = calloc(count, sizeof *start);
    double edge[3];
    for (int c = 0; c < 3; c++)         /* with contacts a rerun's additional spheres need their room */
        edge[c] = m->cell[c][c] * (m->has_contact ? cbrt(run->samples) : 1.0);
    scene_set(scene, "box.lengths", json_pack("[fff]", edge[0], edge[1], edge[2]));
    gsl_rng *random = pair_random(run);
    gsl_rng_set(random, run->seed + which);
    for (size_t i = 0; i < count; i++) {
        start[i] = (struct state_row){ .id = (int)i + 1, .species = 1 };
        do
            for (int c = 0; c < 3; c++)
                start[i].x[c] = gsl_rng_uniform(random) * edge[c];
        while (m->has_contact && touches_one_before(start, i, edge, 2.0 * sphere->radius));
        random_vector(random, sqrt(kT / sphere->mass), start[i].u);
        random_vector(random, sqrt(kT / sphere->inertia), start[i].w);
    }
    gsl_rng_free(random);

    char label[32], name[128];
    snprintf(label, sizeof label, "kT %g", kT);
    snprintf(name, sizeof name, "kT-%g", kT);
    struct track track;
    if (steps > 0 && track_ask(run, name, scene, start, count, at, steps, &track)) {
        const struct ensemble e = { .run = run, .track = &track, .start = start, .time = time, .kT = kT, .dt = dt, .label = label,
                                    .plot = plot };
        const struct kind kinds[2] = {
            { "translation", "velocity", "displacement", sphere->mass, sphere->friction, false },
            { "rotation", "spin", "angle turned", sphere->inertia, sphere->spin_friction, true } };
        for (int k = 0; k < 2; k++) {
            const double own_eps = dt * kinds[k].friction / kinds[k].mass;
            if (k == 1 && !isfinite(track_at(&track, 0, 0)->w[0])) {
                check_skip(run, titled(name, &e, "rotation"), "trajectory.csv gives no spins (wx, wy, wz)");
                break;
            }
            if (k == 0 || isfinite(track_at(&track, 0, 0)->turn[0]))
                judge_msd(&e, &kinds[k], own_eps);
            judge_vacf(&e, &kinds[k], own_eps);
            judge_temperature(&e, &kinds[k], own_eps);
            if (k == 0 || isfinite(track_at(&track, 0, 0)->turn[0]))
                judge_drift(&e, &kinds[k]);
            if (k == 1)
                judge_independence(&e, kinds);
        }
        track_free(&track);
    }
    free(start);
    json_decref(scene);
}

/* Mean square displacement against time: points measured, lines Langevin's. */
static void draw(struct check_run *run, const double *kT, size_t temperatures)
{
    char path[PATH_LENGTH], command[PATH_LENGTH + 64];
    path_join(path, run->work, "msd.gnuplot");
    FILE *f = fopen(path, "w");
    if (!f)
        return;
    fprintf(f, "set terminal svg size 720,460 enhanced font 'sans,12'\nset output 'msd.svg'\nset logscale xy\nset key top left\n"
               "set format y '10^{%%L}'\nset xlabel 'time / relaxation time'\nset ylabel 'mean square displacement per component'\nplot ");
    for (size_t k = 0; k < temperatures; k++)
        fprintf(f, "%s'msd.dat' index %zu using 1:3 with lines lc %zu notitle, '' index %zu using 1:2:4 with yerrorbars pt 7 ps 0.6 lc %zu title 'kT = %g'",
                k ? ", " : "", k, k + 1, k, k + 1, kT[k]);
    fputc('\n', f);
    fclose(f);
    snprintf(command, sizeof command, "cd '%s' && gnuplot msd.gnuplot 2>gnuplot.log", run->work);
    if (system(command) == 0 && run->results.count > 0)
        result_picture(&run->results.item[0], "msd.svg");
}

void check_langevin(struct check_run *run)
{
    struct model m;
    double kT[8];
    size_t temperatures;
    char path[PATH_LENGTH];
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    const struct free_sphere sphere = free_sphere(&m);
    parameter_list(run->gate_case->parameters, "kT", kT, &temperatures, 8);
    path_join(path, run->work, "msd.dat");
    FILE *plot = fopen(path, "w");
    for (size_t k = 0; k < temperatures; k++) {
        judge_temperature_of(run, &m, &sphere, kT[k], (unsigned)k, plot);
        if (plot)
            fputs("\n\n", plot);
    }
    if (plot) {
        fclose(plot);
        draw(run, kT, temperatures);
    }
}
