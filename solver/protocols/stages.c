/*
 * Driving in stages: simple shears whose rates change with time, one stage after the other, at rest after the last
 *
 *     G_fg(t) = r(s),     s = t - (begin of the stage)
 *     r(s) = rate                             a number
 *     r(s) = from + (to - from) s/duration    { "ramp": [from, to] }
 *     r(s) = mean + amplitude sin(w s + p)    { "mean", "amplitude", "angular_frequency": w, "phase": p }, p in radians
 *
 *     S(t) = integral of G from time 0, stage by stage in closed form: never accumulated from step to step
 *
 * Several shears may act at once, each by its own law (crosswise oscillation: x along y steady, z along y oscillating).
 * No axis may be a flow axis here and a gradient axis there: S would not be enough to know the cell (core/flow.h).
 *
 * The strain that tables print is the way travelled, the integral of |r| of the first shear that each stage lists.
 *
 * Inertia. In a periodic cell the images of a particle move with U + G(t) H s, so they take part in the acceleration of the
 * flow, dG/dt H s, whatever its place. m dU/dt = F cannot hold for all of them unless each also feels
 *
 *     F_i = m_i (dG/dt) x_i
 *
 * the force by which the accelerating liquid carries along a body of its own density. It is applied as the impulse
 * m [<G> of the next step - <G> of the last] x, <G> = [S(t + dt) - S(t)]/dt: finite also where a rate jumps, at whatever moment
 * of a step, and what follows the flow then drifts as far in each step as the cell is sheared. Where the gradient axis is open there
 * are no such images, the force is absent, and a particle lags behind the flow by its own inertia.
 */
#include "protocols/protocols.h"

#include <stdlib.h>

struct law { int flow, gradient; double mean, slope, amplitude, frequency, phase; };

enum { MAX_LAWS = 6 };
struct stage { double begin, duration; int laws; struct law law[MAX_LAWS]; };

struct stages { struct flow base; int count; struct stage stage[]; };

static double rate_of(const struct law *l, double s)
{
    return l->mean + l->slope * s + (l->amplitude != 0.0 ? l->amplitude * sin(l->frequency * s + l->phase) : 0.0);
}

/* The integral of the rate from 0 to s. */
static double strain_of(const struct law *l, double s)
{
    const double swing = l->amplitude != 0.0 ? l->amplitude / l->frequency * (cos(l->phase) - cos(l->frequency * s + l->phase)) : 0.0;
    return l->mean * s + 0.5 * l->slope * s * s + swing;
}

/* The integral of |rate| from a to b, which hold at most one period: between zeros it is that of the rate, up to sign. */
static double travelled_between(const struct law *l, double a, double b)
{
    double zero[2] = { INFINITY, INFINITY };
    if (l->amplitude != 0.0 && fabs(l->mean) < fabs(l->amplitude)) {
        const double first = asin(-l->mean / l->amplitude), angle[2] = { first, M_PI - first };
        for (int k = 0; k < 2; k++) {               /* the first time from a on at which w s + p is that angle */
            const double turns = ceil((l->frequency * a + l->phase - angle[k]) / (2.0 * M_PI));
            zero[k] = (angle[k] + 2.0 * M_PI * turns - l->phase) / l->frequency;
        }
    } else if (l->slope != 0.0)
        zero[0] = -l->mean / l->slope;
    const double early = fmin(zero[0], zero[1]), late = fmax(zero[0], zero[1]);
    const double cut[4] = { a, early > a && early < b ? early : a, late > a && late < b ? late : b, b };
    double sum = 0.0;
    for (int k = 0; k < 3; k++)
        sum += fabs(strain_of(l, cut[k + 1]) - strain_of(l, cut[k]));
    return sum;
}

static double travelled_of(const struct law *l, double s)
{
    if (l->amplitude == 0.0)
        return travelled_between(l, 0.0, s);
    const double period = 2.0 * M_PI / l->frequency, periods = floor(s / period);
    return periods * travelled_between(l, 0.0, period) + travelled_between(l, periods * period, s);
}

/* Time into a stage, at most its duration; below 0 before it. */
static double into(const struct stage *at, double time) { return fmin(time - at->begin, at->duration); }

/* Moments are sums of durations or multiples of dt, which binary numbers round: 30 times 0.01 is below 0.1 + 0.2. Such two are the same moment. */
static bool reached(const struct stages *all, double time, double moment) { return time >= moment - all->base.rounding; }

static mat3 gradient_at(const struct flow *self, double time)
{
    const struct stages *all = (const struct stages *)self;
    mat3 G = { { { 0.0 } } };
    for (int k = 0; k < all->count; k++) {
        const struct stage *at = &all->stage[k];
        if (!reached(all, time, at->begin) || reached(all, time, at->begin + at->duration))
            continue;
        for (int n = 0; n < at->laws; n++)
            G.m[at->law[n].flow][at->law[n].gradient] += rate_of(&at->law[n], time - at->begin);
    }
    return G;
}

/* The mean rate from a to b. */
static double mean_rate_of(const struct law *l, double a, double b)
{
    const double middle = 0.5 * (a + b), angle = 0.5 * l->frequency * (b - a);
    const double swing = l->amplitude != 0.0 ? l->amplitude * sin(l->frequency * middle + l->phase) * (angle > 0.0 ? sin(angle) / angle : 1.0) : 0.0;
    return l->mean + l->slope * middle + swing;
}

enum { SLIVER = 1000000000 };           /* a stage that fills all but so small a part of a step fills it: the rest is rounding */

static mat3 mean_over(const struct flow *self, double from, double to)
{
    const struct stages *all = (const struct stages *)self;
    mat3 G = { { { 0.0 } } };
    for (int k = 0; k < all->count; k++) {
        const struct stage *at = &all->stage[k];
        const double a = fmax(from, at->begin), b = fmin(to, at->begin + at->duration), part = (b - a) / (to - from);
        for (int n = 0; n < at->laws && part * SLIVER > 1.0; n++)
            G.m[at->law[n].flow][at->law[n].gradient] += ((1.0 - part) * SLIVER < 1.0 ? 1.0 : part) * mean_rate_of(&at->law[n], a - at->begin, b - at->begin);
    }
    return G;
}

static bool ends_between(const struct flow *self, double from, double to)
{
    const struct stages *all = (const struct stages *)self;
    const double sliver = (to - from) / SLIVER;
    for (int k = 0; k < all->count; k++)
        for (int side = 0; side < 2; side++) {
            const double moment = all->stage[k].begin + side * all->stage[k].duration;
            if (moment > from + sliver && moment < to - sliver)
                return true;
        }
    return false;
}

static mat3 strain_at(const struct flow *self, double time)
{
    const struct stages *all = (const struct stages *)self;
    mat3 S = { { { 0.0 } } };
    for (int k = 0; k < all->count; k++) {
        const struct stage *at = &all->stage[k];
        for (int n = 0; n < at->laws && time > at->begin; n++)
            S.m[at->law[n].flow][at->law[n].gradient] += strain_of(&at->law[n], into(at, time));
    }
    return S;
}

static double travelled_at(const struct flow *self, double time)
{
    const struct stages *all = (const struct stages *)self;
    double sum = 0.0;
    for (int k = 0; k < all->count; k++)
        if (all->stage[k].laws > 0 && time > all->stage[k].begin)
            sum += travelled_of(&all->stage[k].law[0], into(&all->stage[k], time));
    return sum;
}

/* ---- out of the scene ---- */

/* Returns the largest |rate|. */
static double read_rate(struct settings *shear, struct law *l, double duration, struct error *e)
{
    if (settings_is_number(shear, "rate")) {
        l->mean = settings_number(shear, "rate", e);
        return fabs(l->mean);
    }
    struct settings rate = settings_child(shear, "rate", e);
    double ends[2] = { 0.0, 0.0 };
    if (!rate.node) {
        settings_refuse(shear, "rate", e, "must be a number, or an object with ramp, or with mean, amplitude, angular_frequency and phase");
    } else if (settings_has(&rate, "ramp")) {
        if (settings_numbers(&rate, "ramp", ends, 2, e) != 2)
            settings_refuse(&rate, "ramp", e, "must be two numbers: the rate at the begin and at the end of the stage");
        l->mean = ends[0];
        l->slope = (ends[1] - ends[0]) / duration;
    } else {
        l->mean = settings_number(&rate, "mean", e);
        l->amplitude = settings_number(&rate, "amplitude", e);
        l->frequency = settings_positive(&rate, "angular_frequency", e);
        l->phase = settings_number(&rate, "phase", e);
        ends[0] = fabs(l->mean) + fabs(l->amplitude);
    }
    settings_done(&rate, e);
    return fmax(fabs(ends[0]), fabs(ends[1]));
}

static void read_stage(struct settings *one, struct stage *at, struct flow *flow, struct error *e)
{
    static const char *const axes[] = { "x", "y", "z", NULL };
    at->laws = settings_length(one, "shear", e);
    if (at->laws > MAX_LAWS)
        settings_refuse(one, "shear", e, "must list at most %d shears", MAX_LAWS);
    const bool by_strain = settings_has(one, "strain");
    const double strain = by_strain ? settings_positive(one, "strain", e) : 0.0;
    mat3 fastest = { { { 0.0 } } };                             /* of this stage: shears along the same axes add up */
    at->duration = by_strain ? 1.0 : settings_positive(one, "duration", e);
    if (by_strain && settings_has(one, "duration"))
        settings_refuse(one, "strain", e, "must not stand beside duration");
    for (int k = 0; k < at->laws && !error_raised(e); k++) {
        struct settings shear = settings_item(one, "shear", k, e);
        struct law *l = &at->law[k];
        l->flow = settings_choice(&shear, "flow", axes, e);
        l->gradient = settings_choice(&shear, "gradient", axes, e);
        if (!error_raised(e) && l->flow == l->gradient)
            settings_refuse(&shear, "gradient", e, "must differ from the flow's axis");
        if (k == 0 && by_strain && !(settings_is_number(&shear, "rate") && settings_number(&shear, "rate", e) != 0.0))
            settings_refuse(one, "strain", e, "needs a first shear at a constant rate, not 0; give a duration");
        if (k == 0 && by_strain && !error_raised(e))
            at->duration = strain / fabs(settings_number(&shear, "rate", e));
        double *rate = &fastest.m[l->flow][l->gradient], *largest = &flow->largest.m[l->flow][l->gradient];
        *rate += read_rate(&shear, l, at->duration, e);
        *largest = fmax(*largest, *rate);
        settings_done(&shear, e);
    }
    if (by_strain && at->laws == 0)
        settings_refuse(one, "strain", e, "needs a shear; a rest has a duration");
    settings_done(one, e);
}

/* "stages": [ { "duration": 3, "shear": [ { "flow": "x", "gradient": "y", "rate": 0.1 } ] }, { "duration": 1, "shear": [] } ] */
struct flow *stages_new(struct settings *root, struct error *e)
{
    if (error_raised(e) || !settings_has(root, "stages"))
        return NULL;
    const int count = settings_length(root, "stages", e);
    struct stages *all = calloc(1, sizeof *all + (size_t)count * sizeof *all->stage);
    if (!all)
        return error_out_of_memory(e), NULL;
    all->base = (struct flow){ .gradient = gradient_at, .mean = mean_over, .ends = ends_between, .strain = strain_at, .travelled = travelled_at };
    if (settings_has(root, "shear") && settings_length(root, "shear", e) > 0)
        settings_refuse(root, "stages", e, "must not stand beside shear, which is the steady flow");
    for (int k = 0; k < count && !error_raised(e); k++) {
        struct settings one = settings_item(root, "stages", k, e);
        all->stage[all->count].begin = all->base.duration;
        read_stage(&one, &all->stage[all->count], &all->base, e);
        const struct stage *at = &all->stage[all->count++];
        all->base.duration += at->duration;
        if (at->laws > 0 && all->base.flow_axis == all->base.gradient_axis) {
            all->base.flow_axis = at->law[0].flow;
            all->base.gradient_axis = at->law[0].gradient;
        }
    }
    if (!error_raised(e))
        return &all->base;
    free(all);
    return NULL;
}

/* ---- the acceleration of the flow ---- */

static void inertia_add(const struct force *self, struct particles *p, struct near_pairs *near, const struct moment *now, struct stress *stress)
{
    const struct flow *flow = now->box->flow;
    (void)self, (void)near, (void)stress;
    /* A run starts with the flow that there is: its first kick, half as long, leads from G(t) to the mean over the first step. */
    const double t = now->box->time, duration = now->step > 0 ? now->dt : 0.5 * now->dt;
    const mat3 after = flow->mean(flow, t, t + now->dt), before = now->step > 0 ? flow->mean(flow, t - now->dt, t) : flow->gradient(flow, t);
    mat3 change;
    bool changes = false;
    for (int k = 0; k < 9; k++) {
        const double difference = after.m[k / 3][k % 3] - before.m[k / 3][k % 3];
        change.m[k / 3][k % 3] = now->box->periodic[k % 3] ? difference / duration : 0.0;
        changes = changes || change.m[k / 3][k % 3] != 0.0;
    }
    for (int i = 0; changes && i < p->count; i++)
        if (!p->kind[p->species[i]].driven)         /* of the others core/driven.c takes care */
            p->force[i] = plus(p->force[i], scaled(mat3_times(&change, p->position[i]), mass_of(p, i)));
}

struct force *stages_inertia(struct error *e)
{
    struct force *f = calloc(1, sizeof *f);

    if (!f)
        error_out_of_memory(e);
    else
        *f = (struct force){ .name = "unsteady_flow", .kind = POTENTIAL, .add = inertia_add };
    return f;
}
