/*
 * retrace CASE_DIR OUT_DIR: the path that LAMMPS went in OUT_DIR, gone again by `shear` piece by piece
 *
 * Two codes that take the same steps part where rounding is multiplied by collisions, and then only means can be compared, at the price of
 * many runs. Here `shear` is put at every recorded state of the other code (places, velocities, spins, forces, torques, number of the step) and goes on
 * to the next one: pieces too short for chaos, which together are the whole run. A step that the codes do differently, however late or rare, is one bad
 * piece; two codes that agree in all pieces, in motion and in stress, can have different means by chance alone.
 *
 * Prints a line per piece: its last step, the largest differences of places, velocities, spins, forces and stress, and the particle
 * that is farthest off. The exit code is 1 if a place is off by more than 1e-9, or a stress by more than 1e-8 of the largest: pieces are rounded to some
 * 1e-13, chaos multiplies that in a few thousand steps by far less than 1e4, and stiff contacts make stresses ten times as sensitive. For velocity Verlet, which goes on from the forces of the last step. What contacts remember is not in the
 * tables and stays that of `shear`.
 */
#include "scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 8000, VALUES = 15 };      /* of a particle: x, u, w, force, torque, three each */
static const double ALLOWED = 1e-9, ALLOWED_STRESS = 1e-8;

static void stop(const char *what, const char *which)
{
    fprintf(stderr, "retrace: %s%s\n", which, what);
    exit(2);
}

/* The larger; NaN stays, and is within no limit. */
static double worse(double a, double b) { return a != a || b <= a ? a : b; }

/* A table of OUT_DIR behind its first line, which must begin with `columns` and goes to `head`. */
static FILE *table(const char *folder, const char *name, const char *columns, char head[HEAD])
{
    char path[1000];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "r");
    if (!f || !fgets(head, HEAD, f) || strncmp(head, columns, strlen(columns)) != 0)
        stop(" cannot be read, or has other columns than lammps-candidate --own reference writes", path);
    return f;
}

/* The next recorded state: rows of one step in the order of the ids. False at the end of the table. */
static bool next_state(FILE *f, int particles, int64_t *step, double (*value)[VALUES])
{
    for (int i = 0; i < particles; i++) {
        char line[2000], *at = line;
        if (!fgets(line, sizeof line, f))
            return false;
        *step = strtoll(at, &at, 10);
        const double time = strtod(at + 1, &at);
        const long id = strtol(at + 1, &at, 10);
        if (id != i + 1 || !(time >= 0.0))
            stop("trajectory.csv is not sorted by step and id", "");
        for (int k = 0; k < VALUES; k++)
            value[i][k] = strtod(at + 1, &at);
    }
    return true;
}

static void put(vec3 *v, const double *from) { *v = vec(from[0], from[1], from[2]); }

/* The suspension at a recorded state. Places there are unwrapped: they count as not yet wrapped, and the search for pairs wraps them. */
static void put_at(struct suspension *s, int64_t step, double (*value)[VALUES])
{
    struct particles *p = &s->particles;
    s->step = step;
    for (int i = 0; i < p->count; i++) {
        const double *v = value[p->tag[i] - 1];
        put(&p->position[i], v);
        put(&p->velocity[i], v + 3);
        put(&p->spin[i], v + 6);
        put(&p->force[i], v + 9);
        put(&p->torque[i], v + 12);
        memset(p->image[i], 0, sizeof p->image[i]);
    }
}

static double off(vec3 a, const double *b) { return norm(minus(a, vec(b[0], b[1], b[2]))); }

/* Where the column `name` of stress.csv is in `s`: every column behind step, time and strain is one component of an origin. */
static double component(const struct stress *s, const char *name)
{
    for (int o = 0; o < s->origins; o++) {
        const size_t n = strlen(s->name[o]);
        if (strncmp(name, s->name[o], n) == 0 && name[n] == '_' && strcspn(name, ",\n") == n + 3)
            return s->sum[o].m[name[n + 1] - 'x'][name[n + 2] - 'x'];
    }
    char column[80];
    snprintf(column, sizeof column, "%.*s", (int)strcspn(name, ",\n"), name);
    stop(" is a column of stress.csv that shear does not have", column);
    return NAN;
}

/* The largest difference of stress from the row of this step. `largest`: the largest component so far. */
static double stress_off(const struct stress *s, FILE *f, const char *head, int64_t step, double *largest)
{
    char line[HEAD];
    do
        if (!fgets(line, sizeof line, f))
            stop("stress.csv ends before the trajectory", "");
    while (strtoll(line, NULL, 10) != step);
    double worst = 0.0;
    const char *name = head, *cell = line;
    for (int column = 0; name && cell; column++, name = strchr(name, ','), cell = strchr(cell, ',')) {
        name += column > 0, cell += column > 0;
        if (column < 3)
            continue;
        const double value = strtod(cell, NULL);
        *largest = fmax(*largest, fabs(value));
        worst = worse(worst, fabs(component(s, name) - value));
    }
    return worst;
}

/* One step, its stress summed up if the next recorded state is that of its end. */
static bool step_once(struct simulation *sim, bool last, struct error *e)
{
    struct suspension *s = &sim->suspension;
    bool relisted;
    s->measuring = last;
    if (last)
        stress_clear(&s->stress);
    if (!sim->dynamics->step(sim->dynamics, s, &relisted, e))
        return false;
    if (last) {
        stress_kinetic(&s->stress, s->kinetic_origin, &s->box, &s->particles);
        stress_finish(&s->stress, s->box.volume);
    }
    return true;
}

static double report(const struct suspension *s, double (*value)[VALUES], double stress)
{
    const struct particles *p = &s->particles;
    double worst[4] = { 0.0 };
    int who = 0;
    for (int i = 0; i < p->count; i++) {
        const double *v = value[p->tag[i] - 1];
        const vec3 taken = box_unwrapped(&s->box, p->image[i]);
        const double place = off(plus(p->position[i], taken), v);
        if (!(place <= worst[0]))
            who = p->tag[i];
        worst[0] = worse(worst[0], place);
        worst[1] = worse(worst[1], off(plus(p->velocity[i], box_flow(&s->box, taken)), v + 3));
        worst[2] = worse(worst[2], off(p->spin[i], v + 6));
        worst[3] = worse(worst[3], off(p->force[i], v + 9));
    }
    printf("%lld,%.3g,%.3g,%.3g,%.3g,%.3g,%d\n", (long long)s->step, worst[0], worst[1], worst[2], worst[3], stress, who);
    return worst[0];
}

int main(int argc, char **argv)
{
    if (argc != 3)
        stop("usage: retrace CASE_DIR OUT_DIR", "");
    static struct simulation sim[1];
    struct error e = { 0 };
    char scene[1000];
    snprintf(scene, sizeof scene, "%s/scene.json", argv[1]);
    const struct scene_options options = { 0 };
    if (!scene_build(scene, &options, sim, &e) || !simulation_begin(sim, &e))
        stop(e.text, "");
    struct suspension *s = &sim->suspension;
    if (strcmp(sim->dynamics->name, "verlet") != 0 || !s->particles.spin)
        stop("only velocity Verlet with spins can go on from recorded forces", "");
    double (*value)[VALUES] = calloc((size_t)s->particles.count, sizeof *value);
    char head[HEAD];
    FILE *f = table(argv[2], "trajectory.csv", "step,time,id,x,y,z,ux,uy,uz,wx,wy,wz,fx,fy,fz,tx,ty,tz\n", head);
    FILE *stresses = table(argv[2], "stress.csv", "step,time,strain,contact_normal_xx,", head);
    int64_t step, begin;
    if (!value || !next_state(f, s->particles.count, &begin, value))
        stop("trajectory.csv has no state", "");
    const int64_t first = begin;
    long pieces = 0;
    double worst = 0.0, worst_stress = 0.0, largest_stress = 0.0;
    printf("step,place,velocity,spin,force,stress,particle\n");
    for (put_at(s, begin, value); next_state(f, s->particles.count, &step, value); put_at(s, step, value), pieces++) {
        while (s->step < step)
            if (!step_once(sim, s->step + 1 == step, &e))
                stop(e.text, "");
        const double stress = stress_off(&s->stress, stresses, head, step, &largest_stress);
        worst = worse(worst, report(s, value, stress));
        worst_stress = worse(worst_stress, stress);
        fflush(stdout);
    }
    const bool good = pieces > 0 && worst <= ALLOWED && worst_stress <= ALLOWED_STRESS * largest_stress;
    printf("retrace: %ld pieces from step %lld to %lld: places agree to %.2g, stresses to %.2g: %s\n", pieces, (long long)first, (long long)s->step, worst,
           worst_stress, good ? "the same steps" : "NOT THE SAME STEPS");
    fclose(f);
    fclose(stresses);
    free(value);
    simulation_close(sim, &e);
    return good ? 0 : 1;
}
