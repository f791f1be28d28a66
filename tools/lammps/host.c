/*
 * LAMMPS with the gate's own resistances: a second code for what no stock style of LAMMPS computes rightly
 *
 *     lammps-host DECK PARAMETERS
 *
 * Runs the commands of DECK through LAMMPS's library and serves its `fix host all external pf/callback 1 1` with lubrication, one-body drag
 * and their noise. LAMMPS keeps contacts, integration, cell, images and lists. The scalars come from validation/theory (Jeffrey & Onishi
 * in their own variables), the rest is written here from components; nothing of solver/ takes part. One process, no MPI.
 *
 * PARAMETERS, one per line: viscosity; rate (dU_x/dy); dt; kT, seed, realisation, 1 for uniform numbers; drag torque lubrication drag_noise
 * lubrication_noise as 0 or 1; inner and outer gap; repulsion: 1 if by energy, strength (0: none), kappa over a_1 + a_2, cut-off over kappa;
 * every and first step of the stress; name of the pair style whose list is read. host.stress: step, nine sums of lubrication, nine of repulsion.
 *
 * Noise of a pair: with the covariance (2 kT/dt) C of (F_1.s, T_1.t, T_2.t), s across n and t = n x s,
 *
 *     C = | Y_A   -B_1   -B_2 |
 *         | -B_1  C_11   C_12 |      of rank 2: its Cholesky factor has two columns, and the second of them is (0, l, -l') as
 *         | -B_2  C_12   C_22 |      C_12 Y_A - B_1 B_2 < 0
 *
 * with signs that follow from F_1 = B_1 W_1 x n + ... and T_1 = B_1 dU x n - ... The random numbers are the function of seed, realisation, step and
 * tags of docs/formats.md, "Random numbers": two codes that draw the same numbers can be compared path by path.
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
    unsigned seed, realisation;
    int uniform, drag, torque, lubrication, drag_noise, lubrication_noise;
    struct theory_lubrication law;
    struct theory_repulsion repulsion;
    long every, first;
    char style[80];
    FILE *stress;
    int *owner;         /* where LAMMPS keeps the particle of a tag */
};

/* Six numbers of mean 0 and variance 1 for a particle (j = 0) or a pair, by what they are for. */
enum { ONE_BODY = 2, PAIR = 3 };
static void numbers(const struct host *h, int64_t step, int i, int j, uint64_t purpose, double z[6])
{
    const philox4x64_ctr_t at = { { (uint64_t)step, 0, (uint64_t)i, (uint64_t)j } };
    const philox4x64_key_t key = { { (uint64_t)h->seed << 32 | h->realisation, purpose } };
    const philox4x64_ctr_t w = philox4x64(at, key);
    for (int k = 0; k < 3; k++) {
        const double u = ((double)(w.v[k] & 0xffffffff) + 0.5) / 4294967296.0, v = ((double)(w.v[k] >> 32) + 0.5) / 4294967296.0;
        z[2 * k] = h->uniform ? sqrt(12.0) * (u - 0.5) : sqrt(-2 * log(u)) * cos(2 * PI * v);
        z[2 * k + 1] = h->uniform ? sqrt(12.0) * (v - 0.5) : sqrt(-2 * log(u)) * sin(2 * PI * v);
    }
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int k = 0; k < 3; k++)
        c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* Both directions across n, each as s and t = n x s. */
static void frame(const double n[3], double way[2][2][3])
{
    const double other[3] = { fabs(n[0]) < 0.6, fabs(n[0]) >= 0.6, 0 };
    cross(n, other, way[0][1]);
    const double length = sqrt(dot(way[0][1], way[0][1]));
    for (int k = 0; k < 3; k++)
        way[0][1][k] /= length;
    cross(way[0][1], n, way[0][0]);
    for (int k = 0; k < 3; k++) {
        way[1][0][k] = way[0][1][k];
        way[1][1][k] = -way[0][0][k];
    }
}

/* What a pair feels: force on 1 (minus that on 2), torques. */
struct load { double F[3], T1[3], T2[3]; };

static void add(double c, const double a[3], double sum[3])
{
    for (int k = 0; k < 3; k++)
        sum[k] += c * a[k];
}

/*
 * Drag of a pair by components along n and two directions s across it, t = n x s: with u = (U_2 - U_1).s and spins p, q about t,
 * F.s = Y_A u + ..., T.t = ... of F = B W x n, T = B dU x n - C W and t x n = s, s x n = -t.
 */
static void resist(const double S[THEORY_SCALARS], double n[3], double way[2][2][3], const double dU[3], const double w1[3], const double w2[3],
                   struct load *out)
{
    add(S[THEORY_XA] * dot(dU, n), n, out->F);
    for (int k = 0; k < 2; k++) {
        double *s = way[k][0], *t = way[k][1];
        const double u = dot(dU, s), p = dot(w1, t), q = dot(w2, t);
        add(S[THEORY_YA] * u + S[THEORY_B1] * p + S[THEORY_B2] * q, s, out->F);
        add(-S[THEORY_B1] * u - S[THEORY_C11] * p - S[THEORY_C12] * q, t, out->T1);
        add(-S[THEORY_B2] * u - S[THEORY_C12] * p - S[THEORY_C22] * q, t, out->T2);
    }
}

/* Its noise, from six numbers z and g = sqrt(2 kT/dt). */
static void fluctuate(const double S[THEORY_SCALARS], double n[3], double way[2][2][3], double g, const double z[6], struct load *out)
{
    const double f = sqrt(S[THEORY_YA]), m1 = -S[THEORY_B1] / f, m2 = -S[THEORY_B2] / f;                    /* first column of the factor */
    const double rest1 = sqrt(S[THEORY_C11] - m1 * m1), rest2 = (S[THEORY_C12] - m1 * m2) / rest1;          /* second column */
    add(g * sqrt(S[THEORY_XA]) * dot(z, n), n, out->F);
    for (int k = 0; k < 2; k++) {
        double *s = way[k][0], *t = way[k][1];
        const double x = dot(z, s), y = dot(z + 3, t);
        add(g * f * x, s, out->F);
        add(g * (m1 * x + rest1 * y), t, out->T1);
        add(g * (m2 * x + rest2 * y), t, out->T2);
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
            numbers(h, step - h->first, tag[i], 0, ONE_BODY, z);
        for (int k = 0; k < 3; k++) {
            f[i][k] += zeta * (flow[k] - v[i][k]) + sqrt(2 * h->kT * zeta / h->dt) * z[k];
            if (h->torque)
                torque[i][k] += turn * (spin[k] - w[i][k]) + sqrt(2 * h->kT * turn / h->dt) * z[3 + k];
        }
    }
}

static void repel(const struct host *h, double **x, const double *a, int one, int two, double **f, const int *owner, const int *tag, double stress[9])
{
    struct theory_sphere pair[2] = { { .radius = a[one] }, { .radius = a[two] } };
    struct theory_pair out;
    for (int k = 0; k < 3; k++) {
        pair[0].x[k] = x[one][k];
        pair[1].x[k] = x[two][k];
    }
    theory_repulsion_pair(&h->repulsion, pair, &out);
    add(1, out.force[0], f[owner[tag[one]]]);
    add(1, out.force[1], f[owner[tag[two]]]);
    for (int k = 0; k < 9; k++)
        stress[k] += out.stress[k / 3][k % 3];
}

/*
 * With `newton off` a pair across a face is listed at both of its ends, each time with a ghost of the other. One process owns all particles, so
 * the end with the smaller tag acts on both: on the ghost's owner, whose force is the same.
 */
static void pairs(const struct host *h, int64_t step, int local, const int *owner, double **x, double **f, double stress[18])
{
    double **v = vectors(h, "v"), **w = vectors(h, "omega"), **torque = vectors(h, "torque"), *a = lammps_extract_atom(h->lammps, "radius");
    const int *tag = lammps_extract_atom(h->lammps, "id");
    const int list = lammps_find_pair_neighlist(h->lammps, h->style, 1, 0, 0), size = lammps_neighlist_num_elements(h->lammps, list);
    /* Farther pairs, most of the list, are passed over; a little more than what the laws themselves decide exactly. */
    const double reach = fmax(h->law.outer_gap / 2, h->repulsion.strength > 0 ? h->repulsion.cutoff * h->repulsion.kappa_factor : 0) + 1e-9;
    for (int element = 0; element < size; element++) {
        int i, many, *near;
        lammps_neighlist_element_neighbors(h->lammps, list, element, &i, &many, &near);
        for (int m = 0; m < many; m++) {
            const int j = near[m] & 0x3FFFFFFF, one = tag[i] < tag[j] ? i : j, two = one == i ? j : i;
            if (j >= local && one != i)
                continue;
            double n[3], dU[3], S[THEORY_SCALARS], way[2][2][3];
            struct load load = { .F = { 0 } };
            for (int k = 0; k < 3; k++) {
                n[k] = x[two][k] - x[one][k];
                dU[k] = v[two][k] - v[one][k];
            }
            const double sizes = a[one] + a[two], far = sizes * (1 + reach);
            if (dot(n, n) > far * far)
                continue;
            const double r = sqrt(dot(n, n));
            if (h->repulsion.strength > 0)
                repel(h, x, a, one, two, f, owner, tag, stress + 9);
            if (!h->lubrication || 2 * (r - sizes) / sizes > h->law.outer_gap)
                continue;
            for (int k = 0; k < 3; k++)
                n[k] /= r;
            theory_scalars(&h->law, a[one], a[two], r, S);
            frame(n, way);
            resist(S, n, way, dU, w[one], w[two], &load);
            for (int k = 0; k < 9; k++)     /* of the drag alone: noise has a stress of mean zero */
                stress[k] += load.F[k / 3] * r * n[k % 3];
            if (h->lubrication_noise) {
                double z[6];
                numbers(h, step - h->first, tag[one], tag[two], PAIR, z);
                fluctuate(S, n, way, sqrt(2 * h->kT / h->dt), z, &load);
            }
            const int at_one = owner[tag[one]], at_two = owner[tag[two]];
            add(1, load.F, f[at_one]);
            add(1, load.T1, torque[at_one]);
            add(-1, load.F, f[at_two]);
            add(1, load.T2, torque[at_two]);
        }
    }
}

static void callback(void *self, int64_t step, int local, int *tag, double **x, double **f)
{
    struct host *h = self;
    double stress[18] = { 0 };
    if (!h->owner)
        h->owner = malloc((size_t)(local + 1) * sizeof *h->owner);      /* tags are 1 to `local`: one process owns them all */
    for (int i = 0; i < local; i++)
        h->owner[tag[i]] = i;
    for (int i = 0; i < local; i++)
        f[i][0] = f[i][1] = f[i][2] = 0;
    if (h->drag)
        one_body(h, step, local, tag, x, f);
    if (h->lubrication || h->repulsion.strength > 0)
        pairs(h, step, local, h->owner, x, f, stress);
    if (h->stress && h->every > 0 && step >= h->first && step % h->every == 0) {
        fprintf(h->stress, "%ld", (long)step);
        for (int k = 0; k < 18; k++)
            fprintf(h->stress, " %.17g", stress[k]);
        fprintf(h->stress, "\n");
    }
}

static int read_parameters(struct host *h, const char *path)
{
    FILE *f = fopen(path, "r");
    int by_energy = 0;
    const int read = f ? fscanf(f, "%lf %lf %lf %lf %u %u %d %d %d %d %d %d %lf %lf %d %lf %lf %lf %ld %ld %79s", &h->viscosity, &h->rate, &h->dt, &h->kT, &h->seed,
                                &h->realisation, &h->uniform, &h->drag, &h->torque, &h->lubrication, &h->drag_noise, &h->lubrication_noise, &h->law.inner_gap, &h->law.outer_gap,
                                &by_energy, &h->repulsion.strength, &h->repulsion.kappa_factor, &h->repulsion.cutoff,
                                &h->every, &h->first, h->style) : 0;
    if (f)
        fclose(f);
    h->law.viscosity = h->viscosity;
    h->repulsion.by_energy = by_energy;
    return read == 21;
}

int main(int argc, char **argv)
{
    struct host h = { .lammps = NULL };
    char line[2000];
    if (argc != 3 || !read_parameters(&h, argv[2])) {
        fprintf(stderr, argc == 3 ? "lammps-host: %s does not hold the twenty-one parameters\n" : "usage: lammps-host DECK PARAMETERS\n", argv[argc - 1]);
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
    free(h.owner);
    if (h.lammps)
        lammps_close(h.lammps);
    return fclose(h.stress) == 0 && h.lammps ? 0 : 1;
}
