/*
 * Layer 4: an image that comes by while its sphere stands still
 *
 * Two spheres at rest in the laboratory, one just below the upper face of a sheared cell, the other just above the lower one. Nothing acts but their
 * spring, so nothing moves, except that the image of the second beyond the upper face passes with the velocity G H s of the flow's difference. It
 * runs into the first. The same two spheres in a fluid at rest, the second where its image was and as fast, take the same path:
 *
 *     x_1(t), u_1(t)   across the face of a sheared cell = inside a large one
 *
 * A code that asks only how far spheres have moved since it last looked for neighbours does not see the image come. Each axis is once that of the flow.
 */
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOMENTS = 3 };

static void try_plane(struct check_run *run, int flow)
{
    static const char axes[3][2] = { "x", "y", "z" };
    const json_t *parameters = run->gate_case->parameters;
    const int gradient = (flow + 1) % 3, other = (flow + 2) % 3, steps = (int)scene_number(parameters, "steps", NAN);
    const int at[MOMENTS] = { steps / 2, 3 * steps / 4, steps };
    const double edge = scene_number(parameters, "edge", NAN), rate = scene_number(parameters, "rate", NAN), gap = scene_number(parameters, "gap", NAN);
    json_t *scene[2] = { NULL, NULL };
    struct track track[2] = { { 0 } };
    struct worst w = WORST_NONE;
    struct model m;
    bool good = true;
    for (int inside = 0; inside < 2 && good; inside++) {
        char name[32];
        struct state_row row[2] = { { .id = 1, .species = 1 }, { .id = 2, .species = 2 } };
        scene[inside] = json_deep_copy(run->gate_case->scene);
        const double size = inside ? 5.0 * edge : edge;
        scene_set(scene[inside], "box.lengths", json_pack("[fff]", size, size, size));
        if (!inside)
            scene_set(scene[0], "shear", json_pack("[{ss ss sf}]", "flow", axes[flow], "gradient", axes[gradient], "rate", rate));
        good = model_read(run, scene[inside], &m);
        row[0].x[flow] = 0.6 * edge;
        row[1].x[flow] = 0.6 * edge - (m.radius[0] + m.radius[1] + gap);
        row[0].x[gradient] = 0.99 * edge;
        row[1].x[gradient] = (inside ? 1.01 : 0.01) * edge;
        row[0].x[other] = 0.5 * edge;
        row[1].x[other] = 0.52 * edge;
        row[1].u[flow] = inside ? rate * edge : 0.0;
        snprintf(name, sizeof name, "%s-%s", inside ? "inside" : "across", axes[flow]);
        good = good && track_ask(run, name, scene[inside], row, 2, at, MOMENTS, &track[inside]);
    }
    if (good) {
        const double hit = fabs(track_at(&track[1], MOMENTS - 1, 0)->u[flow]) / (rate * edge);
        char what[48];
        for (size_t s = 0; s < MOMENTS; s++)
            worst_see_vector(&w, track_at(&track[0], s, 0)->x, track_at(&track[1], s, 0)->x, 9, 1.0, s);
        snprintf(what, sizeof what, "flow along %s", axes[flow]);
        check_error(run, INVARIANT, what, w.measured, w.expected, hit > 0.1 ? w.error : NAN, run->gate_case->tolerance,
                    "a sphere that the image of another runs into while both stand still moves otherwise than one that is run into inside the cell: %s; the search "
                    "for neighbours does not reckon with images that move", compare(&w));
    }
    for (int k = 0; k < 2; k++) {
        track_free(&track[k]);
        json_decref(scene[k]);
    }
}

void check_passing(struct check_run *run)
{
    for (int flow = 0; flow < 3; flow++)
        try_plane(run, flow);
}
