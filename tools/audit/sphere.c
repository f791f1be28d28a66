/*
 * One sphere: Stokes's velocity field, and moments of its random and its driven motion as differential equations
 *
 * Drag. Around a sphere of radius a at the origin that translates with V and spins with W relative to the fluid in the straining flow E x:
 *
 *     u = (3a/4)(V/r + x (x.V)/r^3) + (a^3/4)(V/r^3 - 3 x (x.V)/r^5)           p = (3/2) eta a x.V/r^3
 *       + W x x a^3/r^3                                                         0
 *       + E x - (5/2) a^3 x (x.E x)/r^5 + a^5 [(5/2) x (x.E x)/r^7 - E x/r^5]   -5 eta a^3 x.E x/r^5
 *
 * Stress from the velocity gradient by difference quotients; force, torque and symmetric first moment (stresslet) are integrals of the traction over
 * the sphere, by Gauss points in cos(theta) and equal angles. That the field keeps to the sphere's motion and is a Stokes flow (force and torque through a
 * larger sphere are the same) is tried too.
 *
 * Langevin. d<x^2>/dt = 2 <x u>, d<x u>/dt = <u^2> - <x u>/tau, <u^2> = kT/m; correlations at two times decay by d<. u>/dt = -<. u>/tau.
 * Driven sphere. Laboratory velocities (theory: peculiar ones), dU/dt = (G x - U)/tau + the acceleration of the flow along periodic axes.
 */
#include "audit.h"

#include <math.h>
#include <string.h>

/* --- drag --- */

struct stokes { quad a, eta, V[3], W[3], E[3][3]; };

static quad field(const struct stokes *s, const quad x[3], quad u[3])
{
    const quad r = sqrtq(dotq(x, x)), a = s->a, a3 = a * a * a, r3 = r * r * r, r5 = r3 * r * r, xV = dotq(x, s->V);
    quad spin[3], Ex[3];
    crossq(s->W, x, spin);
    for (int k = 0; k < 3; k++)
        Ex[k] = dotq(s->E[k], x);
    const quad xEx = dotq(x, Ex);
    for (int k = 0; k < 3; k++)
        u[k] = 3 * a / 4 * (s->V[k] / r + x[k] * xV / r3) + a3 / 4 * (s->V[k] / r3 - 3 * x[k] * xV / r5) + spin[k] * a3 / r3 + Ex[k]
               - (quad)5 / 2 * a3 * x[k] * xEx / r5 + a3 * a * a * ((quad)5 / 2 * x[k] * xEx / (r5 * r * r) - Ex[k] / r5);
    return (quad)3 / 2 * s->eta * a * xV / r3 - 5 * s->eta * a3 * xEx / r5;
}

/* Traction on the fluid sphere through x, outward normal x/r. */
static void traction(const struct stokes *s, const quad x[3], quad t[3])
{
    quad unused[3], gradient[3][3];
    const quad r = sqrtq(dotq(x, x)), step = s->a * (quad)1e-11, p = field(s, x, unused);
    for (int l = 0; l < 3; l++) {
        quad ahead[3], behind[3], far[3] = { x[0], x[1], x[2] }, near[3] = { x[0], x[1], x[2] };
        far[l] += step;
        near[l] -= step;
        field(s, far, ahead);
        field(s, near, behind);
        for (int k = 0; k < 3; k++)
            gradient[k][l] = (ahead[k] - behind[k]) / (2 * step);
    }
    for (int k = 0; k < 3; k++) {
        t[k] = -p * x[k] / r;
        for (int l = 0; l < 3; l++)
            t[k] += s->eta * (gradient[k][l] + gradient[l][k]) * x[l] / r;
    }
}

/* Integrals of the traction over the sphere of this radius: force, torque, first moment. */
static void moments(const struct stokes *s, quad radius, quad force[3], quad torque[3], quad moment[3][3])
{
    enum { RINGS = 4, ANGLES = 8 };         /* the traction is of degree 1, its moment of degree 2 in the direction: exact */
    quad cosine[RINGS], weight[RINGS];
    gauss_points(RINGS, cosine, weight);
    memset(force, 0, 3 * sizeof *force);
    memset(torque, 0, 3 * sizeof *torque);
    memset(moment, 0, 9 * sizeof(quad));
    for (int c = 0; c < RINGS; c++)
        for (int k = 0; k < ANGLES; k++) {
            const quad sine = sqrtq(1 - cosine[c] * cosine[c]), angle = 2 * PIQ * k / ANGLES + (quad)1 / 3;
            const quad x[3] = { radius * sine * cosq(angle), radius * sine * sinq(angle), radius * cosine[c] };
            const quad area = weight[c] * 2 * PIQ / ANGLES * radius * radius;
            quad t[3], turn[3];
            traction(s, x, t);
            crossq(x, t, turn);
            for (int l = 0; l < 3; l++) {
                force[l] += area * t[l];
                torque[l] += area * turn[l];
                for (int m = 0; m < 3; m++)
                    moment[l][m] += area * t[l] * x[m];
            }
        }
}

void drag_answer(quad eta, bool with_torque, quad G[3][3], quad a, const quad x[3], const quad u[3], const quad w[3], quad force[3], quad moment[3],
                 quad stresslet[3][3])
{
    struct stokes s = { .a = a, .eta = eta };
    quad first[3][3], far_force[3], far_torque[3], far_moment[3][3];
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        s.V[k] = u[k] - dotq(G[k], x);
        s.W[k] = w[k] - (G[m][l] - G[l][m]) / 2;
        for (int j = 0; j < 3; j++)
            s.E[k][j] = (G[k][j] + G[j][k]) / 2;
    }
    /* on the sphere the fluid moves with it: V + W x x (the frame turns with the fluid) */
    const quad on[3] = { a * (quad)0.6, a * (quad)-0.48, a * sqrtq(1 - (quad)0.6 * (quad)0.6 - (quad)0.48 * (quad)0.48) };
    quad there[3], spin[3];
    field(&s, on, there);
    crossq(s.W, on, spin);
    for (int k = 0; k < 3; k++)
        if (fabsq(there[k] - s.V[k] - spin[k]) > (quad)1e-28 * (1 + fabsq(s.V[k]) + fabsq(spin[k])))
            audit_fault("Stokes's field slips on the sphere by %g", (double)(there[k] - s.V[k] - spin[k]));
    moments(&s, a, force, moment, first);
    moments(&s, a * (quad)1.7, far_force, far_torque, far_moment);
    for (int k = 0; k < 3; k++)
        if (fabsq(far_force[k] - force[k]) + fabsq(far_torque[k] - moment[k]) / a > (quad)1e-18 * eta * a * (1 + fabsq(s.V[0]) + fabsq(s.V[1]) + fabsq(s.V[2]) + 100))
            audit_fault("Stokes's field is no Stokes flow: force %g through the sphere, %g farther out", (double)force[k], (double)far_force[k]);
    const quad trace = first[0][0] + first[1][1] + first[2][2];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            stresslet[k][j] = (first[k][j] + first[j][k]) / 2 - (k == j ? trace / 3 : 0);
    for (int k = 0; k < 3 && !with_torque; k++)
        moment[k] = 0;
}

/* --- Langevin --- */

struct langevin { quad kT, mass, friction; };

static void langevin_moments(quad t, const quad *y, quad *dydt, const void *with)
{
    /* y: <x^2>, <x u>, <u(0) u>, <x(s) x>, <x(s) u> */
    const struct langevin *l = with;
    const quad rate = l->friction / l->mass;
    (void)t;
    dydt[0] = 2 * y[1];
    dydt[1] = l->kT / l->mass - rate * y[1];
    dydt[2] = -rate * y[2];
    dydt[3] = y[4];
    dydt[4] = -rate * y[4];
}

static void audit_langevin(void)
{
    static const double at[] = { 1e-4, 0.03, 0.4, 0.6, 1.7, 9.0, 60.0 };
    const struct langevin l = { (quad)0.31, (quad)0.83, (quad)2.9 };
    const double tau = 0.83 / 2.9, scale[5] = { 1e-3, 1e-3, 1e-3, 1e-3, 1e-3 };
    quad y[7][5];
    for (int k = 0; k < 7; k++) {
        memset(y[k], 0, sizeof y[k]);
        y[k][2] = (quad)0.31 / (quad)0.83;
        solve(langevin_moments, &l, 5, y[k], (quad)(at[k] * tau), 1e-20, scale, 0);
    }
    audit_quantity("Langevin: mean square displacement", "equation of the second moments", 1e-13, "a few roundings; series where terms cancel",
                   "theory_langevin_msd");
    for (int k = 0; k < 7; k++)
        audit_see(theory_langevin_msd(0.31, 0.83, 2.9, at[k] * tau), y[k][0], (double)y[k][0], "");
    audit_quantity("Langevin: velocity autocorrelation", "its decay equation", 1e-13, "9 relaxation times: the exponent is rounded", "theory_langevin_vacf");
    for (int k = 0; k < 6; k++)
        audit_see(theory_langevin_vacf(0.31, 0.83, 2.9, at[k] * tau), y[k][2], (double)y[k][2], "");
    audit_quantity("Langevin: displacements at two times", "equation of <x(s) x(t)>", 1e-13, "a few roundings", "theory_langevin_msd_covariance");
    for (int k = 0; k + 1 < 7; k++) {
        quad z[5];
        memcpy(z, y[k], sizeof z);
        z[3] = z[0];
        z[4] = z[1];
        solve(langevin_moments, &l, 5, z, (quad)(at[k + 1] * tau) - (quad)(at[k] * tau), 1e-20, scale, 0);
        audit_see(theory_langevin_msd_covariance(0.31, 0.83, 2.9, at[k] * tau, at[k + 1] * tau), z[3], (double)sqrtq(y[k][0] * y[k + 1][0]), "");
    }
}

/* --- driven spheres --- */

struct driven { const struct theory_stage *stage; const bool *open; quad tau, spin_tau; };

static void rates_at(const struct theory_stage *stage, quad s, quad G[3][3], quad dG[3][3])
{
    memset(G, 0, 9 * sizeof(quad));
    memset(dG, 0, 9 * sizeof(quad));
    for (size_t k = 0; stage && k < stage->shears; k++) {
        const struct theory_rate *r = &stage->shear[k];
        quad sine, cosine;
        sincosq(r->frequency * s + r->phase, &sine, &cosine);
        G[r->flow][r->gradient] += r->mean + r->slope * s + r->amplitude * sine;
        dG[r->flow][r->gradient] += r->slope + (quad)r->amplitude * r->frequency * cosine;
    }
}

/* Laboratory velocities: y = x, U, W. */
static void driven_motion(quad s, const quad *y, quad *dydt, const void *with)
{
    const struct driven *d = with;
    quad G[3][3], dG[3][3];
    rates_at(d->stage, s, G, dG);
    for (int k = 0; k < 3; k++) {
        const int l = (k + 1) % 3, m = (k + 2) % 3;
        quad carried = 0;
        for (int j = 0; j < 3; j++)
            carried += d->open[j] ? 0 : dG[k][j] * y[j];
        dydt[k] = y[3 + k];
        dydt[3 + k] = (dotq(G[k], y) - y[3 + k]) / d->tau + carried;
        dydt[6 + k] = ((G[m][l] - G[l][m]) / 2 - y[6 + k]) / d->spin_tau;
    }
}

static void driven_by_laboratory(const struct theory_stage *stage, size_t stages, const bool open[3], double tau, double spin_tau, double t,
                                 const struct theory_sphere *start, quad y[9])
{
    const double scale[9] = { 1, 1, 1, 1, 1, 1, 1, 1, 1 };
    quad left = t, before[3][3], G[3][3], dG[3][3];
    for (int k = 0; k < 3; k++) {
        y[k] = start->x[k];
        y[3 + k] = start->u[k];
        y[6 + k] = start->w[k];
    }
    for (size_t n = 0; n <= stages && left > 0; n++) {
        const struct driven d = { n < stages ? &stage[n] : 0, open, tau, spin_tau };
        const quad end = n < stages && stage[n].duration < (double)left ? (quad)stage[n].duration : left;
        rates_at(d.stage, 0, G, dG);
        for (int k = 0; k < 9 && n > 0; k++)        /* a jump of the flow takes along whoever has images in it */
            y[3 + k / 3] += open[k % 3] ? 0 : (G[k / 3][k % 3] - before[k / 3][k % 3]) * y[k % 3];
        solve(driven_motion, &d, 9, y, end, 1e-20, scale, 0);
        rates_at(d.stage, end, before, dG);
        left -= end;
    }
}

struct path { const struct theory_stage *stage; };

static void way(quad s, const quad *y, quad *dydt, const void *with)
{
    const struct theory_rate *r = &((const struct path *)with)->stage->shear[0];
    (void)y;
    dydt[0] = fabsq(r->mean + r->slope * s + r->amplitude * sinq(r->frequency * s + r->phase));
}

static void see_sphere(const struct theory_sphere *now, const quad y[9], double scale, const char *where)
{
    audit_see_list(now->x, y, 3, scale, where);
    audit_see_list(now->u, y + 3, 3, scale, where);
    audit_see_list(now->w, y + 6, 3, scale, where);
}

static void audit_driven(void)
{
    static const struct theory_stage stage[] = {
        { 1.7, 1, { { 0, 1, 0.4, 0, 0, 0, 0 } } },
        { 2.3, 2, { { 0, 1, 0.1, -0.3, 0, 0, 0 }, { 2, 1, 0, 0, 0.5, 2.1, 0.7 } } },
        { 1.1, 1, { { 0, 1, -0.2, 0, 0.6, 5.0, 0.3 } } },
    };
    static const double at[] = { 0.9, 1.7, 3.1, 4.6, 7.0 };
    const struct theory_sphere start = { 1.3, { 1.1, 2.3, -0.7 }, { 0.2, -0.4, 0.9 }, { -0.5, 0.3, 0.8 } };
    audit_quantity("sphere in steady flow", "laboratory equation of motion (theory: matrix exponential)", 1e-12, "25 squarings of a rounded exponential", "theory_free_sphere");
    for (int plane = 0; plane < 6; plane++) {
        const int flow = plane % 3, gradient = (flow + 1 + plane / 3) % 3;
        const struct theory_stage shear = { 1e30, 1, { { flow, gradient, plane % 2 ? -0.4 : 0.7, 0, 0, 0, 0 } } };
        const bool open[3] = { false, false, false };
        double G[3][3] = { { 0.0 } };
        struct theory_sphere now;
        quad y[9];
        G[flow][gradient] = plane % 2 ? -0.4 : 0.7;
        theory_free_sphere((const double(*)[3])G, 0.35, 0.12, 2.9, &start, &now);
        driven_by_laboratory(&shear, 1, open, 0.35, 0.12, 2.9, &start, y);
        see_sphere(&now, y, 3.0, "");
    }
    audit_quantity("sphere in stages", "laboratory velocities, extrapolated midpoint rule", 1e-11, "the theory's own step control: 1e-13 per step", "theory_driven_sphere");
    for (int o = 0; o < 2; o++)
        for (int k = 0; k < 5; k++) {
            const bool open[3] = { false, o == 1, false };
            struct theory_sphere now;
            quad y[9];
            if (!theory_driven_sphere(stage, 3, open, 0.35, 0.12, at[k], &start, &now))
                audit_fault("theory_driven_sphere gave up");
            driven_by_laboratory(stage, 3, open, 0.35, 0.12, at[k], &start, y);
            see_sphere(&now, y, 3.0, o ? "open" : "periodic");
        }
    audit_quantity("flow in stages: rates", "the same sums in quadruple precision", 1e-14, "a few roundings", "theory_driven_flow");
    quad travelled[5] = { 0 };
    double said[5];
    for (int k = 0; k < 5; k++) {
        double G[3][3];
        quad left = at[k], Gq[3][3] = { { 0 } }, dG[3][3];
        theory_driven_flow(stage, 3, at[k], G, &said[k]);
        for (int n = 0; n < 3 && left >= 0; n++) {
            const double scale = 1.0;
            const struct path p = { &stage[n] };
            const quad end = left < stage[n].duration ? left : (quad)stage[n].duration;
            quad y[1] = { 0 };
            if (end > 0)
                solve(way, &p, 1, y, end, 1e-15, &scale, 0);
            travelled[k] += y[0];
            if (left < stage[n].duration)
                rates_at(&stage[n], left, Gq, dG);
            left -= stage[n].duration;
        }
        audit_see_list(&G[0][0], &Gq[0][0], 9, 1.0, "");
    }
    audit_quantity("flow in stages: way travelled", "differential equation of |rate|", 1e-6, "Simpson with 4096 pieces is off by the square of a piece where the rate changes sign",
                   "");
    for (int k = 0; k < 5; k++)
        audit_see(said[k], travelled[k], 1.0, "");
    audit_quantity("flow in stages: way without a turn", "primitive of the rate", 1e-12, "Simpson is exact to the fourth power of a piece where the rate is smooth", "");
    static const struct theory_stage forth = { 2.3, 1, { { 0, 1, 0.7, 0.1, 0.3, 2.1, 0.4 } } };
    const struct theory_rate *r = &forth.shear[0];
    for (int k = 1; k <= 3; k++) {
        const double t = 0.7 * k;
        double G[3][3], way_said;
        theory_driven_flow(&forth, 1, t, G, &way_said);
        audit_see(way_said, r->mean * (quad)t + r->slope * (quad)t * t / 2 + r->amplitude / (quad)r->frequency * (cosq(r->phase) - cosq((quad)r->frequency * t + r->phase)), 1.0, "");
    }
}

void audit_spheres(void)
{
    audit_langevin();
    audit_driven();
}
