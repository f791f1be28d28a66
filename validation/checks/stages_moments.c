/*
 * Layer 3: moments that binary numbers round
 *
 * A stage of 0.035 that ends in the middle of a step of 0.01 ends at 3 dt + dt/2 and at 4 dt - dt/2, which are two numbers, or one, as rounding will have it.
 * A code that asks twice on which side of them it is may push spheres along with the flow twice, or not at all. So: shears that turn round every few half
 * steps, seven times in a run, by durations written in decimals; heavy spheres of a periodic cell that start with the flow,
 *
 *     u = G(t) x          wherever no rate has jumped within the last step or will within the next
 */
#include "single.h"

#include <stdio.h>
#include <stdlib.h>

enum { HEAVY = 3 };

void check_stages_moments(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const int runs = (int)scene_number(parameters, "runs", 0);
    const double rate = scene_number(parameters, "rate", NAN), dt = scene_number(run->gate_case->scene, "dynamics.verlet.dt", NAN);
    struct worst w = WORST_NONE;
    int worst_run = 0;
    for (int r = 0; r < runs; r++) {
        json_t *scene = json_deep_copy(run->gate_case->scene), *stages = json_array();
        int half[STAGES], end[STAGES], steps = 0;               /* in half steps */
        char name[32];
        for (int n = 0; n < STAGES; n++) {
            half[n] = 5 + (5 * r + 3 * n) % 12;
            end[n] = half[n] + (n ? end[n - 1] : 0);
            json_array_append_new(stages, json_pack("{sfs[{sssssf}]}", "duration", (double)half[n] * 0.5 * dt, "shear", "flow", "x", "gradient", "y", "rate", n % 2 ? -rate : rate));
        }
        steps = end[STAGES - 1] / 2;
        int at[200];
        for (int s = 0; s < steps && s < 200; s++)
            at[s] = s + 1;
        struct model m;
        struct track track;
        struct state_row start[HEAVY];
        scene_set(scene, "stages", stages);
        if (!model_read(run, scene, &m)) {
            json_decref(scene);
            return;
        }
        for (int i = 0; i < HEAVY; i++)
            start[i] = (struct state_row){ .id = i + 1, .species = 1, .x = { 1.0 + 2.0 * i, (0.2 + 0.3 * i) * m.cell[1][1], 1.5 }, .u = { rate * (0.2 + 0.3 * i) * m.cell[1][1], 0.0, 0.0 },
                                           .w = { 0.0, 0.0, -0.5 * rate } };
        snprintf(name, sizeof name, "run-%d", r);
        if (steps <= 200 && track_ask(run, name, scene, start, HEAVY, at, (size_t)steps, &track)) {
            for (int s = 0; s < steps; s++) {
                int now = 0, near = 2 * at[s];                  /* half steps since the start: all jumps are far */
                for (int n = 0; n < STAGES; n++) {                      /* after the last the liquid is at rest */
                    now += end[n] < 2 * at[s];
                    near = abs(end[n] - 2 * at[s]) < near ? abs(end[n] - 2 * at[s]) : near;
                }
                for (size_t i = 0; near >= 2 && i < HEAVY; i++) {
                    const double expected = (now % 2 ? -rate : rate) * start[i].x[1], before = w.error;
                    worst_see(&w, track_at(&track, (size_t)s, i)->u[0], expected, rate * start[i].x[1], (size_t)at[s]);
                    worst_run = w.error > before ? r : worst_run;
                }
            }
            track_free(&track);
        }
        json_decref(scene);
    }
    check_error(run, INVARIANT, "one push for each jump", w.measured, w.expected, w.error, run->gate_case->tolerance,
                "run-%d, step %zu: a sphere that should be carried along by the flow moves at %s; rates jump in the middle of steps, at moments that have no binary number",
                worst_run, w.at, compare(&w));
}
