/*
 * Stock LAMMPS as a candidate of the gate: what its three files share. Read candidate.c first.
 */
#ifndef ADAPTER_H
#define ADAPTER_H

#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

enum { PATH_ROOM = 1024, SPECIES_ROOM = 16 };

/* One particle in LAMMPS's axes: unwrapped position x, velocity u of that image, spin w. */
struct particle { int state, id, species; double x[3], u[3], w[3]; };

struct task {
    bool frozen;                        /* protocol `forces`; else `run` */
    double viscosity, edge[3], tilt;    /* box: cell vectors (edge0,0,0), (tilt,edge1,0), (0,0,edge2), at the start */
    int axis[3];                        /* LAMMPS's axis k is the scene's axis axis[k]: flow first, gradient second */
    double handed;                      /* -1 if that renaming mirrors space: spins and torques change sign */
    double rate;                        /* dU_flow/dx_gradient */
    int species_count;
    double radius[SPECIES_ROOM], density[SPECIES_ROOM];
    bool contact, drag, torque;
    double normal_stiffness, tangential_stiffness, friction;
    double normal_damping, tangential_damping;     /* gamma [1/T]: a dashpot m_eff gamma */
    double time, dt;
    long steps, stress_every, states_every;     /* 0: not wanted */
    int count, states;                          /* particles per state, states */
    struct particle *particle;
};

_Noreturn void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));       /* exit 1 */
_Noreturn void unsupported(const char *format, ...) __attribute__((format(printf, 1, 2))); /* exit 77 */
FILE *open_file(const char *folder, const char *name, const char *mode);
void close_file(FILE *f, const char *name);

struct task read_task(const char *case_dir);                    /* question.c: JSON and CSV -> task */
long first_step(const struct task *t);                            /* the number that LAMMPS gives to step 0 of a run */
void write_answer_frozen(const struct task *t, const char *out); /* answer.c: LAMMPS's files -> forces.csv, stress.csv */
void write_answer_run(const struct task *t, const char *out);    /* answer.c: LAMMPS's files -> stress.csv, trajectory.csv */

#endif
