/*
 * Where particles are in shear: pair distribution, its anisotropy, and the Brownian stress that it implies.
 *
 *     g(r) = (pairs in a shell) / (N (N - 1)/(2 V) times the shell's volume)
 *     Sigma^B = - (kT/V) sum_i (a_i/D_i) sum_j n n  over j with gap h < shell a_i,   D_i = shell a_i + sqrt(pi kT/(2 k_n))
 *
 * Li (2026) eq. 3.54 with shell 0.05, overlapping pairs included, and with the thermal depth of a soft contact added to the
 * shell's thickness, without which the estimate is 3 % high at kT = 0.017 and k_n = 1e4. The shell averages g over its thickness;
 * a second, thinner one allows for a straight line to none. Only the shear part is formed here.
 */
#include "published_shear.h"

#include <gsl/gsl_math.h>
#include <math.h>

static const double shell_of[2] = { 0.05, 0.02 };
static const double near_of[2] = { 0.05, 0.005 };    /* xi of pairs that count as near, and as touching */

struct count {
    double compressive[2], extensional[2], harmonic[2], shear[2], overlap, snapshots, r[STRUCTURE_BINS], ring[STRUCTURE_ANGLES];
};

struct crowd { const struct dense_start *start; double radius[8], unit, depth; };   /* unit: radius of the first species */

static void see_pair(struct count *c, const struct crowd *crowd, double a, double b, const double d[3])
{
    const double r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), gap = r - a - b;
    const double nn = d[0] * d[1] / (r * r) * (crowd->start->rate < 0 ? -1 : 1);
    const int bin = (int)(r / crowd->unit / STRUCTURE_RANGE * STRUCTURE_BINS);
    if (bin < STRUCTURE_BINS)
        c->r[bin] += 1;
    c->overlap = fmax(c->overlap, -gap / (a + b));
    for (int k = 0; k < 2; k++)
        c->shear[k] -= nn * ((gap < shell_of[k] * a ? a / (shell_of[k] * a + crowd->depth) : 0)
                             + (gap < shell_of[k] * b ? b / (shell_of[k] * b + crowd->depth) : 0));
    for (int k = 0; k < 2; k++)
        if (2 * gap < near_of[k] * (a + b))
            (nn < 0 ? c->compressive : c->extensional)[k] += 1;
    if (2 * gap < near_of[0] * (a + b) && fabs(d[2]) < 0.25 * (a + b)) {     /* within 14.5 degrees of the plane */
        c->harmonic[0] += (d[0] * d[0] - d[1] * d[1]) / (d[0] * d[0] + d[1] * d[1]);
        c->harmonic[1] += 2 * d[0] * d[1] / (d[0] * d[0] + d[1] * d[1]);
        for (int end = 0; end < 2; end++) {
            const double angle = atan2(end ? -d[1] : d[1], end ? -d[0] : d[0]) / (2 * M_PI);
            c->ring[(int)((angle - floor(angle)) * STRUCTURE_ANGLES) % STRUCTURE_ANGLES] += 1;
        }
    }
}

struct seeing { struct count *count; const struct crowd *crowd; };

static void see_snapshot(void *to, const struct dense_start *s, const struct dense_snapshot *now)
{
    const struct seeing *seeing = to;
    const double *radius = seeing->crowd->radius;
    for (size_t i = 0; i < s->count; i++)
        for (size_t j = i + 1; j < s->count; j++) {
            double d[3];
            dense_pair(s, now, i, j, d);
            see_pair(seeing->count, seeing->crowd, radius[s->row[i].species - 1], radius[s->row[j].species - 1], d);
        }
    seeing->count->snapshots += 1;
}

/* Centre of the fullest bin, by g, within 0.1 of r: farther, the flank of another peak may be higher. */
static double peak_near(const double *g, double r)
{
    int best = -1;
    for (int k = 0; k < STRUCTURE_BINS; k++) {
        const double centre = (k + 0.5) * STRUCTURE_RANGE / STRUCTURE_BINS;
        if (fabs(centre - r) < 0.1 && (best < 0 || g[k] > g[best]))
            best = k;
    }
    return (best + 0.5) * STRUCTURE_RANGE / STRUCTURE_BINS;
}

static void conclude(const struct count *c, const struct crowd *crowd, double kT, double value[POINT_QUANTITIES], struct structure *sum)
{
    const struct dense_start *s = crowd->start;
    const double volume = gsl_pow_3(s->edge), n = (double)s->count, width = STRUCTURE_RANGE / STRUCTURE_BINS * crowd->unit;
    const double per_volume = n * (n - 1) / 2 / volume;
    double g[STRUCTURE_BINS];
    for (int k = 0; k < STRUCTURE_BINS; k++) {
        g[k] = c->r[k] / c->snapshots / (per_volume * 4 * M_PI / 3 * (gsl_pow_3((k + 1) * width) - gsl_pow_3(k * width)));
        sum->g[k] += g[k] * c->snapshots;
    }
    double in_ring = 0;
    for (int k = 0; k < STRUCTURE_ANGLES; k++)
        in_ring += c->ring[k];
    for (int k = 0; k < STRUCTURE_ANGLES; k++)  /* share of the ring, 1 where all directions are alike */
        sum->ring[k] += in_ring > 0 ? c->ring[k] / in_ring * STRUCTURE_ANGLES * c->snapshots : 0;
    sum->snapshots += c->snapshots;
    const double stress_unit = kT / volume / (s->viscosity * fabs(s->rate)) / c->snapshots;
    for (int k = 0; k < 2; k++) {
        const double near = c->compressive[k] + c->extensional[k];
        value[k ? ANISOTROPY_CONTACT : ANISOTROPY] = near > 0 ? (c->compressive[k] - c->extensional[k]) / near : NAN;
    }
    value[FABRIC] = in_ring > 0 ? 2 * hypot(c->harmonic[0], c->harmonic[1]) / in_ring : NAN;
    value[STRUCTURAL] = c->shear[0] * stress_unit;
    value[STRUCTURAL_THIN] = c->shear[1] * stress_unit;
    value[STRUCTURAL_ZERO] = value[STRUCTURAL_THIN] + (value[STRUCTURAL_THIN] - value[STRUCTURAL]) * shell_of[1] / (shell_of[0] - shell_of[1]);
    value[OVERLAP] = c->overlap;
    value[PEAK_11] = peak_near(g, 2 * crowd->radius[0] / crowd->unit);
    value[PEAK_12] = peak_near(g, (crowd->radius[0] + crowd->radius[1]) / crowd->unit);
    value[PEAK_22] = peak_near(g, 2 * crowd->radius[1] / crowd->unit);
}

bool structure_read(struct check_run *run, const char *out, const struct dense_start *s, double discard, double value[POINT_QUANTITIES],
                    struct structure *sum)
{
    struct count c = { 0 };
    const json_t *species = json_object_get(s->scene, "species");
    const double kT = scene_number(s->scene, "fluid.kT", 0);
    struct crowd crowd = { .start = s, .depth = sqrt(M_PI * kT / 2 / scene_number(s->scene, "forces.contact.normal_stiffness", INFINITY)) };
    for (size_t k = 0; k < 8 && k < json_array_size(species); k++)
        crowd.radius[k] = scene_number(json_array_get(species, k), "radius", 1);
    crowd.unit = crowd.radius[0];
    if (!dense_snapshots(run, out, s, discard, see_snapshot, &(struct seeing){ &c, &crowd }))
        return false;
    conclude(&c, &crowd, kT, value, sum);
    return true;
}
