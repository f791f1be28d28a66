/*
 * shear: runs one scene. The program alone prints and exits; everything below it returns errors.
 */
#include "describe.h"
#include "evaluate.h"
#include "export.h"
#include "scene.h"

#include <stdio.h>
#include <string.h>

static const char usage[] =
    "usage: shear SCENE.json [-o DIR] [--set path=value ...] [--check] [--resume] [--export lammps DIR]\n"
    "       shear --evaluate CASE_DIR OUT_DIR\n"
    "       shear --help | --version\n"
    "\n"
    "Runs the suspension of SCENE.json and writes the tables that it asks for to DIR (default: out).\n"
    "\n"
    "  -o DIR             where to write; made if it is not there\n"
    "  --set path=value   replace one value of the scene, such as --set fluid.kT=0 or --set species[0].radius=1.3\n"
    "  --check            say what would be built, its time scales and its step limit, and stop\n"
    "  --resume           go on from the checkpoint in DIR, bit for bit (Ctrl-C writes one)\n"
    "  --export lammps DIR  write a LAMMPS deck and data file instead of running; refuse what stock styles cannot do\n"
    "  --evaluate         a case of the gate: frozen states in, forces, torques and stresses out; or noise draws; or a run\n"
    "\n"
    "Exit codes: 0 done, 1 the run failed, 2 the input is wrong, 77 not supported, 130 interrupted.\n"
    "Formats: docs/formats.md.\n";

static void run_scene(const char *scene, const char *folder, const struct scene_options *options, bool check, struct error *e)
{
    static struct simulation sim[1];
    const bool built = scene_build(scene, options, sim, e);
    if (built && check && neighbours_find(&sim->suspension.neighbours, &sim->suspension.box, &sim->suspension.particles, &(bool){ false }, e))
        describe_scene(sim, e);
    if (built && simulation_begin(sim, e) && !check) {
        describe_bias(sim);
        describe_provenance(sim, scene, options);
        checkpoint_watch();
        sim->destination.resuming = options->resume;
        if ((sim->observer_count == 0 && !sim->checkpoint.every && !options->resume) || destination_make(&sim->destination, folder, e))
            simulation_run(sim, e);
    }
    simulation_close(sim, e);
}

int main(int argc, char **argv)
{
    struct error e = { 0 };
    const char *scene = NULL, *set[64], *format = NULL;
    char folder[400] = "out";
    bool check = false;
    struct scene_options options = { .set = set };

    if (argc == 4 && strcmp(argv[1], "--evaluate") == 0) {
        evaluate_case(argv[2], argv[3], &e);
    } else {
        for (int k = 1; k < argc && !error_raised(&e); k++) {
            if (strcmp(argv[k], "--help") == 0)
                return fputs(usage, stdout) < 0;
            if (strcmp(argv[k], "--version") == 0)
                return printf("shear %s\n", SHEAR_VERSION) < 0;
            if (strcmp(argv[k], "--check") == 0)
                check = true;
            else if (strcmp(argv[k], "--resume") == 0)
                options.resume = true;
            else if (strcmp(argv[k], "--export") == 0 && k + 2 < argc) {
                format = argv[++k];
                snprintf(folder, sizeof folder, "%s", argv[++k]);
            } else if (strcmp(argv[k], "-o") == 0 && k + 1 < argc)
                snprintf(folder, sizeof folder, "%s", argv[++k]);
            else if (strcmp(argv[k], "--set") == 0 && k + 1 < argc && options.set_count < 64)
                set[options.set_count++] = argv[++k];
            else if (argv[k][0] != '-' && !scene)
                scene = argv[k];
            else
                error_raise(&e, ERROR_INPUT, "%s: not understood here; shear --help says what is", argv[k]);
        }
        if (!scene)
            error_raise(&e, ERROR_INPUT, "no scene given; shear --help says how");
        if (!error_raised(&e))
            format ? (void)export_scene(scene, &options, format, folder, &e) : run_scene(scene, folder, &options, check, &e);
    }
    if (error_raised(&e))
        fprintf(stderr, "shear: %s\n", e.text);
    return e.code;
}
