/*
 * Layer 3: noise does not come again
 *
 * A generator whose counter is cut to 16 or 20 bits, or that is seeded anew every so many steps, repeats its numbers. Nothing else
 * sees it: each kick is right, and repeats are farther apart than the other runs are long. Here a few Brownian spheres take more
 * than 2^20 steps. With d_n the displacement over the n-th stretch of k steps, many relaxation times long, the correlation
 *
 *     C(l) = sum over n, spheres and axes of d_n d_(n+l) / sqrt(sum of d_n^2 . sum of d_(n+l)^2)
 *
 * is 0 but for chance. If the noise has a period, stretches one period apart share half of their kicks or more, and C >= 1/2 there. All lags
 * that leave an eighth of the run to compare are tried; lag 1 and 2, through which inertia reaches, are not. Chance has the
 * standard deviation 1/sqrt(numbers compared), of which half of 1/2 must be ten. A correlation that is no number (spheres that stand still) ends the search.
 */
#include "single.h"

#include <stdlib.h>

static double correlation(const double *d, size_t width, size_t stretches, size_t lag)
{
    double both = 0.0, early = 0.0, late = 0.0;
    for (size_t k = 0; k < (stretches - lag) * width; k++) {
        const double a = d[k], b = d[k + lag * width];
        both += a * b;
        early += a * a;
        late += b * b;
    }
    return both / sqrt(early * late);
}

void check_noise_period(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    const size_t stretches = (size_t)scene_number(parameters, "stretches", 0), count = (size_t)scene_number(parameters, "spheres", 0), width = 3 * count;
    const int every = (int)scene_number(parameters, "every", 0);
    struct model m;
    struct track track;
    if (!model_read(run, run->gate_case->scene, &m))
        return;
    json_t *scene = json_deep_copy(run->gate_case->scene);
    int *at = calloc(stretches + 1, sizeof *at);
    struct state_row *start = calloc(count, sizeof *start);
    double *d = calloc(stretches * width, sizeof *d);
    for (size_t n = 0; n <= stretches; n++)
        at[n] = (int)n * every;
    for (size_t i = 0; i < count; i++) {
        start[i] = (struct state_row){ .id = (int)i + 1, .species = 1 };
        for (int c = 0; c < 3; c++) {
            start[i].x[c] = m.cell[c][c] * ((double)i + 0.5) / (double)count;
            start[i].u[c] = 0.1 * (double)(c + 1);      /* stock LAMMPS leaves a sphere at rest at rest (fix langevin with a bias) */
        }
    }
    scene_set(scene, "seed", json_integer(run->seed));
    if (track_ask(run, "long", scene, start, count, at, stretches + 1, &track)) {
        double most = 0.0;
        size_t lag = 0;
        for (size_t n = 0; n < stretches; n++)
            for (size_t k = 0; k < width; k++)
                d[n * width + k] = track_at(&track, n + 1, k / 3)->x[k % 3] - track_at(&track, n, k / 3)->x[k % 3];
        for (size_t l = 3; l <= stretches - stretches / 8 && isfinite(most); l++) {
            const double C = fabs(correlation(d, width, stretches, l));
            if (!(C <= most)) {
                most = C;
                lag = l;
            }
        }
        if (isfinite(most))
            check_error(run, INVARIANT, "stretches of the path independent", most, 0.0, most, run->gate_case->tolerance,
                        "what the spheres do in %d steps they do again, correlated by %.2g, about %zu steps later: the noise repeats itself", every,
                        most, lag * (size_t)every);
        else
            check_garbage(run, "the spheres stand still, or leave the numbers: no path to look at");
        track_free(&track);
    }
    free(d);
    free(start);
    free(at);
    json_decref(scene);
}
