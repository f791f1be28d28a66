/*
 * The numbers of golden/vectors, read from their hexadecimal form, against the second derivations; and what validation/theory makes of the same
 * inputs today.
 */
#include "audit.h"

#include <dirent.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- reading --- */

static double hex(const json_t *value)
{
    const char *text = json_string_value(value);
    char *end;
    const double x = text ? strtod(text, &end) : NAN;
    if (!text || *end)
        audit_fault("a vector holds %s where a hexadecimal number belongs", text ? text : "nothing");
    return x;
}

static void list(const json_t *from, const char *name, double *value, size_t count)
{
    const json_t *array = json_object_get(from, name);
    for (size_t k = 0; k < count; k++)
        value[k] = array ? hex(json_array_get(array, k)) : 0.0;
}

static double number(const json_t *from, const char *name)
{
    return json_object_get(from, name) ? hex(json_object_get(from, name)) : 0.0;
}

static bool says(const json_t *model, const char *name, const char *word)
{
    const char *text = json_string_value(json_object_get(model, name));
    return text && strcmp(text, word) == 0;
}

/* What is read of a vector. */
struct vector { const json_t *model, *model_hex, *input, *expected; json_t *scale; const char *id, *kind; };

static double scale_of(const struct vector *v, const char *name)
{
    const json_t *s = json_object_get(v->scale, name);
    return s ? json_number_value(s) : 1.0;
}

static void read_pair(const struct vector *v, struct theory_sphere s[2])
{
    double radius[2], x[6], u[6], w[6];
    list(v->input, "radius", radius, 2);
    list(v->input, "position", x, 6);
    list(v->input, "velocity", u, 6);
    list(v->input, "spin", w, 6);
    for (int k = 0; k < 6; k++) {
        s[k / 3].radius = radius[k / 3];
        s[k / 3].x[k % 3] = x[k];
        s[k / 3].u[k % 3] = u[k];
        s[k / 3].w[k % 3] = w[k];
    }
}

/* --- comparing --- */

static void see_answer(const struct vector *v, const struct quad_answer *q, const struct theory_pair *now)
{
    double force[6], torque[6], stress[9];
    list(v->expected, "force", force, 6);
    list(v->expected, "torque", torque, 6);
    list(v->expected, "stress", stress, 9);
    audit_see_list(force, &q->force[0][0], 6, scale_of(v, "force"), v->id);
    audit_see_list(torque, &q->torque[0][0], 6, scale_of(v, "torque"), v->id);
    audit_see_list(stress, &q->stress[0][0], 9, scale_of(v, "stress"), v->id);
    audit_see_list(&now->force[0][0], &q->force[0][0], 6, scale_of(v, "force"), v->id);
    audit_see_list(&now->torque[0][0], &q->torque[0][0], 6, scale_of(v, "torque"), v->id);
    audit_see_list(&now->stress[0][0], &q->stress[0][0], 9, scale_of(v, "stress"), v->id);
}

static struct theory_contact contact_law(const struct vector *v)
{
    static const char *const law[] = { "plain", "critical", "soft", "shifted", "binary" }, *const cap[] = { "spring", "damped", "absolute" };
    struct theory_contact c = { .normal_stiffness = number(v->model_hex, "normal_stiffness"),
                                .tangential_stiffness = number(v->model_hex, "tangential_stiffness"),
                                .friction = number(v->model_hex, "friction"),
                                .critical_load = number(v->model_hex, "critical_load"),
                                .normal_damping = number(v->model_hex, "normal_damping"),
                                .tangential_damping = number(v->model_hex, "tangential_damping"),
                                .restitution = number(v->model_hex, "restitution"),
                                .lever_at_contact = says(v->model, "lever", "contact"),
                                .clip = says(v->model, "tension", "clip"),
                                .rough = { true, !says(v->model, "rough", "only the first") } };
    for (int k = 0; k < 5; k++)
        c.law = says(v->model, "law", law[k]) ? (enum theory_law)k : c.law;
    for (int k = 0; k < 3; k++)
        c.load = says(v->model, "cap", cap[k]) ? (enum theory_load)k : c.load;
    list(v->input, "mass", c.mass, 2);
    if (says(v->model, "second", "held"))
        c.mass[1] = (double)INFINITY;
    return c;
}

static quad disc(quad z, const void *radius)
{
    const quad a = *(const quad *)radius;
    return PIQ * (a * a - z * z);
}

static void audit_contact(const struct vector *v)
{
    const struct theory_contact law = contact_law(v);
    struct theory_sphere s[2];
    struct quad_answer q;
    struct theory_pair now;
    double history[3], density[2], residual[3];
    read_pair(v, s);
    list(v->input, "history", history, 3);
    list(v->input, "density", density, 2);
    const struct quad_pair p = quad_pair_of(s);
    const quad stretched[3] = { history[0], history[1], history[2] };
    contact_answer(&law, &p, stretched, &q);
    if (json_object_get(v->model, "law"))
        theory_contact_laws_pair(&law, s, history, &now);
    else {
        theory_contact_pair(&law, s, history, &now);
        theory_contact_torque_residual(&law, s, history, residual);
        audit_see_list(residual, q.balance, 3, scale_of(v, "torque"), v->id);
    }
    see_answer(v, &q, &now);
    for (int a = 0; a < 2 && density[0] > 0.0; a++)         /* the masses that the file states: volume from discs */
        if (!isinf(law.mass[a])) {
            const quad mass = density[a] * integral(disc, &p.radius[a], -p.radius[a], p.radius[a]);
            audit_see(law.mass[a], mass, (double)mass, v->id);
        }
}

static void audit_repulsion(const struct vector *v)
{
    const bool energy = says(v->model, "form", "energy");
    const struct theory_repulsion law = { energy, number(v->model_hex, energy ? "energy" : "force"), number(v->model_hex, "kappa_factor"),
                                          number(v->model_hex, "cutoff") };
    struct theory_sphere s[2];
    struct quad_answer q;
    struct theory_pair now;
    read_pair(v, s);
    const struct quad_pair p = quad_pair_of(s);
    repulsion_answer(&law, &p, &q);
    theory_repulsion_pair(&law, s, &now);
    see_answer(v, &q, &now);
}

static struct theory_lubrication lubrication_law(const struct vector *v)
{
    return (struct theory_lubrication){ number(v->model_hex, "viscosity"), number(v->model_hex, "inner_gap"), number(v->model_hex, "outer_gap"),
                                        says(v->model, "rotation_correction", "exact") };
}

static void audit_lubrication(const struct vector *v)
{
    const struct theory_lubrication law = lubrication_law(v);
    struct theory_sphere s[2];
    struct quad_answer q;
    struct theory_pair now;
    double residual[3];
    read_pair(v, s);
    const struct quad_pair p = quad_pair_of(s);
    lubrication_answer(&law, &p, &q);
    theory_lubrication_pair(&law, s, &now);
    see_answer(v, &q, &now);
    theory_lubrication_torque_residual(&law, s, residual);
    audit_see_list(residual, q.balance, 3, scale_of(v, "torque"), v->id);
}

static void audit_scalars(const struct vector *v)
{
    const struct theory_lubrication law = lubrication_law(v);
    double radius[2], now[THEORY_SCALARS];
    quad scalar[THEORY_SCALARS];
    list(v->input, "radius", radius, 2);
    const double distance = number(v->input, "distance");
    near_field_scalars(law.viscosity, law.inner_gap, law.outer_gap, law.exact_rotation, radius[0], radius[1], distance, scalar);
    theory_scalars(&law, radius[0], radius[1], distance, now);
    for (int k = 0; k < THEORY_SCALARS; k++) {
        const double scale = scalar[k] == 0 ? 1.0 : fabs((double)scalar[k]);
        audit_see(number(v->expected, theory_scalar_name[k]), scalar[k], scale, v->id);
        audit_see(now[k], scalar[k], scale, v->id);
    }
}

/* R = sum of c d d^T over the modes; for noise the same is the covariance of sqrt(c) d theta with one random number for each mode. */
static void audit_matrix(const struct vector *v)
{
    const bool noise = strcmp(v->kind, "noise-pair") == 0;
    const struct theory_lubrication law = lubrication_law(v);
    struct theory_sphere s[2];
    double expected[144], now[144], between[3];
    quad R[144] = { 0 };
    read_pair(v, s);
    const struct quad_pair p = quad_pair_of(s);
    const struct modes m = lubrication_modes(&law, &p);
    for (int q = 0; q < m.count; q++)
        for (int k = 0; k < 144; k++)
            R[k] += m.size[q] * m.motion[q][k / 12] * m.motion[q][k % 12];
    for (int k = 0; k < 3; k++)
        between[k] = s[1].x[k] - s[0].x[k];
    theory_pair_resistance(&law, s[0].radius, s[1].radius, between, now);
    list(v->expected, noise ? "covariance" : "resistance", expected, 144);
    const quad factor = noise ? 2 * (quad)number(v->model_hex, "kT") / (quad)number(v->model_hex, "dt") : 1;
    for (int k = 0; k < 144; k++) {
        const bool turning = k / 12 >= 6 || k % 12 >= 6;
        const double scale = scale_of(v, noise ? "covariance" : turning ? "torque" : "force");
        audit_see(expected[k], factor * R[k], scale, v->id);
        audit_see(now[k], R[k], scale / (double)factor, v->id);
    }
}

static void audit_drag(const struct vector *v)
{
    struct theory_sphere s = { .radius = number(v->input, "radius") };
    double G[9], expected[15], now[15];
    quad Gq[3][3], x[3], u[3], w[3], answer[15];
    list(v->input, "position", s.x, 3);
    list(v->input, "velocity", s.u, 3);
    list(v->input, "spin", s.w, 3);
    list(v->input, "gradient", G, 9);
    for (int k = 0; k < 9; k++)
        Gq[k / 3][k % 3] = G[k];
    for (int k = 0; k < 3; k++) {
        x[k] = s.x[k];
        u[k] = s.u[k];
        w[k] = s.w[k];
    }
    const bool torque = says(v->model, "torque", "on");
    const double viscosity = number(v->model_hex, "viscosity");
    drag_answer(viscosity, torque, Gq, s.radius, x, u, w, answer, answer + 3, (quad(*)[3])(answer + 6));
    theory_drag(viscosity, torque, (const double(*)[3])G, &s, now, now + 3, (double(*)[3])(now + 6));
    list(v->expected, "force", expected, 3);
    list(v->expected, "torque", expected + 3, 3);
    list(v->expected, "stress", expected + 6, 9);
    for (int k = 0; k < 15; k++) {
        const double scale = scale_of(v, k < 3 ? "force" : k < 6 ? "torque" : "stress");
        audit_see(expected[k], answer[k], scale, v->id);
        audit_see(now[k], answer[k], scale, v->id);
    }
}

static void audit_one_body_noise(const struct vector *v)
{
    double expected[36];
    const double a = number(v->input, "radius");
    const quad factor = 2 * (quad)number(v->model_hex, "kT") / (quad)number(v->model_hex, "dt"), none[3] = { 0 };
    quad rest[3][3] = { { 0 } };
    list(v->expected, "covariance", expected, 36);
    for (int column = 0; column < 6; column++) {
        quad motion[6] = { 0 }, load[6], stresslet[3][3];
        motion[column] = 1;
        drag_answer(number(v->model_hex, "viscosity"), true, rest, a, none, motion, motion + 3, load, load + 3, stresslet);
        for (int row = 0; row < 6; row++)
            audit_see(expected[6 * row + column], -factor * load[row], scale_of(v, "covariance"), v->id);
    }
}

/* Passed on: the model's own numbers. */
static void audit_applied(const struct vector *v)
{
    for (int part = 0; part < 3; part++) {
        static const char *const name[] = { "force", "torque", "stress" };
        double expected[9], given[9] = { 0 };
        list(v->expected, name[part], expected, part < 2 ? 3 : 9);
        if (part < 2)
            list(v->model_hex, name[part], given, 3);
        for (int k = 0; k < (part < 2 ? 3 : 9); k++)
            audit_see(expected[k], given[k], 1.0, v->id);
    }
}

/* --- files --- */

static const struct { const char *kind, *term, *what, *how, *functions; double tolerance; const char *reason; void (*audit)(const struct vector *v); } kinds[] = {
    { "contact", "contact-frictionless", "vectors: spring of a contact", "virtual work of -N r", "theory_contact_pair", 1e-12,
      "overlap of 3e-3 is a difference of 17-digit numbers", audit_contact },
    { "contact", "contact-friction", "vectors: contact with history and cap", "virtual work of Moreau's potential", "theory_contact_pair theory_contact_torque_residual", 1e-12,
      "overlap of 3e-3 is a difference of 17-digit numbers", audit_contact },
    { "contact", "contact-laws", "vectors: dashpots and friction laws", "virtual work; restitution by the oscillator's equation",
      "theory_contact_laws_pair theory_normal_dashpot", 1e-12, "overlap of 3e-3 is a difference of 17-digit numbers", audit_contact },
    { "repulsion", "repulsion", "vectors: repulsion", "difference quotient of the potential", "theory_repulsion_pair", 1e-11,
      "a rounding of the distance, 1e-15, is 1e-13 of the range, and beyond the cut-off e^14 more", audit_repulsion },
    { "lubrication", "lubrication-forces", "vectors: lubrication forces, stress, balance", "lubrication integrals; derivative of the dissipation",
      "theory_lubrication_pair theory_lubrication_torque_residual", 1e-12, "gap of 4e-4 of 17-digit numbers", audit_lubrication },
    { "lubrication-scalars", "lubrication-scalars", "vectors: seven resistance scalars", "lubrication integrals", "theory_scalars", 1e-12,
      "gap of 1e-3 of 17-digit numbers", audit_scalars },
    { "lubrication-resistance", "lubrication-resistance", "vectors: resistance matrix", "sum over five modes of motion", "theory_pair_resistance", 1e-12,
      "gap of 1e-3 of 17-digit numbers", audit_matrix },
    { "drag", "drag", "vectors: drag on one sphere", "tractions and dissipation of Stokes's flow", "theory_drag", 1e-14, "a few roundings", audit_drag },
    { "applied", "applied", "vectors: forces from outside", "the numbers given", "", 1e-16, "the same numbers", audit_applied },
    { "noise-one-body", "noise-one-body", "vectors: covariance of one-body noise", "2 kT/dt times drag by tractions", "", 1e-14, "a few roundings", audit_one_body_noise },
    { "noise-pair", "noise-pair", "vectors: covariance of pair noise", "one random number for each of five modes", "", 1e-12, "gap of 1e-3 of 17-digit numbers", audit_matrix },
};

static void audit_file(const char *folder, size_t k)
{
    char path[4096];
    json_error_t where;
    snprintf(path, sizeof path, "%s/%s.json", folder, kinds[k].term);
    json_t *book = json_load_file(path, 0, &where), *group, *item;
    audit_quantity(kinds[k].what, kinds[k].how, kinds[k].tolerance, kinds[k].reason, kinds[k].functions);
    if (!book) {
        audit_fault("%s:%d: %s", path, where.line, where.text);
        return;
    }
    size_t g, n;
    json_array_foreach(json_object_get(book, "groups"), g, group)
        json_array_foreach(json_object_get(group, "vectors"), n, item) {
            const struct vector v = { json_object_get(group, "model"), json_object_get(group, "model_hex"), json_object_get(item, "input_hex"),
                                      json_object_get(item, "expected_hex"), json_object_get(item, "scale"), json_string_value(json_object_get(item, "id")),
                                      kinds[k].kind };
            if (!says(group, "kind", kinds[k].kind))
                audit_fault("%s: a group is not of kind %s", path, kinds[k].kind);
            else
                kinds[k].audit(&v);
        }
    json_decref(book);
}

void audit_vectors(const char *folder)
{
    const size_t count = sizeof kinds / sizeof *kinds;
    size_t files = 0;
    for (size_t k = 0; k < count; k++)
        audit_file(folder, k);
    DIR *all = opendir(folder);
    for (struct dirent *entry; all && (entry = readdir(all)) != NULL;)
        files += strstr(entry->d_name, ".json") != NULL;
    if (all)
        closedir(all);
    if (files != count)
        audit_fault("%s holds %zu files of vectors, %zu are audited", folder, files, count);
}
