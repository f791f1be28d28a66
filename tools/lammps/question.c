/*
 * What the gate asks: case.json, scene.json and states.csv -> struct task, or a sentence on what stock LAMMPS cannot do.
 *
 * Two things need care. LAMMPS's cell has fixed orientation and its shears are xy, xz, yz only, so axes are renamed to bring the
 * flow to x and the gradient to y; a renaming that mirrors space changes the sign of spins and torques. And a particle that
 * crosses a face along which the flow varies changes velocity with its image, which LAMMPS does on the way but not in read_data.
 */
#include "adapter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static json_t *read_json(const char *folder, const char *name)
{
    char path[PATH_ROOM];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    json_error_t e;
    json_t *j = json_load_file(path, 0, &e);
    if (!j)
        fail("%s:%d:%d: %s", path, e.line, e.column, e.text);
    return j;
}

static const char *text(const json_t *object, const char *key)
{
    const char *value = json_string_value(json_object_get(object, key));
    if (!value || !value[0])
        fail("a text is missing for \"%s\"", key);
    return value;
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value))
        unsupported("this adapter needs a number for \"%s\"", key);
    return json_number_value(value);
}

static void only(const json_t *object, const char *what, const char *const known[])
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value) {
        int k = 0;
        while (known[k] && strcmp(known[k], key))
            k++;
        if (!known[k])
            unsupported("stock LAMMPS styles have no exact equivalent of %s \"%s\" of the scene", what, key);
    }
}

static void read_forces(struct task *t, const json_t *scene)
{
    const json_t *forces = json_object_get(scene, "forces"), *f;
    only(forces, "the force", (const char *const[]){ "contact", "drag", NULL });
    if ((f = json_object_get(forces, "contact"))) {
        t->contact = true;
        only(f, "the contact's key", (const char *const[]){ "normal_stiffness", "tangential_stiffness", "friction", "lever", "normal_damping",
                                                           "tangential_damping", "tension", "cap", NULL });
        t->normal_stiffness = number(f, "normal_stiffness");
        t->friction = number(f, "friction");
        if (t->friction > 0) {
            t->tangential_stiffness = number(f, "tangential_stiffness");
            if (strcmp(text(f, "lever"), "radius"))
                unsupported("gran/hooke/history turns contacts about the full radii: only \"lever\": \"radius\"");
        }
        if (json_object_get(f, "normal_damping")) {
            t->normal_damping = number(f, "normal_damping");
            t->tangential_damping = t->friction > 0 ? number(f, "tangential_damping") : 0;
            if (strcmp(text(f, "tension"), "allow") || (t->friction > 0 && strcmp(text(f, "cap"), "absolute")))
                unsupported("gran/hooke/history lets contacts pull and caps friction by the absolute damped force: only \"allow\" and \"absolute\"");
        }
    }
    if ((f = json_object_get(forces, "drag"))) {
        t->drag = true;
        t->viscosity = number(json_object_get(scene, "fluid"), "viscosity");
        t->torque = json_is_true(json_object_get(f, "torque"));
        if (t->torque && t->rate != 0)
            unsupported("fix langevin damps spins towards zero, not towards half the vorticity: in shear \"torque\" must be false");
    }
}

static void read_box(struct task *t, const json_t *scene)
{
    const json_t *box = json_object_get(scene, "box"), *shears = json_object_get(scene, "shear");
    const json_t *shear = json_array_get(shears, 0), *wall;
    if (json_array_size(shears) > 1)
        unsupported("this adapter takes one simple shear, not a superposition");
    if (shear) {
        t->axis[0] = text(shear, "flow")[0] - 'x';
        t->axis[1] = text(shear, "gradient")[0] - 'x';
        t->axis[2] = 3 - t->axis[0] - t->axis[1];
        t->handed = (t->axis[1] - t->axis[0] + 3) % 3 == 1 ? 1 : -1;
        t->rate = number(shear, "rate");
    }
    size_t k;
    json_array_foreach(json_object_get(box, "periodic"), k, wall)
        if (!json_is_true(wall))
            unsupported("this adapter writes boxes that are periodic in all directions");
    if (!json_is_array(json_object_get(box, "lengths")))
        unsupported("this adapter takes box.lengths, not a general cell: LAMMPS's cells are lower triangular");
    for (k = 0; k < 3; k++)
        t->edge[k] = json_number_value(json_array_get(json_object_get(box, "lengths"), (size_t)t->axis[k]));
    /* The second cell vector is known up to multiples of the first; LAMMPS wants the one with the smallest tilt. */
    t->tilt = remainder(t->rate * t->edge[1] * t->time, t->edge[0]);
}

static void read_protocol(struct task *t, const json_t *scene)
{
    static const char *const out[] = { "stress", "states", NULL };
    const json_t *verlet = json_object_get(json_object_get(scene, "dynamics"), "verlet"), *run = json_object_get(scene, "run");
    const json_t *output = json_object_get(scene, "output"), *states = json_object_get(output, "states"), *at;
    t->dt = number(verlet, "dt");
    const double steps = json_object_get(run, "steps") ? number(run, "steps")
                         : json_object_get(run, "time") ? number(run, "time") / t->dt
                                                        : number(run, "strain") / (fabs(t->rate) * t->dt);
    t->steps = lround(steps);
    only(output, "the output", out);
    t->stress_every = json_integer_value(json_object_get(json_object_get(output, "stress"), "every"));
    t->states_every = json_integer_value(json_object_get(states, "every"));
    size_t k;
    json_array_foreach(json_object_get(states, "at"), k, at) {  /* the largest interval that meets all of them */
        long a = json_integer_value(at), b = t->states_every;
        while (b) { const long rest = a % b; a = b; b = rest; }
        t->states_every = a;
    }
    if (json_is_true(json_object_get(states, "turn")))
        unsupported("LAMMPS does not integrate the angle that a sphere has turned through");
}

/* Into LAMMPS's axes, and wrapped: read_data would move x into the cell without changing u. */
static void take_particle(struct task *t, const double *row)
{
    t->particle = realloc(t->particle, (size_t)(t->count + 1) * sizeof *t->particle);
    if (!t->particle)
        fail("out of memory");
    struct particle *p = &t->particle[t->count++];
    *p = (struct particle){ .state = (int)row[0], .id = (int)row[1], .species = (int)row[2] };
    for (int k = 0; k < 3; k++) {
        p->x[k] = row[3 + t->axis[k]];
        p->u[k] = row[6 + t->axis[k]];
        p->w[k] = row[9 + t->axis[k]] * t->handed;
    }
    if (p->species < 1 || p->species > t->species_count)
        fail("states: particle %d is of species %d; the scene has %d", p->id, p->species, t->species_count);
    if (p->state + 1 > t->states)
        t->states = p->state + 1;
}

static void read_states(struct task *t, const char *folder, const char *name)
{
    static const char *const wanted[12] = { "state", "id", "species", "x", "y", "z", "ux", "uy", "uz", "wx", "wy", "wz" };
    char line[4096];
    int column[64], columns = 0;
    FILE *f = open_file(folder, name, "r");
    while (fgets(line, sizeof line, f)) {
        if (line[0] == '#' || line[0] == '\n')
            continue;
        double row[12] = { 0 };
        const bool header = columns == 0;
        int c = 0;
        for (char *cell = strtok(line, ",\r\n"); cell; cell = strtok(NULL, ",\r\n"), c++) {
            if (header && c < 64)
                for (int k = column[columns++] = -1; ++k < 12;)
                    if (strcmp(cell, wanted[k]) == 0)
                        column[c] = k;
            if (!header && c < columns && column[c] >= 0)
                row[column[c]] = strtod(cell, NULL);
        }
        if (!header)
            take_particle(t, row);
    }
    fclose(f);
    if (t->count == 0 || t->count % t->states)
        fail("%s/%s: %d rows do not make %d states", folder, name, t->count, t->states);
    t->count /= t->states;
}

/* Whether any two spheres of the only state touch, images included: neighbouring cells are enough for the nearest one. */
static bool touching(const struct task *t)
{
    for (int i = 0; i < t->count; i++)
        for (int j = i + 1; j < t->count; j++) {
            const struct particle *p = &t->particle[i], *q = &t->particle[j];
            const double reach = t->radius[p->species - 1] + t->radius[q->species - 1], dy = q->x[1] - p->x[1];
            const double z = remainder(q->x[2] - p->x[2], t->edge[2]);
            for (int n = (int)lround(-dy / t->edge[1]) - 1; n <= (int)lround(-dy / t->edge[1]) + 1; n++) {
                const double y = dy + n * t->edge[1], x = remainder(q->x[0] - p->x[0] + n * t->tilt, t->edge[0]);
                if (x * x + y * y + z * z < reach * reach)
                    return true;
            }
        }
    return false;
}

struct task read_task(const char *case_dir)
{
    struct task t = { .axis = { 0, 1, 2 }, .handed = 1 };
    const json_t *job = read_json(case_dir, "case.json"), *species;
    const char *protocol = text(job, "protocol");
    const char *states = json_string_value(json_object_get(job, "states"));
    json_t *scene = read_json(case_dir, text(job, "scene"));
    if (strcmp(protocol, "forces") && strcmp(protocol, "run"))
        unsupported("this adapter does not answer protocol \"%s\"", protocol);
    t.frozen = strcmp(protocol, "forces") == 0;
    if (!states)
        unsupported("this adapter starts from states.csv: LAMMPS makes no packings");
    if (json_object_get(job, "contacts"))
        unsupported("tangential histories cannot be given to LAMMPS from outside");
    if (json_integer_value(json_object_get(scene, "dimensions")) == 2)
        unsupported("this adapter writes three-dimensional boxes only");
    const json_t *start = json_object_get(scene, "start");
    t.time = json_number_value(json_object_get(start, "time"));
    if (json_is_true(json_object_get(start, "thermal")))
        unsupported("thermal starting velocities are the candidate's own random numbers; this adapter draws none");
    size_t k;
    json_array_foreach(json_object_get(scene, "species"), k, species) {
        if (k == SPECIES_ROOM)
            unsupported("this adapter takes at most %d species", SPECIES_ROOM);
        only(species, "the species' key", (const char *const[]){ "name", "radius", "density", NULL });
        t.radius[k] = number(species, "radius");
        t.density[k] = number(species, "density");
        t.species_count++;
    }
    read_box(&t, scene);
    read_forces(&t, scene);
    if (!t.frozen) {
        read_protocol(&t, scene);
        /* The tilt that LAMMPS is given must last to the end without a flip (candidate.c): centre its range at 0. */
        const double change = t.rate * t.edge[1] * t.dt * (double)t.steps;
        if (fabs(change) > 16 * t.edge[0])
            unsupported("a run of more than 16 strains needs flips of LAMMPS's cell, which give some spheres a wrong velocity");
        t.tilt -= nearbyint(change / 2 / t.edge[0]) * t.edge[0];
    }
    read_states(&t, case_dir, states);
    if (!t.frozen && t.friction > 0 && touching(&t))
        unsupported("a frictional run must start without contacts: LAMMPS would advance their history once before the first step");
    json_decref(scene);
    json_decref((json_t *)job);
    return t;
}
