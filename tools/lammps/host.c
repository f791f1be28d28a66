/*
 * LAMMPS with the gate's own resistances: a second code for what no stock style of LAMMPS computes rightly
 *
 *     lammps-host DECK PARAMETERS
 *
 * Runs the commands of DECK through LAMMPS's library and serves its `fix host all external pf/callback 1 1` with lubrication, one-body drag
 * and their noise. LAMMPS keeps contacts, integration, cell, images and lists. The scalars come from validation/theory (Jeffrey & Onishi
 * in their own variables), the rest is written here from components; nothing of solver/ takes part. One process, no MPI.
 *
 * PARAMETERS, one per line: viscosity; rate (dU_x/dy); dt; kT and seed; drag torque lubrication drag_noise lubrication_noise as 0 or 1;
 * inner and outer gap; every and first step of the stress; name of the pair style whose list is read.
 *
 * Noise of a pair, squeeze and two tangential directions s (n x s = t):  with the covariance (2 kT/dt) C of (T_1.t, T_2.t, F_1.s),
 *
 *     C = | C_11  C_12  B_1 |
 *         | C_12  C_22  B_2 |        of rank 2: its Cholesky factor has two columns,
 *         | B_1   B_2   Y_A |        L = (sqrt C_11, 0), (C_12/l_11, sqrt(C_22 - l_21^2)), (B_1/l_11, (B_2 - l_21 l_31)/l_22)
 *
 * signs as they follow from F_1 = B_1 W_1 x n + ... and T_1 = B_1 dU x n - ... Random numbers: Philox by tags and step, Gaussian.
 */
#include "theory.h"

#include <Random123/philox.h>
#include <lammps/library.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

struct host {
    void *lammps;
    double viscosity, rate, dt, kT;
    unsigned seed;
    int drag, torque, lubrication, drag_noise, lubrication_noise;
    struct theory_lubrication law;
    long every, first;
    char style[80];
    FILE *stress;
};

/* Six Gaussian numbers for particles or pairs, by what they are for. */
static void gaussians(const struct host *h, int64_t step, int i, int j, uint32_t stream, double z[6])
{
    const philox4x64_ctr_t at = { { (uint64_t)step, (uint64_t)i, (uint64_t)j, stream } };
    const philox4x64_key_t key = { { h->seed, 0x6c6d70u } };
    const philox4x64_ctr_t w = philox4x64(at, key);
    for (int k = 0; k < 3; k++) {
        const double u = ((double)(w.v[k] >> 32) + 0.5) * 0x1p-32, v = ((double)(uint32_t)w.v[k] + 0.5) * 0x1p-32;
        z[2 * k] = sqrt(-2 * log(u)) * cos(2 * PI * v);
        z[2 * k + 1] = sqrt(-2 * log(u)) * sin(2 * PI * v);
    }
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Unit vectors s, t with s x t = n. */
static void frame(const double n[3], double s[3], double t[3])
{
    const double other[3] = { fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0 };
    cross(n, other, t);
    const double length = sqrt(dot(t, t));
    for (int k = 0; k < 3; k++)
        t[k] /= length;
    cross(t, n, s);
}

/*
 * Force on 1 and torques on 1 and 2 by components along n and two tangential directions. In direction s (with n x s = t): with
 * u = (U_2 - U_1).s and spins w about t,   F.s = Y_A u + ..., T.t = ... of F = B W x n, T = B dU x n - C W and t x n = s, s x n = -t.
 */
static void act(const struct host *h, const double S[THEORY_SCALARS], const double n[3], const double dU[3], const double w1[3], const double w2[3],
                const double *z, double F[3], double T1[3], double T2[3])
{
    const double g = z ? sqrt(2 * h->kT / h->dt) : 0;
    double side[3], turn[3];
    frame(n, side, turn);
    const double squeeze = S[THEORY_XA] * dot(dU, n) + (z ? g * sqrt(S[THEORY_XA]) * z[0] : 0);
    for (int k = 0; k < 3; k++) {
        F[k] = squeeze * n[k];
        T1[k] = T2[k] = 0;
    }
    double a = 0, b = 0, c = 0, d = 0, e = 0;
    if (z) {
        a = sqrt(S[THEORY_C11]), b = S[THEORY_C12] / a, c = S[THEORY_B1] / a;
        d = sqrt(S[THEORY_C22] - b * b), e = (S[THEORY_B2] - b * c) / d;
    }
    for (int way = 0; way < 2; way++) {     /* s = side, t = turn; then s = turn, t = -side: both have n x s = t */
        double s[3], t[3];
        for (int k = 0; k < 3; k++) {
            s[k] = way ? turn[k] : side[k];
            t[k] = way ? -side[k] : turn[k];
        }
        const double u = dot(dU, s), p = dot(w1, t), q = dot(w2, t);
        double f = S[THEORY_YA] * u + S[THEORY_B1] * p + S[THEORY_B2] * q;
        double m1 = -S[THEORY_B1] * u - S[THEORY_C11] * p - S[THEORY_C12] * q;
        double m2 = -S[THEORY_B2] * u - S[THEORY_C12] * p - S[THEORY_C22] * q;
        if (z) {    /* <f f> = Y_A, <m m> = C, <f m> = -B: as force on 1 and torque respond to velocities U_1 = -dU and W */
            const double x = z[1 + 2 * way], y = z[2 + 2 * way];
            m1 += g * a * x;
            m2 += g * (b * x + d * y);
            f -= g * (c * x + e * y);
        }
        for (int k = 0; k < 3; k++) {
            F[k] += f * s[k];
            T1[k] += m1 * t[k];
            T2[k] += m2 * t[k];
        }
    }
}

static double **vectors(const struct host *h, const char *name) { return lammps_extract_atom(h->lammps, name); }

static void one_body(const struct host *h, int64_t step, int count, const int *tag, double **x, double **f)
{
    double **v = vectors(h, "v"), **w = vectors(h, "omega"), **torque = vectors(h, "torque"), *a = lammps_extract_atom(h->lammps, "radius");
    for (int i = 0; i < count; i++) {
        const double zeta = 6 * PI * h->viscosity * a[i], turn = 8 * PI * h->viscosity * a[i] * a[i] * a[i];
        const double flow[3] = { h->rate * x[i][1], 0, 0 }, spin[3] = { 0, 0, -h->rate / 2 };
        double z[6] = { 0 };
        if (h->drag_noise)
            gaussians(h, step, tag[i], 0, 1, z);
        for (int k = 0; k < 3; k++) {
            f[i][k] += zeta * (flow[k] - v[i][k]) + sqrt(2 * h->kT * zeta / h->dt) * z[k];
            if (h->torque)
                torque[i][k] += turn * (spin[k] - w[i][k]) + sqrt(2 * h->kT * turn / h->dt) * z[3 + k];
        }
    }
}

static void pairs(const struct host *h, int64_t step, int local, double **x, double **f, double stress[9])
{
    double **v = vectors(h, "v"), **w = vectors(h, "omega"), **torque = vectors(h, "torque"), *a = lammps_extract_atom(h->lammps, "radius");
    const int *tag = lammps_extract_atom(h->lammps, "id");
    const int list = lammps_find_pair_neighlist(h->lammps, h->style, 1, 0, 0), size = lammps_neighlist_num_elements(h->lammps, list);
    for (int element = 0; element < size; element++) {
        int i, many, *near;
        lammps_neighlist_element_neighbors(h->lammps, list, element, &i, &many, &near);
        for (int m = 0; m < many; m++) {
            const int j = near[m] & 0x3FFFFFFF, one = tag[i] < tag[j] ? i : j, two = one == i ? j : i;
            double n[3], dU[3], S[THEORY_SCALARS], z[6], F[3], T1[3], T2[3];
            for (int k = 0; k < 3; k++) {
                n[k] = x[two][k] - x[one][k];
                dU[k] = v[two][k] - v[one][k];
            }
            const double r = sqrt(dot(n, n));
            if (2 * (r - a[one] - a[two]) / (a[one] + a[two]) > h->law.outer_gap)
                continue;
            for (int k = 0; k < 3; k++)
                n[k] /= r;
            theory_scalars(&h->law, a[one], a[two], r, S);
            if (h->lubrication_noise)
                gaussians(h, step, tag[one], tag[two], 2, z);
            act(h, S, n, dU, w[one], w[two], h->lubrication_noise ? z : NULL, F, T1, T2);
            for (int k = 0; k < 3; k++) {   /* `newton off`: a ghost's own side comes from its owner's list */
                if (one < local) { f[one][k] += F[k]; torque[one][k] += T1[k]; }
                if (two < local) { f[two][k] -= F[k]; torque[two][k] += T2[k]; }
                for (int q = 0; q < 3; q++)
                    stress[3 * k + q] += (j < local ? 1.0 : 0.5) * F[k] * r * n[q];
            }
        }
    }
}

static void callback(void *self, int64_t step, int local, int *tag, double **x, double **f)
{
    struct host *h = self;
    double stress[9] = { 0 };
    for (int i = 0; i < local; i++)
        f[i][0] = f[i][1] = f[i][2] = 0;
    if (h->drag)
        one_body(h, step, local, tag, x, f);
    if (h->lubrication)
        pairs(h, step, local, x, f, stress);
    if (h->stress && h->every > 0 && step >= h->first && step % h->every == 0) {
        fprintf(h->stress, "%ld", (long)step);
        for (int k = 0; k < 9; k++)
            fprintf(h->stress, " %.17g", stress[k]);
        fprintf(h->stress, "\n");
    }
}

static int read_parameters(struct host *h, const char *path)
{
    FILE *f = fopen(path, "r");
    const int read = f ? fscanf(f, "%lf %lf %lf %lf %u %d %d %d %d %d %lf %lf %ld %ld %79s", &h->viscosity, &h->rate, &h->dt, &h->kT, &h->seed, &h->drag,
                                &h->torque, &h->lubrication, &h->drag_noise, &h->lubrication_noise, &h->law.inner_gap, &h->law.outer_gap,
                                &h->every, &h->first, h->style) : 0;
    if (f)
        fclose(f);
    h->law.viscosity = h->viscosity;
    return read == 15;
}

int main(int argc, char **argv)
{
    struct host h = { .lammps = NULL };
    char line[2000];
    if (argc != 3 || !read_parameters(&h, argv[2])) {
        fprintf(stderr, argc == 3 ? "lammps-host: %s does not hold the fifteen parameters\n" : "usage: lammps-host DECK PARAMETERS\n", argv[argc - 1]);
        return 2;
    }
    FILE *deck = fopen(argv[1], "r");
    h.stress = fopen("host.stress", "w");
    if (!deck || !h.stress) {
        fprintf(stderr, "lammps-host: %s cannot be read, or host.stress not written\n", argv[1]);
        return 1;
    }
    char *words[] = { "lammps-host", "-log", "lammps.log", "-screen", "none", "-nocite" };
    h.lammps = lammps_open_no_mpi(6, words, NULL);
    while (h.lammps && fgets(line, sizeof line, deck)) {
        lammps_command(h.lammps, line);
        if (strncmp(line, "fix host ", 9) == 0)
            lammps_set_fix_external_callback(h.lammps, "host", callback, &h);
    }
    fclose(deck);
    if (h.lammps)
        lammps_close(h.lammps);
    return fclose(h.stress) == 0 && h.lammps ? 0 : 1;
}
