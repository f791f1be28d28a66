/*
 * Layer 6: a run that was stopped goes on as if it never had been
 *
 * One crowd is run twice: in one piece, and with a pause after which only what is on disk is left (case.json: pause, docs/formats.md). The
 * path afterwards must be the same to the last bit or nearly so, and tables that gather over the whole run, too. The next step depends on more
 * than places and velocities: forces (velocity Verlet kicks with them), histories of contacts, how often spheres have crossed faces, the cell's
 * labels, the number of the step that noise is drawn for, sums of observers. The pause comes after the cell has been remapped, with contacts
 * that slide and stick, and at a step at which no list is made.
 */
#include "packing.h"
#include "two_bodies.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Text of a table without the lines of provenance. NULL: not there. */
static char *text_of(const char *out, const char *file)
{
    char path[PATH_LENGTH], line[8192];
    path_join(path, out, file);
    FILE *in = fopen(path, "r");
    size_t length = 0;
    char *text = in ? calloc(1, 1) : NULL;
    while (text && fgets(line, sizeof line, in)) {
        const size_t n = strlen(line);
        if (*line == '#')
            continue;
        text = realloc(text, length + n + 1);
        memcpy(text + length, line, n + 1);
        length += n;
    }
    if (in)
        fclose(in);
    return text;
}

/* Every number of one table against the other's, found in the order in which they stand. */
static void judge_table(struct check_run *run, const char *file, const char *whole, const char *paused)
{
    char *first = text_of(whole, file), *second = text_of(paused, file), *a = first, *b = second;
    struct worst w = { .measured = 1.0, .expected = 1.0 };
    size_t line = 1, numbers = 0;
    if (!first) {
        check_skip(run, file, "the candidate writes no %s", file);
        free(second);
        return;
    }
    while (b && *a && *b) {
        char *a_end, *b_end;
        const double x = strtod(a, &a_end), y = strtod(b, &b_end);
        if (a_end != a && b_end != b) {
            if (x != y && !(isnan(x) && isnan(y)))      /* -kT ln 0 is infinite in both */
                worst_see(&w, y, x, fmax(fabs(x), 1e-6), line);
            a = a_end, b = b_end;
            numbers++;
            continue;
        }
        if (*a != *b)
            break;
        line += *a == '\n';
        a++, b++;
    }
    if (!b || *a || *b || numbers == 0)
        worst_see(&w, NAN, 0.0, 1.0, line);
    check_error(run, INVARIANT, file, w.measured, w.expected, w.error, run->gate_case->tolerance,
                "%s is not the same after a pause: line %zu says %s; something that is summed over the run was lost, or counted twice", file, w.at, compare(&w));
    free(first);
    free(second);
}

void check_resume(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters, *tables = json_object_get(parameters, "tables");
    json_t *scene = json_deep_copy(run->gate_case->scene);
    struct model m;
    double counts[2];
    size_t species;
    char why[WHY_LENGTH] = "the gate is out of memory", out[2][PATH_LENGTH];
    if (!model_read(run, scene, &m))
        return;
    parameter_list(parameters, "spheres", counts, &species, 2);
    const struct packing_species kind[2] = { { m.radius[0], (int)counts[0] }, { m.radius[1], (int)counts[1] } };
    const size_t count = (size_t)(kind[0].count + kind[1].count);
    const double edge = packing_edge(kind, 2, scene_number(parameters, "phi", NAN));
    const int steps = (int)scene_number(parameters, "steps", NAN), pause = (int)scene_number(parameters, "pause", NAN), at[2] = { pause + 1, steps };
    struct state_row *row = calloc(count, sizeof *row);
    struct track track[2] = { { 0 }, { 0 } };
    scene_set(scene, "box.lengths", json_pack("[fff]", edge, edge, edge));
    bool good = row && packing_make(kind, 2, edge, m.gradient[0][1], run->seed, row, why);
    if (!good)
        check_garbage(run, why);
    scene_set(scene, "output", json_deep_copy(tables));
    track_want(scene, at, 2);
    scene_set(scene, "output.checkpoint", json_pack("{si}", "every", steps));
    for (int k = 0; k < 2 && good; k++) {
        const struct question q = { .protocol = "run", .scene = scene, .state = row, .states = count, .pause = k ? pause : 0 };
        good = check_ask(run, k ? "paused" : "whole", &q, out[k]) && track_load(run, out[k], at, 2, count, &track[k]);
    }
    for (size_t s = 0; s < 2 && good; s++) {
        struct worst w = WORST_NONE;
        for (size_t i = 0; i < count; i++)
            worst_see_vector(&w, track_at(&track[1], s, i)->x, track_at(&track[0], s, i)->x, isfinite(track_at(&track[0], s, i)->turn[0]) ? 12 : 9, 1.0, i);
        char what[64];
        snprintf(what, sizeof what, "the path %d step%s after a pause", at[s] - pause, at[s] - pause > 1 ? "s" : "");
        check_error(run, INVARIANT, what, w.measured, w.expected, w.error, run->gate_case->tolerance,
                    "a run that stops after step %d and goes on takes another path: sphere %zu has %.17g instead of %.17g at step %d; something that the next step "
                    "depends on is not kept (forces, histories, crossings of faces, labels of the cell, the number of the step)", pause, w.at + 1, w.measured,
                    w.expected, at[s]);
    }
    const char *table;
    json_t *unused;
    json_object_foreach(good ? (json_t *)tables : NULL, table, unused)
    {
        char file[96];
        snprintf(file, sizeof file, "%s.csv", table);
        judge_table(run, file, out[0], out[1]);
        if (scene_get(tables, "pair_distribution.plane") && strcmp(table, "pair_distribution") == 0)
            judge_table(run, "pair_plane.csv", out[0], out[1]);
    }
    for (int k = 0; k < 2; k++)
        track_free(&track[k]);
    free(row);
    json_decref(scene);
}
