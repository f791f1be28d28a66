/*
 * Contacts with dashpots and friction laws, repulsion, applied forces, tethers, held and driven spheres: the closed forms of
 * validation/theory against a second origin, and of the solver what can be worked out by hand.
 */
#include "suite.h"

#include "core/dashpot.h"
#include "core/step_limit.h"
#include "forces/friction.h"
#include "scenes.h"
#include "theory/theory.h"

#include <math.h>
#include <string.h>

/* ---- theory ---- */

/*
 * d'' = -N/m from d = 0, d' = 1 by fourth-order Runge-Kutta; returns the speed ratio, the time of free flight's zero, and the
 * integral of each load. k = 1, m = 1: b is half the dashpot.
 */
struct oscillator { double b; bool clip; double d, v, J[3]; };

static void oscillator_rate(const struct oscillator *o, double rate[5])
{
    const double spring = o->d > 0.0 ? o->d : 0.0, damped = o->d > 0.0 ? o->d + 2.0 * o->b * o->v : 0.0;
    const double N = o->clip ? fmax(damped, 0.0) : damped;
    rate[0] = o->v;
    rate[1] = -N;
    rate[2] = spring;
    rate[3] = fmax(N, 0.0);
    rate[4] = fabs(N);
}

static struct oscillator oscillator_moved(struct oscillator o, const double rate[5], double t)
{
    o.d += t * rate[0];
    o.v += t * rate[1];
    for (int k = 0; k < 3; k++)
        o.J[k] += t * rate[2 + k];
    return o;
}

static void oscillate(struct oscillator *o, double *time)
{
    const double dt = 1e-4;
    double r[4][5];
    o->d = 1e-300;
    o->v = 1.0;
    for (*time = 0.0; o->d > 0.0; *time += dt) {
        oscillator_rate(o, r[0]);
        struct oscillator at = oscillator_moved(*o, r[0], 0.5 * dt);
        oscillator_rate(&at, r[1]);
        at = oscillator_moved(*o, r[1], 0.5 * dt);
        oscillator_rate(&at, r[2]);
        at = oscillator_moved(*o, r[2], dt);
        oscillator_rate(&at, r[3]);
        for (int k = 0; k < 5; k++)
            r[0][k] = (r[0][k] + 2.0 * r[1][k] + 2.0 * r[2][k] + r[3][k]) / 6.0;
        *o = oscillator_moved(*o, r[0], dt);
    }
    *time -= o->d / o->v;
}

static void head_on_closed_forms_agree_with_integration(void)
{
    const double damping[] = { 0.05, 0.3, 0.9, 1.0, 2.5 };
    for (int clip = 0; clip < 2; clip++)
        for (int k = 0; k < (clip ? 5 : 3); k++) {
            const double b = damping[k];
            struct oscillator o = { .b = b, .clip = clip };
            double time, e, duration;
            struct theory_contact law = { .normal_stiffness = 1.0, .clip = clip, .mass = { 2.0, 2.0 }, .normal_damping = 2.0 * b };
            oscillate(&o, &time);
            check_relative(theory_restitution(b, clip), -o.v, 3e-4, "speed ratio by integration");
            theory_head_on(&law, &e, &duration);
            check_relative(e, -o.v, 3e-4, "speed ratio of the law");
            if (b != 1.0)
                check_relative(duration, time, 3e-4, "time of free flight's zero by integration");
            for (int load = 0; load < 3; load++) {
                law.load = (enum theory_load)load;
                check_relative(theory_sliding_impulse(&law), o.J[load], 3e-4, "impulse of the load by integration");
            }
        }
}

static void damping_of_restitution_goes_back(void)
{
    for (double e = 0.02; e < 1.0; e += 0.07)
        for (int clip = 0; clip < 2; clip++) {
            check_relative(theory_restitution(theory_damping_ratio(e, clip), clip), e, 1e-12, "theory there and back");
            check_relative(damping_ratio_of_restitution(e, clip), theory_damping_ratio(e, clip), 1e-12, "the solver's damping ratio");
        }
    check_true(damping_ratio_of_restitution(1.0, true) == 0.0 && damping_ratio_of_restitution(1.0, false) == 0.0, "restitution 1 is no dashpot");
    check_relative(restitution_of_damping_ratio(1.0, true), exp(-2.0), 1e-14, "critical damping, clipped");
    check_relative(restitution_of_damping_ratio(1.0 - 1e-7, true), exp(-2.0), 1e-6, "the limit from below");
    check_relative(restitution_of_damping_ratio(1.0 + 1e-7, true), exp(-2.0), 1e-6, "the limit from above");
    check_true(restitution_of_damping_ratio(1.0, false) == 0.0, "critical damping, tension allowed: nothing comes back");
}

static void repulsion_is_the_slope_of_its_potential(void)
{
    for (int form = 0; form < 2; form++) {
        const struct theory_repulsion law = { form == 1, 0.7, 0.05, 14.0 };
        const double a1 = 1.3, a2 = 0.4, h = 0.06, step = 1e-5;
        const struct theory_sphere s[2] = { { .radius = a1 }, { .radius = a2, .x = { 0.0, a1 + a2 + h, 0.0 } } };
        struct theory_pair f;
        theory_repulsion_pair(&law, s, &f);
        const double slope = (theory_repulsion_energy(&law, a1, a2, h + step) - theory_repulsion_energy(&law, a1, a2, h - step)) / (2.0 * step);
        check_relative(f.force[0][1], slope, 1e-7, "F_1 = dV/dh n");
        check_true(f.force[0][1] < 0.0 && f.stress[1][1] < 0.0, "it repels, and presses");
    }
}

/* A reference integration must agree with the closed form where there is one, and conserve what motion conserves. */
static void integration_of_impacts(void)
{
    struct theory_contact law = { .normal_stiffness = 300.0, .tangential_stiffness = 90.0, .friction = 1e9, .normal_damping = 2.0,
                                  .lever_at_contact = true, .mass = { 7.6, 3.7 } };
    struct theory_collision c = { &law, { { .radius = 1.3, .u = { 0.5, 0.0, 0.0 } }, { .radius = 0.9, .x = { 2.2, 0.0, 0.0 } } } };
    struct theory_sphere now[2];
    double e, duration;
    theory_head_on(&law, &e, &duration);
    check_true(theory_collide(&c, 2.0 * duration, now), "integrated");
    check_relative((now[1].u[0] - now[0].u[0]) / 0.5, e, 1e-9, "speed ratio");
    check_relative(2.0 * duration - (now[1].x[0] - now[0].x[0] - 2.2) / (0.5 * e), duration, 1e-9, "duration");

    c.start[0].u[1] = 0.4;
    c.start[1].w[2] = 0.3;
    double L[2] = { 0.0, 0.0 };
    check_true(theory_collide(&c, 2.0 * duration, now), "integrated");
    for (int when = 0; when < 2; when++)
        for (int a = 0; a < 2; a++) {
            const struct theory_sphere *s = when ? &now[a] : &c.start[a];
            L[when] += law.mass[a] * (s->x[0] * s->u[1] - s->x[1] * s->u[0]) + 0.4 * law.mass[a] * s->radius * s->radius * s->w[2];
        }
    check_relative(L[1], L[0], 1e-10, "angular momentum, arms at the contact");
}

/* ---- the solver ---- */

static void friction_laws_at_their_thresholds(void)
{
    struct friction_rule f = { NULL, 0.5, 2.0, { true, false } };
    const double below = nextafter(2.0, 0.0);
    check_true(friction_plain(&f, 3.0, 0, 1).cap == 1.5 && friction_plain(&f, 0.0, 0, 0).lives, "plain");
    check_true(friction_critical(&f, 2.0, 0, 0).cap == 1.0 && friction_critical(&f, 2.0, 0, 0).lives, "critical at its load");
    check_true(friction_critical(&f, below, 0, 0).cap == 0.0 && !friction_critical(&f, below, 0, 0).lives, "critical below its load");
    check_true(friction_soft(&f, 2.0, 0, 0).cap == 1.0 && friction_soft(&f, 1.0, 0, 0).cap == 0.25 && friction_soft(&f, 4.0, 0, 0).cap == 2.0, "soft");
    check_true(friction_shifted(&f, 3.0, 0, 0).cap == 0.5 && friction_shifted(&f, 2.0, 0, 0).cap == 0.0 && !friction_shifted(&f, below, 0, 0).lives, "shifted");
    check_true(friction_binary(&f, 3.0, 0, 0).cap == 1.5 && !friction_binary(&f, 3.0, 0, 1).lives && !friction_binary(&f, 3.0, 1, 0).lives, "binary");
    f.critical_load = 0.0;
    for (double load = 0.0; load < 2.0; load += 0.37)
        check_true(friction_critical(&f, load, 0, 0).cap == friction_plain(&f, load, 0, 0).cap && friction_critical(&f, load, 0, 0).lives
                       && friction_soft(&f, load, 0, 0).cap == friction_plain(&f, load, 0, 0).cap
                       && friction_shifted(&f, load, 0, 0).cap == friction_plain(&f, load, 0, 0).cap, "no critical load is plain to the last bit");
}

#define SPHERES "\"species\":[{\"name\":\"a\",\"radius\":1.0,\"density\":0.25},{\"name\":\"b\",\"radius\":1.4,\"density\":0.25%s}]"
#define HELD ",\"motion\":\"held\""
#define DRIVEN ",\"motion\":{\"velocity\":[0.5,-0.25,0],\"spin\":[0,0,0.5]}"

static struct simulation *scene(const char *motion, const char *fluid, const char *forces, const char *dt, const char *rows, struct error *e)
{
    char text[2000];
    snprintf(text, sizeof text, "{\"about\":\"test\",\"seed\":1,%s\"box\":{\"lengths\":[12,12,12],\"periodic\":[true,true,true]}," SPHERES
             ",\"start\":{\"file\":\"states.csv\"},\"forces\":{%s},\"dynamics\":{\"verlet\":{\"dt\":%s,\"rotation\":\"on\"}},\"run\":{\"steps\":10}}",
             fluid, motion, forces, dt);
    return scene_from(text, rows, e);
}

static void refused(const char *motion, const char *fluid, const char *forces, const char *dt, const char *word)
{
    struct error e = { 0 };
    struct simulation *sim = scene(motion, fluid, forces, dt, "1,1,3,3,3,0,0,0,0,0,0\n2,2,5.35,3,3,0,0,0,0,0,0\n", &e);
    if (!error_raised(&e))
        simulation_begin(sim, &e);
    check_true(error_raised(&e) && strstr(e.text, word), e.text[0] ? e.text : word);
    drop(sim);
}

#define SPRING "\"normal_stiffness\":100,\"tangential_stiffness\":30,\"friction\":0.5,\"lever\":\"radius\""
#define COLD "\"fluid\":{\"kT\":0},"

static void wrong_scenes_are_refused(void)
{
    refused("", "\"fluid\":{\"kT\":0.1},", "\"contact\":{" SPRING ",\"restitution\":0.5,\"tangential_damping\":0,\"tension\":\"allow\",\"cap\":\"spring\"}", "1e-3", "no noise of its own");
    refused("", COLD, "\"contact\":{" SPRING ",\"restitution\":0.5,\"normal_damping\":1,\"tangential_damping\":0,\"tension\":\"allow\",\"cap\":\"spring\"}", "1e-3", "beside normal_damping");
    refused("", COLD, "\"contact\":{" SPRING ",\"restitution\":0,\"tangential_damping\":0,\"tension\":\"allow\",\"cap\":\"spring\"}", "1e-3", "restitution");
    refused("", COLD, "\"contact\":{" SPRING ",\"restitution\":1.5,\"tangential_damping\":0,\"tension\":\"allow\",\"cap\":\"spring\"}", "1e-3", "at most 1");
    refused("", COLD, "\"contact\":{" SPRING ",\"restitution\":0.5,\"tension\":\"allow\",\"cap\":\"spring\"}", "1e-3", "tangential_damping");
    refused("", COLD, "\"contact\":{" SPRING ",\"restitution\":0.5,\"tangential_damping\":0,\"cap\":\"spring\"}", "1e-3", "tension");
    refused("", COLD, "\"contact\":{" SPRING ",\"tension\":\"clip\"}", "1e-3", "tension");
    refused("", COLD, "\"contact\":{" SPRING ",\"law\":\"sticky\"}", "1e-3", "law");
    refused("", COLD, "\"contact\":{" SPRING ",\"law\":\"soft\"}", "1e-3", "critical_load");
    refused("", COLD, "\"contact\":{" SPRING ",\"law\":\"binary\",\"rough\":[true]}", "1e-3", "rough");
    refused("", COLD, "\"repulsion\":{\"form\":\"energy\",\"force\":1,\"kappa_factor\":0.01,\"cutoff\":14}", "1e-3", "energy");
    refused("", COLD, "\"applied\":{\"nobody\":{\"force\":[1,0,0]}}", "1e-3", "nobody");
    refused("", COLD, "\"applied\":{\"a\":{}}", "1e-3", "force, torque");
    refused("", COLD, "\"tether\":{\"a\":{\"stiffness\":-1}}", "1e-3", "stiffness");
    refused(",\"motion\":\"stuck\"", COLD, "", "1e-3", "motion");
    refused(",\"motion\":{\"velocity\":[1,2],\"spin\":[0,0,0]}", COLD, "", "1e-3", "three numbers");
    /* Steps above the limits: of a tether 2/sqrt(k/m), of a dashpot, of repulsion at touch. */
    refused("", COLD, "\"tether\":{\"a\":{\"stiffness\":1e4}}", "0.0206", "tether");
    refused("", COLD, "\"contact\":{\"normal_stiffness\":1,\"friction\":0,\"normal_damping\":1e3,\"tension\":\"allow\"}", "0.0021", "contact");
    refused("", COLD, "\"repulsion\":{\"form\":\"energy\",\"energy\":3,\"kappa_factor\":0.01,\"cutoff\":14}", "0.05", "repulsion");
}

/* A sphere on a spring oscillates about its start, through the faces of the cell; error (w dt)^2/24 of the phase. */
static void tethered_sphere_oscillates(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene("", COLD, "\"tether\":{\"a\":{\"stiffness\":0.02}}", "0.01", "1,1,11,3,3,1.0,0.4,0,0,0,0\n2,2,5,8,8,0.3,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    const struct particles *p = &sim->suspension.particles;
    const double w = sqrt(0.02 / mass_of(p, 0)), t = 12.0;
    check_true(advance(sim, 1200, &e), e.text);
    const vec3 off = box_unwrapped(&sim->suspension.box, p->image[0]);
    check_true(p->image[0][0] != 0, "it has left the cell");
    check_close(p->position[0].x + off.x - 11.0, sin(w * t) / w, 1e-4, "x");
    check_close(p->position[0].y + off.y - 3.0, 0.4 * sin(w * t) / w, 1e-4, "y");
    check_relative(p->velocity[1].x, 0.3, 1e-15, "the other one is free");
    check_relative(step_advised(&sim->suspension), 0.03 * M_PI / w, 1e-12, "advised step of a tether");
    drop(sim);
}

/* 3 % of the time that the lightest pair is in contact, pi sqrt(m_red/k). */
static void advised_step_of_a_collision(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene("", COLD, "\"contact\":{\"normal_stiffness\":300,\"friction\":0}", "0.001", "1,1,1,3,3,0,0,0,0,0,0\n2,2,5,8,8,0,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    const struct particles *p = &sim->suspension.particles;
    const double light = fmin(mass_of(p, 0), mass_of(p, 1));
    check_true(fabs(mass_of(p, 0) - mass_of(p, 1)) > 0.1 * light, "unequal masses");
    check_relative(step_advised(&sim->suspension), 0.03 * M_PI * sqrt(0.5 * light / 300), 1e-12, "advised step of a collision");
    drop(sim);
}

static void driven_spheres_keep_their_motion(void)
{
    struct error e = { 0 };
    struct simulation *sim = scene(DRIVEN, COLD, "\"contact\":{" SPRING ",\"restitution\":0.5,\"tangential_damping\":1,\"tension\":\"allow\",\"cap\":\"spring\"}", "1e-3",
                                   "1,1,3,3,3,0,0,0,0,0,0\n2,2,5.35,3,3,9,9,9,9,9,9\n3,2,5.4,4,3,0,0,0,0,0,0\n", &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    const struct particles *p = &sim->suspension.particles;
    check_true(sim->suspension.neighbours.near.count == 1, "two driven spheres are no pair, however much they overlap");
    check_true(norm(p->force[1]) > 0.0 && norm(p->force[0]) == norm(p->force[1]), "a driven sphere feels what it exerts");
    check_true(advance(sim, 500, &e), e.text);
    check_true(p->velocity[1].x == 0.5 && p->velocity[1].y == -0.25 && p->spin[1].z == 0.5, "velocity and spin of the species, not of the file");
    check_close(p->position[1].x, 5.35 + 0.25, 1e-12, "its path");
    check_true(norm(p->velocity[0]) > 0.0, "the free one was pushed");
    struct stress *stress = &sim->suspension.stress;
    stress_clear(stress);
    stress_kinetic(stress, sim->suspension.kinetic_origin, &sim->suspension.box, p);
    check_relative(stress->sum[sim->suspension.kinetic_origin].m[0][0], -mass_of(p, 0) * p->velocity[0].x * p->velocity[0].x, 1e-14,
                   "kinetic stress of the free one only");
    check_true(step_limit_of(&sim->suspension, &e).dt > 0.0 && isfinite(step_advised(&sim->suspension)), "step limits with infinite masses");
    drop(sim);
}

/* The implicit friction step moves a lubricated neighbour of a driven sphere as small explicit steps do, and leaves the driven one alone. */
static void driven_spheres_in_the_split(void)
{
    vec3 free_one[2] = { { 0 } };
    for (int implicit = 0; implicit < 2; implicit++) {
        struct error e = { 0 };
        char text[1200];
        snprintf(text, sizeof text, "{\"about\":\"test\",\"fluid\":{\"viscosity\":0.7},\"box\":{\"lengths\":[12,12,12],\"periodic\":[true,true,true]}," SPHERES
                 ",\"start\":{\"file\":\"states.csv\"},\"forces\":{\"drag\":{\"torque\":true},\"lubrication\":{\"inner_gap\":1e-3,\"outer_gap\":0.05,"
                 "\"rotation_correction\":\"none\"}},\"dynamics\":{\"%s\":{\"dt\":1e-4}},\"run\":{\"steps\":10}}", DRIVEN, implicit ? "split" : "verlet");
        struct simulation *sim = scene_from(text, "1,1,3,3,3,0,0,0,0,0,0\n2,2,5.42,3,3,9,9,9,9,9,9\n", &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e) && advance(sim, 1000, &e), e.text);
        const struct particles *p = &sim->suspension.particles;
        check_true(p->velocity[1].x == 0.5 && p->velocity[1].y == -0.25 && p->spin[1].z == 0.5, "the driven one");
        free_one[implicit] = p->velocity[0];
        drop(sim);
    }
    check_true(norm(free_one[0]) > 0.05, "the other one is dragged along");
    check_close(norm(minus(free_one[1], free_one[0])), 0.0, 1e-3 * norm(free_one[0]), "explicit and implicit");
}

/* Below the critical load a contact has no history; above it grows from zero. */
static void history_lives_only_above_the_critical_load(void)
{
    for (int heavy = 0; heavy < 2; heavy++) {
        struct error e = { 0 };
        char forces[300];
        snprintf(forces, sizeof forces, "\"contact\":{" SPRING ",\"law\":\"critical\",\"critical_load\":%g}", heavy ? 1.0 : 100.0);
        struct simulation *sim = scene(HELD, COLD, forces, "1e-3", "1,1,3,3,3,0,0.3,0,0,0,0\n2,2,5.35,3,3,0,0,0,0,0,0\n", &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e) && advance(sim, 3, &e), e.text);
        const double size = norm(*sim->suspension.neighbours.near.pair[0].history);
        check_true(heavy ? size > 0.0 : size == 0.0, heavy ? "history above the load" : "no history below the load");
        drop(sim);
    }
}

static const struct unit_test tests[] = {
    { "head-on impacts: closed forms against integration", head_on_closed_forms_agree_with_integration },
    { "damping ratio of a restitution, there and back", damping_of_restitution_goes_back },
    { "repulsion is the slope of its potential", repulsion_is_the_slope_of_its_potential },
    { "impacts integrated: speed ratio, angular momentum", integration_of_impacts },
    { "friction laws at their thresholds", friction_laws_at_their_thresholds },
    { "wrong scenes are refused", wrong_scenes_are_refused },
    { "a tethered sphere oscillates through the faces", tethered_sphere_oscillates },
    { "advised step of a collision", advised_step_of_a_collision },
    { "driven spheres keep their motion", driven_spheres_keep_their_motion },
    { "driven spheres in the split", driven_spheres_in_the_split },
    { "history lives only above the critical load", history_lives_only_above_the_critical_load },
    { NULL, NULL },
};
const struct suite collision_suite = { "collision", tests };
