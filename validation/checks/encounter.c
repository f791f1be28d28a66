/*
 * Layer 4: two spheres meet, in shear or because they are thrown at each other
 *
 *     m dU/dt = drag + lubrication + contact ,   I dW/dt = their torques        theory/pair_motion.c
 *
 * Encounters are given in the axes (flow, gradient, vorticity) of a flow with positive rate and turned into each flow of the case, so that
 * every plane and both signs of the rate are asked for. Each pair straddles faces of the cell, which is remapped on the way: nothing of
 * that may show in unwrapped positions. Both spheres start with the flow, plus the velocity and spin that the encounter says.
 *
 * What is compared, and what the errors of a step look like: two_bodies.c.
 */
#include "two_bodies.h"

#include <stdio.h>
#include <string.h>

/* Axes of the flow, its gradient and what is left; `sign` of the rate, by which x is mirrored so that spheres still meet. */
struct flow_axes { int flow, gradient, rest; double sign, rate; };

static struct flow_axes axes_of(const struct model *m)
{
    struct flow_axes a = { 0, 1, 2, 1.0, 0.0 };
    for (int f = 0; f < 3; f++)
        for (int g = 0; g < 3; g++)
            if (fabs(m->gradient[f][g]) > fabs(a.rate))
                a = (struct flow_axes){ f, g, 3 - f - g, m->gradient[f][g] < 0 ? -1.0 : 1.0, m->gradient[f][g] };
    return a;
}

static void read_vector(const json_t *encounter, const char *key, const struct flow_axes *a, double out[3])
{
    const json_t *list = json_object_get(encounter, key);
    memset(out, 0, 3 * sizeof *out);
    out[a->flow] = a->sign * json_number_value(json_array_get(list, 0));
    out[a->gradient] = json_number_value(json_array_get(list, 1));
    out[a->rest] = json_number_value(json_array_get(list, 2));
}

/* The spheres at +- half their distance from the pair's origin, with the flow. Returns the largest speed between two. */
static double place_pairs(const struct model *m, const json_t *encounters, const struct flow_axes *a, double spacing, struct bodies *b)
{
    size_t k;
    json_t *encounter;
    double fastest = 0.0, gradient[3][3];
    memcpy(gradient, m->gradient, sizeof gradient);
    json_array_foreach(encounters, k, encounter)
    {
        double radius[8], r[3], thrown[3], spin[3], apart[3];
        size_t count;
        parameter_list(encounter, "radii", radius, &count, 2);
        b->motion[k] = bodies_motion(m, radius[0], radius[1]);
        read_vector(encounter, "apart", a, r);
        read_vector(encounter, "thrown", a, thrown);
        read_vector(encounter, "spin", a, spin);
        for (int side = 0; side < 2; side++) {
            struct theory_sphere *s = &b->start[k].s[side];
            s->radius = radius[side];
            for (int c = 0; c < 3; c++)
                s->x[c] = (side ? 0.5 : -0.5) * r[c];
            apply(gradient, s->x, s->u);
            for (int c = 0; c < 3; c++) {
                s->u[c] += (side ? 0.5 : -0.5) * thrown[c];
                s->w[c] = 0.5 * (m->gradient[(c + 2) % 3][(c + 1) % 3] - m->gradient[(c + 1) % 3][(c + 2) % 3]) + (side ? 0.7 : 1.0) * spin[c];
            }
        }
        for (int c = 0; c < 3; c++)
            apart[c] = b->start[k].s[1].u[c] - b->start[k].s[0].u[c];
        fastest = fmax(fastest, norm(apart));
        b->origin[k][a->rest] = spacing * (double)k;
    }
    return fastest;
}

void check_encounter(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters, *encounters = json_object_get(parameters, "encounters");
    const double dt = scene_number(parameters, "dt", NAN), spacing = scene_number(parameters, "spacing", NAN);
    double list[64];
    int at[64];
    size_t times, f;
    parameter_list(parameters, "at", list, &times, 64);
    for (size_t t = 0; t < times; t++)
        at[t] = (int)list[t];
    json_t *flow;
    json_array_foreach(json_object_get(parameters, "flows"), f, flow)
    {
        const char *label = json_string_value(json_object_get(flow, "name"));
        json_t *scene = variant_scene(run->gate_case, flow);
        char name[32];
        snprintf(name, sizeof name, "flow-%zu", f + 1);
        struct model m;
        struct bodies b = { 0 };
        struct comparison c;
        bool answered = model_read(run, scene, &m) && bodies_make(&b, json_array_size(encounters));
        if (answered) {
            const struct flow_axes a = axes_of(&m);
            json_t *lengths = json_array();      /* edges of no round ratio; the pairs lie along the third axis */
            for (int v = 0; v < 3; v++)
                json_array_append_new(lengths, json_real(v == a.flow ? 21.3 : v == a.gradient ? 14.9 : spacing * (double)b.pairs));
            scene_set(scene, "box.lengths", lengths);
            const double speed = place_pairs(&m, encounters, &a, spacing, &b);
            answered = bodies_compare(run, name, scene, &b, dt, at, times, speed, (int)scene_number(parameters, "orders", 1), &c);
        }
        if (answered) {
            bodies_judge(run, label, &c, &b, scene_number(parameters, "coarse", NAN));
            if (f == 0)
                bodies_picture(run, &c, &b, "gap of each pair while it passes");
            comparison_free(&c);
        }
        bodies_free(&b);
        json_decref(scene);
        if (!answered)
            return;
    }
}
