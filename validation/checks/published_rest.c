/*
 * Layer 7: what Li (2026), chapter 4, says of Brownian suspensions at rest, but for diffusion (published_diffusion.c)
 *
 * "published-green-kubo": fig 4.3b. The structural Brownian shear stress decays so that
 *
 *     eta_GK(s) = V/kT integral_0^s <Sigma_xy(t + s') Sigma_xy(t)> ds'  =  eta_phi (1 - exp(-s/tau_phi))                   (4.3)
 *
 * with tau_phi weakly varying below phi = 0.5 and growing fast above. The correlation comes from the candidate's green_kubo.csv; its value
 * at lag 0 is held against Sigma_xy^2 taken from the candidate's states (theory/structural_stress.c). The gate integrates by trapezoids,
 * fits by least squares up to the first zero of the pooled correlation, and takes errors from the jackknife over realisations.
 * From the same runs: the structural pressure, extrapolated to a shell of no width, equals the contact pressure, as fig 4.5 has it of the
 * shear stresses at Pe < 1.
 *
 * "published-friction": friction between the spheres changes neither viscosity nor pressure at rest, the limit of the low Pe of fig 4.9.
 * A frictional contact dissipates and has no noise of its own, so it could cool what it touches: temperatures are compared too. The
 * viscosity is compared up to a lag at which it is known to a few per cent; the rest of the integral is in the notes.
 *
 * "published-split": the parts of the pressure at rest against the time step. Explicit velocity Verlet finds spheres in contact too rarely
 * by 1 - eps/2, eps = X_A dt/m_eff at the inner gap, and books the rest of the pressure as lubrication; the sum stays. Sources: the spurious
 * potential follows from the half-step temperature kT/(1 - eps/2) of a mode with friction rate eps/dt; pressure of Carnahan & Starling.
 */
#include "rest.h"
#include "published_rest.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- Green-Kubo --- */

struct running { size_t lags; double lag[REST_LAGS], correlation[REST_LAGS], eta[REST_LAGS]; };     /* eta over that of the fluid */
struct fit { double eta, tau, residual; };

/* Mean over the realisations but one (`without` < 0: all). */
static struct running running_integral(const struct rest_point *p, int without)
{
    struct running y = { .lags = p->sample[0].lags };
    const double scale = p->volume / p->kT / p->viscosity;
    for (size_t l = 0; l < y.lags; l++) {
        int count = 0;
        y.lag[l] = p->sample[0].lag[l];
        for (int k = 0; k < p->count; k++)
            if (k != without) {
                y.correlation[l] += p->sample[k].correlation[l];
                count++;
            }
        y.correlation[l] /= count;
        y.eta[l] = l ? y.eta[l - 1] + 0.5 * scale * (y.correlation[l] + y.correlation[l - 1]) * (y.lag[l] - y.lag[l - 1]) : 0.0;
    }
    return y;
}

struct range { const struct running *y; size_t lags; };

/* Share of the range that lag l stands for: lags are dense at first and sparse later, the fit is to the curve over s. */
static double share(const struct range *r, size_t l)
{
    return 0.5 * (r->y->lag[l + 1 < r->lags ? l + 1 : l] - r->y->lag[l - 1]) / r->y->lag[r->lags - 1];
}

/* The best eta for this tau is linear; returns the mean square of what is left. */
static double left_over(double log_tau, void *in, double *eta)
{
    const struct range *r = in;
    double fy = 0.0, ff = 0.0, square = 0.0;
    for (size_t l = 1; l < r->lags; l++) {
        const double f = -expm1(-r->y->lag[l] / exp(log_tau));
        fy += share(r, l) * f * r->y->eta[l];
        ff += share(r, l) * f * f;
    }
    for (size_t l = 1; l < r->lags; l++)
        square += share(r, l) * gsl_pow_2(r->y->eta[l] + fy / ff * expm1(-r->y->lag[l] / exp(log_tau)));
    if (eta)
        *eta = fy / ff;
    return square;
}

static double objective(double log_tau, void *in)
{
    return left_over(log_tau, in, NULL);
}

static struct fit fit_exponential(const struct running *y, size_t lags)
{
    struct range r = { y, lags };
    const double low = log(y->lag[1]), high = log(10.0 * y->lag[lags - 1]);
    double best = low;
    enum { GRID = 60 };
    for (int k = 1; k < GRID; k++) {
        const double x = low + (high - low) * k / GRID;
        if (objective(x, &r) < objective(best, &r))
            best = x;
    }
    const double step = (high - low) / GRID;
    gsl_function f = { objective, &r };
    gsl_min_fminimizer *search = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
    gsl_error_handler_t *usual = gsl_set_error_handler_off();
    if (gsl_min_fminimizer_set(search, &f, best, best - step, best + step) == GSL_SUCCESS)
        for (int k = 0; k < 50 && gsl_min_fminimizer_iterate(search) == GSL_SUCCESS; k++)
            best = gsl_min_fminimizer_x_minimum(search);
    gsl_set_error_handler(usual);
    gsl_min_fminimizer_free(search);
    struct fit out = { .tau = exp(best) };
    out.residual = sqrt(left_over(best, &r, &out.eta)) / out.eta;
    return out;
}

/* Up to the first zero of the pooled correlation, later also to 5 tau: beyond, the integral only gathers noise. */
static size_t lags_used(const struct running *y)
{
    size_t l = 1;
    while (l < y->lags && y->correlation[l] > 0.0)
        l++;
    return l;
}

struct green_kubo { struct fit fit; double eta_error, tau_error, plateau, plateau_error, longest; size_t lags; };

static struct green_kubo green_kubo_of(const struct rest_point *p)
{
    const struct running all = running_integral(p, -1);
    struct green_kubo g = { .lags = lags_used(&all) };
    for (int round = 0; round < 4; round++) {
        g.fit = fit_exponential(&all, g.lags);
        while (g.lags > 8 && all.lag[g.lags - 1] > 5.0 * g.fit.tau)
            g.lags--;
    }
    g.longest = all.lag[g.lags - 1];
    g.plateau = all.eta[g.lags - 1];
    for (int k = 0; k < p->count; k++) {
        const struct running y = running_integral(p, k);
        const struct fit f = fit_exponential(&y, g.lags);
        const double factor = (p->count - 1.0) / p->count;      /* jackknife, about the estimate from all */
        g.eta_error += factor * gsl_pow_2(f.eta - g.fit.eta);
        g.tau_error += factor * gsl_pow_2(f.tau - g.fit.tau);
        g.plateau_error += factor * gsl_pow_2(y.eta[g.lags - 1] - g.plateau);
    }
    g.eta_error = sqrt(g.eta_error);
    g.tau_error = sqrt(g.tau_error);
    g.plateau_error = sqrt(g.plateau_error);
    return g;
}

/* The running viscosities with their fits, and the means of every point with the fit's parameters. */
static void write_fits(const struct check_run *run, const struct rest_point *p, const struct green_kubo *g, size_t points)
{
    FILE *curves = rest_table(run, "green-kubo.csv", "point,phi,lag,C/C(0),eta_GK,fit");
    for (size_t i = 0; i < points && curves; i++) {
        const struct running y = running_integral(&p[i], -1);
        for (size_t l = 1; l < y.lags; l++)
            fprintf(curves, "%s,%g,%.6g,%.5g,%.5g,%.5g\n", p[i].label, p[i].phi, y.lag[l], y.correlation[l] / y.correlation[0], y.eta[l],
                    -g[i].fit.eta * expm1(-y.lag[l] / g[i].fit.tau));
    }
    FILE *fits = rest_table(run, "fits.csv", "point,phi,eta,error,tau,error_tau,residual,eta_at_longest,error_longest,longest");
    for (size_t i = 0; i < points && fits; i++)
        fprintf(fits, "%s,%g,%.5g,%.2g,%.5g,%.2g,%.3g,%.5g,%.2g,%.5g\n", p[i].label, p[i].phi, g[i].fit.eta, g[i].eta_error, g[i].fit.tau,
                g[i].tau_error, g[i].fit.residual, g[i].plateau, g[i].plateau_error, g[i].longest);
    if (curves)
        fclose(curves);
    if (fits)
        fclose(fits);
}

static const struct rest_point *labelled(const struct rest_point *p, size_t points, const json_t *name, size_t *at)
{
    for (*at = 0; *at < points; (*at)++)
        if (json_is_string(name) && strcmp(p[*at].label, json_string_value(name)) == 0)
            return &p[*at];
    return NULL;
}

static const char *said(char text[128], const struct rest_point *p, const char *what)
{
    snprintf(text, 128, "%s: %s", p->label, what);
    return text;
}

/* The candidate's own <Sigma_xy^2> against that of its states; one realisation's ratio has the scatter of few states. */
static void judge_variance(struct check_run *run, const struct rest_point *p)
{
    double ratio[REST_REALISATIONS], mean = 0.0, squares = 0.0;
    char text[128];
    for (int k = 0; k < p->count; k++)
        mean += (ratio[k] = p->sample[k].correlation[0] / p->sample[k].value[REST_VARIANCE]) / p->count;
    for (int k = 0; k < p->count; k++)
        squares += gsl_pow_2(ratio[k] - mean);
    check_interval(run, MODEL, said(text, p, "Brownian stress squared, as observed over that of the states"), mean,
                   sqrt(squares / (p->count - 1) / p->count), 1.0, scene_number(run->gate_case->parameters, "variance_margin", 0.1),
                   "the observed correlation at lag 0 is %.3g times the mean square of the structural stress of the same run's states", mean);
}

static void judge_pressures(struct check_run *run, const struct rest_point *p)
{
    double mean = 0.0, squares = 0.0, ratio[REST_REALISATIONS], contact_error, structural_error;
    char text[128];
    for (int k = 0; k < p->count; k++)
        mean += (ratio[k] = p->sample[k].value[REST_STRUCTURAL] / p->sample[k].value[REST_CONTACT]) / p->count;
    for (int k = 0; k < p->count; k++)
        squares += gsl_pow_2(ratio[k] - mean);
    const double contact = rest_mean(p, REST_CONTACT, &contact_error), structural = rest_mean(p, REST_STRUCTURAL, &structural_error);
    struct result *r = check_interval(run, MODEL, said(text, p, "structural over contact pressure"), mean,
                                      sqrt(squares / (p->count - 1) / p->count), 1.0, scene_number(run->gate_case->parameters, "pressure_margin", 0.1),
                                      "structural Brownian pressure %.4g n kT, contact pressure %.4g n kT: they should be one number at rest",
                                      structural, contact);
    double wide_error, hot_error, spin_error, lubrication_error;
    const double wide = rest_mean(p, REST_WIDE, &wide_error), hot = rest_mean(p, REST_TEMPERATURE, &hot_error);
    const double spin = rest_mean(p, REST_SPIN_TEMPERATURE, &spin_error), lubrication = rest_mean(p, REST_LUBRICATION, &lubrication_error);
    result_notes(r, "contact %.4g +- %.2g, structural %.4g +- %.2g (shell 0.05 a: %.4g +- %.2g), lubrication %.3g +- %.2g, all in n kT; "
                 "temperatures %.4f +- %.4f, spin %.4f +- %.4f kT", contact, contact_error, structural, structural_error, wide, wide_error, lubrication,
                 lubrication_error, hot, hot_error, spin, spin_error);
}

static void judge_fit(struct check_run *run, const struct rest_point *p, const struct green_kubo *g)
{
    char text[128];
    struct result *r = check_error(run, MODEL, said(text, p, "eta_GK(s) is an exponential approach"), g->fit.eta, g->plateau, g->fit.residual,
                                   run->gate_case->tolerance,
                                   "the running viscosity differs from eta (1 - exp(-s/tau)) by %.2g of eta (root mean square up to s = %.3g); "
                                   "best eta %.3g +- %.2g fluid viscosities, tau %.3g +- %.2g", g->fit.residual, g->longest, g->fit.eta, g->eta_error,
                                   g->fit.tau, g->tau_error);
    result_notes(r, "eta %.4g +- %.2g and tau %.4g +- %.2g by the fit, residual %.3g of eta; %.4g +- %.2g at the first zero of the correlation, "
                 "s = %.3g", g->fit.eta, g->eta_error, g->fit.tau, g->tau_error, g->fit.residual, g->plateau, g->plateau_error, g->longest);
}

/* In logarithms: a ratio of two positive numbers known to some tens of per cent. */
static void judge_growth(struct check_run *run, const struct rest_point *p, const struct green_kubo *g, size_t points)
{
    const json_t *growth = json_object_get(run->gate_case->parameters, "growth");
    size_t a, b;
    if (!labelled(p, points, json_array_get(growth, 0), &a) || !labelled(p, points, json_array_get(growth, 1), &b))
        return;
    const double ratio = g[b].fit.tau / g[a].fit.tau, error = hypot(g[a].tau_error / g[a].fit.tau, g[b].tau_error / g[b].fit.tau);
    char text[128];
    snprintf(text, sizeof text, "log of tau at phi %g over that at %g", p[b].phi, p[a].phi);
    struct result *r = rest_exceeds(run, text, log(ratio), error, log(json_number_value(json_array_get(growth, 2))),
                                    "the correlation time should grow fast above phi 0.5, in logarithms");
    result_notes(r, "tau %.4g +- %.2g over %.4g +- %.2g: %.3g, within a factor exp(+-%.2g)", g[b].fit.tau, g[b].tau_error, g[a].fit.tau, g[a].tau_error,
                 ratio, error);
}

void check_published_green_kubo(struct check_run *run)
{
    size_t points;
    struct green_kubo g[REST_POINTS];
    struct rest_point *p = rest_measure(run, &points);
    if (!p)
        return;
    for (size_t i = 0; i < points; i++)
        g[i] = green_kubo_of(&p[i]);
    for (size_t i = 0; i < points; i++) {
        judge_variance(run, &p[i]);
        judge_pressures(run, &p[i]);
        judge_fit(run, &p[i], &g[i]);
    }
    judge_growth(run, p, g, points);
    write_fits(run, p, g, points);
    rest_points_free(p, points);
}

/* --- friction --- */

/* The running viscosity at this lag, of all realisations but one (`without` < 0: of all). */
static double running_at(const struct rest_point *p, double lag, int without)
{
    const struct running y = running_integral(p, without);
    size_t l = 1;
    while (l + 1 < y.lags && y.lag[l] < lag)
        l++;
    return y.eta[l - 1] + (y.eta[l] - y.eta[l - 1]) * (lag - y.lag[l - 1]) / (y.lag[l] - y.lag[l - 1]);
}

static double running_error(const struct rest_point *p, double lag)
{
    const double all = running_at(p, lag, -1);
    double error = 0.0;
    for (int k = 0; k < p->count; k++)
        error += (p->count - 1.0) / p->count * gsl_pow_2(running_at(p, lag, k) - all);
    return sqrt(error);
}

static void judge_ratio(struct check_run *run, const char *what, const double value[2], const double error[2], double margin)
{
    const double ratio = value[1] / value[0];
    struct result *r = check_interval(run, MODEL, what, ratio, ratio * hypot(error[0] / value[0], error[1] / value[1]), 1.0, margin,
                                      "%s: %.4g +- %.2g with friction, %.4g +- %.2g without", what, value[1], error[1], value[0], error[0]);
    result_notes(r, "%.5g +- %.2g with friction, %.5g +- %.2g without", value[1], error[1], value[0], error[0]);
}

/* Two points: without friction and with it. */
void check_published_friction(struct check_run *run)
{
    static const struct { int value; const char *what, *margin; } means[] = {
        { REST_CONTACT, "contact pressure", "friction_margin" }, { REST_STRUCTURAL, "structural Brownian pressure", "friction_margin" },
        { REST_TEMPERATURE, "temperature", "temperature_margin" }, { REST_SPIN_TEMPERATURE, "temperature of spins", "temperature_margin" } };
    size_t points;
    struct green_kubo g[REST_POINTS];
    struct rest_point *p = rest_measure(run, &points);
    const json_t *parameters = run->gate_case->parameters;
    const double lag = scene_number(parameters, "lag", NAN);
    if (!p)
        return;
    for (size_t k = 0; k < sizeof means / sizeof *means; k++) {
        double value[2], error[2];
        for (int side = 0; side < 2; side++)
            value[side] = rest_mean(&p[side], means[k].value, &error[side]);
        judge_ratio(run, means[k].what, value, error, scene_number(parameters, means[k].margin, NAN));
    }
    const double eta[2] = { running_at(&p[0], lag, -1), running_at(&p[1], lag, -1) };
    const double error[2] = { running_error(&p[0], lag), running_error(&p[1], lag) };
    char text[128];
    snprintf(text, sizeof text, "Green-Kubo viscosity up to lag %.3g", lag);
    judge_ratio(run, text, eta, error, scene_number(parameters, "viscosity_margin", NAN));
    for (size_t i = 0; i < points; i++)
        g[i] = green_kubo_of(&p[i]);
    result_notes(&run->results.item[run->results.count - 1], "up to lag %.3g: %.4g +- %.2g with friction, %.4g +- %.2g without; by fits "
                 "%.3g +- %.2g and %.3g +- %.2g", lag, eta[1], error[1], eta[0], error[0], g[1].fit.eta, g[1].eta_error, g[0].fit.eta, g[0].eta_error);
    write_fits(run, p, g, points);
    rest_points_free(p, points);
}

/* --- the split of the pressure --- */

/* Step of the explicit scheme; 0 for the split. */
static double explicit_step(const struct rest_point *p)
{
    return scene_number(json_object_get(json_object_get(p->json, "set"), "dynamics"), "verlet.dt", 0.0);
}

/* eps/2 of a step dt of the explicit scheme at the inner gap, for spheres of species 1. */
static double predicted_deficit(double dt, const struct model *m)
{
    double scalar[THEORY_SCALARS];
    theory_scalars(&m->lubrication, m->radius[0], m->radius[0], 2.0 * m->radius[0], scalar);
    return 0.5 * scalar[THEORY_XA] * dt / (0.5 * free_sphere(m).mass);
}

void check_published_split(struct check_run *run)
{
    size_t points;
    struct model m;
    struct rest_point *p = model_read(run, run->gate_case->scene, &m) ? rest_measure(run, &points) : NULL;
    if (!p)
        return;
    const double sigma = theory_thermal_diameter(m.radius[0], p->stiffness, p->kT);
    const double expected = theory_carnahan_starling(M_PI / 6.0 * p->density * gsl_pow_3(sigma)) - 1.0, margin = run->gate_case->tolerance;
    char text[128];
    FILE *table = rest_table(run, "split.csv", "point,step,contact,error,predicted,lubrication,error_lubrication,sum,error_sum");
    for (size_t i = 0; i < points; i++) {
        const double share = 1.0 - predicted_deficit(explicit_step(&p[i]), &m);
        double error[3], sum[REST_REALISATIONS], mean = 0.0, squares = 0.0;
        const double contact = rest_mean(&p[i], REST_CONTACT, &error[0]), lubrication = rest_mean(&p[i], REST_LUBRICATION, &error[1]);
        for (int k = 0; k < p[i].count; k++)
            mean += (sum[k] = p[i].sample[k].value[REST_CONTACT] + p[i].sample[k].value[REST_LUBRICATION]) / p[i].count;
        for (int k = 0; k < p[i].count; k++)
            squares += gsl_pow_2(sum[k] - mean);
        error[2] = sqrt(squares / (p[i].count - 1) / p[i].count);
        if (table)
            fprintf(table, "%s,%g,%.4f,%.2g,%.4f,%.4f,%.2g,%.4f,%.2g\n", p[i].label, explicit_step(&p[i]), contact, error[0], expected * share, lubrication,
                    error[1], mean, error[2]);
        struct result *r = check_interval(run, MODEL, said(text, &p[i], "contact pressure"), contact, error[0], expected * share, margin * expected,
                                          "contact pressure %.4g n kT; Carnahan and Starling times 1 - eps/2 give %.4g", contact, expected * share);
        result_notes(r, "contact %.4g +- %.2g (predicted %.4g), lubrication %.3g +- %.2g, sum %.4g +- %.2g, in n kT", contact, error[0],
                     expected * share, lubrication, error[1], mean, error[2]);
        check_interval(run, MODEL, said(text, &p[i], "contact and lubrication pressure together"), mean, error[2], expected, 2.0 * margin * expected,
                       "contact and lubrication pressure add up to %.4g n kT; Carnahan and Starling give %.4g", mean, expected);
    }
    if (table)
        fclose(table);
    double error[2];
    const double low = rest_mean(&p[0], REST_LUBRICATION, &error[0]), high = rest_mean(&p[points - 1], REST_LUBRICATION, &error[1]);
    rest_exceeds(run, "lubrication pressure, coarsest explicit step less the first point", high - low, hypot(error[0], error[1]), 0.0,
                 "an explicit step this long books contact pressure as lubrication");
    rest_points_free(p, points);
}

const struct check published_rest_checks[] = {
    { "published-green-kubo", check_published_green_kubo },
    { "published-split", check_published_split },
    { "published-friction", check_published_friction },
    { "published-diffusion", check_published_diffusion },
    { NULL, NULL },
};
