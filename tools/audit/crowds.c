/*
 * Averages over many spheres
 *
 *     phi^2 coefficient   the twelve vertices of an icosahedron integrate any polynomial of degree 5 over directions exactly; shells by double exponential
 *                         quadrature, straight in the gap; stress as the work of a virtual pure strain against the modes of pair.c
 *     crowd               every image of every ordered pair in a cube of 7^3 cells counts half, nothing is searched; stress likewise
 *     structural stress   a function of all distances, sum of c ln r, differentiated by a virtual strain
 *     Carnahan-Starling   its own virial series 1 + sum (k^2 + k - 2) phi^(k - 1), summed
 *     mixture             virial theorem with contact values: 1 + (2 pi/3) n sum x_i x_j s_ij^3 g_ij, g_ij of Boublik (1970) and Grundke & Henderson (1972)
 *     thermal diameter    int (1 - exp(-U/kT)) dr, Barker & Henderson (1967)
 */
#include "audit.h"

#include <math.h>
#include <string.h>

/* Velocities of a homogeneous flow G x at both spheres, with its vorticity as spin or not. */
static void flow_motion(quad G[3][3], const struct quad_pair *p, bool spins, quad v[12])
{
    for (int a = 0; a < 2; a++)
        for (int k = 0; k < 3; k++) {
            const int l = (k + 1) % 3, m = (k + 2) % 3;
            v[3 * a + k] = dotq(G[k], p->x[a]);
            v[6 + 3 * a + k] = spins ? (G[m][l] - G[l][m]) / 2 : 0;
        }
}

/* Sum over modes of c (d.v)(d.w): minus the work of the loads of motion v in the virtual motion w. */
static quad work_between(const struct modes *m, const quad v[12], const quad w[12])
{
    quad sum = 0;
    for (int q = 0; q < m->count; q++) {
        quad one = 0, two = 0;
        for (int k = 0; k < 12; k++) {
            one += m->motion[q][k] * v[k];
            two += m->motion[q][k] * w[k];
        }
        sum += m->size[q] * one * two;
    }
    return sum;
}

/* --- random spheres at second order --- */

struct random_pairs { struct theory_lubrication law; };

static quad shell(quad xi, const void *with)
{
    const struct random_pairs *c = with;
    const quad golden = (1 + sqrtq(5)) / 2, length = sqrtq(1 + golden * golden), r = 2 + xi;
    quad shear[3][3] = { { 0, 1, 0 }, { 0 }, { 0 } }, strain[3][3] = { { 0, (quad)1 / 2, 0 }, { (quad)1 / 2, 0, 0 }, { 0 } };
    quad sum = 0;
    for (int v = 0; v < 12; v++) {
        struct quad_pair p = { { 1, 1 }, { { 0 } }, { { 0 } }, { { 0 } } };
        quad motion[12], virtual_strain[12];
        p.x[1][v % 3] = r * (v & 1 ? 1 : -1) / length;                              /* (+-1, +-g, 0) and its cyclic shifts */
        p.x[1][(v + 1) % 3] = r * (v / 6 ? 1 : -1) * golden / length;
        flow_motion(shear, &p, true, motion);
        flow_motion(strain, &p, false, virtual_strain);
        const struct modes m = lubrication_modes(&c->law, &p);
        sum += work_between(&m, motion, virtual_strain);
    }
    return 4 * PIQ / 12 * sum * r * r;
}

static void audit_random_pairs(void)
{
    static const double cut[][2] = { { 1e-3, 0.05 }, { 2e-3, 0.1 } };
    audit_quantity("phi^2 coefficient of random spheres", "icosahedron and double exponential quadrature", 1e-12, "the theory's quadrature asks for 1e-13", "theory_phi2_coefficient");
    for (int k = 0; k < 2; k++) {
        const struct random_pairs c = { { 1.0, cut[k][0], cut[k][1] * (1.0 + 1e-12), false } };
        const quad density = 1 / (4 * PIQ / 3), inner = cut[k][0], outer = cut[k][1];
        const quad sum = integral(shell, &c, 0, inner) + integral(shell, &c, inner, outer);
        audit_see(theory_phi2_coefficient(cut[k][0], cut[k][1], 0), density * density / 2 * sum, (double)(density * density / 2 * sum), "");
    }
}

/* --- a crowd in a strained cell --- */

static void audit_crowd(void)
{
    enum { SPHERES = 9, IMAGES = 3 };
    static const double cell[3][3] = { { 5.1, 0.0, 0.0 }, { 1.7, 4.6, 0.0 }, { 0.4, -0.9, 4.9 } }, G[3][3] = { { 0.0, -0.4, 0.0 }, { 0.0 }, { 0.0, 0.23, 0.0 } };
    const struct theory_lubrication law = { 0.7, 1e-3, 0.3, false };
    struct theory_sphere s[SPHERES];
    double stress[3][3];
    quad sum[3][3] = { { 0 } }, Gq[3][3];
    unsigned state = 7;
    for (int i = 0; i < SPHERES; i++) {
        s[i].radius = i % 3 ? 0.8 : 1.1;
        for (int k = 0; k < 9; k++) {
            state = state * 1664525u + 1013904223u;
            const double x = (double)(state >> 8) / 16777216.0;
            *(k < 3 ? &s[i].x[k] : k < 6 ? &s[i].u[k - 3] : &s[i].w[k - 6]) = k < 3 ? 5.0 * x : x - 0.5;
        }
    }
    for (int k = 0; k < 9; k++)
        Gq[k / 3][k % 3] = G[k / 3][k % 3];
    theory_crowd_stress(&law, SPHERES, s, cell, G, stress);
    int pairs = 0;
    for (int i = 0; i < SPHERES; i++)
        for (int j = 0; j < SPHERES; j++)
            for (int image = 0; image < 343; image++) {
                const struct theory_sphere both[2] = { s[i], s[j] };
                struct quad_pair p = quad_pair_of(both);
                quad shift[3] = { 0 }, v[12], r[3];
                const int at[3] = { image % 7 - 3, image / 7 % 7 - 3, image / 49 - 3 };
                for (int f = 0; f < 3; f++)
                    for (int k = 0; k < 3; k++)
                        shift[k] += at[f] * (quad)cell[f][k];
                for (int k = 0; k < 3; k++) {
                    p.x[1][k] += shift[k];
                    p.u[1][k] += dotq(Gq[k], shift);
                    r[k] = p.x[1][k] - p.x[0][k];
                }
                if (i == j && image == 171)
                    continue;
                if (dotq(r, r) > 9)
                    continue;
                const struct modes m = lubrication_modes(&law, &p);
                pairs += m.count > 0;
                for (int k = 0; k < 12; k++)
                    v[k] = k < 6 ? p.u[k / 3][k % 3] : p.w[k / 3 - 2][k % 3];
                for (int k = 0; k < 9 && m.count; k++) {
                    quad virtual_flow[3][3] = { { 0 } }, w[12];
                    virtual_flow[k / 3][k % 3] = 1;
                    flow_motion(virtual_flow, &p, false, w);
                    sum[k / 3][k % 3] += work_between(&m, v, w) / 2;
                }
            }
    double size = 0.0;
    for (int k = 0; k < 9; k++)
        size = fmax(size, fabs(stress[k / 3][k % 3]));
    audit_quantity("lubrication stress of a crowd", "all images within three cells, virtual strains", 1e-12, "gaps of 1e-3 of 17-digit numbers", "theory_crowd_stress");
    audit_see_list(&stress[0][0], &sum[0][0], 9, size, "");
    if (pairs < 20)
        audit_fault("the crowd has %d pairs only", pairs);
}

/* --- structural stress --- */

static quad strained(int count, const double (*x)[3], const double *radius, double edge, quad kT, quad fraction, quad depth, int row, int column, quad strain)
{
    quad sum = 0;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) {
            quad r[3], near;
            for (int k = 0; k < 3; k++) {
                r[k] = (quad)x[j][k] - x[i][k];
                r[k] -= edge * rintq(r[k] / edge);
            }
            near = sqrtq(dotq(r, r)) - radius[i] - radius[j] - fraction * radius[i];
            if (i == j || near >= 0)
                continue;
            r[row] += strain * r[column];
            sum += kT * radius[i] / (fraction * radius[i] + depth) * logq(dotq(r, r)) / 2;
        }
    return -sum / ((quad)edge * edge * edge);
}

static void audit_structural(void)
{
    enum { SPHERES = 40 };
    static const int component[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 0, 2 }, { 1, 2 } };
    double x[SPHERES][3], radius[SPHERES], stress[6], size = 0.0;
    unsigned state = 11;
    for (int i = 0; i < SPHERES; i++) {
        radius[i] = i % 2 ? 1.3 : 1.82;
        for (int k = 0; k < 3; k++) {
            state = state * 1664525u + 1013904223u;
            x[i][k] = 11.0 * (double)(state >> 8) / 16777216.0;
        }
    }
    audit_quantity("structural Brownian stress", "virtual strain of a sum of logarithms", 1e-13, "a few hundred roundings", "theory_structural_stress");
    theory_structural_stress(SPHERES, (const double(*)[3])x, radius, 11.0, 0.31, 0.05, 0.013, stress);
    for (int k = 0; k < 6; k++)
        size = fmax(size, fabs(stress[k]));
    for (int k = 0; k < 6; k++) {
        const quad step = (quad)1e-12;
        const quad slope = strained(SPHERES, (const double(*)[3])x, radius, 11.0, 0.31, 0.05, 0.013, component[k][0], component[k][1], step)
                           - strained(SPHERES, (const double(*)[3])x, radius, 11.0, 0.31, 0.05, 0.013, component[k][0], component[k][1], -step);
        audit_see(stress[k], slope / (2 * step), size, "");
    }
}

/* --- hard spheres --- */

struct soft { quad radius, stiffness, kT; };

static quad closed_off(quad r, const void *with)
{
    const struct soft *s = with;
    const quad delta = 2 * s->radius - r;
    return -expm1q(-s->stiffness * delta * delta / (2 * s->kT));
}

static void audit_hard_spheres(void)
{
    static const double phi[] = { 0.01, 0.1, 0.3, 0.4, 0.49 };
    audit_quantity("Carnahan-Starling pressure", "its virial series, summed", 1e-14, "a few roundings", "theory_carnahan_starling");
    for (int k = 0; k < 5; k++) {
        quad sum = 1, power = 1;
        for (int n = 2; n < 400; n++) {
            power *= phi[k];
            sum += (n * n + n - 2) * power;
        }
        audit_see(theory_carnahan_starling(phi[k]), sum, (double)sum, "");
    }
    audit_quantity("pressure of a mixture", "virial theorem with contact values", 1e-13, "a few roundings", "theory_mixture_pressure");
    for (int k = 1; k < 5; k++) {
        const double density[3] = { 0.05 * phi[k], 0.02 * phi[k], 0.004 * phi[k] }, diameter[3] = { 1.9, 2.66, 5.1 };
        quad n = 0, volume = 0, second = 0, pairs = 0;
        for (int i = 0; i < 3; i++) {
            const quad s = diameter[i];
            n += density[i];
            second += PIQ / 6 * density[i] * s * s;
            volume += PIQ / 6 * density[i] * s * s * s;
        }
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const quad si = diameter[i], sj = diameter[j], d = si * sj / (si + sj), free = 1 - volume, apart = (si + sj) / 2;
                const quad contact = 1 / free + 3 * second * d / (free * free) + 2 * second * second * d * d / (free * free * free);
                pairs += (quad)density[i] * density[j] * apart * apart * apart * contact;
            }
        audit_see(theory_mixture_pressure(3, density, diameter), 1 + 2 * PIQ / 3 * pairs / n, (double)(1 + 2 * PIQ / 3 * pairs / n), "");
    }
    audit_quantity("thermal diameter of soft spheres", "Barker & Henderson's integral", 1e-13, "exp(-2 k_n a^2/kT) is left out by the theory", "theory_thermal_diameter");
    for (int k = 0; k < 3; k++) {
        const struct soft s = { (quad)1.3, k == 0 ? 310 : 28500, k == 2 ? (quad)0.017 : (quad)0.31 };
        /* from well inside, where the integrand is 1 to 1e-30, in three pieces */
        const quad width = sqrtq(s.kT / s.stiffness), edge = 2 * s.radius - 14 * width;
        const quad sigma = edge + integral(closed_off, &s, edge, 2 * s.radius - 3 * width) + integral(closed_off, &s, 2 * s.radius - 3 * width, 2 * s.radius);
        audit_see(theory_thermal_diameter((double)s.radius, (double)s.stiffness, (double)s.kT), sigma, (double)sigma, "");
    }
}

/* --- energies --- */

struct law_at { const struct theory_repulsion *law; quad a1, a2; };

static quad push(quad h, const void *with)
{
    const struct law_at *d = with;
    const struct theory_sphere s[2] = { { .radius = (double)d->a1 }, { .radius = (double)d->a2 } };
    struct quad_pair p = quad_pair_of(s);
    struct quad_answer q;
    p.x[1][0] = d->a1 + d->a2 + h;
    repulsion_answer(d->law, &p, &q);
    return -q.force[0][0];
}

static void audit_energy(void)
{
    audit_quantity("energy of repulsion", "force integrated from far away", 1e-12, "what the cut-off at 80 ranges leaves is 1e-35", "theory_repulsion_energy");
    for (int energy = 0; energy < 2; energy++)
        for (int k = 0; k < 4; k++) {
            const struct theory_repulsion law = { energy, energy ? 0.53 : 2.3, 0.013, 1e9 };
            const struct law_at d = { &law, (quad)1.3, k % 2 ? (quad)1.82 : (quad)0.26 };
            const quad range = (quad)law.kappa_factor * ((quad)1.3 + (k % 2 ? (quad)1.82 : (quad)0.26)), h = (k - 1) * range;
            quad sum = 0;
            for (int piece = 0; piece < 16; piece++)
                sum += integral(push, &d, h + 5 * piece * range, h + 5 * (piece + 1) * range);
            audit_see(theory_repulsion_energy(&law, (double)d.a1, (double)d.a2, (double)h), sum, (double)sum, "");
        }
}

void audit_crowds(void)
{
    audit_random_pairs();
    audit_crowd();
    audit_structural();
    audit_hard_spheres();
    audit_energy();
}
