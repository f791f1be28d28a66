/*
 * Two spheres in time
 *
 *     loads     lubrication  - sum c d (d.v) over the modes of pair.c;  contact by virtual work;  drag by the tractions of sphere.c
 *     friction  by events: a contact sticks (ds/dt = slip + (n x dn/dt) x s) until |s| reaches mu k_n delta/k_t, then slides with |s| at that value and a
 *               direction e of its own, de/dt = (slip across e)/|s| + (n x dn/dt) x e, until slip along e falls below the growth of the cap
 *     encounters of both spheres in the laboratory (theory: the symmetric pair in its own centre), with the time integrals of F_1 (x) (x_2 - x_1)
 *
 * Solved by the extrapolated midpoint rule with events found by halving; validation/theory has a Runge-Kutta pair of order 8 and steps over everything.
 */
#include "audit.h"

#include <math.h>
#include <string.h>

struct moving {
    const struct theory_motion *m;
    quad mass[2], inertia[2], zeta[2], turn[2];
    enum { APART, STICKS, SLIDES } state;
    int impulses;       /* whether six time integrals follow the 21 numbers of the pair */
    quad reach;
};

static quad disc(quad z, const void *radius)
{
    const quad a = *(const quad *)radius;
    return PIQ * (a * a - z * z);
}

static quad along_shell(quad z, const void *radius)
{
    const quad a = *(const quad *)radius, square = a * a - z * z;
    return PIQ * square * square / 2;       /* of a disc of unit density about its axis */
}

static struct moving moving_of(const struct theory_motion *m)
{
    struct moving o = { .m = m };
    for (int a = 0; a < 2; a++) {
        const quad radius = m->radius[a], one[3] = { 1, 0, 0 }, none[3] = { 0 };
        quad rest[3][3] = { { 0 } }, force[3], torque[3], stresslet[3][3];
        o.mass[a] = m->density[a] * integral(disc, &radius, -radius, radius);
        o.inertia[a] = m->density[a] * integral(along_shell, &radius, -radius, radius);
        if (m->drag) {
            drag_answer(m->viscosity, m->drag_torque, rest, radius, none, one, one, force, torque, stresslet);
            o.zeta[a] = -force[0];
            o.turn[a] = -torque[0];
        }
    }
    return o;
}

static struct quad_pair pair_at(const struct moving *o, const quad *y)
{
    struct quad_pair p;
    for (int a = 0; a < 2; a++) {
        p.radius[a] = o->m->radius[a];
        for (int k = 0; k < 3; k++) {
            p.x[a][k] = y[9 * a + k];
            p.u[a][k] = y[9 * a + 3 + k];
            p.w[a][k] = y[9 * a + 6 + k];
        }
    }
    return p;
}

/* Normal, its turning n x dn/dt, opening speed, slip of the surface of 1 against 2; returns the distance. */
static quad kinematics(const struct moving *o, const struct quad_pair *p, quad n[3], quad turn[3], quad *opening, quad slip[3])
{
    quad dn[3], spin[3];
    for (int k = 0; k < 3; k++)
        n[k] = p->x[1][k] - p->x[0][k];
    const quad r = sqrtq(dotq(n, n)), sizes = p->radius[0] + p->radius[1];
    for (int k = 0; k < 3; k++) {
        n[k] /= r;
        dn[k] = p->u[1][k] - p->u[0][k];
    }
    *opening = dotq(dn, n);
    const bool meet = o->m->contact && o->m->contact->lever_at_contact;
    for (int k = 0; k < 3; k++) {
        dn[k] -= *opening * n[k];
        spin[k] = (p->radius[0] * p->w[0][k] + p->radius[1] * p->w[1][k]) * (meet ? r / sizes : 1);
    }
    crossq(spin, n, slip);
    for (int k = 0; k < 3; k++)
        slip[k] -= dn[k];
    crossq(n, dn, turn);
    for (int k = 0; k < 3; k++)
        turn[k] /= r;
    return r;
}

static quad yield_of(const struct moving *o, quad r)
{
    const struct theory_contact *c = o->m->contact;
    return c->friction * (quad)c->normal_stiffness * ((quad)o->m->radius[0] + o->m->radius[1] - r) / c->tangential_stiffness;
}

static bool rubs(const struct moving *o) { return o->m->contact && o->m->contact->friction > 0; }

static void motion(quad t, const quad *y, quad *dydt, const void *with)
{
    const struct moving *o = with;
    const struct quad_pair p = pair_at(o, y);
    quad n[3], turn[3], slip[3], opening, load[12] = { 0 }, part[2][3] = { { 0 } };
    const quad r = kinematics(o, &p, n, turn, &opening, slip);
    (void)t;
    if (o->m->lubrication) {
        const struct modes m = lubrication_modes(o->m->lubrication, &p);
        for (int q = 0; q < m.count; q++) {
            quad along = 0;
            for (int k = 0; k < 12; k++)
                along += m.motion[q][k] * (k < 6 ? p.u[k / 3][k % 3] : p.w[k / 3 - 2][k % 3]);
            for (int k = 0; k < 12; k++)
                load[k] -= m.size[q] * along * m.motion[q][k];
        }
        for (int k = 0; k < 3; k++)
            part[1][k] = load[k];
    }
    if (o->m->contact && o->state != APART) {
        struct quad_answer c;
        quad s[3];
        for (int k = 0; k < 3; k++)
            s[k] = y[18 + k] * (o->state == SLIDES ? yield_of(o, r) : 1);
        contact_answer(o->m->contact, &p, s, &c);
        for (int k = 0; k < 6; k++) {
            load[k] += c.force[k / 3][k % 3];
            load[6 + k] += c.torque[k / 3][k % 3];
        }
        for (int k = 0; k < 3; k++)
            part[0][k] = c.force[0][k];
    }
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) {
            const double(*G)[3] = o->m->gradient;
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            quad flow = 0;
            for (int j = 0; j < 3; j++)
                flow += G[k][j] * p.x[a][j];
            dydt[9 * a + k] = p.u[a][k];
            dydt[9 * a + 3 + k] = (load[3 * a + k] + o->m->applied[a][k] + o->zeta[a] * (flow - p.u[a][k])) / o->mass[a];
            dydt[9 * a + 6 + k] = (load[6 + 3 * a + k] + o->m->applied_torque[a][k] + o->turn[a] * (((quad)G[m][l] - G[l][m]) / 2 - p.w[a][k])) / o->inertia[a];
        }
    quad turned[3], along = 0;
    crossq(turn, y + 18, turned);
    if (o->state == SLIDES)
        along = dotq(slip, y + 18);
    for (int k = 0; k < 3; k++)
        dydt[18 + k] = !rubs(o) || o->state == APART ? 0 : o->state == STICKS ? slip[k] + turned[k] : (slip[k] - along * y[18 + k]) / yield_of(o, r) + turned[k];
    for (int q = 0; q < 2 && o->impulses; q++) {
        const quad b[3] = { p.x[1][0] - p.x[0][0], p.x[1][1] - p.x[0][1], p.x[1][2] - p.x[0][2] }, *f = part[q];
        dydt[21 + 3 * q] = (f[0] * b[1] + f[1] * b[0]) / 2;
        dydt[22 + 3 * q] = f[0] * b[0] - f[1] * b[1];
        dydt[23 + 3 * q] = f[1] * b[1] - f[2] * b[2];
    }
}

/* Turns positive when the present state ends: the spheres touch; part or slide; part or stick; leave each other's range. */
static quad state_ends(const quad *y, const void *with)
{
    const struct moving *o = with;
    const struct quad_pair p = pair_at(o, y);
    quad n[3], turn[3], slip[3], opening;
    const quad r = kinematics(o, &p, n, turn, &opening, slip), gap = r - p.radius[0] - p.radius[1];
    if (o->state == APART)
        return o->m->contact && gap < 0 ? -gap : o->reach > 0 && y[9] > y[0] && y[10] > y[1] ? fmaxq(r - o->reach, -gap) : -gap;
    if (!rubs(o))
        return gap;
    const quad yield = yield_of(o, r);
    if (o->state == STICKS)
        return fmaxq(gap, sqrtq(dotq(y + 18, y + 18)) - yield);
    const quad growth = -yield_of(o, (quad)o->m->radius[0] + o->m->radius[1] - 1) * opening;        /* d(yield)/dt */
    return fmaxq(gap, growth - dotq(slip, y + 18));
}

/* From one state of the contact to the next. */
static void next_state(struct moving *o, quad *y)
{
    const struct quad_pair p = pair_at(o, y);
    quad n[3], turn[3], slip[3], opening;
    const quad r = kinematics(o, &p, n, turn, &opening, slip), gap = r - p.radius[0] - p.radius[1], size = sqrtq(dotq(slip, slip));
    const quad growth = rubs(o) ? -yield_of(o, (quad)p.radius[0] + p.radius[1] - 1) * opening : 0;
    if (o->state != APART && gap >= -(quad)1e-17) {
        o->state = APART;
        memset(y + 18, 0, 3 * sizeof *y);
    } else if (o->state == APART && rubs(o) && size > growth) {
        o->state = SLIDES;
        for (int k = 0; k < 3; k++)
            y[18 + k] = slip[k] / size;
    } else if (o->state == STICKS) {
        const quad length = sqrtq(dotq(y + 18, y + 18));
        o->state = SLIDES;
        for (int k = 0; k < 3; k++)
            y[18 + k] /= length;
    } else {
        for (int k = 0; k < 3 && o->state == SLIDES; k++)
            y[18 + k] *= yield_of(o, r);
        o->state = STICKS;
    }
}

static void carry(struct moving *o, quad *y, quad duration, double tolerance)
{
    double scale[MOST_VARIABLES];
    quad t = 0;
    for (int k = 0; k < MOST_VARIABLES; k++)
        scale[k] = k < 21 ? 1.0 : 10.0;
    for (int changes = 0; t < duration && changes < 40; changes++) {
        t += solve(motion, o, o->impulses ? 27 : 21, y, duration - t, tolerance, scale, state_ends);
        const struct quad_pair p = pair_at(o, y);
        const quad r[3] = { p.x[1][0] - p.x[0][0], p.x[1][1] - p.x[0][1], p.x[1][2] - p.x[0][2] };
        if (o->reach > 0 && o->state == APART && y[9] > y[0] && dotq(r, r) >= o->reach * o->reach)
            return;
        if (t < duration)
            next_state(o, y);
    }
}

/* --- what is compared --- */

static void see_motion(const struct theory_motion *m, const struct theory_sphere start[2], double duration, const char *where)
{
    struct theory_pair_state p = { .s = { start[0], start[1] } };
    struct moving o = moving_of(m);
    quad y[MOST_VARIABLES] = { 0 };
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) {
            y[9 * a + k] = start[a].x[k];
            y[9 * a + 3 + k] = start[a].u[k];
            y[9 * a + 6 + k] = start[a].w[k];
        }
    if (!theory_pair_motion(m, duration, 1e-12, &p))
        audit_fault("theory_pair_motion gave up");
    carry(&o, y, duration, 1e-16);
    for (int a = 0; a < 2; a++) {
        audit_see_list(p.s[a].x, y + 9 * a, 3, 1.0, where);
        audit_see_list(p.s[a].u, y + 9 * a + 3, 3, 1.0, where);
        audit_see_list(p.s[a].w, y + 9 * a + 6, 3, 1.0, where);
    }
}

static const struct theory_lubrication lubrication = { 0.7, 1e-3, 0.05, false };

static void audit_pair_motion(void)
{
    const struct theory_contact rough = { .normal_stiffness = 310.0, .tangential_stiffness = 87.0, .friction = 0.45 };
    const struct theory_sphere start[2] = { { 1.3, { 0.1, -0.2, 0.3 }, { 0.9, 0.1, -0.2 }, { 0.3, -0.2, 0.4 } },
                                            { 1.82, { 2.2, -1.3, 2.36 }, { -0.8, 0.6, -0.3 }, { -0.1, 0.2, 0.5 } } };
    struct theory_motion m = { .radius = { 1.3, 1.82 }, .density = { 0.83, 1.1 }, .viscosity = 0.7 };
    audit_quantity("pair motion: friction that slides and sticks", "events of sliding and sticking, virtual work", 1e-11,
                   "the theory steps over the corners of friction, each within 1e-12 of a step, and lets |s| drift from the cap by that", "theory_pair_motion");
    m.contact = &rough;
    see_motion(&m, start, 1.1, "contact alone");
    m.lubrication = &lubrication;
    m.drag = m.drag_torque = true;
    m.gradient[0][1] = -0.4;
    see_motion(&m, start, 0.6, "contact, lubrication, drag");
    audit_quantity("pair motion: lubrication, drag, loads", "modes of motion, extrapolated midpoint rule", 1e-11, "the theory steps over the cut-offs, each within 1e-12 of a step", "");
    m.contact = NULL;
    m.applied[0][0] = 3.0;
    m.applied[1][0] = -2.0;
    m.applied_torque[1][2] = 0.7;
    see_motion(&m, start, 0.9, "no contact");
    audit_quantity("mass of a sphere", "volume from discs", 1e-15, "one rounding", "theory_sphere_mass");
    for (int a = 0; a < 2; a++) {
        const quad radius = m.radius[a];
        audit_see(theory_sphere_mass(&m, a), m.density[a] * integral(disc, &radius, -radius, radius), theory_sphere_mass(&m, a), "");
    }
}

struct squeeze { quad a1, a2; };

static quad squeezing(quad h, const void *with)
{
    const struct squeeze *s = with;
    quad c[THEORY_SCALARS];
    near_field_scalars(lubrication.viscosity, lubrication.inner_gap, lubrication.outer_gap, false, s->a1, s->a2, s->a1 + s->a2 + h, c);
    return c[THEORY_XA];
}

static void audit_squeeze(void)
{
    static const double ends[][2] = { { -1e-3, 2e-3 }, { 4e-4, 3e-2 }, { 0.03, 5e-3 }, { 0.0, 0.2 } };
    audit_quantity("integral of the squeezing resistance", "double exponential quadrature between the cut-offs", 1e-12, "coefficients solved from two values lose two digits",
                   "theory_squeeze_integral");
    for (int r = 0; r < 2; r++)
        for (int k = 0; k < 4; k++) {
            const struct squeeze s = { 1.3, r ? 1.82 : 0.26 };
            const quad mean = (s.a1 + s.a2) / 2, cut[4] = { -1, lubrication.inner_gap * mean, lubrication.outer_gap * mean, 1 };
            const quad from = fminq(ends[k][0], ends[k][1]), to = fmaxq(ends[k][0], ends[k][1]);
            quad sum = 0;
            for (int piece = 0; piece < 3; piece++) {
                const quad low = fmaxq(from, cut[piece]), high = fminq(to, cut[piece + 1]);
                if (low < high)
                    sum += integral(squeezing, &s, low, high);
            }
            audit_see(theory_squeeze_integral(&lubrication, (double)s.a1, (double)s.a2, ends[k][0], ends[k][1]), ends[k][0] < ends[k][1] ? sum : -sum, (double)sum, "");
        }
}

static void encounter(const struct theory_motion *m, quad y0, quad z0, quad impulse[2][3], quad end[3])
{
    struct moving o = moving_of(m);
    const quad a = m->radius[0], reach = 2 * a + (m->lubrication ? a * m->lubrication->outer_gap : 0), rate = m->gradient[0][1];
    quad y[MOST_VARIABLES] = { 0 };
    const quad r[3] = { -sqrtq(fmaxq(reach * reach - y0 * y0 - z0 * z0, 0)) - (quad)1e-6 * a, y0, z0 };
    o.impulses = 1;
    o.reach = reach * (1 + (quad)1e-9);
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < 3; k++)
            y[9 * side + k] = (side ? 1 : -1) * r[k] / 2;
        y[9 * side + 3] = rate * y[9 * side + 1];
        y[9 * side + 8] = -rate / 2;
    }
    carry(&o, y, (400 + 20 * reach / y0) / rate, 1e-14);
    for (int k = 0; k < 6; k++)
        impulse[k / 3][k % 3] = y[21 + k];
    for (int k = 0; k < 3; k++)
        end[k] = y[9 + k] - y[k];
}

static void audit_encounters(void)
{
    const struct theory_contact smooth = { .normal_stiffness = 310.0 };
    struct theory_motion m = { .radius = { 1.3, 1.3 }, .density = { 5.0, 5.0 }, .contact = &smooth, .lubrication = &lubrication, .drag = true, .drag_torque = true,
                               .viscosity = 0.7, .gradient = { { 0.0, 0.4 } } };
    static const double at[][2] = { { 0.9, 0.4 }, { 1.7, 0.2 }, { 2.3, 0.9 } };
    double impulse[6][2][3], end[6][3];
    quad Q[6][2][3], way_out[6][3];
    for (int k = 0; k < 6; k++) {
        m.lubrication = k < 3 ? &lubrication : NULL;
        if (!theory_encounter(&m, at[k % 3][0], at[k % 3][1], 1e-13, impulse[k], end[k]))
            audit_fault("theory_encounter gave up");
        encounter(&m, at[k % 3][0], at[k % 3][1], Q[k], way_out[k]);
    }
    audit_quantity("encounters in shear: impulses", "both spheres in the laboratory, modes of motion", 1e-10, "1e-13 of each of some thousand steps", "theory_encounter");
    for (int k = 0; k < 6; k++)
        audit_see_list(&impulse[k][0][0], &Q[k][0][0], 6, fabs(impulse[k][0][0]) + fabs(impulse[k][1][0]), k < 3 ? "lubricated" : "contact alone");
    audit_quantity("encounters in shear: place of leaving", "both spheres in the laboratory, modes of motion", 1e-6,
                   "the theory looks at whole steps; here the step is halved until the spheres are at their range", "");
    for (int k = 0; k < 3; k++)         /* contact alone: a pair may part long before x > 0, where the theory's next step is as it comes */
        audit_see_list(end[k], way_out[k], 3, 1.3, "");
    audit_quantity("stress of encounters over the plane of impact", "the same points from Newton's roots, encounters in the laboratory", 1e-7,
                   "the theory's encounters at 1e-9 a step; points are the theory's own rule, so that its error drops out", "theory_sheared_pairs");
    enum { POINTS = 2 };
    double c[2][3];
    quad point[POINTS], weight[POINTS], sum[2][3] = { { 0 } };
    m.lubrication = &lubrication;
    if (!theory_sheared_pairs(&m, POINTS, POINTS, c))
        audit_fault("theory_sheared_pairs gave up");
    gauss_points(POINTS, point, weight);
    const quad a = m.radius[0], reach = a * (2 + (quad)lubrication.outer_gap), density = 1 / (4 * PIQ * a * a * a / 3);
    for (int i = 0; i < POINTS; i++)
        for (int j = 0; j < POINTS; j++) {
            const quad b = reach * (1 + point[i]) / 2, angle = PIQ / 4 * (1 + point[j]), area = weight[i] * reach / 2 * weight[j] * PIQ / 4 * b;
            quad one[2][3], leaving[3];
            encounter(&m, b * cosq(angle), b * sinq(angle), one, leaving);
            for (int k = 0; k < 6; k++)     /* n^2/2, four quarters of the plane, |rate y| passing, over eta rate */
                sum[k / 3][k % 3] += density * density / 2 * 4 * area * b * cosq(angle) / m.viscosity * one[k / 3][k % 3];
        }
    for (int k = 0; k < 6; k++)
        audit_see(c[k / 3][k % 3], sum[k / 3][k % 3], fabs(c[k / 3][0]), "");
}

void audit_motion(void)
{
    audit_pair_motion();
    audit_squeeze();
    audit_encounters();
}
