#include "observers/blocks.h"

#include <math.h>

enum { BATCH = 5, ENOUGH = 20, FEWEST = 8 };

size_t blocks_transient(const double *x, size_t count)
{
    const size_t batches = count / BATCH;
    double sum = 0.0, squares = 0.0, least = INFINITY, centre = 0.0;
    size_t dropped = 0;
    for (size_t k = 0; k < count; k++)
        centre += x[k] / (double)count;             /* sums of small numbers: no cancellation where the mean is large */
    /* From the end, so that each batch joins the sums once. */
    for (size_t d = batches; d-- > 0;) {
        double y = 0.0;
        for (size_t k = 0; k < BATCH; k++)
            y += (x[d * BATCH + k] - centre) / BATCH;
        sum += y;
        squares += y * y;
        const double n = (double)(batches - d);
        const double statistic = (squares - sum * sum / n) / (n * n);
        if (d <= batches / 2 && statistic <= least) {
            least = statistic;
            dropped = d;
        }
    }
    return dropped * BATCH;
}

/* Squared error of the mean of m independent numbers. */
static double squared_error(const double *x, size_t m, double mean)
{
    double sum = 0.0;
    for (size_t k = 0; k < m; k++)
        sum += (x[k] - mean) * (x[k] - mean);
    return sum / ((double)m * (double)(m - 1));
}

struct block_mean blocks_mean(double *x, size_t count)
{
    struct block_mean result = { .mean = 0.0, .error = NAN };
    double before = -1.0;
    for (size_t k = 1; k < count; k++)              /* about the first, so that a constant has exactly no scatter */
        result.mean += (x[k] - x[0]) / (double)count;
    result.mean += count ? x[0] : 0.0;
    for (size_t m = count; m >= FEWEST; m /= 2) {
        const double error = sqrt(squared_error(x, m, result.mean)), doubt = error / sqrt(2.0 * (double)(m - 1));
        if (before >= 0.0 && m >= ENOUGH && error <= before + doubt) {
            result.error = fmax(error, before);
            result.blocks = m;
            result.plateau = true;
            break;
        }
        if (!(error <= result.error)) {             /* also where there is none yet */
            result.error = error;
            result.blocks = m;
        }
        before = error;
        for (size_t k = 0; k < m / 2; k++)
            x[k] = 0.5 * (x[2 * k] + x[2 * k + 1]);
    }
    return result;
}
