/* The friction step pair by pair: its order, what it keeps at any step, and the stress that it books. */
#include "suite.h"

#include "core/sweeps.h"
#include "scenes.h"

#include <string.h>

/* Three unequal spheres around a first, lubricated, one overlapping it, one across a face of the cell. */
static const char *const rows[4] = { "%d,1,8.9,4,4,0.3,0,0,0,0.2,0\n", "%d,2,2.002,4.1,4,-0.2,0.1,0,0,0,0.3\n", "%d,1,8.9,6.62,4.02,0,-0.3,0.2,0.4,0,0\n",
                                     "%d,2,8.95,4.1,6.19,0.1,0.1,-0.5,0,0.1,0.2\n" };

/* `label`: sphere label[k] of the rows gets tag k + 1; `turned`: in memory they lie the other way round; sphere `moved` is a cell away. */
static struct simulation *crowd(const char *friction, double dt, double kT, const int label[4], bool turned, int moved, bool drag)
{
    char text[1400], states[600] = "";
    struct error e = { 0 };
    snprintf(text, sizeof text, "{\"about\":\"test\",\"seed\":5,\"fluid\":{\"viscosity\":0.7,\"kT\":%g},\"box\":{\"lengths\":[9.1,8.3,8.7],"
             "\"periodic\":[true,true,true]},\"species\":[{\"name\":\"a\",\"radius\":1.3,\"density\":2.0},{\"name\":\"b\",\"radius\":0.9,\"density\":2.0}],"
             "\"start\":{\"file\":\"states.csv\"},\"forces\":{%s\"lubrication\":{\"inner_gap\":1e-3,\"outer_gap\":0.5,\"rotation_correction\":\"none\"},"
             "\"lubrication_noise\":{\"distribution\":\"gaussian\"}},\"dynamics\":{\"split\":{\"dt\":%.17g,\"friction\":\"%s\"}},\"run\":{\"steps\":1}}",
             kT, drag ? "\"drag\":{\"torque\":true},\"drag_noise\":{\"distribution\":\"gaussian\"}," : "", dt, friction);
    for (int k = 0; k < 4; k++)
        snprintf(states + strlen(states), sizeof states - strlen(states), rows[label[k]], k + 1);
    struct simulation *sim = scene_from(text, states, &e);
    struct particles *p = &sim->suspension.particles;
    for (int k = 0; k < 2 && turned; k++) {
        const struct { int tag, species; vec3 x, u, w; } one = { p->tag[k], p->species[k], p->position[k], p->velocity[k], p->spin[k] };
        p->tag[k] = p->tag[3 - k], p->species[k] = p->species[3 - k];
        p->position[k] = p->position[3 - k], p->velocity[k] = p->velocity[3 - k], p->spin[k] = p->spin[3 - k];
        p->tag[3 - k] = one.tag, p->species[3 - k] = one.species;
        p->position[3 - k] = one.x, p->velocity[3 - k] = one.u, p->spin[3 - k] = one.w;
    }
    if (moved >= 0)
        p->position[moved] = plus(p->position[moved], vec(-9.1, 8.3, 0));
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    return sim;
}

static const int plain[4] = { 0, 1, 2, 3 };

/* Velocity of the sphere of row 0 after time 0.02. */
static vec3 velocity_after(const char *friction, double dt, double kT, const int label[4], bool turned, int moved)
{
    struct simulation *sim = crowd(friction, dt, kT, label, turned, moved, true);
    struct error e = { 0 };
    vec3 v = { NAN, NAN, NAN };
    check_true(advance(sim, lround(0.02 / dt), &e), e.text);
    for (int i = 0; i < 4; i++)
        if (label[sim->suspension.particles.tag[i] - 1] == 0)
            v = sim->suspension.particles.velocity[i];
    drop(sim);
    return v;
}

static void order_is_by_tags_alone(void)
{
    const vec3 v = velocity_after("sweeps", 2e-3, 0.3, plain, false, -1);
    check_close(norm(minus(velocity_after("sweeps", 2e-3, 0.3, plain, true, -1), v)), 0, 1e-12, "another order in memory");
    check_close(norm(minus(velocity_after("sweeps", 2e-3, 0.3, plain, false, 1), v)), 0, 1e-10, "a sphere from another cell: rounding over the gap");
}

/* Other labels are another order of factors that do not commute: a difference of second order in dt. */
static void labels_matter_to_second_order(void)
{
    const int other[4] = { 2, 0, 3, 1 };
    double off[3], from_global[3];
    for (int k = 0; k < 3; k++) {
        const double dt = 2e-5 / (1 << k);
        const vec3 v = velocity_after("sweeps", dt, 0, plain, false, -1);
        off[k] = norm(minus(velocity_after("sweeps", dt, 0, other, false, -1), v));
        from_global[k] = norm(minus(velocity_after("global", dt, 0, plain, false, -1), v));
    }
    check_true(off[0] > 1e-12, "labels matter at all");
    for (int k = 0; k < 2; k++) {
        check_close(log2(off[k] / off[k + 1]), 2, 0.1, "order of what labels change");
        check_close(log2(from_global[k] / from_global[k + 1]), 2, 0.1, "order of the difference from the global solution");
    }
}

static vec3 momentum(const struct particles *p)
{
    vec3 sum = { 0, 0, 0 };
    for (int i = 0; i < p->count; i++)
        sum = plus(sum, scaled(p->velocity[i], mass_of(p, i)));
    return sum;
}

static void momentum_is_kept(void)
{
    struct simulation *sim = crowd("sweeps", 0.02, 0.3, plain, false, -1, false);
    struct error e = { 0 };
    const vec3 before = momentum(&sim->suspension.particles);
    check_true(advance(sim, 200, &e), e.text);
    check_close(norm(minus(momentum(&sim->suspension.particles), before)), 0, 1e-12, "momentum: rounding of 200 steps, nothing is iterated");
    drop(sim);
}

/* A frozen crowd, stepped 20000 times at some hundred times the explicit limit: second moments stay those of Maxwell. */
static void maxwell_is_kept(void)
{
    enum { STEPS = 20000 };
    struct simulation *sim = crowd("sweeps", 0.05, 0.3, plain, false, -1, true);
    struct suspension *s = &sim->suspension;
    const struct particles *p = &s->particles;
    struct friction f;
    struct error e = { 0 };
    double square[4][2] = { { 0 } }, cross_term = 0.0;
    memset(&f, 0, sizeof f);
    s->measuring = false;
    for (int k = 0; k < STEPS && !error_raised(&e); k++) {
        s->step++;
        sweeps_step(&f, s, &e);
        for (int i = 0; i < 4; i++) {
            square[i][0] += mass_of(p, i) * dot(p->velocity[i], p->velocity[i]) / (3 * 0.3 * STEPS);
            square[i][1] += inertia_of(p, i) * dot(p->spin[i], p->spin[i]) / (3 * 0.3 * STEPS);
        }
        cross_term += dot(p->velocity[0], p->velocity[1]) * sqrt(mass_of(p, 0) * mass_of(p, 1)) / (3 * 0.3 * STEPS);
    }
    check_true(!error_raised(&e) && f.links == 3, e.text);
    /* Velocities ring at this step, so they are correlated over some steps: five standard errors of a tenth of the steps. */
    const double error = 5 * sqrt(2.0 / (3 * STEPS / 10));
    for (int i = 0; i < 4; i++) {
        check_close(square[i][0], 1, error, "kinetic temperature");
        check_close(square[i][1], 1, error, "temperature of the spin");
    }
    check_close(cross_term, 0, error, "neighbours' velocities are independent");
    friction_free(&f);
    drop(sim);
}

/* A row of three: its two pair impulses are the momentum that the outer spheres gain, and the stress is made of those. */
static void books_impulses(const char *form)
{
    struct error e = { 0 };
    char text[1000];
    snprintf(text, sizeof text, "{\"about\":\"test\",\"seed\":5,\"fluid\":{\"viscosity\":0.7,\"kT\":0.3},\"box\":{\"lengths\":[19,8.3,8.7],"
        "\"periodic\":[true,true,true]},\"shear\":[{\"flow\":\"x\",\"gradient\":\"y\",\"rate\":-0.4}],\"species\":[{\"name\":\"a\",\"radius\":1.3,\"density\":2.0}],"
        "\"start\":{\"file\":\"states.csv\"},\"forces\":{\"lubrication_noise\":{\"distribution\":\"gaussian\"},\"lubrication\":{\"inner_gap\":1e-3,"
        "\"outer_gap\":0.5,\"rotation_correction\":\"none\"}},\"dynamics\":{\"split\":{\"dt\":0.02,\"friction\":\"%s\"}},\"run\":{\"steps\":1}}", form);
    struct simulation *sim = scene_from(text,
        "1,1,4,4,4,0.3,0,0,0,0.2,0\n2,1,6.601,4.1,4.3,-0.2,0.1,0,0,0,0.3\n3,1,9.22,4.1,4.4,0,1,0.3,0.1,0,0\n", &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    struct suspension *s = &sim->suspension;
    struct particles *p = &s->particles;
    const vec3 first = p->velocity[0], last = p->velocity[2];
    s->measuring = true;
    stress_clear(&s->stress);
    s->step++;
    check_true(sim->dynamics->friction(sim->dynamics, s, &e), e.text);
    mat3 booked = { { { 0 } } }, expected = { { { 0 } } };
    for (int o = 0; o < s->stress.origins; o++)
        for (int k = 0; k < 9; k++)
            booked.m[k / 3][k % 3] += s->stress.sum[o].m[k / 3][k % 3];
    mat3_add_outer(&expected, mass_of(p, 0) / s->dt, minus(p->velocity[0], first), minus(p->position[1], p->position[0]));
    mat3_add_outer(&expected, -mass_of(p, 2) / s->dt, minus(p->velocity[2], last), minus(p->position[2], p->position[1]));
    for (int k = 0; k < 9; k++)
        check_close(booked.m[k / 3][k % 3], expected.m[k / 3][k % 3], 1e-9 * fabs(expected.m[0][0]), "stress times volume");
    drop(sim);
}

static void stress_is_that_of_the_impulses(void)
{
    books_impulses("sweeps");
    books_impulses("global");
}

static void settings_are_refused_where_they_mean_nothing(void)
{
    static const char *const wrong[] = { "\"split\":{\"dt\":1e-3,\"friction\":\"sweeps\",\"residual\":1e-8}", "\"verlet\":{\"dt\":1e-3,\"friction\":\"sweeps\"}",
                                         "\"split\":{\"dt\":1e-3,\"friction\":\"pairs\"}" };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char text[600];
        struct error e = { 0 };
        snprintf(text, sizeof text, "{\"about\":\"test\",\"fluid\":{\"viscosity\":0.7},\"box\":{\"lengths\":[9,8,8],\"periodic\":[true,true,true]},"
                 "\"species\":[{\"name\":\"a\",\"radius\":1.3,\"density\":2.0}],\"start\":{\"file\":\"states.csv\"},\"forces\":{\"drag\":{\"torque\":true}},"
                 "\"dynamics\":{%s},\"run\":{\"steps\":1}}", wrong[k]);
        struct simulation *sim = scene_from(text, "1,1,4,4,4,0.3,0,0,0,0.2,0\n", &e);
        check_close(e.code, ERROR_INPUT, 0, wrong[k]);
        drop(sim);
    }
}

static const struct unit_test tests[] = {
    { "the order is that of tags, not of rows or cells", order_is_by_tags_alone },
    { "other labels: a difference of second order", labels_matter_to_second_order },
    { "momentum is kept to rounding", momentum_is_kept },
    { "the Maxwell distribution is kept far beyond the explicit limit", maxwell_is_kept },
    { "the stress is that of the impulses", stress_is_that_of_the_impulses },
    { "settings are refused where they mean nothing", settings_are_refused_where_they_mean_nothing },
    { NULL, NULL }
};
const struct suite sweeps_suite = { "sweeps", tests };
