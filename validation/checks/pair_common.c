/* Layer 1, shared parts: random pairs, the scene's model, asking, comparing (pair.h). */
#include "pair.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void apply(double m[3][3], const double a[3], double out[3])
{
    const double b[3] = { dot(m[0], a), dot(m[1], a), dot(m[2], a) };
    for (int k = 0; k < 3; k++)
        out[k] = b[k];
}

static int axis(const json_t *word)
{
    const char *name = json_string_value(word);
    return name ? name[0] - 'x' : 0;
}

/* The cell at time t: each vector is carried by the flow, c' = G c, and G^3 = 0 for superposed shears. */
static void carry_cell(struct model *m)
{
    for (int v = 0; v < 3; v++) {
        double once[3], twice[3];
        apply(m->gradient, m->cell[v], once);
        apply(m->gradient, once, twice);
        for (int k = 0; k < 3; k++)
            m->cell[v][k] += m->time * once[k] + 0.5 * m->time * m->time * twice[k];
    }
    double normal[3];
    cross(m->cell[0], m->cell[1], normal);
    m->volume = fabs(dot(normal, m->cell[2]));
}

static void read_box(const json_t *scene, struct model *m)
{
    const json_t *lengths = scene_get(scene, "box.lengths"), *cell = scene_get(scene, "box.cell");
    for (size_t v = 0; v < 3; v++)
        for (size_t k = 0; k < 3; k++)
            m->cell[v][k] = cell     ? json_number_value(json_array_get(json_array_get(cell, v), k))
                            : v == k ? json_number_value(json_array_get(lengths, k))
                                     : 0;
    for (size_t v = 0; v < 3; v++)
        m->open[v] = json_is_false(json_array_get(scene_get(scene, "box.periodic"), v));
    size_t s;
    json_t *shear;
    json_array_foreach(scene_get(scene, "shear"), s, shear)
        m->gradient[axis(json_object_get(shear, "flow"))][axis(json_object_get(shear, "gradient"))]
            += scene_number(shear, "rate", 0);
    m->time = scene_number(scene, "start.time", 0);
    carry_cell(m);
}

bool model_read(struct check_run *run, const json_t *scene, struct model *m)
{
    *m = (struct model){ 0 };
    size_t k;
    json_t *species;
    json_array_foreach(scene_get(scene, "species"), k, species)
    {
        if (k < sizeof m->radius / sizeof *m->radius) {
            m->radius[k] = scene_number(species, "radius", NAN);
            m->density[k] = scene_number(species, "density", NAN);
            m->species++;
        }
    }
    read_box(scene, m);
    m->viscosity = scene_number(scene, "fluid.viscosity", NAN);
    m->has_lubrication = scene_get(scene, "forces.lubrication") != NULL;
    m->has_contact = scene_get(scene, "forces.contact") != NULL;
    m->has_drag = scene_get(scene, "forces.drag") != NULL;
    m->drag_torque = json_is_true(scene_get(scene, "forces.drag.torque"));
    const char *rotation = json_string_value(scene_get(scene, "forces.lubrication.rotation_correction"));
    const char *lever = json_string_value(scene_get(scene, "forces.contact.lever"));
    m->lubrication = (struct theory_lubrication){ .viscosity = m->viscosity,
                                                  .inner_gap = scene_number(scene, "forces.lubrication.inner_gap", NAN),
                                                  .outer_gap = scene_number(scene, "forces.lubrication.outer_gap", NAN),
                                                  .exact_rotation = rotation && strcmp(rotation, "exact") == 0 };
    m->contact = (struct theory_contact){ .normal_stiffness = scene_number(scene, "forces.contact.normal_stiffness", NAN),
                                          .tangential_stiffness = scene_number(scene, "forces.contact.tangential_stiffness", 0),
                                          .friction = scene_number(scene, "forces.contact.friction", 0),
                                          .lever_at_contact = lever && strcmp(lever, "contact") == 0 };
    model_read_laws(scene, m);
    if (m->species == 0 || !(m->volume > 0))
        check_garbage(run, "the scene of the case has no species or no box; this is a mistake in the suite");
    return m->species > 0 && m->volume > 0;
}

json_t *variant_scene(const struct gate_case *c, const json_t *variant)
{
    json_t *scene = json_deep_copy(c->scene), *shear = json_object_get(variant, "shear"), *cell = json_object_get(variant, "cell");
    json_t *lengths = json_object_get(variant, "lengths");
    if (shear)
        json_object_set(scene, "shear", shear);
    if (json_object_get(variant, "time"))
        scene_set(scene, "start.time", json_incref(json_object_get(variant, "time")));
    if (lengths)
        scene_set(scene, "box.lengths", json_incref(lengths));
    if (json_object_get(variant, "periodic"))
        scene_set(scene, "box.periodic", json_incref(json_object_get(variant, "periodic")));
    if (cell) {
        scene_set(scene, "box.cell", json_incref(cell));
        json_object_del(scene_get(scene, "box"), "lengths");
    }
    return scene;
}

int model_species(const struct model *m, double radius)
{
    size_t best = 0;
    for (size_t k = 1; k < m->species; k++)
        if (fabs(m->radius[k] - radius) < fabs(m->radius[best] - radius))
            best = k;
    return (int)best + 1;
}

struct pair_state *book_add(struct pair_book *book, const struct pair_state *s)
{
    book->item = realloc(book->item, (book->count + 1) * sizeof *book->item);
    book->item[book->count] = *s;
    return &book->item[book->count++];
}

void book_free(struct pair_book *book)
{
    free(book->item);
    *book = (struct pair_book){ 0 };
}

gsl_rng *pair_random(const struct check_run *run)
{
    gsl_rng *random = gsl_rng_alloc(gsl_rng_mt19937);
    gsl_rng_set(random, run->seed);
    return random;
}

void random_vector(gsl_rng *random, double size, double v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = gsl_ran_gaussian(random, size);
}

void random_direction(gsl_rng *random, double n[3])
{
    gsl_ran_dir_3d(random, &n[0], &n[1], &n[2]);
}

void random_rotation(gsl_rng *random, double Q[3][3])
{
    double other[3];
    random_direction(random, Q[0]);
    random_direction(random, other);
    cross(Q[0], other, Q[1]);
    const double length = norm(Q[1]);
    for (int k = 0; k < 3; k++)
        Q[1][k] /= length;
    cross(Q[0], Q[1], Q[2]);
}

/* The first sphere sits a little away from the origin, so that neither needs wrapping and no digits are lost to it. */
struct pair_state random_pair(gsl_rng *random, double a1, double a2, double xi)
{
    struct pair_state p = { .s = { { .radius = a1 }, { .radius = a2 } }, .xi = xi };
    double n[3];
    random_direction(random, n);
    const double distance = (a1 + a2) * (1 + 0.5 * xi), middle = 0.5 * distance + 1.7;
    for (int k = 0; k < 3; k++) {
        p.s[0].x[k] = middle - 0.5 * distance * n[k];
        p.s[1].x[k] = middle + 0.5 * distance * n[k];
    }
    for (int side = 0; side < 2; side++) {
        random_vector(random, 0.9, p.s[side].u);
        random_vector(random, 0.7, p.s[side].w);
    }
    return p;
}

struct pair_state swapped(const struct pair_state *p)
{
    struct pair_state q = *p;
    q.s[0] = p->s[1];
    q.s[1] = p->s[0];
    for (int k = 0; k < 3; k++)
        q.history[k] = -p->history[k];
    return q;
}

double pair_geometry(const struct pair_state *p, double n[3], double *distance)
{
    for (int k = 0; k < 3; k++)
        n[k] = p->s[1].x[k] - p->s[0].x[k];
    *distance = norm(n);
    for (int k = 0; k < 3; k++)
        n[k] /= *distance;
    return *distance - p->s[0].radius - p->s[1].radius;
}

void parameter_list(const json_t *parameters, const char *key, double *value, size_t *count, size_t room)
{
    size_t k;
    json_t *item;
    *count = 0;
    json_array_foreach(json_object_get(parameters, key), k, item)
        if (*count < room)
            value[(*count)++] = json_number_value(item);
}

bool book_ask(struct check_run *run, const char *name, json_t *scene, const struct pair_book *book, const char *wanted,
              struct pair_answer *answer)
{
    struct model m;
    if (!model_read(run, scene, &m))
        return false;
    struct state_row *rows = calloc(2 * book->count, sizeof *rows);
    struct contact_row *contacts = calloc(book->count, sizeof *contacts);
    size_t histories = 0;
    for (size_t k = 0; k < book->count; k++) {
        const struct pair_state *p = &book->item[k];
        for (int side = 0; side < 2; side++) {
            struct state_row *row = &rows[2 * k + (size_t)side];
            *row = (struct state_row){ .state = (int)k, .id = side + 1, .species = model_species(&m, p->s[side].radius) };
            memcpy(row->x, p->s[side].x, sizeof row->x);
            memcpy(row->u, p->s[side].u, sizeof row->u);
            memcpy(row->w, p->s[side].w, sizeof row->w);
        }
        if (!p->with_history)
            continue;
        const int back = p->listed_backwards;
        struct contact_row *c = &contacts[histories++];
        *c = (struct contact_row){ .state = (int)k, .i = 1 + back, .j = 2 - back };
        for (int d = 0; d < 3; d++)
            c->s[d] = back ? -p->history[d] : p->history[d];
    }
    const struct question q = { .protocol = "forces", .scene = scene, .state = rows, .states = 2 * book->count,
                                .contact = contacts, .contacts = histories };
    bool good = check_ask(run, name, &q, answer->out);
    free(rows);
    free(contacts);
    if (!good)
        return false;
    char path[PATH_LENGTH], why[WHY_LENGTH];
    path_join(path, answer->out, "forces.csv");
    good = forces_read(path, book->count, 2, wanted, &answer->forces, why);
    if (!good)
        check_garbage(run, why);
    return good;
}

double *answer_stress(struct check_run *run, const struct pair_answer *a, size_t states, const char *origin, double volume)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    double *value;
    path_join(path, a->out, "stress.csv");
    if (!stress_read(path, states, origin, &value, why)) {
        check_garbage(run, why);
        return NULL;
    }
    for (size_t k = 0; k < 9 * states; k++)
        value[k] *= volume;
    return value;
}

/*
 * Errors are measured against the sum of the sizes of the terms, not against their sum: the terms may cancel (they do
 * in rigid motion), and no candidate can do better than rounding of what it adds.
 */
void expect_lubrication(const struct model *m, const struct pair_state *p, struct expected *e)
{
    double n[3], distance, c[THEORY_SCALARS], du[3];
    pair_geometry(p, n, &distance);
    theory_lubrication_pair(&m->lubrication, p->s, &e->pair);
    theory_scalars(&m->lubrication, p->s[0].radius, p->s[1].radius, distance, c);
    for (int k = 0; k < 3; k++)
        du[k] = p->s[1].u[k] - p->s[0].u[k];
    const double u = norm(du), w1 = norm(p->s[0].w), w2 = norm(p->s[1].w);
    e->force_scale = (c[THEORY_XA] + c[THEORY_YA]) * u + fabs(c[THEORY_B1]) * w1 + fabs(c[THEORY_B2]) * w2;
    e->torque_scale = (fabs(c[THEORY_B1]) + fabs(c[THEORY_B2])) * u + (c[THEORY_C11] + c[THEORY_C12]) * w1
                      + (c[THEORY_C22] + c[THEORY_C12]) * w2;
}

/* An overlap below a thousandth of the sizes is known to fewer digits: the scale does not shrink further with it. */
void expect_contact(const struct model *m, const struct pair_state *p, struct expected *e)
{
    const double sizes = p->s[0].radius + p->s[1].radius;
    double n[3], distance;
    const double h = pair_geometry(p, n, &distance);
    const double *history = p->with_history ? p->history : (const double[3]){ 0, 0, 0 };
    e->force_scale = m->contact.normal_stiffness * fmax(-h, 1e-3 * sizes);
    if (m->has_laws) {
        const struct theory_contact law = contact_between(m, p->s[0].radius, p->s[1].radius);
        const double zeta = theory_normal_dashpot(&law) + law.tangential_damping * theory_reduced_mass(&law);
        theory_contact_laws_pair(&law, p->s, history, &e->pair);
        e->force_scale += zeta * (norm(p->s[0].u) + norm(p->s[1].u) + sizes * (norm(p->s[0].w) + norm(p->s[1].w)));
    } else
        theory_contact_pair(&m->contact, p->s, history, &e->pair);
    e->torque_scale = e->force_scale * sizes;
}

void worst_see(struct worst *w, double measured, double expected, double scale, size_t at)
{
    const double difference = fabs(measured - expected), error = difference == 0 ? 0 : difference / scale;
    if (!(error <= w->error) && !isnan(w->error))
        *w = (struct worst){ error, measured, expected, at };
}

void worst_see_vector(struct worst *w, const double *measured, const double *expected, int components, double scale, size_t at)
{
    for (int k = 0; k < components; k++)
        worst_see(w, measured[k], expected[k], scale, at);
}

const char *describe(const struct pair_state *p, size_t at)
{
    static char text[160];
    snprintf(text, sizeof text, "radii %g and %g, gap xi = %g (state %zu)", p->s[0].radius, p->s[1].radius, p->xi, at);
    return text;
}

const char *compare(const struct worst *w)
{
    static char text[160];
    const double rounding = 1e-9;       /* of the other number: nothing, for the reader */
    if (isnan(w->measured))
        snprintf(text, sizeof text, "no number where %.6g is expected", w->expected);
    else if (fabs(w->measured) <= rounding * fabs(w->expected))
        snprintf(text, sizeof text, "nothing where %.6g is expected", w->expected);
    else if (fabs(w->expected) <= rounding * fabs(w->measured))
        snprintf(text, sizeof text, "%.6g where nothing is expected", w->measured);
    else if (fabs(w->measured / w->expected - 1) < FEW_DIGITS)
        snprintf(text, sizeof text, "%.12g where %.12g is expected, %.2g of it too %s", w->measured, w->expected,
                 fabs(w->measured / w->expected - 1), fabs(w->measured) > fabs(w->expected) ? "much" : "little");
    else if (fabs(w->measured / w->expected + 1) < 1e-6)
        snprintf(text, sizeof text, "%.6g where %.6g is expected, the opposite sign", w->measured, w->expected);
    else
        snprintf(text, sizeof text, "%.6g where %.6g is expected, %.6g of it", w->measured, w->expected,
                 w->measured / w->expected);
    return text;
}
