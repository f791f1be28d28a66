/*
 * Random numbers as a function of what they are for (counter-based): (seed, realisation, stream, step, tags of the pair,
 * image) -> six numbers of mean 0 and variance 1. The order in which they are asked for does not matter, so the same
 * scene has the same noise in any loop order, in any number of processes, and after a restart.
 *
 * Generator: Philox4x64-10, Salmon et al. (2011), from Random123: one call gives a particle or a pair all it needs. Gaussian: Box & Muller (1958).
 */
#ifndef CORE_NOISE_H
#define CORE_NOISE_H

#include "core/suspension.h"

#include <Random123/philox.h>
#include <stdint.h>

enum noise_law { NOISE_GAUSSIAN, NOISE_UNIFORM };
#define NOISE_LAWS { "gaussian", "uniform", NULL }                           /* their names in a scene */

/* One stream per thing that draws: two streams never share a number. */
enum noise_stream { NOISE_START, NOISE_THERMAL, NOISE_DRAG, NOISE_LUBRICATION };

/* What the number is for. `j` is 0 for one particle; `image` tells images of the same pair apart, 0 in large boxes. */
struct noise_place { enum noise_stream stream; int64_t step; int i, j; uint32_t image; };

/* Uniform in (0, 1), never 0 or 1, so that its logarithm is finite. */
static inline double noise_fraction(uint32_t word) { return ((double)word + 0.5) * 0x1p-32; }

static inline philox4x64_ctr_t noise_words(const struct noise_key *key, const struct noise_place *at)
{
    const philox4x64_ctr_t counter = { { (uint64_t)at->step, at->image, (uint64_t)at->i, (uint64_t)at->j } };
    const philox4x64_key_t both = { { (uint64_t)key->seed << 32 | key->realisation, (uint64_t)at->stream } };
    return philox4x64(counter, both);
}

/* The two halves of a random word to two independent numbers. */
static inline void noise_two(enum noise_law law, uint64_t word, double z[2])
{
    const uint32_t first = (uint32_t)word, second = (uint32_t)(word >> 32);
    if (law == NOISE_UNIFORM) {
        z[0] = sqrt(12.0) * (noise_fraction(first) - 0.5);
        z[1] = sqrt(12.0) * (noise_fraction(second) - 0.5);
        return;
    }
    const double size = sqrt(-2.0 * log(noise_fraction(first))), angle = 2.0 * M_PI * noise_fraction(second);
    z[0] = size * cos(angle);
    z[1] = size * sin(angle);
}

/* Two independent vectors of independent numbers. */
static inline void noise_vectors(enum noise_law law, const struct noise_key *key, const struct noise_place *at, vec3 *first, vec3 *second)
{
    const philox4x64_ctr_t w = noise_words(key, at);
    double z[6];
    noise_two(law, w.v[0], z);
    noise_two(law, w.v[1], z + 2);
    noise_two(law, w.v[2], z + 4);
    *first = vec(z[0], z[1], z[2]);
    *second = vec(z[3], z[4], z[5]);
}

#endif
