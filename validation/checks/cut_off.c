/*
 * Layer 1: exactly at the cut-off
 *
 * Lubrication acts up to xi = 2 h/(a_i + a_j) = xi_max and repulsion up to h = cutoff kappa, both kept there exactly and gone beyond. Two spheres
 * whose radii, places and cut-offs are short binary numbers, so that the gap is that of the cut-off to the last bit, feel what they feel a
 * billionth of a radius nearer; a billionth farther they feel nothing.
 */
#include "pair_checks.h"

#include <stdio.h>

void pair_cut_off(struct check_run *run)
{
    static const double off[3] = { -1e-9, 0.0, 1e-9 };
    const json_t *parameters = run->gate_case->parameters;
    const double gap = scene_number(parameters, "gap", NAN);
    struct model m;
    struct pair_book book = { 0 };
    struct pair_answer answer = { 0 };
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    for (int k = 0; k < 3; k++) {
        struct pair_state p = { .s = { { .radius = m.radius[0], .x = { 8, 8, 8 } }, { .radius = m.radius[1], .u = { -0.7, 0.4, 0.9 }, .w = { 0.3, -0.5, 0.2 } } } };
        const double distance = m.radius[0] + m.radius[1] + gap + off[k];
        p.s[1].x[0] = 8 + distance;
        p.s[1].x[1] = p.s[1].x[2] = 8;
        p.xi = 2.0 * (gap + off[k]) / (m.radius[0] + m.radius[1]);
        book_add(&book, &p);
    }
    json_t *scene = json_deep_copy(run->gate_case->scene);
    if (book_ask(run, "pairs", scene, &book, "lubrication,repulsion", &answer)) {
        static const char *const names[2] = { "lubrication", "repulsion" };
        for (int f = 0; f < 2; f++) {
            struct worst w = WORST_NONE;
            double size = 0.0;
            for (int side = 0; side < 2; side++)
                size = fmax(size, norm(forces_at(&answer.forces, 0, names[f], 1 + side)));
            for (int side = 0; side < 2; side++) {
                worst_see_vector(&w, forces_at(&answer.forces, 1, names[f], 1 + side), forces_at(&answer.forces, 0, names[f], 1 + side), 3, size, 1);
                worst_see_vector(&w, forces_at(&answer.forces, 2, names[f], 1 + side), (const double[3]){ 0 }, 3, size, 2);
            }
            check_error(run, INVARIANT, names[f], w.measured, w.expected, size > 0.0 ? w.error : NAN, run->gate_case->tolerance, "%s of a pair %s its cut-off is %s: it "
                        "acts up to its cut-off, there too, and not beyond", names[f], w.at == 1 ? "exactly at" : "a billionth beyond", compare(&w));
        }
    }
    forces_free(&answer.forces);
    book_free(&book);
    json_decref(scene);
}
