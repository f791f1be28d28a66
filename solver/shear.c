/*
 * shear: runs one scene. The program alone prints and exits; everything below it returns errors.
 */
#include "core/step_limit.h"
#include "evaluate.h"
#include "scene.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char usage[] =
    "usage: shear SCENE.json [-o DIR] [--set path=value ...] [--check]\n"
    "       shear --evaluate CASE_DIR OUT_DIR\n"
    "       shear --help | --version\n"
    "\n"
    "Runs the suspension that SCENE.json describes and writes the tables it asks for to DIR\n"
    "(default: the scene's name without .json, in the current directory).\n"
    "\n"
    "  -o DIR             where to write; made if it is not there\n"
    "  --set path=value   replace one value of the scene, such as --set fluid.kT=0 or --set species[0].radius=1.3\n"
    "  --check            say what would be built, its time scales and its step limit, and stop\n"
    "  --evaluate         a case of the gate: frozen states in, forces, torques and stresses out; or noise draws; or a run\n"
    "\n"
    "Exit codes: 0 done, 1 the run failed, 2 the input is wrong, 77 not supported.\n"
    "Formats: docs/formats.md.\n";

static void make_provenance(struct destination *to, const struct simulation *sim, const char *scene, const struct scene_options *options)
{
    int used = snprintf(to->provenance, sizeof to->provenance, "# shear %s\n# scene: %s\n# about: %s\n# seed %u realisation %u dt %.17g\n",
                        SHEAR_VERSION, scene, sim->about, sim->suspension.key.seed, sim->suspension.key.realisation, sim->suspension.dt);
    for (int k = 0; k < options->set_count && used < 1200; k++)
        used += snprintf(to->provenance + used, sizeof to->provenance - (size_t)used, "# --set %.100s\n", options->set[k]);
}

/* What a reader of the scene wants to know before it runs: sizes, time scales, limits. */
static void describe(const struct simulation *sim, struct error *e)
{
    const struct suspension *s = &sim->suspension;
    const struct particles *p = &s->particles;
    const struct step_limit limit = step_limit_of(s, e);
    double solid = 0.0, smallest = INFINITY, k_n = 0.0;
    for (int i = 0; i < p->count; i++)
        solid += 4.0 / 3.0 * M_PI * pow(radius_of(p, i), 3);
    for (int k = 0; k < p->species_count; k++)
        smallest = fmin(smallest, p->kind[k].radius);
    printf("scene       %s\nparticles   %d of %d species, volume fraction %.6g, %s\n", sim->about, p->count, p->species_count,
           solid / s->box.volume, s->rotates ? "rotating" : "without rotation");
    printf("cell        A (%g, %g, %g)  B (%g, %g, %g)  C (%g, %g, %g)\nforces     ", s->box.cell.m[0][0], s->box.cell.m[1][0], s->box.cell.m[2][0],
           s->box.cell.m[0][1], s->box.cell.m[1][1], s->box.cell.m[2][1], s->box.cell.m[0][2], s->box.cell.m[1][2], s->box.cell.m[2][2]);
    for (int k = 0; k < s->force_count; k++) {
        struct response r = { 0 };
        printf(" %s", s->force[k]->name);
        if (s->force[k]->respond)
            s->force[k]->respond(s->force[k], p, 0, 0, -1e-300, &r);
        k_n = fmax(k_n, r.normal_stiffness);
    }
    const double rho = p->kind[0].density, a = smallest, eta = s->viscosity;
    printf("%s\npairs       %d within range\ntime scales", s->force_count ? "" : " none", s->neighbours.near.count);
    if (k_n > 0)
        printf("  contact sqrt(rho a^3/k_n) %.4g", sqrt(rho * a * a * a / k_n));
    if (eta > 0)
        printf("  inertia rho a^2/eta %.4g", rho * a * a / eta);
    if (eta > 0 && s->kT > 0)
        printf("  diffusion eta a^3/kT %.4g", eta * a * a * a / s->kT);
    if (s->box.rate > 0)
        printf("  shear 1/rate %.4g", 1.0 / s->box.rate);
    printf("\nstep        dt %.6g, limit %.6g (set by %s), advised %.3g\nrun         %lld steps, time %.6g, strain %.6g\n", s->dt, limit.dt,
           limit.force, step_advised(s), (long long)sim->last_step, (double)sim->last_step * s->dt, (double)sim->last_step * s->dt * s->box.rate);
}

static bool make_folder(const char *path, struct error *e)
{
    if (mkdir(path, 0777) == 0 || errno == EEXIST)
        return true;
    return error_raise(e, ERROR_RUN, "%s cannot be made: %s", path, strerror(errno));
}

static void warn_of_bias(const struct simulation *sim)
{
    const struct suspension *s = &sim->suspension;
    const double eps = s->kT > 0.0 && sim->dynamics->explicit_friction ? step_bias(s, s->dt) : 0.0;
    if (eps > 0.01)
        fprintf(stderr, "shear: note: with noise, %s makes pairs in contact rarer by the factor 1 - eps/2 = %.3f (eps = X_A dt/m_eff = %.3g); "
                        "a smaller dt lessens it in proportion\n", sim->dynamics->name, 1.0 - 0.5 * eps, eps);
}

static void run_scene(const char *scene, const char *folder, const struct scene_options *options, bool check, struct error *e)
{
    struct simulation *sim = calloc(1, sizeof *sim);
    if (!sim) {
        error_out_of_memory(e);
        return;
    }
    const bool built = scene_build(scene, options, sim, e);
    if (built && check && neighbours_find(&sim->suspension.neighbours, &sim->suspension.box, &sim->suspension.particles, &(bool){ false }, e))
        describe(sim, e);
    if (built && simulation_begin(sim, e) && !check) {
        warn_of_bias(sim);
        snprintf(sim->destination.folder, sizeof sim->destination.folder, "%s", folder);
        make_provenance(&sim->destination, sim, scene, options);
        if (sim->observer_count == 0 || make_folder(folder, e))
            simulation_run(sim, e);
    }
    simulation_close(sim, e);
    free(sim);
}

static void default_folder(const char *scene, char folder[400])
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene, *dot = strrchr(name, '.');
    snprintf(folder, 400, "%.*s", dot && dot > name ? (int)(dot - name) : (int)strlen(name), name);
    if (!dot)
        snprintf(folder + strlen(folder), 400 - strlen(folder), ".out");
}

int main(int argc, char **argv)
{
    struct error e = { 0 };
    const char *scene = NULL, *set[64];
    char folder[400] = "";
    bool check = false;
    struct scene_options options = { .set = set };

    if (argc == 4 && strcmp(argv[1], "--evaluate") == 0) {
        if (make_folder(argv[3], &e))
            evaluate_case(argv[2], argv[3], &e);
    } else {
        for (int k = 1; k < argc && !error_raised(&e); k++) {
            if (strcmp(argv[k], "--help") == 0)
                return fputs(usage, stdout) < 0;
            if (strcmp(argv[k], "--version") == 0)
                return printf("shear %s\n", SHEAR_VERSION) < 0;
            if (strcmp(argv[k], "--check") == 0)
                check = true;
            else if (strcmp(argv[k], "-o") == 0 && k + 1 < argc)
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
        if (!error_raised(&e)) {
            if (!*folder)
                default_folder(scene, folder);
            run_scene(scene, folder, &options, check, &e);
        }
    }
    if (error_raised(&e))
        fprintf(stderr, "shear: %s\n", e.text);
    return e.code;
}
