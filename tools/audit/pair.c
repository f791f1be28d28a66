/*
 * Forces, torques and stresses of a pair as derivatives of one scalar
 *
 *     lubrication   dissipation D = X_A (n.dU)^2 + Y_A |dU_t + q|^2 + K |(W_1 - W_2)_t|^2,   q = (B_1 W_1 + B_2 W_2) x n/Y_A,  K = C_11 - B_1^2/Y_A
 *                   load = -(1/2) dD/d(velocity), by differences (exact: D is quadratic); Rayleigh's dissipation function
 *     contact       potential  -N r + P(s),  P the work that a tangential spring with a cap takes: (k_t/2) y^2 up to the cap, straight beyond
 *                   (Moreau's potential of friction), y the tangential displacement of the surfaces with the dashpot's share;
 *                   load = - derivative by virtual displacements and rotations of both spheres
 *     repulsion     potential V(h)
 *     stress        derivative by a virtual homogeneous deformation x -> x + G x:  sum of F (x) x = F_1 (x) (x_1 - x_2), with the sign of tension
 *     balance       derivative by a virtual rigid rotation about sphere 1:  T_1 + T_2 + r x F_2
 *
 * None of the vector formulas of the source or of validation/theory stands here.
 */
#include "audit.h"

struct quad_pair quad_pair_of(const struct theory_sphere s[2])
{
    struct quad_pair p;
    for (int a = 0; a < 2; a++) {
        p.radius[a] = s[a].radius;
        for (int k = 0; k < 3; k++) {
            p.x[a][k] = s[a].x[k];
            p.u[a][k] = s[a].u[k];
            p.w[a][k] = s[a].w[k];
        }
    }
    return p;
}

/* A motion of both spheres: velocities (or small displacements) and spins (or small rotations), U_1 U_2 W_1 W_2. */
struct motion { quad u[2][3], w[2][3]; };

static struct motion unit_motion(int k)
{
    struct motion m = { .u = { { 0 } } };
    *(k < 6 ? &m.u[k / 3][k % 3] : &m.w[k / 3 - 2][k % 3]) = 1;
    return m;
}

static struct motion deformation(const struct quad_pair *p, int row, int column)
{
    struct motion m = { .u = { { 0 } } };
    for (int a = 0; a < 2; a++)
        m.u[a][row] = p->x[a][column];
    return m;
}

static struct motion rotation(const struct quad_pair *p, int axis)
{
    struct motion m = { .u = { { 0 } } };
    quad spin[3] = { 0 };
    spin[axis] = 1;
    for (int a = 0; a < 2; a++) {
        const quad from[3] = { p->x[a][0] - p->x[0][0], p->x[a][1] - p->x[0][1], p->x[a][2] - p->x[0][2] };
        crossq(spin, from, m.u[a]);
        m.w[a][axis] = 1;
    }
    return m;
}

static quad normal_of(const struct quad_pair *p, quad n[3])
{
    for (int k = 0; k < 3; k++)
        n[k] = p->x[1][k] - p->x[0][k];
    const quad r = sqrtq(dotq(n, n));
    for (int k = 0; k < 3; k++)
        n[k] /= r;
    return r;
}

/* Everything from one function: the rate at which a virtual motion does work against the pair's loads, with its sign. */
typedef quad virtual_work(const struct motion *m, const void *with);

static void collect(virtual_work *work, const void *with, const struct quad_pair *p, struct quad_answer *out)
{
    for (int k = 0; k < 12; k++) {
        const struct motion m = unit_motion(k);
        *(k < 6 ? &out->force[k / 3][k % 3] : &out->torque[k / 3 - 2][k % 3]) = work(&m, with);
    }
    for (int k = 0; k < 9; k++) {
        const struct motion m = deformation(p, k / 3, k % 3);
        out->stress[k / 3][k % 3] = -work(&m, with);       /* F_1 (x) x_1 + F_2 (x) x_2 = -F_1 (x) (x_2 - x_1) */
    }
    for (int k = 0; k < 3; k++) {
        const struct motion m = rotation(p, k);
        out->balance[k] = work(&m, with);
    }
}

/* --- lubrication --- */

struct modes lubrication_modes(const struct theory_lubrication *law, const struct quad_pair *p)
{
    struct modes m = { 0 };
    quad n[3], c[THEORY_SCALARS], tangent[2][3], other[3] = { 0 };
    const quad r = normal_of(p, n);
    near_field_scalars(law->viscosity, law->inner_gap, law->outer_gap, law->exact_rotation, p->radius[0], p->radius[1], r, c);
    if (c[THEORY_XA] == 0)
        return m;
    other[fabsq(n[0]) < (quad)0.6 ? 0 : 1] = 1;
    crossq(n, other, tangent[0]);
    const quad length = sqrtq(dotq(tangent[0], tangent[0]));
    for (int k = 0; k < 3; k++)
        tangent[0][k] /= length;
    crossq(n, tangent[0], tangent[1]);
    m.count = 5;
    m.size[0] = c[THEORY_XA];
    for (int k = 0; k < 3; k++) {
        m.motion[0][k] = -n[k];
        m.motion[0][3 + k] = n[k];
    }
    for (int t = 0; t < 2; t++) {
        quad about[3];
        crossq(n, tangent[t], about);       /* (W x n).t = W.(n x t) */
        m.size[1 + t] = c[THEORY_YA];
        m.size[3 + t] = c[THEORY_C11] - c[THEORY_B1] * c[THEORY_B1] / c[THEORY_YA];
        for (int k = 0; k < 3; k++) {
            m.motion[1 + t][k] = -tangent[t][k];
            m.motion[1 + t][3 + k] = tangent[t][k];
            m.motion[1 + t][6 + k] = c[THEORY_B1] / c[THEORY_YA] * about[k];
            m.motion[1 + t][9 + k] = c[THEORY_B2] / c[THEORY_YA] * about[k];
            m.motion[3 + t][6 + k] = tangent[t][k];
            m.motion[3 + t][9 + k] = -tangent[t][k];
        }
    }
    return m;
}

struct lubricated { const struct quad_pair *p; struct modes modes; };

static quad dissipation(const struct lubricated *l, const struct motion *more, quad share)
{
    quad D = 0;
    for (int q = 0; q < l->modes.count; q++) {
        quad along = 0;
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 2; a++)
                along += l->modes.motion[q][3 * a + k] * (l->p->u[a][k] + share * more->u[a][k])
                         + l->modes.motion[q][6 + 3 * a + k] * (l->p->w[a][k] + share * more->w[a][k]);
        D += l->modes.size[q] * along * along;
    }
    return D;
}

static quad work_of_lubrication(const struct motion *m, const void *with)
{
    return -(dissipation(with, m, 1) - dissipation(with, m, -1)) / 4;
}

void lubrication_answer(const struct theory_lubrication *law, const struct quad_pair *p, struct quad_answer *out)
{
    const struct lubricated l = { p, lubrication_modes(law, p) };
    collect(work_of_lubrication, &l, p, out);
}

/* --- contact --- */

struct touching {
    const struct theory_contact *law;
    const struct quad_pair *p;
    quad n[3], arm[2], load, stretch[3], cap, normal_force;     /* stretch: tangential displacement and the dashpot's share of it */
};

/* Tangential displacement of the surface of 1 against that of 2 in a small motion. */
static void slip_of(const struct touching *t, const struct motion *m, quad slip[3])
{
    quad point[2][3];
    for (int a = 0; a < 2; a++) {
        quad arm[3];
        for (int k = 0; k < 3; k++)
            arm[k] = (a == 0 ? t->arm[0] : -t->arm[1]) * t->n[k];
        crossq(m->w[a], arm, point[a]);
        for (int k = 0; k < 3; k++)
            point[a][k] += m->u[a][k];
    }
    for (int k = 0; k < 3; k++)
        slip[k] = point[0][k] - point[1][k];
    const quad along = dotq(slip, t->n);
    for (int k = 0; k < 3; k++)
        slip[k] -= along * t->n[k];
}

static quad distance_after(const struct quad_pair *p, const struct motion *m, quad share)
{
    quad r[3];
    for (int k = 0; k < 3; k++)
        r[k] = p->x[1][k] - p->x[0][k] + share * (m->u[1][k] - m->u[0][k]);
    return sqrtq(dotq(r, r));
}

/* Work that the tangential spring with its cap has taken at this displacement. */
static quad friction_work(const struct touching *t, const struct motion *m, quad share)
{
    quad slip[3];
    slip_of(t, m, slip);
    for (int k = 0; k < 3; k++)
        slip[k] = t->stretch[k] + share * slip[k];
    const quad k_t = t->law->tangential_stiffness, y = sqrtq(dotq(slip, slip)), yield = t->cap / k_t;
    return t->cap < 0 ? 0 : y <= yield ? k_t * y * y / 2 : t->cap * (y - yield / 2);
}

static quad work_of_contact(const struct motion *m, const void *with)
{
    const struct touching *t = with;
    const quad step = (quad)1e-12;
    const quad normal = t->normal_force * (distance_after(t->p, m, step) - distance_after(t->p, m, -step)) / (2 * step);
    return normal - (friction_work(t, m, step) - friction_work(t, m, -step)) / (2 * step);
}

/* Area below the slope of the cap against the load: 2 t/N_c up to N_c, then 1 (soft); 0 up to N_c, then 1 (shifted). */
static quad cap_of(const struct theory_contact *law, quad load)
{
    const quad least = law->critical_load, above = load - least;
    quad area = load;
    bool grips = true;
    if (law->law == THEORY_CRITICAL || law->law == THEORY_SHIFTED)
        grips = above >= 0;
    if (law->law == THEORY_SOFT && above < 0)
        area = load * (2 * load / least) / 2;
    if (law->law == THEORY_SHIFTED)
        area = above;
    if (law->law == THEORY_BINARY)
        grips = law->rough[0] + law->rough[1] == 2;
    return grips && law->friction > 0 ? law->friction * area : -1;
}

void contact_answer(const struct theory_contact *law, const struct quad_pair *p, const quad history[3], struct quad_answer *out)
{
    struct touching t = { .law = law, .p = p };
    const quad r = normal_of(p, t.n), sizes = p->radius[0] + p->radius[1];
    *out = (struct quad_answer){ 0 };
    if (r >= sizes)
        return;
    for (int a = 0; a < 2; a++)
        t.arm[a] = law->lever_at_contact ? r - p->radius[1 - a] * r / sizes : p->radius[a];
    struct motion moving;
    for (int k = 0; k < 6; k++) {
        moving.u[k / 3][k % 3] = p->u[k / 3][k % 3];
        moving.w[k / 3][k % 3] = p->w[k / 3][k % 3];
    }
    quad inverse = 0, gamma = law->normal_damping, gamma_t = law->tangential_damping;
    const bool damped = gamma > 0 || law->restitution > 0;
    for (int a = 0; a < 2; a++)
        inverse += damped && !isinfq((quad)law->mass[a]) ? 1 / (quad)law->mass[a] : 0;
    if (law->restitution > 0)
        gamma = 2 * damping_ratio_of(law->restitution, law->clip) * sqrtq(law->normal_stiffness * inverse);
    const quad step = (quad)1e-12, closing = -(distance_after(p, &moving, step) - distance_after(p, &moving, -step)) / (2 * step);
    const quad elastic = law->normal_stiffness * (sizes - r), viscous = damped ? gamma / inverse * closing : 0;
    t.normal_force = law->clip && elastic + viscous < 0 ? 0 : elastic + viscous;
    t.load = law->load == THEORY_LOAD_SPRING ? elastic : law->load == THEORY_LOAD_ABSOLUTE ? fabsq(t.normal_force) : fmaxq(t.normal_force, 0);
    t.cap = cap_of(law, t.load);
    if (t.cap >= 0) {
        quad slip[3];
        const quad out_of_plane = dotq(history, t.n);
        slip_of(&t, &moving, slip);
        for (int k = 0; k < 3; k++)
            t.stretch[k] = history[k] - out_of_plane * t.n[k] + (damped ? gamma_t / inverse / law->tangential_stiffness * slip[k] : 0);
    }
    collect(work_of_contact, &t, p, out);
}

/* --- repulsion --- */

struct repelled { const struct theory_repulsion *law; const struct quad_pair *p; };

static quad potential(const struct repelled *d, const struct motion *m, quad share)
{
    const quad sizes = d->p->radius[0] + d->p->radius[1], range = d->law->kappa_factor * sizes, h = distance_after(d->p, m, share) - sizes;
    /* the energy is given at touch, or its slope is */
    return (d->law->by_energy ? d->law->strength : d->law->strength * range) / expq(h / range);
}

static quad work_of_repulsion(const struct motion *m, const void *with)
{
    const quad step = (quad)1e-12;
    return -(potential(with, m, step) - potential(with, m, -step)) / (2 * step);
}

void repulsion_answer(const struct theory_repulsion *law, const struct quad_pair *p, struct quad_answer *out)
{
    const struct repelled d = { law, p };
    quad n[3];
    const quad sizes = p->radius[0] + p->radius[1], h = normal_of(p, n) - sizes;
    *out = (struct quad_answer){ 0 };
    if (h <= law->cutoff * (law->kappa_factor * sizes))
        collect(work_of_repulsion, &d, p, out);
}
