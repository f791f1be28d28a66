/* Flows that change with time: strain in closed form against quadrature, pairs against brute force, free spheres. */
#include "suite.h"

#include "scene.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char path[] = "/tmp/shear-stages-XXXXXX";

/* A scene with these stages and particles, built; the caller closes it. `more`: a second species, or "". */
static struct simulation *scene_with(const char *more, const char *stages, const char *rest, struct error *e)
{
    struct simulation *sim = calloc(1, sizeof *sim);
    const struct scene_options options = { .set_count = 0 };
    if (strchr(path, 'X'))
        close(mkstemp(path));
    FILE *out = fopen(path, "w");
    fprintf(out, "{ \"about\": \"test\", \"seed\": 3, \"species\": [ { \"name\": \"a\", \"radius\": 0.5, \"density\": 1.3 }%s%s ], \"stages\": %s,\n%s }\n",
            *more ? ", " : "", more, stages, rest);
    fclose(out);
    memset(e, 0, sizeof *e);
    scene_build(path, &options, sim, e);
    return sim;
}

static struct simulation *scene_of(const char *stages, const char *rest, struct error *e) { return scene_with("", stages, rest, e); }

static void done_with(struct simulation *sim)
{
    struct error e = { 0 };
    simulation_close(sim, &e);
    free(sim);
}

static const char crowd[] =
    "\"box\": { \"lengths\": [5.1, 6.3, 4.7], \"periodic\": [true, true, true] }, \"start\": { \"random\": { \"phi\": 0.15, \"count\": 40, \"volume_shares\": [1] } },\n"
    "\"forces\": { \"contact\": { \"normal_stiffness\": 100, \"friction\": 0 } }, \"dynamics\": { \"verlet\": { \"dt\": 0.001 } }, \"run\": { \"time\": \"stages\" }";

static const char laws[] =
    "[ { \"duration\": 1.3, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": { \"ramp\": [0.8, -0.5] } } ] },\n"
    "  { \"strain\": 0.9, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -1.2 },\n"
    "      { \"flow\": \"z\", \"gradient\": \"y\", \"rate\": { \"mean\": 0.2, \"amplitude\": -1.5, \"angular_frequency\": 9.0, \"phase\": 0.7 } } ] },\n"
    "  { \"duration\": 0.4, \"shear\": [] },\n"
    "  { \"duration\": 2.9, \"shear\": [ { \"flow\": \"z\", \"gradient\": \"y\", \"rate\": { \"mean\": 0.3, \"amplitude\": 1.1, \"angular_frequency\": 4.0, \"phase\": -2.0 } } ] } ]";

static void strain_is_the_integral_of_the_rate(void)
{
    struct error e;
    struct simulation *sim = scene_of(laws, crowd, &e);
    check_true(!error_raised(&e), e.text);
    const struct flow *flow = sim->suspension.box.flow;
    check_true(flow != NULL, "flow");
    if (!flow)
        return;
    const double first = 1.3, second = first + 0.75, third = second + 0.4;
    check_true(flow->flow_axis == 0 && flow->gradient_axis == 1, "the plane of the first shear");
    check_close(flow->duration, third + 2.9, 1e-14, "strain 0.9 at rate -1.2 lasts 0.75");
    check_close((double)sim->last_step, ceil((third + 2.9) / 0.001), 0, "run until the last stage ends");
    double xy = 0.0, zy = 0.0, way = 0.0;
    const int pieces = 400000;
    const double dt = 5.5 / pieces;
    for (int k = 0; k < pieces; k++) {                                          /* midpoint rule; rates jump at stage ends */
        const double t = (k + 0.5) * dt;
        const mat3 G = flow->gradient(flow, t);
        xy += G.m[0][1] * dt;
        zy += G.m[2][1] * dt;
        way += fabs(t < second ? G.m[0][1] : G.m[2][1]) * dt;
        if (k % 20011 == 0 || k == pieces - 1) {
            const mat3 S = flow->strain(flow, t + 0.5 * dt);
            check_close(S.m[0][1], xy, 4 * dt, "strain of x along y: a step across each jump of the rate");
            check_close(S.m[2][1], zy, 4 * dt, "strain of z along y");
            check_close(flow->travelled(flow, t + 0.5 * dt), way, 4 * dt, "way travelled by the first shear of each stage");
        }
    }
    check_close(flow->gradient(flow, first + 0.1).m[2][1], 0.2 - 1.5 * sin(0.9 + 0.7), 1e-14, "oscillating rate");
    check_close(flow->gradient(flow, 0.65).m[0][1], 0.15, 1e-14, "middle of the ramp");
    check_close(flow->gradient(flow, second + 0.1).m[0][1], 0, 0, "rest");
    check_close(flow->strain(flow, 99).m[2][1], flow->strain(flow, 50).m[2][1], 0, "at rest after the last stage");
    done_with(sim);
}

/* Pairs within range over all images, and a moment of them. */
static int brute_force(const struct box *b, const struct particles *p, double range, double *moment)
{
    int pairs = 0;
    *moment = 0.0;
    for (int i = 0; i < p->count; i++)
        for (int j = i + 1; j < p->count; j++)
            for (int k = 0; k < 7 * 7 * 7; k++) {
                const int shift[3] = { k % 7 - 3, k / 7 % 7 - 3, k / 49 - 3 };
                const vec3 r = minus(plus(p->position[j], box_offset(b, shift)), p->position[i]);
                if (norm(r) <= range) {
                    pairs++;
                    *moment += r.x * r.y + 0.3 * r.z * r.z + 0.1 * r.x * r.z;
                }
            }
    return pairs;
}

/* Two shears along one gradient or of one flow, with different laws, through reversals, in every plane. */
static void pairs_in_all_planes(void)
{
    static const char axis[] = "xyz";
    for (int f = 0; f < 3; f++)
        for (int g = 0; g < 3; g++) {
            if (f == g)
                continue;
            char stages[600];
            struct error e;
            bool relisted;
            int lists = 0;
            snprintf(stages, sizeof stages, "[ { \"duration\": 0.8, \"shear\": [ { \"flow\": \"%c\", \"gradient\": \"%c\", \"rate\": 1.7 }, { \"flow\": \"%c\", "
                     "\"gradient\": \"%c\", \"rate\": { \"mean\": 0.1, \"amplitude\": 2.0, \"angular_frequency\": 5.0, \"phase\": 0.5 } } ] },\n"
                     "{ \"duration\": 0.8, \"shear\": [ { \"flow\": \"%c\", \"gradient\": \"%c\", \"rate\": { \"ramp\": [-1.4, -0.3] } } ] } ]",
                     axis[f], axis[g], axis[f < g ? 3 - f - g : f], axis[f < g ? g : 3 - f - g], axis[f], axis[g]);
            struct simulation *sim = scene_of(stages, crowd, &e);
            check_true(!error_raised(&e), e.text);
            struct box *b = &sim->suspension.box;
            struct particles *p = &sim->suspension.particles;
            struct neighbours *n = &sim->suspension.neighbours;
            bool moved_cell = false;
            const double volume = b->volume;
            for (int step = 0; step < 16 && !error_raised(&e); step++) {
                double expected, moment = 0.0;
                check_true(neighbours_find(n, b, p, &relisted, &e), e.text);
                const int pairs = brute_force(b, p, n->largest_range, &expected);
                for (int k = 0; k < n->near.count; k++) {
                    const vec3 r = scaled(n->near.pair[k].normal, n->near.pair[k].distance);
                    moment += r.x * r.y + 0.3 * r.z * r.z + 0.1 * r.x * r.z;
                }
                check_close(n->near.count, pairs, 0, "pairs found");
                check_close(moment, expected, 1e-11 * (1 + pairs), "moment of the pairs: rounding of a sum");
                lists += relisted;
                moved_cell = moved_cell || b->lattice[f][g] != 0;
                const double next = b->time + 0.1;
                const mat3 F = box_deformation(b, b->time, next);
                for (int i = 0; i < p->count; i++) {                            /* with the flow, and a jitter of its own */
                    const vec3 jitter = vec(0.006 * sin(7.0 * i + step), 0.006 * cos(5.0 * i + step), 0.006 * sin(3.0 * i - step));
                    p->position[i] = plus(mat3_times(&F, p->position[i]), jitter);
                    p->velocity[i] = box_flow(b, p->position[i]);
                }
                box_set_time(b, next);
                double determinant = dot(mat3_column(&b->cell, 0), cross(mat3_column(&b->cell, 1), mat3_column(&b->cell, 2)));
                check_close(determinant, volume, 1e-11, "volume");
            }
            check_true(moved_cell, "the cell was remapped on the way");
            check_true(lists >= 3, "several lists");
            done_with(sim);
        }
}

static const char lone[] =
    "\"box\": { \"lengths\": [5.1, 6.3, 4.7], \"periodic\": [true, %s, true] }, \"fluid\": { \"viscosity\": 0.7 }, \"start\": { \"file\": \"%s.csv\" },\n"
    "\"forces\": { \"drag\": { \"torque\": true } }, \"dynamics\": { \"verlet\": { \"dt\": 0.0005 } }, \"run\": { \"time\": 2.2 }";

/*
 * x along y at rate A sin(w t), sphere at rest at y0, friction time T = m/(6 pi eta a).
 * Periodic: the liquid's own acceleration carries it along, so U = A sin(w t) y0 and x = x0 + S y0, without lag.
 * Open: U = A y0 [sin(w t) - w T cos(w t) + w T exp(-t/T)]/(1 + w^2 T^2).
 * The spin lags in both: the same expression with -A/2 and T_r = I/(8 pi eta a^3).
 */
static void free_sphere_in_oscillating_shear(void)
{
    const double A = 0.9, w = 6.0, y0 = 1.7, a = 0.5, eta = 0.7, m = 4.0 / 3.0 * M_PI * 1.3 * a * a * a;
    const double T = m / (6.0 * M_PI * eta * a), T_r = 0.4 * m * a * a / (8.0 * M_PI * eta * a * a * a), t = 2.2;
    for (int open = 0; open < 2; open++) {
        char rest[900], states[100];
        struct error e;
        snprintf(rest, sizeof rest, lone, open ? "false" : "true", path);
        snprintf(states, sizeof states, "%s.csv", path);
        done_with(scene_of("[]", crowd, &e));                                   /* gives `path` its name */
        snprintf(rest, sizeof rest, lone, open ? "false" : "true", path);
        snprintf(states, sizeof states, "%s.csv", path);
        FILE *out = fopen(states, "w");
        fprintf(out, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0.3,%g,0.2,0,0,0,0,0,0\n", y0);
        fclose(out);
        struct simulation *sim = scene_of("[ { \"duration\": 9, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": { \"mean\": 0, \"amplitude\": 0.9, "
                                          "\"angular_frequency\": 6.0, \"phase\": 0 } } ] } ]", rest, &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e) && simulation_run(sim, &e), e.text);
        const struct particles *p = &sim->suspension.particles;
        if (error_raised(&e))
            return;
        const vec3 off = box_unwrapped(&sim->suspension.box, p->image[0]);
        const double lag = w * T, U = A * y0 * (sin(w * t) - lag * cos(w * t) + lag * exp(-t / T)) / (1.0 + lag * lag);
        const double X = A * y0 * ((1.0 - cos(w * t)) / w - T * sin(w * t) + lag * T * (1.0 - exp(-t / T))) / (1.0 + lag * lag);
        const double lag_r = w * T_r, W = -0.5 * A * (sin(w * t) - lag_r * cos(w * t) + lag_r * exp(-t / T_r)) / (1.0 + lag_r * lag_r);
        /* Tolerance: the scheme's drag is first order, dt/T of the lag's scale. */
        check_close(p->velocity[0].x + box_flow(&sim->suspension.box, off).x, open ? U : A * sin(w * t) * y0, 2e-3, open ? "open: velocity" : "velocity");
        check_close(p->position[0].x + off.x - 0.3, open ? X : A * y0 * (1.0 - cos(w * t)) / w, 1e-3, open ? "open: path" : "path");
        check_close(p->spin[0].z, W, 2e-3, "spin");
        check_close(p->position[0].y + off.y, y0, 1e-12, "across the flow");
        done_with(sim);
        remove(states);
    }
}

/* A jump of the rate: whatever cell a sphere is counted in, its peculiar velocity is the same (translation invariance). */
static void reversal_keeps_images_alike(void)
{
    struct error e;
    struct simulation *sim = scene_of("[ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 0.8 } ] },"
                                      "  { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -0.8 } ] } ]", crowd, &e);
    check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
    const int forces = sim->suspension.force_count;
    sim->suspension.overlap_limit = INFINITY;
    sim->suspension.force_count = 1;                                            /* the flow's acceleration alone: no contacts */
    check_true(strcmp(sim->suspension.force[0]->name, "unsteady_flow") == 0, "first force");
    vec3 place[40];
    for (int i = 0; i < 40; i++)
        place[i] = sim->suspension.particles.position[i];
    check_true(simulation_run(sim, &e), e.text);
    sim->suspension.force_count = forces;
    for (int i = 0; i < 40; i++) {
        const vec3 off = box_unwrapped(&sim->suspension.box, sim->suspension.particles.image[i]);
        const vec3 x = plus(sim->suspension.particles.position[i], off);
        check_close(norm(minus(x, place[i])), 0, 0.02, "there and back again: the jump falls between two half steps");
    }
    done_with(sim);
}

/*
 * A row in the very moment in which a rate jumps: a light sphere has half of the jump by then, as the flow of that row has. It moves with the flow
 * whatever cell it is counted in, and a driven one, which has left the cell, has its own velocity.
 */
static void row_at_a_jump(void)
{
    static const char *const schemes[] = { "verlet", "predicted_verlet", "split" };
    for (int k = 0; k < 3; k++) {
        struct error e;
        char rest[900], states[100];
        done_with(scene_of("[]", crowd, &e));                                   /* gives `path` its name */
        snprintf(states, sizeof states, "%s.csv", path);
        FILE *out = fopen(states, "w");
        fprintf(out, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0.3,1.7,0.2,1.36,0,0,0,0,-0.4\n2,2,0.3,6.2,3.2,0,0,0,0,0,0\n");
        fclose(out);
        snprintf(rest, sizeof rest, "\"box\": { \"lengths\": [5.1, 6.3, 4.7], \"periodic\": [true, true, true] }, \"fluid\": { \"viscosity\": 0.7 }, "
                 "\"start\": { \"file\": \"%s\" },\n"
                 "\"forces\": { \"drag\": { \"torque\": true } }, \"dynamics\": { \"%s\": { \"dt\": 0.001 } }, \"run\": { \"time\": 1 }", states, schemes[k]);
        struct simulation *sim = scene_with("{ \"name\": \"b\", \"radius\": 0.5, \"density\": 1.3, \"motion\": { \"velocity\": [0.2, 0.3, 0], \"spin\": [0, 0, 0] } }",
                                            "[ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 0.8 } ] },"
                                            "  { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -0.8 } ] } ]", rest, &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e) && simulation_run(sim, &e), e.text);
        const struct particles *p = &sim->suspension.particles;
        const struct box *b = &sim->suspension.box;
        /* predicted_verlet predicts with the forces of the step before, in which nothing jumped: drag then acts on half the jump, 0.0132 = (zeta dt/m) 1.6 1.7/2. */
        check_close(norm(minus(p->velocity[0], box_flow(b, p->position[0]))), 0, k == 1 ? 1.4e-2 : 1e-12, "free");
        const vec3 driven = plus(p->velocity[1], box_flow(b, box_unwrapped(b, p->image[1])));
        check_true(p->image[1][1] == 1, "the driven sphere has crossed the face");
        check_close(norm(minus(driven, vec(0.2, 0.3, 0))), 0, 1e-12, "driven");
        done_with(sim);
        remove(states);
    }
}

/*
 * Rates that jump in the middle of a step and at its end, in moments that binary numbers round: n dt + dt/2 and (n + 1) dt - dt/2 need not be the same, nor
 * 0.1 + 0.2 and 30 dt. Without drag nothing repairs an impulse that is given twice or not at all.
 */
static void jumps_in_rounded_moments(void)
{
    char states[100], rest[500];
    struct error e;
    done_with(scene_of("[]", crowd, &e));                                       /* gives `path` its name */
    snprintf(states, sizeof states, "%s.csv", path);
    FILE *out = fopen(states, "w");
    fprintf(out, "id,species,x,y,z,ux,uy,uz,wx,wy,wz\n1,1,0.3,1.7,0.2,1.36,0,0,0,0,0\n");
    fclose(out);
    for (int half = 2; half < 140; half++) {                                    /* the first stage ends after so many half steps */
        char stages[300];
        snprintf(stages, sizeof stages, "[ { \"duration\": %.3f, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 0.8 } ] },"
                 "  { \"duration\": 9, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -0.8 } ] } ]", 0.005 * half);
        snprintf(rest, sizeof rest, "\"box\": { \"lengths\": [5.1, 6.3, 4.7], \"periodic\": [true, true, true] }, \"start\": { \"file\": \"%s\" },\n"
                 "\"forces\": { \"contact\": { \"normal_stiffness\": 100, \"friction\": 0 } }, \"dynamics\": { \"verlet\": { \"dt\": 0.01 } }, "
                 "\"run\": { \"steps\": %d }", states, half / 2 + 3);
        struct simulation *sim = scene_of(stages, rest, &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e) && simulation_run(sim, &e), e.text);
        const struct box *b = &sim->suspension.box;
        check_close(b->gradient.m[0][1], -0.8, 0, "the second stage");
        check_close(sim->suspension.particles.velocity[0].x, -0.8 * 1.7, 1e-12, "one impulse");
        done_with(sim);
    }
    struct simulation *sim = scene_of("[ { \"duration\": 0.1, \"shear\": [] }, { \"duration\": 0.2, \"shear\": [] },"
                                      "  { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 0.8 } ] } ]", crowd, &e);
    check_true(!error_raised(&e), e.text);
    const struct flow *flow = sim->suspension.box.flow;
    check_close(flow->gradient(flow, 300 * 0.001).m[0][1], 0.8, 0, "0.1 + 0.2 is 300 times 0.001: the stage that begins");
    check_close(flow->gradient(flow, 0.3 - 1e-9).m[0][1], 0, 0, "and not before");
    done_with(sim);
    remove(states);
}

/*
 * Wherever in a step a rate jumps, also after a start before time 0: at every row spheres that follow the flow have its velocity, and have come as far as
 * the cell is sheared, to the last digits, whether they are followed in the cell or from where they started, a cell higher.
 */
static void jumps_anywhere_in_a_step(void)
{
    static const char *const schemes[] = { "verlet", "predicted_verlet", "split" };
    static const double durations[] = { 0.05, 0.0503, 0.0505, 0.0497, 0.0495, 0.05999 }, begins[] = { 0.0, -0.0045, -0.0055, -0.025, -3.00049 }, height[] = { 4.1, 10.4 };
    char states[100], rest[600], stages[400];
    struct error e;
    done_with(scene_of("[]", crowd, &e));                                       /* gives `path` its name */
    snprintf(states, sizeof states, "%s.csv", path);
    for (int k = 0; k < 3 * 6 * 5; k++) {
        const double begin = begins[k / 18];
        FILE *out = fopen(states, "w");
        fputs("id,species,x,y,z,ux,uy,uz,wx,wy,wz\n", out);
        for (int i = 0; i < 2; i++)
            fprintf(out, "%d,1,%g,%g,0.2,%.17g,0,0,0,0,0\n", i + 1, 4.9 + i, height[i], begin < 0.0 ? 0.0 : 3.0 * height[i]);
        fclose(out);
        snprintf(stages, sizeof stages, "[ { \"duration\": %.5f, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 3 } ] },"
                 "  { \"duration\": 9, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": -4 } ] } ]", durations[k / 3 % 6]);
        snprintf(rest, sizeof rest, "\"box\": { \"lengths\": [5.1, 6.3, 4.7], \"periodic\": [true, true, true] }, \"start\": { \"file\": \"%s\", \"time\": %.6f },\n"
                 "\"forces\": { \"contact\": { \"normal_stiffness\": 100, \"friction\": 0 } }, \"dynamics\": { \"%s\": { \"dt\": 0.001 } }, "
                 "\"run\": { \"steps\": 1 }", states, begin, schemes[k % 3]);
        struct simulation *sim = scene_of(stages, rest, &e);
        check_true(!error_raised(&e) && simulation_begin(sim, &e), e.text);
        struct suspension *s = &sim->suspension;
        const double before = s->box.flow->strain(s->box.flow, begin).m[0][1];
        double velocity = 0.0, place = 0.0;
        for (sim->last_step = 1; sim->last_step <= 70 - (int)(1000.0 * begin); sim->last_step++) {
            check_true(simulation_run(sim, &e), e.text);
            const double strain = s->box.flow->strain(s->box.flow, s->box.time).m[0][1] - before;
            for (int i = 0; i < 2; i++) {
                const vec3 off = box_unwrapped(&s->box, s->particles.image[i]), x = plus(s->particles.position[i], off);
                const vec3 u = plus(s->particles.velocity[i], box_flow(&s->box, off));
                velocity = fmax(velocity, fabs(u.x - box_flow(&s->box, x).x));
                place = fmax(place, fabs(x.x - 4.9 - i - strain * height[i]));
            }
        }
        check_close(velocity, 0, 1e-10, "velocity of the flow");          /* a rounding of t over dt, of 70 */
        check_close(place, 0, 1e-10, "as far as the cell is sheared");
        done_with(sim);
    }
    remove(states);
}

static void wrong_stages_are_named(void)
{
    static const char *const wrong[][2] = {
        { "7", "stages is 7; it must be a list" },
        { "[ { \"shear\": [] } ]", "stages[0].duration is missing" },
        { "[ { \"strain\": 1, \"shear\": [] } ]", "a rest has a duration" },
        { "[ { \"strain\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": { \"ramp\": [0, 1] } } ] } ]", "constant rate" },
        { "[ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"x\", \"rate\": 1 } ] } ]", "must differ from the flow's axis" },
        { "[ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": \"fast\" } ] } ]", "stages[0].shear[0].rate is \"fast\"" },
        { "[ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": { \"mean\": 1, \"amplitude\": 1, \"frequency\": 3 } } ] } ]",
          "angular_frequency is missing" },
        { "[ { \"duration\": 1, \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 1 } ] },"
          "  { \"duration\": 1, \"shear\": [ { \"flow\": \"y\", \"gradient\": \"z\", \"rate\": 1 } ] } ]", "y is a flow axis of one shear" },
        { "[], \"shear\": [ { \"flow\": \"x\", \"gradient\": \"y\", \"rate\": 1 } ]", "must not stand beside shear" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        struct error e;
        struct simulation *sim = scene_of(wrong[k][0], crowd, &e);
        check_true(e.code == ERROR_INPUT && strstr(e.text, wrong[k][1]), e.text);
        done_with(sim);
    }
    remove(path);
}

static const struct unit_test tests[] = {
    { "strain is the integral of the rate", strain_is_the_integral_of_the_rate },
    { "every pair in all planes, two laws at once", pairs_in_all_planes },
    { "a free sphere in oscillating shear", free_sphere_in_oscillating_shear },
    { "a reversal keeps images alike", reversal_keeps_images_alike },
    { "a row at a jump of the rate", row_at_a_jump },
    { "jumps in rounded moments", jumps_in_rounded_moments },
    { "jumps anywhere in a step", jumps_anywhere_in_a_step },
    { "wrong stages are named", wrong_stages_are_named },
    { NULL, NULL }
};
const struct suite stages_suite = { "stages", tests };
