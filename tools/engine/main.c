/*
 * shear-lammps: runs one scene inside LAMMPS, on as many MPI processes as mpirun starts. Rank 0 prints and writes.
 */
#include "engine.h"

#include "describe.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: [mpirun -np N] shear-lammps SCENE.json [-o DIR] [--set path=value ...] [--resume] [--skin FRACTION]\n"
    "       shear-lammps --help | --version\n"
    "\n"
    "Runs the suspension that SCENE.json describes inside LAMMPS, with the forces of shear, and writes\n"
    "the tables that shear would write to DIR (default: out), and LAMMPS's own log.\n"
    "\n"
    "  -o DIR             where to write; made if it is not there\n"
    "  --set path=value   replace one value of the scene, such as --set fluid.kT=0\n"
    "  --resume           go on from the checkpoint in DIR, be it of shear-lammps or of shear\n"
    "  --skin FRACTION    lists reach so far beyond the forces, in units of the smallest radius (default 0.15)\n"
    "\n"
    "Exit codes: 0 done, 1 the run failed, 2 the input is wrong or not the engine's, 130 interrupted.\n"
    "On clusters: docs/clusters.md.\n";

struct arguments { const char *scene, *folder, *set[64]; struct scene_options options; double skin; };

void engine_abort(const struct engine *g, const struct error *e)
{
    fprintf(stderr, "shear-lammps: rank %d: %s\n", g->rank, e->text);
    fflush(NULL);
    MPI_Abort(g->world, e->code);
    abort();
}

static bool understand(int argc, char **argv, struct arguments *a, struct error *e)
{
    *a = (struct arguments){ .folder = "out", .skin = 0.15 };
    for (int k = 1; k < argc && !error_raised(e); k++) {
        char *end = NULL;
        if (strcmp(argv[k], "--resume") == 0)
            a->options.resume = true;
        else if (strcmp(argv[k], "-o") == 0 && k + 1 < argc)
            a->folder = argv[++k];
        else if (strcmp(argv[k], "--set") == 0 && k + 1 < argc && a->options.set_count < 64)
            a->set[a->options.set_count++] = argv[++k];
        else if (strcmp(argv[k], "--skin") == 0 && k + 1 < argc) {
            a->skin = strtod(argv[++k], &end);
            if (*end || !(a->skin > 0.0))
                error_raise(e, ERROR_INPUT, "--skin is %s; it must be a number above 0", argv[k]);
        } else if (argv[k][0] != '-' && !a->scene)
            a->scene = argv[k];
        else
            error_raise(e, ERROR_INPUT, "%s: not understood here; shear-lammps --help says what is", argv[k]);
    }
    a->options.set = a->set;
    return a->scene ? !error_raised(e) : error_raise(e, ERROR_INPUT, "no scene given; shear-lammps --help says how");
}

/* Rank 0: everything that shear does, with the engine for its steps. `ready`: the others wait for orders. */
static void lead(struct engine *g, struct simulation *sim, const struct arguments *a, bool ready, struct error *e)
{
    if (ready && simulation_begin(sim, e)) {
        describe_bias(sim);
        describe_provenance(sim, a->scene, &a->options);
        char *end = sim->destination.provenance + strlen(sim->destination.provenance);
        snprintf(end, sizeof sim->destination.provenance - (size_t)(end - sim->destination.provenance), "# engine: LAMMPS, %d ranks\n", g->ranks);
        checkpoint_watch();
        sim->destination.resuming = a->options.resume;
        const bool writes = sim->observer_count > 0 || sim->checkpoint.every || a->options.resume;
        if (!writes || destination_make(&sim->destination, a->folder, e)) {
            if (writes)
                snprintf(g->log, sizeof g->log, "%s/lammps.log", sim->destination.folder);
            simulation_run(sim, e);
        }
    }
    if (ready)
        engine_dismiss(g);
}

int main(int argc, char **argv)
{
    static struct simulation sim[1];
    static struct engine g[1];
    struct arguments a;
    struct error e = { 0 };
    MPI_Init(&argc, &argv);
    *g = (struct engine){ .world = MPI_COMM_WORLD, .sim = sim, .scene = &sim->suspension };
    MPI_Comm_rank(g->world, &g->rank);
    MPI_Comm_size(g->world, &g->ranks);
    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "--version") == 0)) {
        if (g->rank == 0)
            printf("%s", argv[1][2] == 'h' ? usage : "shear-lammps " SHEAR_VERSION "\n");
        MPI_Finalize();
        return 0;
    }
    if (understand(argc, argv, &a, &e)) {
        /* The others need the forces and the liquid; cell, step and particles come from rank 0. */
        const struct scene_options without_particles = { .set = a.options.set, .set_count = a.options.set_count, .states = "", .frozen = true };
        if (scene_build(a.scene, g->rank == 0 ? &a.options : &without_particles, sim, &e) && g->rank == 0 && engine_can(sim, &e))
            engine_lead(g, sim);
    }
    g->skin = a.skin;
    int worst;
    MPI_Allreduce(&e.code, &worst, 1, MPI_INT, MPI_MAX, g->world);
    if (g->rank == 0)
        lead(g, sim, &a, worst == 0, &e);
    else if (worst == 0) {
        for (const int *s = (const int[]){ SIGINT, SIGTERM, SIGUSR1, 0 }; *s; s++)
            signal(*s, SIG_IGN);                            /* mpirun tells all ranks; rank 0 ends the run */
        engine_follow(g);
    }
    host_stop(g);
    simulation_close(sim, &e);
    if (error_raised(&e) && (g->rank == 0 || worst == 0))
        fprintf(stderr, "shear-lammps: %s\n", e.text);
    MPI_Finalize();
    return g->rank == 0 ? (error_raised(&e) ? e.code : worst) : 0;
}
