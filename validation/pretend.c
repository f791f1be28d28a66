/* Invented answers (offline.h): of the right form, without sense, and others in the second pass. */
#include "geometry.h"
#include "offline.h"
#include "plain.h"
#include "precision.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct invention { uint64_t state; };

/* About normal, of size 1 (xorshift64*, sum of four uniform numbers). */
static double invent(struct invention *i)
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        i->state ^= i->state >> 12;
        i->state ^= i->state << 25;
        i->state ^= i->state >> 27;
        sum += ldexp((double)(i->state * UINT64_C(2685821657736338717) >> 11), -53) - 0.5;
    }
    return sqrt(3) * sum;
}

static FILE *open_table(const char *out, const char *name)
{
    char path[PATH_LENGTH];
    path_join(path, out, name);
    return fopen(path, "w");
}

static void invent_row(struct invention *i, FILE *file, int numbers)
{
    for (int k = 0; k < numbers; k++)
        fprintf(file, ",%.6g", invent(i));
    fputc('\n', file);
}

static const char *const origins[] = { "contact_normal", "contact_tangential", "repulsion", "lubrication", "drag", "lubrication_noise", "kinetic" };

static void stress_header(FILE *file, const char *keys)
{
    fputs(keys, file);
    for (int o = 0; o < 7; o++)
        for (int k = 0; k < 9; k++)
            fprintf(file, ",%s_%c%c", origins[o], "xyz"[k / 3], "xyz"[k % 3]);
    fputc('\n', file);
}

static void drag_row(FILE *file, const struct state_row *r, const char *force, double drag)
{
    fprintf(file, "%d,%s,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", r->state, force, r->id, -drag * r->u[0], -drag * r->u[1], -drag * r->u[2],
            -drag * r->w[0], -drag * r->w[1], -drag * r->w[2]);
}

static bool pretend_forces(struct invention *i, const struct question *q, const char *out)
{
    json_t *forces = scene_get(q->scene, "forces"), *force;
    FILE *file = open_table(out, "forces.csv"), *stress = open_table(out, "stress.csv");
    const char *name;
    if (!file || !stress)
        return false;
    fputs("state,force,id,fx,fy,fz,tx,ty,tz\n", file);
    stress_header(stress, "state");
    const double drag = 1 + 0.1 * fabs(invent(i));      /* one for all: a resistance measured from such forces is symmetric and positive */
    for (size_t r = 0; r < q->states; r++) {
        json_object_foreach(forces, name, force)
            drag_row(file, &q->state[r], name, drag);
        drag_row(file, &q->state[r], "total", drag);
        if (r == 0 || q->state[r].state != q->state[r - 1].state) {
            fprintf(stress, "%d", q->state[r].state);
            invent_row(i, stress, 63);
        }
    }
    fclose(file);
    return fclose(stress) == 0;
}

/* One frame: everybody near its place. */
static void pretend_frame(struct invention *i, FILE *file, const struct question *q, size_t count, const char *keys, double rate)
{
    for (size_t r = 0; r < count; r++) {
        const struct state_row *row = q->states ? &q->state[r] : NULL;
        fprintf(file, "%s,%zu", keys, r + 1);
        for (int k = 0; k < 3; k++)
            fprintf(file, ",%.17g", row ? row->x[k] + 1e-3 * invent(i) : 10 * invent(i));
        for (int k = 0; k < 6; k++)
            fprintf(file, ",%.17g", (row && k < 3 ? row->u[k] : row ? row->w[k - 3] : 0) + (0.1 + fabs(rate)) * invent(i));
        fprintf(file, ",%d", row ? row->species : 1);
        invent_row(i, file, 3);
    }
}

static const char trajectory_columns[] = "step,time,id,x,y,z,ux,uy,uz,wx,wy,wz,species,turn_x,turn_y,turn_z\n";

static bool pretend_run(struct invention *i, const struct question *q, const char *out)
{
    const double n = question_steps(q->scene), rate = scene_number(json_array_get(scene_get(q->scene, "shear"), 0), "rate", 0);
    const double begin = scene_number(q->scene, "start.time", 0.0), dt = question_dt(q->scene), frames = scene_number(q->scene, "output.states.every", 0), tables = scene_number(q->scene, "output.stress.every", 0);
    const json_t *at = scene_get(q->scene, "output.states.at");
    const size_t count = q->states ? q->states : (size_t)scene_number(q->scene, "start.random.count", 1);
    FILE *file = open_table(out, "trajectory.csv"), *stress = open_table(out, "stress.csv");
    size_t k;
    json_t *step;
    char keys[80];
    if (!file || !stress)
        return false;
    fputs(trajectory_columns, file);
    json_array_foreach(at, k, step)
    {
        snprintf(keys, sizeof keys, "%lld,%.17g", (long long)json_integer_value(step), begin + dt * json_number_value(step));
        pretend_frame(i, file, q, count, keys, rate);
    }
    for (double s = 0; frames > 0 && s <= n; s += frames) {
        snprintf(keys, sizeof keys, "%.0f,%.17g", s, begin + s * dt);
        pretend_frame(i, file, q, count, keys, rate);
    }
    stress_header(stress, "step,time,strain");
    for (double s = 0; tables > 0 && s <= n; s += tables) {
        fprintf(stress, "%.0f,%.17g,%.17g", s, begin + s * dt, s * dt * fabs(rate));
        if (s + tables <= n)
            invent_row(i, stress, 63);
        else    /* whatever was held together has parted */
            for (int c = 0; c < 63; c++)
                fputs(c < 62 ? ",0" : ",0\n", stress);
    }
    fclose(file);
    return fclose(stress) == 0;
}

/* Velocities of the start are those given: others would be an error. */
static bool pretend_steps(struct invention *i, const struct question *q, const char *out)
{
    FILE *file = open_table(out, "trajectory.csv"), *stress = open_table(out, "stress.csv");
    if (!file || !stress)
        return false;
    fprintf(file, "state,%s", trajectory_columns);
    stress_header(stress, "state");
    for (size_t r = 0; r < q->states; r++) {
        const struct state_row *row = &q->state[r];
        for (size_t step = 0; step <= q->steps; step++) {
            fprintf(file, "%d,%zu,0,%d,%.17g,%.17g,%.17g", row->state, step, row->id, row->x[0], row->x[1], row->x[2]);
            for (int k = 0; k < 6; k++)
                fprintf(file, ",%.17g", (k < 3 ? row->u[k] : row->w[k - 3]) + (step ? 1e-3 * invent(i) : 0));
            fprintf(file, ",%d", row->species);
            invent_row(i, file, 3);
        }
        if (r == 0 || row->state != row[-1].state) {
            fprintf(stress, "%d", row->state);
            invent_row(i, stress, 63);
        }
    }
    fclose(file);
    return fclose(stress) == 0;
}

static bool pretend_draws(struct invention *i, const char *out, const char *name, size_t rows, size_t particles)
{
    char path[PATH_LENGTH], why[WHY_LENGTH];
    double *value = malloc(rows * particles * 6 * sizeof *value);
    for (size_t k = 0; k < rows * particles * 6; k++)
        value[k] = invent(i);
    path_join(path, out, name);
    const bool good = npy_write(path, rows, particles, value, why);
    free(value);
    return good;
}

bool offline_pretend(const struct offline *o, const struct question *q, const char *out)
{
    struct invention i = { .state = 0x9e3779b97f4a7c15u * o->pass };
    size_t particles = 0;
    while (particles < q->states && q->state[particles].state == q->state[0].state)
        particles++;
    if (strcmp(q->protocol, "forces") == 0)
        return pretend_forces(&i, q, out);
    if (strcmp(q->protocol, "run") == 0)
        return pretend_run(&i, q, out);
    if (strcmp(q->protocol, "steps") == 0)
        return pretend_steps(&i, q, out);
    if (strcmp(q->protocol, "friction") == 0)
        return pretend_draws(&i, out, "friction.npy", q->states / particles * q->draws, particles);
    return pretend_draws(&i, out, "noise_drag_noise.npy", q->draws, particles) && pretend_draws(&i, out, "noise_lubrication_noise.npy", q->draws, particles);
}
