/*
 * Impacts as differential equations, solved until the spheres part
 *
 *     head-on      d'' = -N/m, N = k d + zeta d' (never below 0 with tension clip), d(0) = 0, d'(0) = v; the way the cap feels it: dJ/dt = load
 *     restitution  speed of parting over speed of approach; its inverse by secants
 *     in space     both spheres with the loads of pair.c (virtual work), history carried by the rotation that turns the normal:
 *                  ds/dt = slip + (n x dn/dt) x s
 *
 * validation/theory has closed forms for the first two, and another Runge-Kutta method with other vector formulas for the third.
 */
#include "audit.h"

#include <math.h>
#include <string.h>

/* --- head-on: y = d, d', J --- */

struct head_on { quad mass, stiffness, dashpot; bool clip; enum theory_load load; };

static quad normal_force(const struct head_on *c, const quad *y)
{
    const quad N = c->stiffness * y[0] + c->dashpot * y[1];
    return c->clip && N < 0 ? 0 : N;
}

static void overlap_motion(quad t, const quad *y, quad *dydt, const void *with)
{
    const struct head_on *c = with;
    const quad N = normal_force(c, y);
    (void)t;
    dydt[0] = y[1];
    dydt[1] = -N / c->mass;
    dydt[2] = c->load == THEORY_LOAD_SPRING ? c->stiffness * y[0] : c->load == THEORY_LOAD_ABSOLUTE ? fabsq(N) : fmaxq(N, 0);
}

static quad parted(const quad *y, const void *with) { (void)with; return -y[0]; }

/* Free of each other: where the force would turn to a pull that is not there. */
static quad let_go(const quad *y, const void *with)
{
    const struct head_on *c = with;
    return -(c->stiffness * y[0] + c->dashpot * y[1]);
}

/* From touch with unit speed to where the spheres are free (or overlap no more); the state then, and the time. */
static quad impact(const struct head_on *c, bool until_apart, quad y[3])
{
    const double period = 2 * (double)(PIQ * sqrtq(c->mass / c->stiffness)), b = (double)(c->dashpot / sqrtq(c->mass * c->stiffness)) / 2;
    const double scale[3] = { period, 1.0, (double)c->mass };
    y[0] = y[2] = 0;
    y[1] = 1;
    return solve(overlap_motion, c, 3, y, 100 * period * (1.0 + 10.0 * b) / (b < 0.999 ? sqrt(1.0 - b * b) : 0.05), 1e-19, scale, c->clip && !until_apart ? let_go : parted);
}

static quad restitution_of(quad b, bool clip)
{
    quad y[3];
    const struct head_on c = { 1, 1, 2 * b, clip, THEORY_LOAD_SPRING };
    impact(&c, false, y);
    return -y[1];
}

quad damping_ratio_of(quad restitution, bool clip)
{
    static struct { quad restitution, ratio; bool clip; } known[8];
    static int count = 0;
    for (int k = 0; k < count; k++)
        if (known[k].restitution == restitution && known[k].clip == clip)
            return known[k].ratio;
    if (restitution >= 1)
        return 0;
    const quad wanted = logq(restitution);
    quad one = (quad)0.05, at_one = logq(restitution_of(one, clip)) - wanted, two = clip ? (quad)0.3 : (quad)0.25, at_two;
    for (int k = 0; k < 25; k++) {
        at_two = logq(restitution_of(two, clip)) - wanted;
        if (fabsq(at_two) < (quad)1e-18 || at_two == at_one)
            break;
        const quad next = two - at_two * (two - one) / (at_two - at_one);
        one = two;
        at_one = at_two;
        two = next <= 0 ? one / 2 : !clip && next >= 1 ? (one + 1) / 2 : next;
    }
    if (count < 8) {
        known[count].restitution = restitution;
        known[count].clip = clip;
        known[count++].ratio = two;
    }
    return two;
}

static void audit_head_on(void)
{
    static const double ratio[] = { 0.0, 0.02, 0.3, 0.8, 1.0, 1.9 }, wanted[] = { 0.97, 0.35, 0.5 };
    const double mass[2] = { 0.83, 1.9 };
    audit_quantity("speed ratio of a damping ratio", "oscillator solved until the spheres part", 1e-13, "exp of a rounded exponent", "theory_restitution");
    for (int k = 0; k < 6; k++)
        for (int clip = 0; clip < 2; clip++)
            if (clip || ratio[k] < 1.0)
                audit_see(theory_restitution(ratio[k], clip), restitution_of(ratio[k], clip), theory_restitution(ratio[k], clip), clip ? "clip" : "allow");
    audit_quantity("damping ratio of a speed ratio", "secants on the solved oscillator", 1e-13, "halving ends at 1e-15", "theory_damping_ratio");
    for (int k = 0; k < 3; k++)
        for (int clip = 0; clip < 2; clip++)
            audit_see(theory_damping_ratio(wanted[k], clip), damping_ratio_of(wanted[k], clip), theory_damping_ratio(wanted[k], clip), "");
    for (int part = 0; part < 3; part++) {
        audit_quantity(part == 0 ? "head-on impact: speed ratio" : part == 1 ? "head-on impact: duration" : "sliding impact: impulse of the cap",
                       part == 2 ? "load integrated along the impact" : "oscillator solved until the spheres part", 1e-12, "a few roundings of the exponent",
                       part == 0 ? "theory_head_on theory_reduced_mass theory_normal_dashpot" : part == 1 ? "theory_head_on" : "theory_sliding_impulse");
        for (int k = 0; k < 3; k++)
            for (int held = 0; held < 2; held++)
                for (int clip = 0; clip < 2; clip++)
                    for (int load = 0; load < (part == 2 ? 3 : 1); load++) {
                        struct theory_contact law = { .normal_stiffness = 310.0, .clip = clip, .load = (enum theory_load)load, .mass = { mass[0], mass[1] } };
                        if (k == 2)
                            law.restitution = 0.35;
                        else
                            law.normal_damping = k ? 9.0 : 0.7;
                        if (held)
                            law.mass[1] = (double)INFINITY;
                        /* reduced mass: the mass that moves in the frame of the common centre: m_1 v_1^2 + m_2 v_2^2 = m (v_1 - v_2)^2 */
                        const quad v1 = held ? 1 : (quad)mass[1] / ((quad)mass[0] + mass[1]), v2 = 1 - v1, m = mass[0] * v1 * v1 + (held ? 0 : mass[1] * v2 * v2);
                        const quad zeta = k == 2 ? 2 * damping_ratio_of(law.restitution, clip) * sqrtq(m * law.normal_stiffness) : m * law.normal_damping;
                        const struct head_on c = { m, law.normal_stiffness, zeta, clip, law.load };
                        double e, duration;
                        quad y[3];
                        const quad t = impact(&c, part == 2, y);
                        theory_head_on(&law, &e, &duration);
                        if (part == 0) {
                            audit_see(e, -y[1], e, "");
                            audit_see(theory_normal_dashpot(&law), zeta, (double)zeta, "dashpot");
                            audit_see(theory_reduced_mass(&law), m, (double)m, "reduced mass");
                        } else if (part == 1)
                            audit_see(duration, t + y[0] / -y[1], duration, "");        /* where the straight flight passes d = 0 */
                        else
                            audit_see(theory_sliding_impulse(&law), y[2], (double)y[2], clip ? "clip" : "allow");
                    }
    }
}

/* --- friction laws at a load: known points of their curves --- */

static void audit_caps(void)
{
    audit_quantity("friction cap at a load", "areas below the slopes of the laws", 1e-14, "a few roundings", "theory_friction_cap theory_contact_grips");
    for (int law = THEORY_PLAIN; law <= THEORY_BINARY; law++)
        for (int k = 0; k <= 6; k++) {
            const struct theory_contact c = { .normal_stiffness = 100.0, .friction = 0.45, .law = (enum theory_law)law, .critical_load = 9.0, .rough = { true, k % 2 == 0 } };
            const quad load = 3 * k, above = fmaxq(load - 9, 0), below = fminq(load, 9);
            /* no friction: -1 */
            const quad area[] = { load, load >= 9 ? load : -1, above + below * below / 9, load >= 9 ? above : -1, c.rough[1] ? load : -1 };
            const quad cap = area[law] < 0 ? -1 : (quad)0.45 * area[law];
            audit_see(theory_friction_cap(&c, (double)load), area[law] < 0 ? -1 : (quad)c.friction * area[law], 9.0, "");
            audit_see(theory_contact_grips(&c, (double)(load / 100), 0.0) ? 1.0 : 0.0, k > 0 && cap >= 0 && area[law] >= 0 ? 1 : 0, 1.0, "grips");
        }
}

/* --- in space: y = x_1 u_1 w_1 x_2 u_2 w_2 s --- */

struct in_space { struct theory_contact law; quad radius[2]; };

static struct quad_pair pair_of(const struct in_space *c, const quad *y)
{
    struct quad_pair p = { { c->radius[0], c->radius[1] }, { { 0 } }, { { 0 } }, { { 0 } } };
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) {
            p.x[a][k] = y[9 * a + k];
            p.u[a][k] = y[9 * a + 3 + k];
            p.w[a][k] = y[9 * a + 6 + k];
        }
    return p;
}

static quad gap_now(const quad *y, const void *with)
{
    const struct in_space *c = with;
    const quad r[3] = { y[9] - y[0], y[10] - y[1], y[11] - y[2] };
    return sqrtq(dotq(r, r)) - c->radius[0] - c->radius[1];
}

static void impact_motion(quad t, const quad *y, quad *dydt, const void *with)
{
    const struct in_space *c = with;
    const struct quad_pair p = pair_of(c, y);
    struct quad_answer q;
    (void)t;
    contact_answer(&c->law, &p, y + 18, &q);
    quad n[3], dn[3], turn[3], turned[3], slip[3], arm[2];
    for (int k = 0; k < 3; k++)
        n[k] = p.x[1][k] - p.x[0][k];
    const quad r = sqrtq(dotq(n, n));
    for (int k = 0; k < 3; k++) {
        n[k] /= r;
        dn[k] = (p.u[1][k] - p.u[0][k]) / r;
    }
    const quad stretching = dotq(dn, n);
    for (int k = 0; k < 3; k++)
        dn[k] -= stretching * n[k];
    crossq(n, dn, turn);
    crossq(turn, y + 18, turned);
    for (int a = 0; a < 2; a++)
        arm[a] = c->law.lever_at_contact ? c->radius[a] * r / (c->radius[0] + c->radius[1]) : c->radius[a];
    const quad spin[3] = { arm[0] * p.w[0][0] + arm[1] * p.w[1][0], arm[0] * p.w[0][1] + arm[1] * p.w[1][1], arm[0] * p.w[0][2] + arm[1] * p.w[1][2] };
    crossq(spin, n, slip);
    for (int k = 0; k < 3; k++)
        slip[k] -= r * dn[k];
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) {
            const quad mass = c->law.mass[a];
            dydt[9 * a + k] = p.u[a][k];
            dydt[9 * a + 3 + k] = q.force[a][k] / mass;
            dydt[9 * a + 6 + k] = q.torque[a][k] / (2 * mass * c->radius[a] * c->radius[a] / 5);
        }
    for (int k = 0; k < 3; k++)
        dydt[18 + k] = slip[k] + turned[k];
}

void audit_impacts(void)
{
    const double a[2] = { 1.3, 1.82 }, scale[21] = { 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0.1, 0.1, 0.1 };
    audit_quantity("impacts that stick", "virtual work, extrapolated midpoint rule, end by halving", 1e-10, "the theory's own step control: 1e-13 per step of a few hundred",
                   "theory_collide");
    for (int k = 0; k < 3; k++) {
        struct theory_collision c = { .start = { { a[0], { 0.2, -0.1, 0.3 }, { 0.5, 0.1, -0.2 }, { 0.3, -0.2, 0.4 } },
                                                 { a[1], { 0.0 }, { -0.6, -0.05, 0.1 }, { -0.1, 0.2, 0.3 } } } };
        struct in_space here = { .law = { .normal_stiffness = 310.0, .tangential_stiffness = 87.0, .friction = 1e4, .lever_at_contact = k == 1,
                                          .normal_damping = k ? 1.7 : 0.0, .tangential_damping = k ? 0.9 : 0.0, .clip = k == 2, .mass = { 2.3, 3.1 } },
                                 .radius = { a[0], a[1] } };
        const double n[3] = { 2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0 };
        quad y[21] = { 0 };
        struct theory_sphere now[2];
        for (int d = 0; d < 3; d++)
            c.start[1].x[d] = c.start[0].x[d] + (a[0] + a[1]) * n[d];
        c.law = &here.law;
        const double t = 0.7;
        if (!theory_collide(&c, t, now))
            audit_fault("theory_collide gave up");
        for (int s = 0; s < 2; s++)
            for (int d = 0; d < 3; d++) {
                y[9 * s + d] = c.start[s].x[d];
                y[9 * s + 3 + d] = c.start[s].u[d];
                y[9 * s + 6 + d] = c.start[s].w[d];
            }
        const quad time = solve(impact_motion, &here, 21, y, t, 1e-16, scale, gap_now);
        for (int s = 0; s < 2; s++) {
            for (int d = 0; d < 3; d++)
                y[9 * s + d] += (t - time) * y[9 * s + 3 + d];
            audit_see_list(now[s].x, y + 9 * s, 3, 1.0, "places");
            audit_see_list(now[s].u, y + 9 * s + 3, 3, 1.0, "velocities");
            audit_see_list(now[s].w, y + 9 * s + 6, 3, 1.0, "spins");
        }
    }
}

void audit_collisions(void)
{
    audit_head_on();
    audit_caps();
}
