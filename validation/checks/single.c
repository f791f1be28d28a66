/* Layer 3, shared parts: asking for trajectories and reading them (single.h). */
#include "single.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct free_sphere free_sphere(const struct model *m)
{
    const double a = m->radius[0], pi = 3.14159265358979323846;
    struct free_sphere s = { .radius = a, .mass = 4.0 / 3.0 * pi * m->density[0] * a * a * a };
    s.inertia = 0.4 * s.mass * a * a;
    s.friction = 6.0 * pi * m->viscosity * a;
    s.spin_friction = 8.0 * pi * m->viscosity * a * a * a;
    return s;
}

const struct track_point *track_at(const struct track *t, size_t step, size_t sphere)
{
    return &t->point[step * t->count + sphere];
}

void track_free(struct track *t)
{
    free(t->point);
    *t = (struct track){ 0 };
}

/* Rows of other steps (the start, say) are ignored; each row asked for must be there once. */
/* The step of whichever scheme the scene names; NaN if it is not a number. */
static double step_of(const json_t *scene)
{
    const char *key;
    json_t *scheme;
    json_object_foreach(scene_get(scene, "dynamics"), key, scheme)
        return scene_number(scheme, "dt", NAN);
    return NAN;
}

size_t lag_of(size_t k) { return k <= 16 ? k : (9 + (k - 17) % 8) << (1 + (k - 17) / 8); }

size_t lags_due(double levels, size_t samples)
{
    size_t due = 0;
    while ((double)due < 16.0 + 8.0 * (levels - 1.0) && lag_of(due + 1) < samples)
        due++;
    return due;
}

bool time_is(double said, double time, double dt) { return fabs(said - time) <= 1e-3 * dt + 1e-5 * fabs(time); }

struct clock { double begin, dt; const struct state_row *start; /* NULL: not known */ };

/* Whether a row is of its moment, and of a sphere of its species; however few digits the time has. */
static bool row_is_right(const struct table *t, size_t r, const struct clock *c, char why[WHY_LENGTH])
{
    const double step = table_at(t, r, 0), id = table_at(t, r, 1), said = table_at(t, r, 14), species = table_at(t, r, 15), time = c->begin + step * c->dt;
    if (isfinite(said) && isfinite(time) && !time_is(said, time, c->dt))
        return why_not(why, "%s: step %g has the time %g where %g is due", t->path, step, said, time);
    if (c->start && isfinite(species) && species != c->start[(size_t)id - 1].species)
        return why_not(why, "%s: particle %g is of species %g where the start says %d", t->path, id, species, c->start[(size_t)id - 1].species);
    return true;
}

static bool track_read(const char *path, const int *at, const struct clock *clock, struct track *t, char why[WHY_LENGTH])
{
    struct table table;
    if (!table_read(path, "step,id,x,y,z,ux,uy,uz,wx?,wy?,wz?,turn_x?,turn_y?,turn_z?,time?,species?", &table, why))
        return false;
    const size_t rows = t->steps * t->count;
    bool *found = calloc(rows, sizeof *found), good = found != NULL;
    size_t missing = rows, k = 0;
    for (size_t r = 0; r < table.rows && good; r++) {
        const double step = table_at(&table, r, 0), id = table_at(&table, r, 1);
        while (k < t->steps && step > at[k])            /* rows come in order of time, as a rule */
            k++;
        if (k == t->steps || step != at[k])
            for (k = 0; k < t->steps && step != at[k];)
                k++;
        if (k == t->steps) {
            k = 0;
            continue;
        }
        if (id < 1 || id > (double)t->count || id != floor(id)) {
            good = why_not(why, "%s: step %g has a particle with id %g; ids are 1 to %zu", path, step, id, t->count);
            break;
        }
        const size_t row = k * t->count + (size_t)id - 1;
        if (found[row]) {
            good = why_not(why, "%s: particle %g has two rows at step %g", path, id, step);
            break;
        }
        if (clock && !(good = row_is_right(&table, r, clock, why)))
            break;
        found[row] = true;
        missing--;
        double *value = t->point[row].x;     /* x, u, w, turn lie one after the other */
        for (size_t c = 0; c < 12; c++)
            value[c] = table_at(&table, r, 2 + c);
    }
    for (size_t row = 0; row < rows && good && missing > 0; row++)
        if (!found[row])
            good = why_not(why, "%s: no row for particle %zu at step %d", path, row % t->count + 1, at[row / t->count]);
    free(found);
    table_free(&table);
    return good;
}

void track_want(json_t *scene, const int *at, size_t steps)
{
    json_t *list = json_array();
    for (size_t k = 0; k < steps; k++)
        json_array_append_new(list, json_integer(at[k]));
    scene_set(scene, "start.file", json_string("states.csv"));
    scene_set(scene, "run", json_pack("{si}", "steps", at[steps - 1]));
    scene_set(scene, "output.states", json_pack("{so}", "at", list));
    const char *rotation = json_string_value(scene_get(scene, "dynamics.verlet.rotation"));
    if (rotation && strcmp(rotation, "on") == 0)
        scene_set(scene, "output.states.turn", json_true());
}

static bool load(struct check_run *run, const char *out, const int *at, size_t steps, size_t count, const struct clock *clock, struct track *t)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    *t = (struct track){ .steps = steps, .count = count, .point = calloc(steps * count, sizeof *t->point) };
    path_join(path, out, "trajectory.csv");
    if (t->point && track_read(path, at, clock, t, why))
        return true;
    check_garbage(run, t->point ? why : "the gate is out of memory");
    track_free(t);
    return false;
}

bool track_load(struct check_run *run, const char *out, const int *at, size_t steps, size_t count, struct track *t)
{
    return load(run, out, at, steps, count, NULL, t);
}

bool track_ask(struct check_run *run, const char *name, json_t *scene, const struct state_row *start, size_t count, const int *at,
               size_t steps, struct track *t)
{
    char out[PATH_LENGTH];
    track_want(scene, at, steps);
    const struct question q = { .protocol = "run", .scene = scene, .state = start, .states = count };
    const struct clock clock = { scene_number(scene, "start.time", 0.0), step_of(scene), start };
    return check_ask(run, name, &q, out) && load(run, out, at, steps, count, &clock, t);
}

const struct check single_checks[] = { { "single-langevin", check_langevin }, { "single-shear", check_shear }, { "single-tether", check_tether },
                                       { "single-stages", check_stages }, { "single-stages-drawn", check_stages_drawn }, { "run-length", check_run_length },     { "single-thermal", check_thermal }, { "random-start", check_random_start }, { "stages-moments", check_stages_moments }, { "single-stages-pair", check_stages_pair },
                                       { "single-noise-period", check_noise_period }, { NULL, NULL } };
