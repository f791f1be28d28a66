/*
 * Layer 6: what a candidate says it has measured, against what its own trajectory says
 *
 * One run of a sheared crowd writes places, velocities, spins and stresses, and the tables of docs/formats.md, all at the same steps. From the
 * former the gate computes the latter anew, images by brute force, by the definitions in that document: no physics enters, so the numbers
 * must agree to rounding. A table that the candidate does not write is skipped. Last, the run without tables must take the same path:
 *
 *     displacement, velocity_correlation    <dx^2>, <dtheta^2> without the affine part, <c c>, <w w>, by species against lag
 *     pair_distribution                     pairs of every image counted, over those of an ideal gas
 *     contacts, temperature                 contact numbers with and without rattlers; <m c^2>, <I w^2>, spins of nearest neighbours
 *     viscosity, brownian_stress            parts over eta rate, N1, N2, pressure; -(kT/V) a/(shell + depth) n n
 *
 * This file has the run, its pairs and how a table is read; the tables of each moment are in observers_moment.c, those of lags in
 * observers_lags.c, what else gathers over the run in observers_run.c.
 */
#include "observers.h"
#include "packing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double film_radius(const struct film *f, size_t i) { return f->m.radius[f->row[i].species - 1]; }
double film_mass(const struct film *f, size_t i) { return 4.0 / 3.0 * M_PI * f->m.density[f->row[i].species - 1] * gsl_pow_3(film_radius(f, i)); }

/*
 * The flow of each frame, and its integral from time 0 on. A frame within a step of the end of a stage (docs/physics.md): velocities have half of each
 * push, which is what the flow has in the mean over the steps before and after; spins are compared with the flow that there is.
 */
static bool find_flow(struct film *f)
{
    double way;
    f->flow = calloc(f->frames, sizeof *f->flow);
    f->turning = calloc(f->frames, sizeof *f->turning);
    f->strain = calloc(f->frames, sizeof *f->strain);
    const bool good = f->flow && f->turning && f->strain;
    for (size_t s = 0; good && s < f->frames; s++) {
        const double time = f->begin + (double)s * f->every * f->dt;
        double before[3][3], after[3][3], end = 0.0;
        bool near = false;
        memcpy(f->turning[s], f->m.gradient, sizeof f->m.gradient);
        for (int k = 0; k < 9; k++)
            f->strain[s][k / 3][k % 3] = f->m.gradient[k / 3][k % 3] * time;
        for (size_t n = 0; s > 0 && n < f->stages; n++) {
            end += f->stage[n].duration;
            near = near || fabs(time - end) < (1.0 - 1e-9) * f->dt;
        }
        if (f->stages) {
            theory_driven_flow(f->stage, f->stages, time + (near ? 1e-9 * f->dt : 0.0), f->turning[s], &way);
            stages_strain(f->stage, f->stages, time, f->strain[s]);
        }
        memcpy(f->flow[s], f->turning[s], sizeof f->turning[s]);
        if (near) {
            stages_strain(f->stage, f->stages, time - f->dt, before);
            stages_strain(f->stage, f->stages, time + f->dt, after);
            for (int k = 0; k < 9; k++)
                f->flow[s][k / 3][k % 3] = (after[k / 3][k % 3] - before[k / 3][k % 3]) / (2.0 * f->dt);
        }
    }
    return good;
}

void film_peculiar(const struct film *f, size_t frame, const struct track_point *p, double c[3], double w[3])
{
    double (*G)[3] = f->turning[frame];
    apply(f->flow[frame], p->x, c);
    for (int k = 0; k < 3; k++) {
        c[k] = p->u[k] - c[k];
        w[k] = p->w[k] - 0.5 * (G[(k + 2) % 3][(k + 1) % 3] - G[(k + 1) % 3][(k + 2) % 3]);
    }
}

static void find_axes(struct film *f)
{
    double fastest = 0.0;
    for (int c = 0; c < 3; c++)
        f->axis[c] = c;
    if (f->stages) {
        const struct theory_rate *first = &f->stage[0].shear[0];
        f->axis[0] = first->flow, f->axis[1] = first->gradient, f->axis[2] = 3 - first->flow - first->gradient;
    }
    for (int c = 0; c < 9; c++)
        if (fabs(f->m.gradient[c / 3][c % 3]) > fastest) {
            fastest = fabs(f->m.gradient[c / 3][c % 3]);
            f->axis[0] = c / 3, f->axis[1] = c % 3, f->axis[2] = 3 - c / 3 - c % 3;
        }
}

double film_rate(const struct film *f) { return f->m.gradient[f->axis[0]][f->axis[1]]; }

void film_stress_columns(const struct film *f, const char *origin, char columns[400])
{
    static const int pair[5][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 0 } };
    *columns = 0;
    for (int k = 0; k < 5; k++) {
        const size_t used = strlen(columns);
        snprintf(columns + used, 400 - used, "%s%s_%c%c", k ? "," : "", origin, "xyz"[f->axis[pair[k][0]]], "xyz"[f->axis[pair[k][1]]]);
    }
}

bool film_driven(const struct film *f, size_t i) { return f->m.driven[f->row[i].species - 1]; }

int film_parts(const struct film *f, const char *part[FILM_PARTS])
{
    const struct { const char *name; bool there; } all[FILM_PARTS] = { { "contact_normal", f->m.has_contact }, { "contact_tangential", f->m.contact.friction > 0.0 },
        { "repulsion", scene_get(f->scene, "forces.repulsion") != NULL }, { "lubrication", f->m.has_lubrication }, { "drag", f->m.has_drag } };
    int count = 0;
    for (int k = 0; k < FILM_PARTS; k++)
        if (all[k].there)
            part[count++] = all[k].name;
    return count;
}

/* All pairs of a frame, whose cell is that of its time; of the two images of a sphere that face each other one. */
static void find_pairs(struct film *f, size_t frame)
{
    double cell[3][3], inverse[3][3];
    size_t room = 0;
    for (int v = 0; v < 3; v++) {           /* the cell of that time: each edge is carried along */
        apply(f->strain[frame], f->start[v], cell[v]);
        for (int c = 0; c < 3; c++)
            cell[v][c] += f->start[v][c];
    }
    for (int v = 0; v < 3; v++) {
        cross(cell[(v + 1) % 3], cell[(v + 2) % 3], inverse[v]);
        for (int c = 0; c < 3; c++)
            inverse[v][c] /= f->m.volume;
    }
    for (size_t j = 0; j < f->count; j++)
        for (size_t i = 0; i <= j; i++) {
            const double *a = track_at(&f->track, frame, i)->x, *b = track_at(&f->track, frame, j)->x, d[3] = { b[0] - a[0], b[1] - a[1], b[2] - a[2] };
            double share[3];
            apply(inverse, d, share);
            for (int image = i == j ? 63 : 0; image < 125; image++) {           /* the 62nd is itself */
                const int step[3] = { image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2 };
                struct near_pair p = { .i = i, .j = j, .own = i == j, .told = film_driven(f, i) && film_driven(f, j) };
                for (int v = 0; v < 3; v++)
                    for (int c = 0; c < 3; c++)
                        p.n[c] += (share[v] - round(share[v]) + step[v]) * cell[v][c];
                p.distance = norm(p.n);
                p.gap = p.distance - film_radius(f, i) - film_radius(f, j);
                if (p.distance >= f->range)
                    continue;
                for (int c = 0; c < 3; c++)
                    p.n[c] /= p.distance;
                if (f->nears[frame] == room)
                    f->near[frame] = realloc(f->near[frame], (room = 2 * room + 64) * sizeof p);
                f->near[frame][f->nears[frame]++] = p;
            }
        }
}

/* How many lags a table of this name has. */
static size_t lags_of(const struct film *f, const char *table)
{
    char key[96];
    snprintf(key, sizeof key, "tables.%s.levels", table);
    return lags_due(scene_number(f->run->gate_case->parameters, key, NAN), f->frames);
}

/* How many rows a table must have; 0: as many as it has. */
static size_t rows_due(const struct film *f, const char *file)
{
    const json_t *p = f->run->gate_case->parameters;
    const double pairs = 0.5 * (double)(f->m.species * (f->m.species + 1));
    if (strcmp(file, "displacement.csv") == 0)
        return f->m.species * lags_of(f, "displacement");
    if (strcmp(file, "velocity_correlation.csv") == 0)
        return f->m.species * (lags_of(f, "velocity_correlation") + 1);
    if (strcmp(file, "green_kubo.csv") == 0)
        return lags_of(f, "green_kubo") + 1;
    if (strcmp(file, "pair_distribution.csv") == 0)
        return (size_t)(pairs * (scene_number(p, "tables.pair_distribution.bins", 0.0) + scene_number(p, "tables.pair_distribution.near.bins", 0.0)));
    if (strcmp(file, "pair_plane.csv") == 0)
        return (size_t)gsl_pow_2(scene_number(p, "tables.pair_distribution.plane.bins", 0.0));
    return strcmp(file, "averages.csv") == 0 ? 0 : f->frames;
}

/* The moments of a table that has a row for each of them. */
static bool moments_are_right(const struct film *f, const char *file, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    struct table t;
    path_join(path, f->out, file);
    if (!table_read(path, "step,time", &t, why))
        return false;
    bool good = true;
    for (size_t r = 0; r < t.rows && good; r++) {
        const double step = (double)r * f->every, time = f->begin + step * f->dt;
        if (table_at(&t, r, 0) != step || !time_is(table_at(&t, r, 1), time, f->dt))
            good = why_not(why, "%s: row %zu is of step %g at time %g where step %g at time %g is due", file, r + 1, table_at(&t, r, 0), table_at(&t, r, 1), step, time);
    }
    table_free(&t);
    return good;
}

/* False where the case does not ask for the table, where the candidate has not written it (skipped) or it cannot be read (recorded). */
bool film_table(const struct film *f, const char *file, const char *columns, struct table *t)
{
    char asked[64];
    snprintf(asked, sizeof asked, "tables.%.*s", (int)strcspn(file, "."), file);
    if (strcmp(file, "stress.csv") != 0 && !scene_get(f->run->gate_case->parameters, strcmp(file, "pair_plane.csv") ? asked : "tables.pair_distribution.plane"))
        return false;
    char why[WHY_LENGTH];
    const size_t due = rows_due(f, file);
    if (!check_table(f->run, f->out, file, columns, file, t))
        return false;
    bool good = !due || t->rows == due || why_not(why, "%s has %zu rows where the case asks for %zu", file, t->rows, due);
    static const char *const of_moments[] = { "temperature.csv", "contacts.csv", "viscosity.csv", "brownian_stress.csv", "stress.csv" };
    for (size_t k = 0; good && k < sizeof of_moments / sizeof *of_moments; k++)
        good = strcmp(file, of_moments[k]) != 0 || moments_are_right(f, file, why);
    if (!good) {
        check_garbage(f->run, why);
        table_free(t);
    }
    return good;
}

/* The frame of a row whose first column is the step. */
size_t film_frame(const struct film *f, const struct table *t, size_t row)
{
    const double frame = table_at(t, row, 0) / f->every;
    return frame >= 0 && frame < (double)f->frames && frame == floor(frame) ? (size_t)frame : f->frames;
}

void film_judge(const struct film *f, const char *what, const struct worst *w)
{
    check_error(f->run, INVARIANT, what, w->measured, w->expected, w->error, f->run->gate_case->tolerance,
                "%s: row %zu says %s; its own trajectory says that", what, w->at + 1, compare(w));
}

/* --- the run --- */

static bool record(struct film *f, const char *name, bool with_tables, struct track *track)
{
    json_t *scene = json_deep_copy(f->scene);
    int *at = calloc(f->frames + 1, sizeof *at);
    for (size_t k = 0; at && k < f->frames; k++)
        at[k] = (int)k * f->every;
    if (with_tables) {
        json_t *tables = json_deep_copy(json_object_get(f->run->gate_case->parameters, "tables")), *one;
        const char *key;
        json_object_foreach(tables, key, one)
        {
            json_object_set_new(one, "every", json_integer(f->every));
            json_t *output = scene_get(scene, "output");
            json_object_set(output, key, one);
        }
        json_decref(tables);
    }
    const bool good = at && track_ask(f->run, name, scene, f->row, f->count, at, f->frames, track);
    free(at);
    char folder[PATH_LENGTH];
    path_join(folder, f->run->work, name);
    if (with_tables)
        path_join(f->out, folder, "out");
    json_decref(scene);
    return good;
}

static void judge_unwatched(struct film *f)
{
    struct track plain;
    struct worst w = WORST_NONE;
    if (!record(f, "unwatched", false, &plain))
        return;
    for (size_t s = 0; s < f->frames; s++)
        for (size_t i = 0; i < f->count; i++)
            worst_see_vector(&w, track_at(&f->track, s, i)->x, track_at(&plain, s, i)->x, 9, 1.0, i);      /* x, u, w lie one after the other */
    track_free(&plain);
    check_error(f->run, INVARIANT, "the path without tables", w.measured, w.expected, w.error, 0.0, "sphere %zu moves otherwise when the tables are written: "
                "%.17g instead of %.17g", w.at + 1, w.measured, w.expected);
}

/* Every other sphere changes places with the one as far from the end, so that ids are not in the order of species. */
static void interleave(struct state_row *row, size_t count)
{
    for (size_t i = 0; i < count / 2; i += 2) {
        struct state_row *one = &row[i], *two = &row[count - 1 - i], kept = *one;
        *one = *two;
        *two = kept;
        one->id = (int)i + 1;
        two->id = (int)(count - i);
    }
}

void check_observers(struct check_run *run)
{
    const json_t *parameters = run->gate_case->parameters;
    struct film f = { .run = run, .scene = json_deep_copy(run->gate_case->scene), .frames = (size_t)scene_number(parameters, "frames", 0),
                      .every = (int)scene_number(parameters, "every", 1), .range = scene_number(parameters, "range", NAN) };
    double counts[4], packed[4];
    size_t kinds, smaller;
    char why[WHY_LENGTH] = "the gate is out of memory";
    struct packing_species kind[4];
    parameter_list(parameters, "spheres", counts, &kinds, 4);
    parameter_list(parameters, "packed_as", packed, &smaller, 4);           /* radii that do not overlap at the start, if other than those of the scene */
    if (!model_read(run, f.scene, &f.m) || f.m.species != kinds)
        return;
    for (size_t k = 0; k < kinds; k++) {
        kind[k] = (struct packing_species){ k < smaller ? packed[k] : f.m.radius[k], (int)counts[k] };
        f.count += (size_t)counts[k];
    }
    const double edge = packing_edge(kind, (int)kinds, scene_number(parameters, "phi", NAN));
    f.dt = scene_number(f.scene, "dynamics.verlet.dt", NAN);
    f.kT = scene_number(f.scene, "fluid.kT", NAN);
    f.begin = scene_number(f.scene, "start.time", 0.0);
    f.row = calloc(f.count, sizeof *f.row);
    f.near = calloc(f.frames, sizeof *f.near);
    f.nears = calloc(f.frames, sizeof *f.nears);
    scene_set(f.scene, "box.lengths", json_pack("[fff]", edge, edge, edge));
    scene_set(f.scene, "seed", json_integer(run->seed));
    scene_set(f.scene, "output.stress", json_pack("{si}", "every", f.every));
    bool good = f.row && f.near && f.nears && model_read(run, f.scene, &f.m) && packing_make(kind, (int)kinds, edge, 0.0, run->seed, f.row, why);
    if (!good)
        check_garbage(run, why);
    else
        interleave(f.row, f.count);
    for (int v = 0; v < 3; v++)
        f.start[v][v] = edge;
    f.stages = stages_read(scene_get(f.scene, "stages"), f.stage);
    find_axes(&f);
    good = good && find_flow(&f);
    for (size_t i = 0; good && i < f.count; i++) {      /* with the flow */
        struct track_point at = { .u = { 0 } };
        double c[3], w[3];
        memcpy(at.x, f.row[i].x, sizeof at.x);
        film_peculiar(&f, 0, &at, c, w);
        for (int k = 0; k < 3; k++) {
            f.row[i].u[k] = -c[k];
            f.row[i].w[k] = -w[k];
        }
    }
    good = good && record(&f, "watched", true, &f.track);
    for (size_t s = 0; good && s < f.frames; s++)
        find_pairs(&f, s);
    if (good) {
        film_judge_driven(&f);
        film_judge_temperature(&f);
        film_judge_contacts(&f);
        film_judge_viscosity(&f);
        film_judge_kinetic(&f);
        film_judge_brownian(&f);
        film_judge_lags(&f);
        film_judge_distribution(&f);
        film_judge_plane(&f);
        film_judge_stress_table(&f);
        film_judge_green_kubo(&f);
        film_judge_averages(&f);
        judge_unwatched(&f);
        track_free(&f.track);
    }
    for (size_t s = 0; f.near && s < f.frames; s++)
        free(f.near[s]);
    free(f.near);
    free(f.nears);
    free(f.flow);
    free(f.turning);
    free(f.strain);
    free(f.row);
    json_decref(f.scene);
}
