/* Forces, steps and noise of the solver, on what can be worked out by hand. */
#include "suite.h"

#include "core/noise.h"
#include "core/step_limit.h"
#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SCENE(forces, dt, rest) \
    "{\"about\":\"test\",\"seed\":5,\"species\":[{\"name\":\"a\",\"radius\":1.0,\"density\":0.25},{\"name\":\"b\",\"radius\":1.4,\"density\":0.25}]," \
    "\"start\":{\"file\":\"states.csv\"},\"forces\":{" forces "},\"dynamics\":{\"verlet\":{\"dt\":" dt "}},\"run\":{\"steps\":10}," rest "}"
#define STILL "\"box\":{\"lengths\":[30,30,30],\"periodic\":[true,true,true]}"

static double energy(const struct suspension *s, double k_n)
{
    double E = 0.0;
    for (int i = 0; i < s->particles.count; i++)
        E += 0.5 * mass_of(&s->particles, i) * dot(s->particles.velocity[i], s->particles.velocity[i]);
    for (int k = 0; k < s->neighbours.near.count; k++)
        E += 0.5 * k_n * pow(fmin(s->neighbours.near.pair[k].gap, 0.0), 2);
    return E;
}

/* Frictionless collision: elastic, and its duration is pi sqrt(m_eff/k). */
static void collision_is_elastic(void)
{
    struct error e = { 0 };
    bool relisted;
    struct simulation *sim = scene_from(SCENE("\"contact\":{\"normal_stiffness\":1e4,\"friction\":0}", "1e-4", STILL),
                                        "1,1,10,10,10,1,0,0,0,0,0\n2,2,12.5,10.2,10,-0.5,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    const double start = energy(&sim->suspension, 1e4);
    int touching = 0;
    double drift = 0.0;
    for (int k = 0; k < 4000; k++) {
        check_true(sim->dynamics->step(sim->dynamics, &sim->suspension, &relisted, &e), e.text);
        touching += sim->suspension.neighbours.near.count > 0;
        drift = fmax(drift, fabs(energy(&sim->suspension, 1e4) / start - 1.0));
    }
    const struct particles *p = &sim->suspension.particles;
    const double m = mass_of(p, 0) * mass_of(p, 1) / (mass_of(p, 0) + mass_of(p, 1));
    check_close(energy(&sim->suspension, 1e4) / start, 1.0, 1e-4, "energy after the collision: steps cut its two ends, O(dt^2)");
    check_true(drift < 1e-2, "energy during the collision");
    check_close(touching * 1e-4, M_PI * sqrt(m / 1e4), 2.1e-4, "duration, to two steps");
    check_true(p->spin == NULL, "without friction nothing spins");
    check_close(p->velocity[0].x * mass_of(p, 0) + p->velocity[1].x * mass_of(p, 1), mass_of(p, 0) - 0.5 * mass_of(p, 1), 1e-12, "momentum");
    drop(sim);
}

/* Sphere sliding on another that is much heavier: the cap; and the displacement is shortened with it. */
static void friction_caps_and_turns_back(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene_from(SCENE("\"contact\":{\"normal_stiffness\":1e4,\"tangential_stiffness\":5e3,\"friction\":0.5,\"lever\":\"radius\"}",
                                              "1e-6", STILL), "1,1,10,10,10,0,3,0,0,0,0\n2,2,12.39,10,10,0,0,0,0,0,0\n", &e);
    bool relisted;
    check_true(!error_raised(&e) && sim->dynamics->begin(sim->dynamics, &sim->suspension, &relisted, &e), e.text);
    struct particles *p = &sim->suspension.particles;
    check_close(p->force[0].x, -100.0, 1e-9, "spring: k_n times overlap 0.01");
    check_close(p->force[0].y, 0.0, 0.0, "no displacement at the start");
    advance(sim, 1, &e);
    check_close(across(p->force[0], sim->suspension.neighbours.near.pair[0].normal).y, -5e3 * 3e-6, 1e-6, "tangential spring after one step of 3e-6");
    check_close(p->torque[0].z, -5e3 * 3e-6, 1e-6, "torque a_1 n x f");
    check_close(p->torque[1].z, -1.4 * 5e3 * 3e-6, 1e-6, "torque a_2 n x f, the same sign");
    advance(sim, 5999, &e);
    const double gap = sim->suspension.neighbours.near.pair[0].gap;
    const vec3 n = sim->suspension.neighbours.near.pair[0].normal, rub = across(p->force[0], n);
    check_close(norm(rub), 0.5 * 1e4 * -gap, 1e-6 * norm(rub), "sliding: mu times the spring");
    const double slid = norm(*sim->suspension.neighbours.near.pair[0].history);
    check_close(slid, norm(rub) / 5e3, 1e-9, "displacement shortened to what the force says");
    drop(sim);
}

/* Twice the step, one lone sphere: drag is first order, exact where the sphere already moves with the flow. */
static void drag_converges_at_first_order(void)
{
    static const char *const dts[] = { "0.02", "0.01", "0.005" };
    double wrong[3];
    for (int k = 0; k < 3; k++) {
        char text[1200];
        struct error e = { 0 };
        snprintf(text, sizeof text, SCENE("\"drag\":{\"torque\":true}", "%s", "\"fluid\":{\"viscosity\":0.2},\"shear\":[{\"flow\":\"z\",\"gradient\":\"x\",\"rate\":-0.4}]," STILL), dts[k]);
        struct simulation *sim = scene_from(text, "1,1,3,2,1,0,0,0,0,0,0\n", &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
        advance(sim, lround(0.4 / atof(dts[k])), &e);
        const struct particles *p = &sim->suspension.particles;
        const double rate = 6 * M_PI * 0.2 / mass_of(p, 0);
        wrong[k] = fabs(p->velocity[0].z - -0.4 * 3 * (1 - exp(-0.4 * rate)));
        check_close(p->velocity[0].x, 0, 0, "nothing across the flow");
        drop(sim);
    }
    check_close(wrong[0] / wrong[1], 2.0, 0.15, "error halves with the step");
    check_close(wrong[1] / wrong[2], 2.0, 0.08, "error halves with the step");
}

/* The estimate of the largest stable step against what happens just below and above it, in a squeezed pair. */
static void step_limit_is_where_it_blows_up(void)
{
    const char *text = SCENE("\"contact\":{\"normal_stiffness\":1e4,\"friction\":0},\"drag\":{\"torque\":true},"
                             "\"lubrication\":{\"inner_gap\":1e-3,\"outer_gap\":0.05,\"rotation_correction\":\"none\"}", "1e-5",
                             "\"fluid\":{\"viscosity\":0.2}," STILL);
    double grew[2];
    for (int k = 0; k < 2; k++) {
        struct error e = { 0 };
        struct simulation *sim = scene_from(text, "1,1,10,10,10,0,0,0,0,0,0\n2,1,11.999,10,10,0,0,0,0,0,0\n", &e);
        bool relisted;
        check_true(!error_raised(&e) && sim->dynamics->begin(sim->dynamics, &sim->suspension, &relisted, &e), e.text);
        const struct step_limit limit = step_limit_of(&sim->suspension, &e);
        check_true(strcmp(limit.force, "lubrication") == 0, "lubrication limits");
        sim->suspension.dt = (k ? 1.20 : 0.97) * limit.dt;
        sim->suspension.particles.velocity[0].x = 1e-9;
        grew[k] = 0.0;
        for (int step = 0; step < 300; step++) {                    /* what blows up flies apart and is slowed again: keep the most */
            advance(sim, 1, &e);
            grew[k] = fmax(grew[k], norm(sim->suspension.particles.velocity[0]));
        }
        drop(sim);
    }
    check_true(grew[1] > 20.0 * grew[0], "below the limit it settles, above it grows");
}

static void unstable_steps_are_refused(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene_from(SCENE("\"contact\":{\"normal_stiffness\":1e4,\"friction\":0}", "0.1", STILL),
                                        "1,1,10,10,10,0,0,0,0,0,0\n2,1,11.999,10,10,0,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && !simulation_begin(sim, &e) && e.code == ERROR_INPUT, "refused");
    check_true(strstr(e.text, "contact") && strstr(e.text, "take dt at most"), e.text);
    drop(sim);
    struct error deep = { 0 };
    sim = scene_from(SCENE("\"contact\":{\"normal_stiffness\":1e4,\"friction\":0}", "1e-4", STILL),
                     "1,1,10,10,10,0,0,0,0,0,0\n2,1,11.5,10,10,0,0,0,0,0,0\n", &deep);
    check_true(!error_raised(&deep) && !simulation_begin(sim, &deep) && strstr(deep.text, "overlap by 0.5"), deep.text);
    drop(sim);
}

/* The same draw whatever the order of asking; other tags, steps, streams, images: other numbers; moments right. */
static void noise_is_a_function_of_its_place(void)
{
    const struct noise_key key = { 7, 3 };
    const struct noise_place at = { NOISE_LUBRICATION, 11, 4, 9, 0 };
    vec3 a, b, c, d;
    noise_vectors(NOISE_GAUSSIAN, &key, &at, &a, &b);
    noise_vectors(NOISE_GAUSSIAN, &key, &at, &c, &d);
    check_true(a.x == c.x && b.z == d.z, "repeatable");
    const struct noise_place others[] = { { NOISE_DRAG, 11, 4, 9, 0 }, { NOISE_LUBRICATION, 12, 4, 9, 0 }, { NOISE_LUBRICATION, 11, 5, 9, 0 },
        { NOISE_LUBRICATION, 11, 4, 8, 0 }, { NOISE_LUBRICATION, 11, 4, 9, 1 }, { NOISE_LUBRICATION, 11 + ((int64_t)1 << 32), 4, 9, 0 } };
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        noise_vectors(NOISE_GAUSSIAN, &key, &others[k], &c, &d);
        check_true(a.x != c.x && a.y != c.y && b.x != d.x, "another place, another number");
    }
    const struct noise_key other_key[] = { { 8, 3 }, { 7, 4 } };
    for (int k = 0; k < 2; k++) {
        noise_vectors(NOISE_GAUSSIAN, &other_key[k], &at, &c, &d);
        check_true(a.x != c.x, "another seed or realisation");
    }
    for (int law = 0; law < 2; law++) {
        double one = 0, two = 0, four = 0, cross_moment = 0;
        const int n = 100000;
        for (int k = 0; k < n; k++) {
            const struct noise_place place = { NOISE_START, k, 1, 2, 0 };
            noise_vectors((enum noise_law)law, &key, &place, &a, &b);
            one += a.x + b.y;
            two += a.x * a.x + b.y * b.y;
            four += pow(a.z, 4);
            cross_moment += a.x * a.y + a.z * b.x;
        }
        check_close(one / (2.0 * n), 0, 5 * sqrt(0.5 / n), "mean, five standard errors");
        check_close(two / (2.0 * n), 1, 5 * sqrt(1.0 / n), "variance, five standard errors");
        check_close(four / n, law ? 1.8 : 3.0, 5 * sqrt((law ? 9.0 : 105.0) / n), "fourth moment, five standard errors");
        check_close(cross_moment / n, 0, 5 * sqrt(2.0 / n), "components independent, five standard errors");
    }
    const philox4x64_ctr_t zero = { { 0, 0, 0, 0 } };
    const philox4x64_key_t none = { { 0, 0 } };
    check_true(philox4x64(zero, none).v[0] == 0x16554d9eca36314cu, "Philox's published answer");
}

/* kT = 0: nothing random is built; the seed changes no bit. */
static void no_temperature_no_noise(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene_from(SCENE("\"drag\":{\"torque\":true},\"drag_noise\":{\"distribution\":\"gaussian\"}", "1e-3",
                                              "\"fluid\":{\"viscosity\":0.2,\"kT\":0}," STILL), "1,1,10,10,10,1,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && sim->suspension.force_count == 1 && !suspension_force(&sim->suspension, "drag_noise"), "only the drag is built");
    drop(sim);
    sim = scene_from(SCENE("\"drag\":{\"torque\":true}", "1e-3", "\"fluid\":{\"viscosity\":0.2,\"kT\":0.3}," STILL), "1,1,10,10,10,1,0,0,0,0,0\n", &e);
    check_true(strstr(e.text, "add forces.drag_noise") != NULL, "drag without its noise at kT > 0 is refused");
    drop(sim);
}

/* In two dimensions nothing leaves the plane, noise included. */
static void two_dimensions_stay_flat(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene_from(SCENE("\"drag\":{\"torque\":true},\"drag_noise\":{\"distribution\":\"uniform\"}", "1e-3",
                                              "\"dimensions\":2,\"fluid\":{\"viscosity\":0.2,\"kT\":0.3}," STILL), "1,1,10,10,0,1,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    advance(sim, 50, &e);
    const struct particles *p = &sim->suspension.particles;
    check_true(p->position[0].z == 0 && p->velocity[0].z == 0 && p->spin[0].x == 0 && p->spin[0].y == 0, "exact zeros");
    check_true(p->position[0].y != 10 && p->spin[0].z != 0, "and motion in the plane");
    drop(sim);
}

static const struct unit_test tests[] = {
    { "a frictionless collision is elastic", collision_is_elastic },
    { "friction: spring, torques, cap", friction_caps_and_turns_back },
    { "drag converges at first order", drag_converges_at_first_order },
    { "the step limit is where a pair blows up", step_limit_is_where_it_blows_up },
    { "unstable steps and deep overlaps are refused", unstable_steps_are_refused },
    { "noise is a function of its place", noise_is_a_function_of_its_place },
    { "no temperature, no noise", no_temperature_no_noise },
    { "two dimensions stay flat", two_dimensions_stay_flat },
    { NULL, NULL }
};
const struct suite force_suite = { "force", tests };
