/*
 * Layer 6: two codes run one scene from one start, the candidate and a reference; and what they left is read.
 */
#include "dense.h"
#include "sheared_point.h"
#include "../offline.h"
#include "../packing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool dense_start_in(struct check_run *run, const json_t *scene, const json_t *par, unsigned seed, struct dense_start *s)
{
    json_t *shear = json_array_get(json_object_get(scene, "shear"), 0);
    const json_t *species = json_object_get(scene, "species"), *counts = json_object_get(par, "counts");
    struct packing_species mix[8];
    const int kinds = (int)json_array_size(species);
    char why[WHY_LENGTH];
    *s = (struct dense_start){ .scene = json_deep_copy(scene), .phi = scene_number(par, "phi", 0.5),
                               .viscosity = scene_number(scene, "fluid.viscosity", 1),
                               .rate = scene_number(shear, "rate", 1) };
    for (int k = 0; k < kinds && k < 8; k++) {
        mix[k].radius = scene_number(json_array_get(species, (size_t)k), "radius", 1);
        mix[k].count = (int)json_integer_value(json_array_get(counts, (size_t)k));
        s->count += (size_t)mix[k].count;
    }
    s->row = calloc(s->count, sizeof *s->row);
    s->edge = packing_edge(mix, kinds, s->phi);
    if (!s->row || !packing_make(mix, kinds, s->edge, s->rate, seed, s->row, why)) {
        check_error(run, INVARIANT, "start", NAN, NAN, NAN, NAN, "the gate itself failed: %s", why);
        dense_start_free(s);
        return false;
    }
    scene_set(s->scene, "box", json_pack("{s[fff] s[bbb]}", "lengths", s->edge, s->edge, s->edge, "periodic", 1, 1, 1));
    scene_set(s->scene, "start.file", json_string("states.csv"));
    return true;
}

bool dense_start(struct check_run *run, unsigned seed, struct dense_start *s)
{
    return dense_start_in(run, run->gate_case->scene, run->gate_case->parameters, seed, s);
}

void dense_start_free(struct dense_start *s)
{
    free(s->row);
    json_decref(s->scene);
}

const char *dense_reference(void)
{
    static char beside[PATH_LENGTH + 64];
    const char *named = getenv("GATE_REFERENCE"), *here = "build/lammps-candidate --own reference";
    if (named || access("build/lammps-candidate", X_OK) == 0)
        return named ? named : here;
    char gate[PATH_LENGTH];                     /* called from elsewhere: it lies beside the gate */
    const ssize_t n = readlink("/proc/self/exe", gate, sizeof gate - 1);
    gate[n > 0 ? n : 0] = '\0';
    char *slash = strrchr(gate, '/');
    if (!slash)
        return here;
    *slash = '\0';
    snprintf(beside, sizeof beside, "'%s/lammps-candidate' --own reference", gate);
    return beside;
}

bool dense_ask_both(struct check_run *run, const char *name, const struct dense_start *s, char out[2][PATH_LENGTH], double core_seconds[2])
{
    const struct candidate *own = run->candidate;
    struct candidate reference = *own;
    struct capabilities whole;          /* what the candidate lacks or rounds is not said of the reference */
    const struct question q = { .protocol = "run", .scene = s->scene, .state = s->row, .states = s->count };
    const double seconds = run->candidate_seconds, before = children_seconds();
    char label[64];
    if (!check_ask(run, name, &q, out[0]))
        return false;
    const double after = run->candidate_seconds, between = children_seconds();
    if (offline_waits(own)) {           /* no answer yet: nothing will be judged, and the reference need not be run */
        memcpy(out[1], out[0], PATH_LENGTH);
        return true;
    }
    reference.server = NULL;            /* the reference is always started here: the candidate is not asked in its stead */
    reference.offline = NULL;
    capabilities_default(&whole);
    reference.capabilities = &whole;
    reference.command = dense_reference();
    snprintf(label, sizeof label, "reference-%s", name);
    run->candidate = &reference;
    const bool good = check_ask(run, label, &q, out[1]);
    run->candidate = own;
    if (core_seconds) {
        core_seconds[0] = between - before;
        core_seconds[1] = children_seconds() - between;
    }
    run->candidate_seconds = after > seconds ? after : seconds;
    if (!good && run->results.count) {  /* a missing reference is an error of the set-up, never a skip */
        struct result *r = &run->results.item[run->results.count - 1];
        char said[WHY_LENGTH + PATH_LENGTH];
        snprintf(said, sizeof said, "the reference, not the candidate, gave no answer ('%s', or name another in GATE_REFERENCE): %s",
                 reference.command, r->sentence);
        free(r->sentence);
        r->sentence = strdup(said);
        r->verdict = VERDICT_FAIL;
    }
    return good;
}

double dense_radius(const struct dense_start *s, size_t i)
{
    return scene_number(json_array_get(json_object_get(s->scene, "species"), (size_t)s->row[i].species - 1), "radius", 1);
}

/* Positions are unwrapped: the image n cells up along y is displaced by n edges times the strain along x as well. */
void dense_pair(const struct dense_start *s, const struct dense_snapshot *now, size_t i, size_t j, double d[3])
{
    const double edge = s->edge;
    for (size_t k = 0; k < 3; k++)
        d[k] = now->x[3 * j + k] - now->x[3 * i + k];
    d[2] -= edge * nearbyint(d[2] / edge);
    const double up = edge * nearbyint(d[1] / edge);
    d[1] -= up;
    d[0] -= up * s->rate * now->time;
    d[0] -= edge * nearbyint(d[0] / edge);
}

bool dense_snapshots(struct check_run *run, const char *out, const struct dense_start *s, double discard,
                     void (*see)(void *to, const struct dense_start *s, const struct dense_snapshot *now), void *to)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    struct table t;
    double *frame[3] = { calloc(3 * s->count, sizeof **frame), calloc(3 * s->count, sizeof **frame), calloc(3 * s->count, sizeof **frame) };
    path_join(path, out, "trajectory.csv");
    const bool memory = frame[0] && frame[1] && frame[2], read = memory && table_read(path, "step,time,id,x,y,z,ux?,uy?,uz?,wx?,wy?,wz?", &t, why);
    size_t in_frame = 0, frames = 0;
    for (size_t r = 0; read && r < t.rows; r++) {
        const double id = table_at(&t, r, 2), time = table_at(&t, r, 1);
        if (id < 1 || id > (double)s->count)
            continue;
        for (size_t k = 0; k < 9; k++)
            frame[k / 3][3 * ((size_t)id - 1) + k % 3] = table_at(&t, r, 3 + k);
        in_frame++;
        if (r + 1 < t.rows && table_at(&t, r + 1, 0) == table_at(&t, r, 0))
            continue;
        if (in_frame == s->count && time * fabs(s->rate) > discard) {
            see(to, s, &(struct dense_snapshot){ time, frame[0], frame[1], frame[2] });
            frames++;
        }
        in_frame = 0;
    }
    if (read)
        table_free(&t);
    if (!read || !frames)
        check_garbage(run, !memory ? "the gate is out of memory" : !read ? why : "trajectory.csv has no whole snapshot in the steady part of the run");
    for (int k = 0; k < 3; k++)
        free(frame[k]);
    return frames > 0;
}

const struct check dense_checks[] = {
    { "dense-viscosities", dense_viscosities },
    { "dense-path", dense_path },
    { "contact-path", contact_path },
    { "dense-memory", dense_memory },
    { "equation-of-state", check_equation_of_state },
    { NULL, NULL },
};
