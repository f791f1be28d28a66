/* What is wrong with a covariance, in words: which block, which kinds of block, and what such a factor often means. */
#include "noise.h"

#include <stdio.h>

const char *noise_block_name(char text[160], const struct subject *s, size_t a, size_t b)
{
    static const char *const kind[2] = { "force", "torque" };
    const size_t i = a / 2, j = b / 2;
    int used = snprintf(text, 160, "<%s %zu, %s %zu> (radii %.4g and %.4g", kind[a % 2], i + 1, kind[b % 2], j + 1, s->f->radius[i],
                        s->f->radius[j]);
    for (size_t k = 0; k < s->f->pairs; k++)
        if ((s->f->pair[k].i == i && s->f->pair[k].j == j) || (s->f->pair[k].i == j && s->f->pair[k].j == i))
            used += snprintf(text + used, 160 - (size_t)used, ", gap xi = %.3g", s->f->pair[k].xi);
    snprintf(text + used, 160 - (size_t)used, ")");
    return text;
}

const char *noise_guess(const struct subject *s, double ratio)
{
    const struct { double value; const char *text; } known[] = {
        { 2.0, " A factor 2: both sides of a pair draw, or noise is added twice." },
        { 0.5, " A factor 1/2: kT where 2 kT belongs." },
        { s->dt, " A factor dt: the noise lacks 1/sqrt(dt)." },
        { 1.0 / s->dt, " A factor 1/dt: 1/dt where 1/sqrt(dt) belongs." },
        { s->kT, " A factor kT: kT where sqrt(kT) belongs." },
        { 1.0 / s->kT, " A factor 1/kT: sqrt(kT) is missing." },
        { 1.0 / 3.0, " A factor 1/3: uniform numbers on (-1, 1) without the factor 3 of their variance." },
        { 1.0 / 12.0, " A factor 1/12: uniform numbers on (-1/2, 1/2) without the factor 12 of their variance." },
    };
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (fabs(ratio / known[k].value - 1.0) < 0.03)
            return known[k].text;
    return "";
}

/*
 * Measured over expected by kind of block, each over all spheres or pairs of the configuration: "<F_i F_i> 1.00, <F_i F_j> 0.50".
 * Which kinds are wrong says more than the worst block: all alike, a factor; those of i and j alone, a sign or an index.
 */
static const char *kinds_of_blocks(char text[200], const struct subject *s, int stream, const double *C)
{
    static const char *const name[6] = { "<F_i F_i>", "<F_i T_i>", "<T_i T_i>", "<F_i F_j>", "<F_i T_j>", "<T_i T_j>" };
    double both[6] = { 0 }, squared[6] = { 0 }, largest = 0.0;
    const size_t n = s->size;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++) {
            const int torques = (int)(i / 3 % 2 + j / 3 % 2), kind = torques + (i / 6 == j / 6 ? 0 : 3);
            both[kind] += C[i * n + j] * s->R[stream][i * n + j];
            squared[kind] += s->R[stream][i * n + j] * s->R[stream][i * n + j];
            largest = fmax(largest, s->R[stream][i * n + j]);
        }
    int used = 0;
    text[0] = '\0';
    for (int k = 0; k < 6; k++)
        if (squared[k] > 1e-12 * largest * largest)
            used += snprintf(text + used, 200 - (size_t)used, "%s%s %.2f", used ? ", " : "", name[k], both[k] / squared[k]);
    return text;
}

const char *noise_blame(char text[900], const struct subject *s, int stream, const char *name, const double *C,
                        const struct block_finding *w)
{
    char block[160], kinds[200];
    noise_block_name(block, s, w->a, w->b);
    const char *hint = isnan(w->ratio) ? "" : noise_guess(s, w->ratio);
    if (w->a % 2 && w->b % 2 && w->a != w->b && stream == LUBRICATION && !hint[0])
        hint = " The sign of the second sphere's torque noise (a minus; the plus of Li's printed eq 3.24 is wrong) shows here and"
               " nowhere else.";
    if (isnan(w->ratio))
        snprintf(text, 900, "block %s of the covariance of the %s should vanish, and does not (z = %.3g); all blocks by kind, over what is "
                 "expected: %s", block, name, w->z, kinds_of_blocks(kinds, s, stream, C));
    else
        snprintf(text, 900, "block %s of the covariance of the %s is %.4g times what the candidate's own resistance asks for (z = %.3g); "
                 "all blocks by kind: %s.%s", block, name, w->ratio, w->z, kinds_of_blocks(kinds, s, stream, C), hint);
    return text;
}
