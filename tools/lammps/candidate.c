/*
 * Stock LAMMPS as a candidate: `lammps-candidate CASE_DIR OUT_DIR`. A worked example of an adapter: read the question
 * (question.c), write the input of the code under test (here), run it, turn its output into the gate's files (answer.c).
 * Nothing of our own solver is used. What LAMMPS's stock styles cannot compute exactly ends with exit code 77 and the reason.
 *
 * How LAMMPS (29 Sep 2021) differs from docs/formats.md, and what is done about it:
 *
 *   contact    gran/hooke/history, with dashpots where the scene has them: F = k_n delta, tangential spring with Coulomb cap, full radii
 *              as lever arms. gran/hooke (no history) where there is no friction.
 *   drag       fix langevin at T = 0 is -(m/damp) u. damp = m/(6 pi eta a) of species 1, `scale` for the others. With the
 *              bias of compute temp/deform, u is taken relative to the box's flow h_rate * lamda = rate (y - ylo); the cell
 *              therefore starts at y = 0, so that this is U_inf. Torque only in a fluid at rest: `omega yes` is
 *              -8 pi eta a^3 w (its 10/3 times 2/5 m a^2/damp), towards no spin.
 *   velocities laboratory ones, as ours. Image velocities need `remap v` and `comm_modify vel yes`.
 *   step       velocity Verlet; contact history and drag see positions at t + dt and half-step velocities.
 *   lagging    fix deform moves the cell at the end of a step, so the forces of step n + 1 see the cell of step n. Here a first
 *   cell       step lets only the cell move (no sphere belongs to the group that is integrated), and the spheres follow:
 *              from then on forces see the cell of their own time. `run` is told when the whole began and ends (`start`,
 *              `stop`), which also removes the trap of `run 0`, where the flow rate would be zero.
 *   remap      where the cell flips to the opposite tilt, fix deform wraps spheres that are outside at that moment without changing
 *              their velocity (pre_exchange: domain->remap), which kicks them by rate x edge; LAMMPS pull request 4577 mends it. So the
 *              cell never flips here: the tilt runs from minus to plus half of what it changes by (question.c), up to 16 strains.
 *   friction   that first step would advance the history of a pair that already touches: such a start is refused.
 *   stress     pressure is positive in compression: stress = -pressure; xy is r_x F_y. It has six components only, which
 *              is all for central forces; with friction the pair forces are read one by one (answer.c).
 *   steps      counted from M, a multiple of all output intervals, because fixes and dumps act at multiples of theirs.
 */
#include "adapter.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const double pi = 3.14159265358979323846;

_Noreturn void fail(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    fprintf(stderr, "lammps-candidate: ");
    vfprintf(stderr, format, list);
    fprintf(stderr, "\n");
    va_end(list);
    exit(1);
}

_Noreturn void unsupported(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vfprintf(stderr, format, list);
    fprintf(stderr, "\n");
    va_end(list);
    exit(77);
}

FILE *open_file(const char *folder, const char *name, const char *mode)
{
    char path[PATH_ROOM];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, mode);
    if (!f)
        fail("cannot open %s", path);
    return f;
}

void close_file(FILE *f, const char *name)
{
    const bool bad = ferror(f) != 0;
    if (fclose(f) || bad)
        fail("cannot write %s", name);
}

/* Particles of one state, each in the cell with its image counts: read_data would wrap x but leave u as it is. */
static void write_data(const struct task *t, int state, const char *out)
{
    char name[64];
    snprintf(name, sizeof name, "lammps-%d.data", state);
    FILE *f = open_file(out, name, "w");
    fprintf(f, "spheres\n\n%d atoms\n%d atom types\n\n", t->count, t->species_count);
    for (int k = 0; k < 3; k++)
        fprintf(f, "0 %.17g %clo %chi\n", t->edge[k], "xyz"[k], "xyz"[k]);
    fprintf(f, "%.17g 0 0 xy xz yz\n\nAtoms # sphere\n\n", t->tilt);
    const struct particle *p = t->particle + (size_t)state * (size_t)t->count;
    for (int i = 0; i < t->count; i++, p++) {
        const double nz = floor(p->x[2] / t->edge[2]), ny = floor(p->x[1] / t->edge[1]);
        const double x = p->x[0] - ny * t->tilt, nx = floor((x - t->tilt * (p->x[1] / t->edge[1] - ny)) / t->edge[0]);
        fprintf(f, "%d %d %.17g %.17g %.17g %.17g %.17g %.0f %.0f %.0f\n", p->id, p->species, 2 * t->radius[p->species - 1],
                t->density[p->species - 1], x - nx * t->edge[0], p->x[1] - ny * t->edge[1], p->x[2] - nz * t->edge[2],
                nx, ny, nz);
    }
    fprintf(f, "\nVelocities\n\n");
    p = t->particle + (size_t)state * (size_t)t->count;
    for (int i = 0; i < t->count; i++, p++)
        fprintf(f, "%d %.17g %.17g %.17g %.17g %.17g %.17g\n", p->id, p->u[0] - floor(p->x[1] / t->edge[1]) * t->rate * t->edge[1],
                p->u[1], p->u[2], p->w[0], p->w[1], p->w[2]);
    close_file(f, name);
}

static double relaxation_time(const struct task *t, int species)
{
    const double a = t->radius[species], mass = 4 * pi / 3 * t->density[species] * a * a * a;
    return mass / (6 * pi * t->viscosity * a);
}

/* Everything from the data file to the computes; `contact` and `drag` switch the two forces. */
static void write_physics(FILE *f, const struct task *t, int state, bool contact, bool drag)
{
    double smallest = t->radius[0], largest = smallest;
    for (int k = 1; k < t->species_count; k++) {
        smallest = fmin(smallest, t->radius[k]);
        largest = fmax(largest, t->radius[k]);
    }
    fprintf(f, "clear\nunits lj\natom_style sphere\nboundary p p p\nnewton off\ncomm_modify vel yes\nbox tilt large\n"
               "read_data lammps-%d.data\n", state);
    if (contact && t->friction > 0)
        fprintf(f, "pair_style gran/hooke/history %.17g %.17g %.17g %.17g %.17g %d\npair_coeff * *\n", t->normal_stiffness,
                t->tangential_stiffness, t->normal_damping, t->tangential_damping, t->friction, t->tangential_damping > 0);
    else if (contact)
        fprintf(f, "pair_style gran/hooke %.17g 0 %.17g 0 0 0\npair_coeff * *\n", t->normal_stiffness, t->normal_damping);
    else
        fprintf(f, "pair_style zero %.17g\npair_coeff * *\n", 2 * largest);
    /* The skin costs neighbours, but LAMMPS also rebuilds its lists when a corner of the sheared cell has moved half of it. */
    fprintf(f, "neighbor %.17g bin\nneigh_modify every 1 delay 0 check yes\n"
               "fix flow all deform 1 xy erate %.17g remap v flip no\n"
               "compute c all temp/deform\n"
               "compute pp all pressure NULL pair\ncompute pk all pressure c ke\n"
               "thermo_style custom step c_pp[1] c_pp[2] c_pp[3] c_pp[4] c_pp[5] c_pp[6] "
               "c_pk[1] c_pk[2] c_pk[3] c_pk[4] c_pk[5] c_pk[6]\nthermo_modify format float %%.17g lost error\n",
            fmax(0.3 * smallest, fmin(1.2 * smallest, 0.08 * t->edge[1])), t->rate);
    if (drag) {
        fprintf(f, "fix drag all langevin 0 0 %.17g 1", relaxation_time(t, 0));
        for (int k = 1; k < t->species_count; k++)
            fprintf(f, " scale %d %.17g", k + 1, relaxation_time(t, k) / relaxation_time(t, 0));
        fprintf(f, " omega %s\nfix_modify drag temp c\n", t->torque ? "yes" : "no");
    }
}

static void write_frozen(FILE *f, const struct task *t)
{
    for (int state = 0; state < t->states; state++)
        for (int force = 0; force < 2; force++) {   /* contact, then drag: one frame of forces in the dump for each */
            write_physics(f, t, state, force == 0 && t->contact, force == 1 && t->drag);
            fprintf(f, "timestep 1\ndump s all custom 1 lammps.dump id ix iy iz x y z fx fy fz tqx tqy tqz\n"
                       "dump_modify s append yes sort id format float %%.17g\nrun 0 start 0 stop 1000\n");
        }
}

static void write_run(FILE *f, const struct task *t)
{
    const long first = first_step(t);
    write_physics(f, t, 0, t->contact, t->drag);
    fprintf(f, "reset_timestep %ld\ntimestep %.17g\ngroup moving empty\nfix move moving nve/sphere\nthermo %ld\n", first - 1, t->dt,
            t->stress_every);
    if (t->states_every > 0)
        fprintf(f, "dump s all custom %ld lammps.dump id ix iy iz x y z vx vy vz omegax omegay omegaz\n"
                   "dump_modify s sort id format float %%.17g\n", t->states_every);
    if (t->stress_every > 0 && t->contact && t->friction > 0)
        fprintf(f, "compute pairs all pair/local dist force fx fy fz p1 p2 p3\n"
                   "dump p all local %ld lammps.pairs c_pairs[*]\ndump_modify p format float %%.17g\n", t->stress_every);
    /* One step in which only the cell moves, then all steps of the run; `pre no` keeps the forces and the lists. */
    fprintf(f, "run 1 start %ld stop %ld\ngroup moving union all\nrun %ld start %ld stop %ld pre no\n", first - 1,
            first + t->steps, t->steps, first - 1, first + t->steps);
}

static void run_lammps(const char *out)
{
    const char *program = getenv("LMP") ? getenv("LMP") : "lmp";
    char log[PATH_ROOM], line[PATH_ROOM], error[PATH_ROOM] = "";
    snprintf(log, sizeof log, "%s/lammps.log", out);
    const pid_t child = fork();
    if (child == 0) {
        if (chdir(out) == 0)    /* so the deck names its files without a folder and can be run again by hand */
            execlp(program, program, "-in", "in.lammps", "-log", "lammps.log", "-screen", "none", "-nocite", (char *)NULL);
        _exit(127);
    }
    int status;
    if (child < 0 || waitpid(child, &status, 0) < 0)
        fail("cannot start a process");
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        fail("the LAMMPS program \"%s\" was not found (Debian package lammps; or give its full path in the environment variable LMP)",
             program);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return;
    FILE *f = fopen(log, "r");
    while (f && fgets(line, sizeof line, f))
        if (strncmp(line, "ERROR", 5) == 0)
            snprintf(error, sizeof error, "%s", line);
    fail("LAMMPS stopped: %s (see %s)", error[0] ? error : "no message", log);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: lammps-candidate CASE_DIR OUT_DIR\n");
        return 2;
    }
    const struct task t = read_task(argv[1]);
    for (int state = 0; state < t.states; state++)
        write_data(&t, state, argv[2]);
    close_file(open_file(argv[2], "lammps.dump", "w"), "lammps.dump");  /* frozen states append to it */
    FILE *deck = open_file(argv[2], "in.lammps", "w");
    (t.frozen ? write_frozen : write_run)(deck, &t);
    close_file(deck, "in.lammps");
    run_lammps(argv[2]);
    (t.frozen ? write_answer_frozen : write_answer_run)(&t, argv[2]);
    free(t.particle);
    return 0;
}
