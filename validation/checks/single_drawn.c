/*
 * Layer 3: flows in stages drawn at random
 *
 * One to eight stages of up to four shears at once, rates of any sign that are constant, ramp (to rest, too) or oscillate with phases of several turns
 * either way, begun at a random moment: stress of the drag, way travelled, deformation and turn of the flow as in single_stages.c. A law that is
 * right for the drives of that case only shows here. Stages and the begin fall on whole steps.
 */
#include "stages.h"

#include <gsl/gsl_randist.h>
#include <stdio.h>
#include <stdlib.h>

static double between(gsl_rng *random, double low, double high) { return low + (high - low) * gsl_rng_uniform(random); }
static double signed_between(gsl_rng *random, double low, double high) { return (gsl_rng_uniform(random) < 0.5 ? 1 : -1) * between(random, low, high); }

static json_t *draw_rate(gsl_rng *random, bool rests)
{
    const double rate = signed_between(random, 0.2, 1.2), kind = gsl_rng_uniform(random), other = signed_between(random, 0.2, 1.2);
    if (kind < 0.3 && !rests)
        return json_real(rate);
    if (kind < 0.6)
        return json_pack("{s[ff]}", "ramp", rate, rests || gsl_rng_uniform(random) < 0.3 ? 0.0 : other);
    return json_pack("{sfsfsfsf}", "mean", rests || gsl_rng_uniform(random) < 0.3 ? -other : 0.4 * rate, "amplitude", other, "angular_frequency", between(random, 1.0, 6.0),
                     "phase", between(random, -20.0, 20.0));
}

/* Two axes along which it flows and one along which rates vary, or one and two: none is both. */
static json_t *draw_drive(gsl_rng *random, double dt, size_t number, double *duration)
{
    static const char *const axis[3] = { "x", "y", "z" };
    int order[3] = { 0, 1, 2 };
    char name[32];
    const bool two_flows = gsl_rng_uniform(random) < 0.5;
    const bool alone = gsl_rng_uniform(random) < 0.3;       /* one law that comes to rest: nothing else says how fast this flow can be */
    const size_t stages = alone ? 1 : 1 + gsl_rng_uniform_int(random, STAGES);
    json_t *list = json_array();
    gsl_ran_shuffle(random, order, 3, sizeof *order);
    *duration = 0.0;
    for (size_t n = 0; n < stages; n++) {
        const double lasts = dt * (double)(40 + gsl_rng_uniform_int(random, 200));
        json_t *shears = json_array();
        const size_t count = alone ? 1 : n == 0 ? 1 + gsl_rng_uniform_int(random, 4) : gsl_rng_uniform_int(random, 5);
        for (size_t k = 0; k < count; k++) {
            const int either = order[1 + gsl_rng_uniform_int(random, 2)];
            json_array_append_new(shears, json_pack("{ssssso}", "flow", axis[two_flows ? either : order[0]], "gradient", axis[two_flows ? order[0] : either], "rate",
                                                    draw_rate(random, alone)));
        }
        json_array_append_new(list, json_pack("{sfso}", "duration", lasts, "shear", shears));
        *duration += lasts;
    }
    snprintf(name, sizeof name, "drive %zu", number);
    return json_pack("{ssso}", "name", name, "stages", list);
}

void check_stages_drawn(struct check_run *run)
{
    const double dt = scene_number(run->gate_case->parameters, "dt", NAN);
    const size_t drives = (size_t)scene_number(run->gate_case->parameters, "drives", 0);
    gsl_rng *random = pair_random(run);
    bool good = true;
    for (size_t k = 1; k <= drives && good; k++) {
        double duration;
        json_t *drive = draw_drive(random, dt, k, &duration);
        const double begin = dt * floor(gsl_rng_uniform(random) * duration / dt);
        good = stages_try_late(run, drive, k, begin);
        json_decref(drive);
    }
    gsl_rng_free(random);
}
