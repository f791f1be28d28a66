/*
 * Layer 4: a contact that slides to and fro, under every friction law
 *
 * A heavy sphere on a tether swings past a held one that it touches: the contact sticks, slides, sticks again where the motion turns, and slides
 * back. What it remembers when it turns is no more than the cap allows,
 *
 *     ds/dt = slip ,    |k_t s| <= cap(N)        s cut to the cap while it slides
 *
 * s is added up here from the candidate's own places and velocities with the law of theory/contact_laws.c, and the stress that s makes, F_t (x) r, is compared with
 * what the candidate writes. A law that keeps more, or less, of the displacement is right while it slides and wrong after each turn.
 */
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Largest difference of F_t (x) r over the swing, against the largest cap. */
static struct worst see(const struct model *m, const struct track *track, const struct table *stress, size_t steps, double dt)
{
    const struct theory_contact law = contact_between(m, m->radius[0], m->radius[1]);
    struct worst w = WORST_NONE;
    double s[3] = { 0 }, scale = 0.0;
    for (int pass = 0; pass < 2; pass++)        /* first for the scale only */
        for (size_t t = 0; t < steps; t++) {
            struct theory_sphere sphere[2] = { { .radius = m->radius[0] }, { .radius = m->radius[1] } };
            struct theory_pair pair;
            double n[3], slip[3], rest[3], along = 0.0, r = 0.0;
            for (size_t i = 0; i < 2; i++) {
                const struct track_point *p = track_at(track, t, i);
                memcpy(sphere[i].x, p->x, sizeof p->x);
                memcpy(sphere[i].u, p->u, sizeof p->u);
                memcpy(sphere[i].w, p->w, sizeof p->w);
            }
            for (int k = 0; k < 3; k++)
                n[k] = sphere[1].x[k] - sphere[0].x[k];
            r = norm(n);
            for (int k = 0; k < 3; k++) {
                const struct track_point *before = t ? track_at(track, t - 1, 1) : NULL;      /* the first sphere rests */
                n[k] /= r;
                slip[k] = t ? -0.5 * (sphere[1].u[k] + before->u[k]) : 0.0;
            }
            for (int k = 0; k < 3 && pass; k++)
                s[k] += dt * (slip[k] - dot(slip, n) * n[k]);
            theory_contact_laws_pair(&law, sphere, s, &pair);
            along = dot(pair.force[0], n);
            for (int k = 0; k < 3; k++)
                rest[k] = pair.force[0][k] - along * n[k];
            scale = fmax(scale, theory_friction_cap(&law, law.normal_stiffness * (m->radius[0] + m->radius[1] - r)) * r);
            for (int k = 0; k < 3 && pass; k++)
                s[k] = -rest[k] / law.tangential_stiffness;
            for (size_t k = 0; k < 9 && pass; k++)
                worst_see(&w, table_at(stress, t, k) * m->volume, rest[k / 3] * r * n[k % 3], scale, t);
        }
    return w;
}

void check_sliding(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters, *laws = json_object_get(parameters, "laws");
    const size_t steps = (size_t)scene_number(parameters, "steps", 0);
    const double overlap = scene_number(parameters, "overlap", NAN), speed = scene_number(parameters, "speed", NAN), dt = scene_number(run->gate_case->scene, "dynamics.verlet.dt", NAN);
    int *at = calloc(steps + 1, sizeof *at);
    size_t number;
    json_t *law;
    for (size_t t = 0; at && t < steps; t++)
        at[t] = (int)t;
    json_array_foreach(at ? laws : NULL, number, law)
    {
        json_t *scene = json_deep_copy(run->gate_case->scene);
        const char *label = json_string_value(json_object_get(law, "law"));
        char path[PATH_LENGTH], out[PATH_LENGTH], what[96];
        struct state_row row[2] = { { .id = 1, .species = 1 }, { .id = 2, .species = 2 } };
        struct model m;
        struct track track;
        struct table stress;
        json_object_update(scene_get(scene, "forces.contact"), law);
        scene_set(scene, "output.stress", json_pack("{si}", "every", 1));
        if (model_read(run, scene, &m) && label) {
            const double n[3] = { 0.48, -0.64, 0.6 }, t[3] = { 0.8, 0.6, 0.0 }, r = m.radius[0] + m.radius[1] - overlap;
            for (int k = 0; k < 3; k++) {
                row[0].x[k] = 0.4 * m.cell[k][k];
                row[1].x[k] = row[0].x[k] + r * n[k];
                row[1].u[k] = speed * t[k];
            }
            snprintf(what, sizeof what, "%s: force that remembers the way", label);
            if (track_ask(run, label, scene, row, 2, at, steps, &track)) {
                path_join(path, run->work, label);
                path_join(out, path, "out");
                if (check_table(run, out, "stress.csv", "contact_tangential_xx,contact_tangential_xy,contact_tangential_xz,contact_tangential_yx,contact_tangential_yy,"
                                "contact_tangential_yz,contact_tangential_zx,contact_tangential_zy,contact_tangential_zz", what, &stress)) {
                    const struct worst w = see(&m, &track, &stress, stress.rows < steps ? stress.rows : steps, dt);
                    check_error(run, MODEL, what, w.measured, w.expected, w.error, run->gate_case->tolerance, "law `%s`: at step %zu of a contact that slides to and fro "
                                "the tangential stress times the volume is %s", label, w.at, compare(&w));
                    table_free(&stress);
                }
                track_free(&track);
            }
        }
        json_decref(scene);
    }
    free(at);
}
