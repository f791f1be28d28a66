/* Blocking and MSER against series whose answer is known, and lags against the definition. */
#include "suite.h"

#include "observers/blocks.h"
#include "observers/lags.h"

#include <math.h>
#include <stdlib.h>

static double uniform(void) { return (rand() + 0.5) / ((double)RAND_MAX + 1.0) - 0.5; }

/* x' = f x + noise: the error of a mean of n is sigma/sqrt(n) sqrt((1 + f)/(1 - f)). */
static void blocking_sees_correlation(void)
{
    enum { N = 1 << 15, ROUNDS = 40 };
    double *x = malloc(N * sizeof *x);
    for (int k = 0; k < 3; k++) {
        const double f = k == 0 ? 0.0 : k == 1 ? 0.8 : 0.95, sigma = 1.0 / sqrt(12.0 * (1.0 - f * f));
        double square = 0.0, mean = 0.0, spread = 0.0;
        int plateaus = 0;
        srand(11u + (unsigned)k);
        for (int round = 0; round < ROUNDS; round++) {
            double y = 0.0;
            for (int n = -2000; n < N; n++) {
                y = f * y + uniform();
                if (n >= 0)
                    x[n] = y + 7.0;
            }
            const struct block_mean b = blocks_mean(x, N);
            mean += b.mean / ROUNDS;
            spread += (b.mean - 7.0) * (b.mean - 7.0) / ROUNDS;
            square += b.error * b.error / ROUNDS;
            plateaus += b.plateau;
        }
        const double expected = sigma / sqrt(N) * sqrt((1.0 + f) / (1.0 - f));
        check_close(mean, 7.0, 5.0 * expected / sqrt(ROUNDS), "mean");
        check_relative(sqrt(square), expected, 0.12, "error by blocking: low by its rule of stopping, high by the larger of two levels");
        check_relative(sqrt(spread), expected, 5.0 / sqrt(2.0 * ROUNDS), "what the means really scatter");
        check_close(plateaus, ROUNDS, 0, "plateaus found");
    }
    for (int n = 0; n < 30; n++)                                        /* a trend over the whole series: no plateau */
        x[n] = n;
    check_true(!blocks_mean(x, 30).plateau, "30 samples of a trend have no plateau");
    for (int n = 0; n < 3; n++)
        x[n] = n;
    check_true(isnan(blocks_mean(x, 3).error), "three samples have no error bar");
    check_close(blocks_mean(x, 3).mean, 1.0, 1e-15, "but a mean");
    for (int n = 0; n < 100; n++)
        x[n] = 3.5;
    const struct block_mean constant = blocks_mean(x, 100);
    check_true(constant.plateau && constant.error < 1e-15, "a constant has no error but rounding");
    free(x);
}

static void transients_are_discarded(void)
{
    enum { N = 4000 };
    double *x = malloc(N * sizeof *x);
    srand(5);
    for (int n = 0; n < N; n++)
        x[n] = uniform() + 20.0 * exp(-n / 100.0);
    const size_t dropped = blocks_transient(x, N);
    check_true(dropped >= 300 && dropped <= 900, "20 exp(-n/100) reaches the error of the mean, 5e-3, at 830 and the noise at 420");
    double still = 0.0;
    for (int round = 0; round < 50; round++) {
        for (int n = 0; n < N; n++)
            x[n] = uniform();
        still += (double)blocks_transient(x, N) / N / 50;
    }
    check_true(still < 0.15, "little is discarded of a settled series");
    for (int n = 0; n < N; n++)
        x[n] = n;
    check_close((double)blocks_transient(x, N), N / 2, 5, "a trend: half, and no more");
    check_close((double)blocks_transient(x, 4), 0, 0, "too short");
    free(x);
}

/* Samples whose value is their own number: the difference of a pair is its lag. */
struct seen { const struct lags *of; int64_t count[400]; double worst; };

static void see(void *owner, int row, const double *old, const double *now)
{
    struct seen *s = owner;
    s->count[row]++;
    s->worst = fmax(s->worst, fabs(now[0] - old[0] - (double)lags_of_row(row)) + fabs(old[1] - 2.0 * old[0]));
}

static void lags_are_what_they_say(void)
{
    struct lags l;
    struct seen seen = { .of = &l };
    struct error e = { 0 };
    const int samples = 1000;
    check_true(lags_new(&l, 5, 2, &e), e.text);
    for (int n = 0; n < samples; n++)
        lags_push(&l, (const double[2]){ n, 2.0 * n }, see, &seen);
    check_close(seen.worst, 0, 0, "lag of every pair that was shown");
    check_close(lags_rows(&l), 1 + 16 + 4 * 8, 0, "rows");
    for (int row = 0; row < lags_rows(&l); row++) {
        const int64_t lag = lags_of_row(row), stride = row <= 16 ? 1 : INT64_C(1) << ((row - 17) / 8 + 1);
        check_close((double)seen.count[row], (double)((samples - 1 - lag) / stride + 1), 0, "pairs at a lag");
        check_true(row == 0 || lag > lags_of_row(row - 1), "lags ascend");
    }
    check_close((double)lags_of_row(lags_rows(&l) - 1), 256, 0, "longest lag 16 2^4");
    lags_free(&l);
}

static const struct unit_test tests[] = {
    { "blocking sees correlation", blocking_sees_correlation },
    { "transients are discarded", transients_are_discarded },
    { "lags are what they say", lags_are_what_they_say },
    { NULL, NULL }
};
const struct suite blocks_suite = { "blocks", tests };
