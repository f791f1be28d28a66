#include "export.h"

#include "core/settings.h"
#include "output/table.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* The particles as a start file: unwrapped, with the velocity of that image. */
static bool write_states(const struct suspension *s, const char *folder, struct error *e)
{
    const struct particles *p = &s->particles;
    struct destination to = { 0 };
    struct table t = { .file = NULL };
    if (!destination_make(&to, folder, e) || !table_open(&t, &to, "states.csv", e))
        return false;
    fputs("id,species,x,y,z,ux,uy,uz,wx,wy,wz\n", t.file);
    for (int i = 0; i < p->count; i++) {
        const vec3 off = box_unwrapped(&s->box, p->image[i]), x = plus(p->position[i], off);
        const vec3 u = plus(p->velocity[i], box_flow(&s->box, off)), w = p->spin ? p->spin[i] : vec(0, 0, 0);
        fprintf(t.file, "%d,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", p->tag[i], p->species[i] + 1, x.x, x.y, x.z,
                u.x, u.y, u.z, w.x, w.y, w.z);
    }
    return table_close(&t, e);
}

/* The scene as it was read, but for its start, which is now the file of states, and the edges that a random start has scaled. */
static bool write_scene(const char *scene, const struct scene_options *options, const struct suspension *s, const char *folder, struct error *e)
{
    char path[PATH_MAX], start[120], edges[120];
    const char *set[66];
    int count = options->set_count;
    const mat3 *cell = &s->box.start;
    struct settings root;
    memcpy(set, options->set, (size_t)count * sizeof *set);
    snprintf(start, sizeof start, "start={\"file\":\"states.csv\",\"time\":%.17g}", s->start_time);
    snprintf(edges, sizeof edges, "box.lengths=[%.17g,%.17g,%.17g]", cell->m[0][0], cell->m[1][1], cell->m[2][2]);
    set[count++] = start;
    if (!settings_load(&root, scene, options->set, options->set_count, e))
        return false;
    struct settings box = settings_child(&root, "box", e);
    if (settings_has(&box, "lengths"))
        set[count++] = edges;
    settings_unload(&root);
    snprintf(path, sizeof path, "%s/scene.json", folder);
    const bool good = settings_load(&root, scene, set, count, e) && settings_save(&root, path, e);
    settings_unload(&root);
    return good;
}

static bool write_case(const char *folder, struct error *e)
{
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/case.json", folder);
    FILE *f = fopen(path, "w");
    if (!f)
        return error_raise(e, ERROR_RUN, "%s cannot be written", path);
    fputs("{ \"protocol\": \"run\", \"scene\": \"scene.json\", \"states\": \"states.csv\" }\n", f);
    return fclose(f) == 0 || error_raise(e, ERROR_RUN, "%s was not written in full", path);
}

/* The program of that name in this program's own folder. */
static bool sibling(const char *name, char path[PATH_MAX])
{
    const ssize_t n = readlink("/proc/self/exe", path, PATH_MAX - 100);
    if (n <= 0)
        return false;
    path[n] = '\0';
    strcpy(strrchr(path, '/') + 1, name);
    return access(path, X_OK) == 0;
}

/* Runs `program --deck case_folder folder`; what it says on failing is the error. */
static bool write_deck(const char *case_folder, const char *folder, struct error *e)
{
    char program[PATH_MAX], said[400] = "";
    int ends[2], status = 0;
    if (!sibling("lammps-candidate", program))
        return error_raise(e, ERROR_RUN, "the program lammps-candidate is not beside shear; `make` builds both");
    if (pipe(ends) != 0)
        return error_raise(e, ERROR_RUN, "no pipe could be opened");
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], 2);
        close(ends[0]);
        execl(program, program, "--deck", case_folder, folder, (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    size_t length = 0;
    for (ssize_t n; (n = read(ends[0], said + length, sizeof said - 1 - length)) > 0;)
        length += (size_t)n;
    said[strcspn(said, "\n")] = '\0';
    close(ends[0]);
    if (child < 0 || waitpid(child, &status, 0) < 0)
        return error_raise(e, ERROR_RUN, "lammps-candidate could not be started");
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    return error_raise(e, WIFEXITED(status) && WEXITSTATUS(status) == ERROR_UNSUPPORTED ? ERROR_UNSUPPORTED : ERROR_RUN, "%s",
                       *said ? said : "lammps-candidate stopped without a word");
}

bool export_scene(const char *scene, const struct scene_options *options, const char *format, const char *folder, struct error *e)
{
    static struct simulation sim[1];
    static const char *const files[] = { "case.json", "scene.json", "states.csv" };
    char between[] = "/tmp/shear-export-XXXXXX", path[PATH_MAX];
    if (strcmp(format, "lammps") != 0)
        return error_raise(e, ERROR_INPUT, "--export %s: there is only lammps", format);
    if (!scene_build(scene, options, sim, e))
        return false;
    if (!mkdtemp(between))
        error_raise(e, ERROR_RUN, "no temporary folder could be made in /tmp");
    else {
        if (write_states(&sim->suspension, between, e) && write_scene(scene, options, &sim->suspension, between, e) && write_case(between, e))
            write_deck(between, folder, e);
        for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
            snprintf(path, sizeof path, "%s/%s", between, files[k]);
            remove(path);
        }
        rmdir(between);
    }
    simulation_close(sim, e);
    return !error_raised(e) || error_within(e, scene);
}
