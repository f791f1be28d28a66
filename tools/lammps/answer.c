/*
 * LAMMPS's output -> the gate's files. Stress = -pressure; components and axes are renamed back to those of the scene.
 */
#include "adapter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A symmetric tensor in LAMMPS's order (xx yy zz xy xz yz) as a full one. */
static const int voigt[3][3] = { { 0, 3, 4 }, { 3, 1, 5 }, { 4, 5, 2 } };

long first_step(const struct task *t)
{
    return (t->stress_every > 0 ? t->stress_every : 1) * (t->states_every > 0 ? t->states_every : 1);
}

static void write_header(FILE *f, const struct task *t)
{
    const char *const origin[] = { t->contact ? "contact_normal" : NULL,
                                   t->contact && t->friction > 0 ? "contact_tangential" : NULL, t->drag ? "drag" : NULL, "kinetic" };
    for (int o = 0; o < 4; o++)
        for (int k = 0; origin[o] && k < 9; k++)
            fprintf(f, ",%s_%c%c", origin[o], "xyz"[k / 3], "xyz"[k % 3]);
    fprintf(f, "\n");
}

static void write_tensor(FILE *f, const struct task *t, double s[3][3])
{
    double turned[3][3];
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            turned[t->axis[a]][t->axis[b]] = s[a][b];
    for (int k = 0; k < 9; k++)
        fprintf(f, ",%.17g", turned[k / 3][k % 3]);
}

static double volume(const struct task *t)
{
    return t->edge[0] * t->edge[1] * t->edge[2];
}

/* One row: the contact stress (normal, tangential), the drag stresslets of the state, the kinetic stress. */
static void write_stress(FILE *f, const struct task *t, int state, double contact[2][3][3], double kinetic[3][3])
{
    if (t->contact)
        write_tensor(f, t, contact[0]);
    if (t->contact && t->friction > 0)
        write_tensor(f, t, contact[1]);
    if (t->drag) {  /* LAMMPS has no stresslet: (20/3) pi eta a^3 E is a constant of the scene, written down from it */
        double cubes = 0, drag[3][3] = { { 0 } };
        for (int i = 0; i < t->count; i++)
            cubes += pow(t->radius[t->particle[state * t->count + i].species - 1], 3);
        drag[0][1] = drag[1][0] = 20 * acos(-1) / 3 * t->viscosity * cubes * t->rate / 2 / volume(t);
        write_tensor(f, t, drag);
    }
    write_tensor(f, t, kinetic);
    fprintf(f, "\n");
}

/* The next line of thermodynamic output: step, six of pair pressure, six of kinetic pressure, as stresses. */
static bool next_pressure(FILE *log, long *step, double contact[3][3], double kinetic[3][3])
{
    char line[PATH_ROOM];
    while (fgets(line, sizeof line, log)) {
        double v[13];
        int found = 0;
        for (char *at = line, *end; found < 13; found++, at = end) {
            v[found] = strtod(at, &end);
            if (end == at)
                break;
        }
        if (found < 13)
            continue;
        *step = lround(v[0]);
        for (int k = 0; k < 9; k++) {
            contact[k / 3][k % 3] = -v[1 + voigt[k / 3][k % 3]];
            kinetic[k / 3][k % 3] = -v[7 + voigt[k / 3][k % 3]];
        }
        return true;
    }
    return false;
}

/* The next frame of a dump: its step, number of rows and the xy of its box; false at the end of the file. */
static bool next_frame(FILE *dump, long *step, long *rows, double *tilt)
{
    char line[PATH_ROOM];
    while (fgets(line, sizeof line, dump)) {
        const bool is_step = strncmp(line, "ITEM: TIMESTEP", 14) == 0, is_rows = strncmp(line, "ITEM: NUMBER", 12) == 0;
        const bool is_box = strncmp(line, "ITEM: BOX", 9) == 0;
        if (strncmp(line, "ITEM: ATOMS", 11) == 0 || strncmp(line, "ITEM: ENTRIES", 13) == 0)
            return true;
        if ((is_step || is_rows || is_box) && !fgets(line, sizeof line, dump))
            return false;
        if (is_step)
            *step = atol(line);
        if (is_rows)
            *rows = atol(line);
        if (is_box)
            sscanf(line, "%*f %*f %lf", tilt);
    }
    return false;
}

static void read_numbers(FILE *f, int count, double *v)
{
    for (int k = 0; k < count; k++)
        if (fscanf(f, "%lf", &v[k]) != 1)
            fail("LAMMPS's output ends in the middle of a row");
}

/*
 * Stress of frictional contacts from the list of pairs: distance, normal force (positive: repulsion), its vector, tangential force.
 * Both forces act on i; the vector of the normal force is along d = x_i - x_j, and the stress is -F (x) d.
 */
static void pair_stress(FILE *pairs, const struct task *t, long wanted, double contact[2][3][3])
{
    long step = -1, rows = 0;
    double tilt, v[8];
    memset(contact, 0, 2 * sizeof *contact);
    while (step != wanted)
        if (!next_frame(pairs, &step, &rows, &tilt))
            fail("LAMMPS wrote fewer pair lists than stresses");
    for (long r = 0; r < rows; r++) {
        read_numbers(pairs, 8, v);
        for (int k = 0; v[1] != 0 && k < 9; k++) {
            const double d = v[0] * v[2 + k % 3] / v[1];
            contact[0][k / 3][k % 3] -= v[2 + k / 3] * d / volume(t);
            contact[1][k / 3][k % 3] -= v[5 + k / 3] * d / volume(t);
        }
    }
}

void write_answer_run(const struct task *t, const char *out)
{
    const long first = first_step(t);
    long step, rows, last = -1;
    double contact[2][3][3] = { { { 0 } } }, kinetic[3][3], tilt = 0;
    if (t->stress_every > 0) {
        FILE *log = open_file(out, "lammps.log", "r"), *f = open_file(out, "stress.csv", "w");
        FILE *pairs = t->contact && t->friction > 0 ? open_file(out, "lammps.pairs", "r") : NULL;
        fprintf(f, "step,time,strain");
        write_header(f, t);
        while (next_pressure(log, &step, contact[0], kinetic)) {
            if (step % t->stress_every || step < first || step == last)
                continue;   /* printed anyway: the first and last step of each of the two runs, and so step 0 twice */
            last = step;
            if (pairs)
                pair_stress(pairs, t, step, contact);
            const double passed = (double)(step - first) * t->dt;
            fprintf(f, "%ld,%.17g,%.17g", step - first, t->time + passed, fabs(t->rate) * passed);
            write_stress(f, t, 0, contact, kinetic);
        }
        close_file(f, "stress.csv");
        fclose(log);
        if (pairs)
            fclose(pairs);
    }
    if (t->states_every > 0) {
        FILE *dump = open_file(out, "lammps.dump", "r"), *f = open_file(out, "trajectory.csv", "w");
        fprintf(f, "step,time,id,x,y,z,ux,uy,uz,wx,wy,wz\n");
        while (next_frame(dump, &step, &rows, &tilt)) {
            if (step < first)
                continue;   /* before the spheres began to move */
            tilt -= t->rate * t->edge[1] * t->dt;     /* the cell in the dump is a step ahead, see candidate.c */
            for (long r = 0; r < rows; r++) {
                double v[13], x[3], u[3], w[3];
                read_numbers(dump, 13, v);
                for (int k = 0; k < 3; k++) {
                    x[t->axis[k]] = v[4 + k] + v[1 + k] * t->edge[k] + (k == 0 ? v[2] * tilt : 0);
                    u[t->axis[k]] = v[7 + k] + (k == 0 ? v[2] * t->rate * t->edge[1] : 0);
                    w[t->axis[k]] = v[10 + k] * t->handed;
                }
                fprintf(f, "%ld,%.17g,%.0f,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", step - first,
                        t->time + (double)(step - first) * t->dt, v[0], x[0], x[1], x[2], u[0], u[1], u[2], w[0], w[1], w[2]);
            }
        }
        close_file(f, "trajectory.csv");
        fclose(dump);
    }
}

void write_answer_frozen(const struct task *t, const char *out)
{
    FILE *dump = open_file(out, "lammps.dump", "r"), *log = open_file(out, "lammps.log", "r");
    FILE *f = open_file(out, "forces.csv", "w"), *s = open_file(out, "stress.csv", "w");
    double *part = malloc(2 * (size_t)t->count * 6 * sizeof *part), kinetic[3][3], contact[2][3][3] = { { { 0 } } }, none[3][3], tilt;
    long step, rows;
    if (!part)
        fail("out of memory");
    fprintf(f, "state,force,id,fx,fy,fz,tx,ty,tz\n");
    fprintf(s, "state");
    write_header(s, t);
    for (int state = 0; state < t->states; state++) {
        for (int force = 0; force < 2; force++) {
            if (!next_frame(dump, &step, &rows, &tilt) || !next_pressure(log, &step, force ? none : contact[0], kinetic))
                fail("LAMMPS evaluated fewer states than it was given");
            for (int i = 0; i < t->count; i++) {
                double v[13];
                read_numbers(dump, 13, v);
                for (int k = 0; k < 3; k++) {
                    part[(force * t->count + i) * 6 + t->axis[k]] = v[7 + k];
                    part[(force * t->count + i) * 6 + 3 + t->axis[k]] = v[10 + k] * t->handed;
                }
            }
        }
        const char *const name[3] = { t->contact ? "contact" : NULL, t->drag ? "drag" : NULL, "total" };
        for (int force = 0; force < 3; force++)
            for (int i = 0; name[force] && i < t->count; i++) {
                fprintf(f, "%d,%s,%d", state, name[force], i + 1);
                for (int k = 0; k < 6; k++) {
                    const double c = part[i * 6 + k], d = part[(t->count + i) * 6 + k];
                    fprintf(f, ",%.17g", force == 0 ? c : force == 1 ? d : c + d);
                }
                fprintf(f, "\n");
            }
        fprintf(s, "%d", state);
        write_stress(s, t, state, contact, kinetic);
    }
    close_file(f, "forces.csv");
    close_file(s, "stress.csv");
    fclose(dump);
    fclose(log);
    free(part);
}
