/*
 * Layer 4: temperatures of lubricated Brownian pairs
 *
 *     <v v^T> = kT M^-1 ,    v = (U_1, U_2, W_1, W_2)
 *
 * at equilibrium, whatever the friction: no velocity of one sphere is correlated with any velocity of the other, nor with its own
 * spin. Source: Maxwell; for frozen pairs it is the stationary solution of M dv/dt = - R v + noise of covariance 2 kT R. Twelve
 * numbers per pair, in the frame of its line of centres n and two directions across it; each is divided by its root mean square.
 *
 * kT is so small that gaps do not change while velocities relax many times: the pairs are frozen, started from the Maxwell
 * distribution, and looked at after 3 and 6 relaxation times of a lone sphere, which is independent to 0.3 %. The noise of the
 * published pair torques (plus for minus in the second one) leaves all temperatures within a few per cent and shows in
 * <W_1.W_2> across n, which becomes + 0.3 to + 0.5 kT/I.
 *
 * Velocity Verlet with half-step velocities keeps <v v^T> of full-step velocities exactly at any step; so does a split with an implicit
 * friction step. There is no allowance; a scheme that needs one is told so by its half-step temperature, (1 - eps/2)^-1.
 */
#include "statistics.h"
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS = 12 };      /* per pair: U_1 (n, s, t), U_2, W_1, W_2 */
static const double seen = 5.9;

struct sample { double *z; size_t rows; };

/* The frame of a pair now: n, s, t. */
static void frame_of(const double first[3], const double second[3], double frame[3][3])
{
    double *n = frame[0], *s = frame[1];
    for (int k = 0; k < 3; k++)
        n[k] = second[k] - first[k];
    const double distance = norm(n);
    for (int k = 0; k < 3; k++)
        n[k] /= distance;
    const double other[3] = { fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0.0 };
    cross(n, other, s);
    const double length = norm(s);
    for (int k = 0; k < 3; k++)
        s[k] /= length;
    cross(n, s, frame[2]);
}

static struct sample whitened(const struct track *t, const struct model *m, const struct state_row *start, double kT, size_t pairs)
{
    struct sample sample = { calloc(t->steps * pairs * NUMBERS, sizeof(double)), t->steps * pairs };
    for (size_t row = 0; sample.z && row < sample.rows; row++) {
        const size_t step = row / pairs, pair = row % pairs;
        const struct track_point *p[2] = { track_at(t, step, 2 * pair), track_at(t, step, 2 * pair + 1) };
        double frame[3][3], *z = sample.z + NUMBERS * row;
        frame_of(p[0]->x, p[1]->x, frame);
        for (size_t side = 0; side < 2; side++) {
            const size_t species = (size_t)start[2 * pair + side].species - 1;
            struct model own = { .viscosity = m->viscosity, .radius = { m->radius[species] }, .density = { m->density[species] } };
            const struct free_sphere sphere = free_sphere(&own);
            for (size_t k = 0; k < 3; k++) {
                z[3 * side + k] = dot(p[side]->u, frame[k]) / sqrt(kT / sphere.mass);
                z[6 + 3 * side + k] = dot(p[side]->w, frame[k]) / sqrt(kT / sphere.inertia);
            }
        }
    }
    return sample;
}

static double declared(const struct check_run *run, const char *key)
{
    char path[64];
    snprintf(path, sizeof path, "declared.%s", key);
    return scene_number(run->gate_case->parameters, path, NAN);
}

/* Mean square of some of the twelve numbers: those from `first` to `last`, every third if `along` (only n) or the others. */
static void judge_temperature(struct check_run *run, const char *label, const struct sample *s, size_t first, bool along, const char *what)
{
    double sum = 0.0, dof = 0.0;
    char name[128];
    for (size_t row = 0; row < s->rows; row++)
        for (size_t k = first; k < first + 6; k++)
            if ((k % 3 == 0) == along) {
                sum += gsl_pow_2(s->z[NUMBERS * row + k]);
                dof += 1.0;
            }
    snprintf(name, sizeof name, "%s: temperature of %s", label, what);
    check_p(run, INVARIANT, name, sum / dof, 1.0, statistics_variance_p(sum / dof, dof, 0.0), seen * sqrt(2.0 / dof), declared(run, "temperature"),
            "%s has %.4g kT per degree of freedom: its noise does not balance its friction", what, sum / dof);
}

/* Mean product of numbers a and b of each pair: a sum of products of independent normal numbers if the candidate is right. */
static void judge_product(struct check_run *run, const char *label, const struct sample *s, const size_t (*factor)[2], const double *sign,
                          size_t products, const char *what, const char *hint)
{
    double sum = 0.0;
    char name[128];
    for (size_t row = 0; row < s->rows; row++)
        for (size_t k = 0; k < products; k++)
            sum += sign[k] * s->z[NUMBERS * row + factor[k][0]] * s->z[NUMBERS * row + factor[k][1]];
    const double n = (double)(s->rows * products);
    snprintf(name, sizeof name, "%s: %s", label, what);
    check_p(run, INVARIANT, name, sum / n, 0.0, statistics_normal_p(sum / sqrt(n)), seen / sqrt(n), declared(run, "correlation"),
            "%s is %+.3g of its equipartition value, and must vanish at equilibrium%s", what, sum / n, hint);
}

static void judge(struct check_run *run, const char *label, const struct sample *s)
{
    static const size_t squeeze[][2] = { { 0, 3 } }, slide[][2] = { { 1, 4 }, { 2, 5 } }, roll[][2] = { { 7, 10 }, { 8, 11 } }, twist[][2] = { { 6, 9 } };
    /* each velocity across with both spins that it is coupled to, (n x W).U: s with t and t with s, opposite signs */
    static const size_t couple[][2] = { { 1, 8 }, { 2, 7 }, { 1, 11 }, { 2, 10 }, { 4, 8 }, { 5, 7 }, { 4, 11 }, { 5, 10 } };
    static const double plus[] = { 1, 1 }, turned[] = { 1, -1, 1, -1, -1, 1, -1, 1 };
    judge_product(run, label, s, roll, plus, 2, "<W_1.W_2> across n", ": the torque noise on j has a plus where the balance needs a minus, "
                                                                       "or an index is wrong");
    judge_product(run, label, s, squeeze, plus, 1, "<U_1.U_2> along n", "");
    judge_product(run, label, s, slide, plus, 2, "<U_1.U_2> across n", "");
    judge_product(run, label, s, twist, plus, 1, "<W_1.W_2> along n", "");
    judge_product(run, label, s, couple, turned, 8, "<U x W> across n", "");
    judge_temperature(run, label, s, 0, true, "translation along n");
    judge_temperature(run, label, s, 0, false, "translation across n");
    judge_temperature(run, label, s, 6, true, "spin about n");
    judge_temperature(run, label, s, 6, false, "spin across n");
    char name[128];
    snprintf(name, sizeof name, "%s: all 78 second moments", label);
    check_p(run, INVARIANT, name, NAN, NAN, statistics_identity_p(s->z, s->rows, NUMBERS), NAN, NAN,
            "the covariance of velocities and spins of a pair is not kT M^-1");
}

/* Pairs on a lattice, at the gap of the case, with Maxwell velocities. */
static struct state_row *start_pairs(struct check_run *run, const struct model *m, const double radius[2], double kT, size_t pairs, size_t across,
                                     double spacing)
{
    struct state_row *row = calloc(2 * pairs, sizeof *row);
    gsl_rng *random = pair_random(run);
    for (size_t k = 0; row && k < pairs; k++) {
        const size_t cell[3] = { k % across, k / across % across, k / across / across };
        const struct pair_state p = random_pair(random, radius[0], radius[1], scene_number(run->gate_case->parameters, "xi", NAN));
        for (size_t side = 0; side < 2; side++) {
            struct model own = { .viscosity = m->viscosity, .radius = { radius[side] } };
            struct state_row *r = &row[2 * k + side];
            *r = (struct state_row){ .id = (int)(2 * k + side) + 1, .species = model_species(m, radius[side]) };
            own.density[0] = m->density[r->species - 1];
            const struct free_sphere sphere = free_sphere(&own);
            for (int c = 0; c < 3; c++)
                r->x[c] = p.s[side].x[c] + spacing * (double)cell[c];
            random_vector(random, sqrt(kT / sphere.mass), r->u);
            random_vector(random, sqrt(kT / sphere.inertia), r->w);
        }
    }
    gsl_rng_free(random);
    return row;
}

void check_equipartition(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t pairs = (size_t)run->samples * (size_t)scene_number(parameters, "pairs", 0), across = (size_t)ceil(cbrt((double)pairs));
    const double spacing = scene_number(parameters, "spacing", NAN), eps = scene_number(parameters, "eps", NAN);
    struct model m;
    size_t g;
    json_t *sizes;
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    json_array_foreach(json_object_get(parameters, "radii"), g, sizes)
    {
        const double radius[2] = { json_number_value(json_array_get(sizes, 0)), json_number_value(json_array_get(sizes, 1)) };
        json_t *scene = json_deep_copy(run->gate_case->scene);
        const double kT = scene_number(scene, "fluid.kT", NAN), edge = spacing * (double)across;
        const struct theory_motion motion = bodies_motion(&m, radius[0], radius[1]);
        const double m1 = theory_sphere_mass(&motion, 0), m2 = theory_sphere_mass(&motion, 1);
        double c[THEORY_SCALARS], slowest = 0.0;
        theory_scalars(&m.lubrication, radius[0], radius[1], radius[0] + radius[1], c);
        for (int side = 0; side < 2; side++)
            slowest = fmax(slowest, (side ? m2 : m1) / (6.0 * M_PI * m.viscosity * radius[side]));
        const double dt = eps * m1 * m2 / (m1 + m2) / c[THEORY_XA];
        const int at[2] = { (int)ceil(3.0 * slowest / dt), 2 * (int)ceil(3.0 * slowest / dt) };
        scene_set(scene, "seed", json_integer((run->seed + (unsigned)g) & 0xffffffffu));
        scene_set(scene, "dynamics.verlet.dt", json_real(dt));
        scene_set(scene, "box.lengths", json_pack("[fff]", edge, edge, edge));
        char label[64], name[32];
        snprintf(label, sizeof label, "radii %g and %g", radius[0], radius[1]);
        snprintf(name, sizeof name, "pairs-%zu", g + 1);
        struct state_row *start = start_pairs(run, &m, radius, kT, pairs, across, spacing);
        struct track track;
        const bool answered = start && track_ask(run, name, scene, start, 2 * pairs, at, 2, &track);
        if (answered) {
            const struct sample sample = whitened(&track, &m, start, kT, pairs);
            if (isfinite(track_at(&track, 0, 0)->w[0]))
                judge(run, label, &sample);
            else
                check_skip(run, label, "trajectory.csv gives no spins (wx, wy, wz)");
            free(sample.z);
            track_free(&track);
        }
        free(start);
        json_decref(scene);
        if (!answered)
            return;
    }
}
