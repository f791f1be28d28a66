/*
 * Layer 6: a contact that parts forgets its tangential displacement, also where the pair stays near
 *
 * A crowd of rough spheres rattles in its cages: contacts part and are made again within a fraction of a radius. The same crowd
 * is run twice by the candidate: with contact forces alone, and with a lubrication added whose viscosity is so small (1e-200)
 * that it cannot change a digit. It changes only who counts as near, so both runs must be the same motion. A code that keeps the
 * displacement of a parted pair for as long as the pair is near gives the second contact a false start in the second run.
 *
 * No formula is needed. Neighbours are summed in another order, so digits differ by rounding, which collisions multiply.
 */
#include "dense.h"
#include "single.h"

#include <math.h>

void dense_memory(struct check_run *run)
{
    static const int end = 600;
    struct dense_start s = { 0 };
    struct track alone = { 0 }, near = { 0 };
    if (!dense_start(run, run->seed, &s))
        return;
    gsl_rng *random = pair_random(run);
    for (size_t i = 0; i < s.count; i++) {
        random_vector(random, 0.7, s.row[i].u);
        random_vector(random, 0.4, s.row[i].w);
    }
    gsl_rng_free(random);
    const bool first = track_ask(run, "contact-alone", s.scene, s.row, s.count, &end, 1, &alone);
    scene_set(s.scene, "fluid.viscosity", json_real(1e-200));
    scene_set(s.scene, "forces.lubrication", json_pack("{sf sf ss}", "inner_gap", 1e-3, "outer_gap", 0.3, "rotation_correction", "none"));
    if (first && track_ask(run, "with-neighbours", s.scene, s.row, s.count, &end, 1, &near)) {
        double spin = 0.0, place = 0.0, turned = 0.0;
        for (size_t i = 0; i < s.count; i++)
            for (int c = 0; c < 3; c++) {
                const struct track_point *a = track_at(&alone, 0, i), *b = track_at(&near, 0, i);
                place = fmax(place, fabs(a->x[c] - b->x[c]));
                spin = fmax(spin, fabs(a->w[c] - b->w[c]));
                turned = fmax(turned, fabs(a->w[c] - s.row[i].w[c]));
            }
        check_error(run, INVARIANT, "contacts change spins", turned, NAN, turned > 0.05 ? 0.0 : 1.0, 0.5,
                    "friction changed no spin in %d steps of a dense crowd: nothing was tried", end);
        check_error(run, INVARIANT, "parted contacts forget", spin, 0.0, spin, run->gate_case->tolerance,
                    "with neighbours listed farther than contact, spins differ by %.3g after %d steps: contacts that part keep their tangential "
                    "displacement while the pair stays near, or contacts are lost with the list", spin, end);
        check_error(run, INVARIANT, "range changes no motion", place, 0.0, place, run->gate_case->tolerance,
                    "with neighbours listed farther than contact, places differ by %.3g after %d steps", place, end);
    }
    track_free(&alone);
    track_free(&near);
    dense_start_free(&s);
}
