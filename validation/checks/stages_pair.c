/*
 * Layer 3: a pair in a flow that changes with time
 *
 * Two spheres near contact, within the cell and across a face: their motion against each other is the same. The velocity of an image is the mean over
 * the step, like the velocities that it is compared with; at the end of the step it would be wrong by half a step of the flow's change. Where a rate
 * jumps within a step, images and spheres must be carried along as far as each other.
 */
#include "single.h"

#include <stdlib.h>

void check_stages_pair(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct theory_stage stage[STAGES];
    struct state_row start[2];
    struct track track[2] = { { 0 } };
    struct worst w[3] = { WORST_NONE, WORST_NONE, WORST_NONE };
    struct model m;
    int at[8];
    double G[3][3], way;
    bool good = model_read(run, scene, &m);
    const size_t stages = stages_read(scene_get(scene, "stages"), stage);
    const double a = m.radius[0], n[3] = { 0.36, 0.48, 0.8 }, rate = scene_number(parameters, "rate", NAN), apart = scene_number(parameters, "apart", 1.01);
    theory_driven_flow(stage, stages, 0.0, G, &way);
    for (int k = 0; k < 8; k++)
        at[k] = (int)scene_number(parameters, "steps", NAN) / 8 * (k + 1);
    for (int face = 0; face < 2 && good; face++) {
        for (int side = 0; side < 2; side++) {
            start[side] = (struct state_row){ .id = side + 1, .species = m.species > 1 ? side + 1 : 1 };
            for (int c = 0; c < 3; c++)
                start[side].x[c] = (face ? 0.0 : 0.5 * m.cell[c][c]) + (side ? 1.0 : -1.0) * a * apart * n[c];
            apply(G, start[side].x, start[side].u);
        }
        good = track_ask(run, face ? "across-faces" : "inside", scene, start, 2, at, 8, &track[face]);
    }
    for (size_t s = 0; s < 8 && good; s++)
        for (size_t c = 0; c < 3; c++) {
            double x[2], u[2];
            for (int face = 0; face < 2; face++) {
                const struct track_point *p = track_at(&track[face], s, 0), *q = track_at(&track[face], s, 1);
                x[face] = q->x[c] - p->x[c];
                u[face] = q->u[c] - p->u[c];
            }
            worst_see(&w[0], x[1], x[0], a, s);
            worst_see(&w[1], u[1], u[0], rate * a, s);
            worst_see(&w[2], track_at(&track[1], s, 0)->w[c], track_at(&track[0], s, 0)->w[c], rate, s);
        }
    static const char *const names[3] = { "distance", "relative velocity", "spin" };
    for (int q = 0; q < 3 && good; q++)
        check_error(run, INVARIANT, names[q], w[q].measured, w[q].expected, w[q].error, run->gate_case->tolerance,
                    "in a flow that changes with time a pair across the faces moves otherwise than inside the cell: its %s is %s", names[q], compare(&w[q]));
    for (int face = 0; face < 2; face++)
        track_free(&track[face]);
    json_decref(scene);
}
