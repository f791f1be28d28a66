/* Pairs of spheres for golden vectors: sizes and gaps as asked, all else from a generator that needs no library (splitmix64). */
#include "vectors.h"

#include <math.h>

const double ratios[6] = { 1.0, 1.4, 0.7142857142857143, 0.2, 5.0, 7.0 };

static unsigned long long dice_bits(struct dice *d)
{
    unsigned long long z = d->state += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
}

double dice_number(struct dice *d)
{
    return (double)((long long)(dice_bits(d) % 2001) - 1000) / 1000.0;
}

void dice_vector(struct dice *d, double size, double v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = size * dice_number(d);
}

/* Sphere 1 sits away from the origin, as in the gate's own cases, so that a code that measures positions from there is seen. */
void dice_pair(struct dice *d, double ratio, double xi, struct theory_sphere s[2])
{
    const double a1 = 1.3, a2 = 1.3 * ratio, distance = (a1 + a2) * (1.0 + 0.5 * xi);
    double n[3], length;
    do {
        dice_vector(d, 1.0, n);
        length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    } while (length < 0.3 || length > 1.0);
    for (int side = 0; side < 2; side++) {
        s[side].radius = side ? a2 : a1;
        dice_vector(d, 0.9, s[side].u);
        dice_vector(d, 0.7, s[side].w);
    }
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * distance + 1.7;
        s[0].x[k] = middle - 0.5 * distance * n[k] / length;
        s[1].x[k] = middle + 0.5 * distance * n[k] / length;
    }
}

void exchange(struct theory_sphere s[2], double history[3])
{
    const struct theory_sphere first = s[0];
    s[0] = s[1];
    s[1] = first;
    for (int k = 0; history && k < 3; k++)
        history[k] = -history[k];
}

double gap_of(const struct theory_sphere s[2])
{
    const double r[3] = { s[1].x[0] - s[0].x[0], s[1].x[1] - s[0].x[1], s[1].x[2] - s[0].x[2] };
    const double sizes = s[0].radius + s[1].radius;
    return 2.0 * (sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) - sizes) / sizes;
}

static double size_of(const double v[3]) { return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }
double speed_of(const struct theory_sphere *s) { return size_of(s->u); }
double spin_of(const struct theory_sphere *s) { return size_of(s->w); }

void add_pair(struct fields *f, const struct theory_sphere s[2])
{
    double radius[2], x[6], u[6], w[6];
    for (int k = 0; k < 6; k++) {
        radius[k / 3] = s[k / 3].radius;
        x[k] = s[k / 3].x[k % 3];
        u[k] = s[k / 3].u[k % 3];
        w[k] = s[k / 3].w[k % 3];
    }
    add_number(f, "gap", gap_of(s));
    add_list(f, "radius", radius, 2);
    add_list(f, "position", x, 6);
    add_list(f, "velocity", u, 6);
    add_list(f, "spin", w, 6);
}

void add_pair_answer(struct fields *f, const struct theory_pair *p)
{
    add_list(f, "force", &p->force[0][0], 6);
    add_list(f, "torque", &p->torque[0][0], 6);
    add_list(f, "stress", &p->stress[0][0], 9);
}
