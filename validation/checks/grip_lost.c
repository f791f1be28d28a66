/*
 * Layer 4: friction that lets go forgets its displacement, also where the pair stays in touch
 *
 * Under a friction law with a critical load each free sphere is pressed onto a held one by a constant force that swings in its spring, without
 * parting, between loads above and below the critical one,
 *
 *     N(t) = N_0 + (N_max - N_0) cos(w t) ,   w = sqrt(k_n/m) ,   N_0 = the critical load
 *
 * while it slides and rolls. At the least load, half a period on, nothing grips: places, velocities and spins are all there is to know, for the
 * displacement of a contact without friction is none. So a run that starts anew from there must take the path of the run that goes on, through
 * the next grip and the one after. No formula is needed. Springs alone act, so that velocity Verlet starts anew exactly.
 */
#include "two_bodies.h"

#include <stdlib.h>
#include <string.h>

enum { PAIRS = 3, FRAMES = 4 };

/* Each pair along an axis of its own, the held sphere (species 1) below, the free one (species 2 to 4, each with its own force) above. */
static void start_pairs(const struct model *m, const double load, struct state_row row[2 * PAIRS])
{
    memset(row, 0, 2 * PAIRS * sizeof *row);
    for (int k = 0; k < PAIRS; k++)
        for (int side = 0; side < 2; side++) {
            struct state_row *r = &row[2 * k + side];
            const double apart = m->radius[0] + m->radius[k + 1] - load / m->contact.normal_stiffness;
            r->id = 2 * k + side + 1;
            r->species = side ? k + 2 : 1;
            for (int c = 0; c < 3; c++) {
                r->x[c] = (0.2 + 0.3 * k) * m->cell[c][c] + (side && c == k ? apart : 0.0);
                r->u[c] = side && c != k ? 0.3 - 0.5 * ((c + k) % 2) : 0.0;
                r->w[c] = side ? 0.4 - 0.3 * c + 0.2 * k : 0.0;
            }
        }
}

void check_grip_lost(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    json_t *scene = json_deep_copy(run->gate_case->scene);
    const double load = scene_number(parameters, "load", NAN), dt = scene_number(scene, "dynamics.verlet.dt", NAN);
    struct model m;
    struct state_row row[2 * PAIRS];
    struct track whole, anew;
    struct worst w = WORST_NONE;
    double turned = 0.0;
    if (model_read(run, scene, &m)) {
        const double mass = 4.0 / 3.0 * M_PI * m.density[1] * gsl_pow_3(m.radius[1]);
        const int half = (int)lround(M_PI / sqrt(m.contact.normal_stiffness / mass) / dt), at[1 + FRAMES] = { half, 2 * half, 3 * half, 4 * half, 5 * half };
        const int later[FRAMES] = { half, 2 * half, 3 * half, 4 * half };
        start_pairs(&m, load, row);
        if (track_ask(run, "whole", scene, row, 2 * PAIRS, at, 1 + FRAMES, &whole)) {
            for (size_t i = 0; i < 2 * PAIRS; i++) {
                const struct track_point *p = track_at(&whole, 0, i);
                for (int c = 0; c < 3; c++)
                    turned = fmax(turned, fabs(track_at(&whole, 1, i)->w[c] - p->w[c]));
                memcpy(row[i].x, p->x, sizeof row[i].x);
                memcpy(row[i].u, p->u, sizeof row[i].u);
                memcpy(row[i].w, p->w, sizeof row[i].w);
            }
            if (track_ask(run, "anew", scene, row, 2 * PAIRS, later, FRAMES, &anew)) {
                for (size_t s = 0; s < FRAMES; s++)
                    for (size_t i = 0; i < 2 * PAIRS; i++)
                        worst_see_vector(&w, track_at(&anew, s, i)->x, track_at(&whole, s + 1, i)->x, 9, 1.0, i);
                check_error(run, INVARIANT, "friction is at work", turned, NAN, turned > 1e-3 ? 0.0 : 1.0, 0.5,
                            "friction changed no spin between two moments at which it does not grip: nothing was tried");
                check_error(run, INVARIANT, "friction that lets go forgets", w.measured, w.expected, w.error, run->gate_case->tolerance,
                            "a run that starts anew while no contact has friction takes another path than the one that goes on: sphere %zu has %.12g instead of "
                            "%.12g; the contacts remember a displacement from before their friction let go", w.at + 1, w.measured, w.expected);
                track_free(&anew);
            }
            track_free(&whole);
        }
    }
    json_decref(scene);
}
