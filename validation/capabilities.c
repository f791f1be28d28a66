/* Reading a capabilities file, and holding a question against it. */
#include "capabilities.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *const words[] = { "contact", "repulsion", "applied", "tether", "drag", "drag_noise", "lubrication", "lubrication_noise", "friction",
                                     "dashpot", "friction-laws", "drag-torque", "histories", "unequal", "shear", "superposed-shear", "stages", "tilted",
                                     "open-box", "two-dimensional", "motion", "random-start", "predicted_verlet", "split", "turn", "observers",
                                     "stress", NULL };
static const char *const keys[] = { "$schema", "contract", "name", "version", "level", "precision", "run_all", "physics", "model", NULL };
static const char *const precisions[] = { "double", "float", NULL };
static const char *const levels[] = { "A", "B", "C", NULL };

/* A key of `model`, its values, and the places of scenes that it stands for. */
static const struct convention { const char *key, *values[4], *path[2]; } conventions[] = {
    { "lever", { "radius", "contact" }, { "forces.contact.lever" } },
    { "tension", { "allow", "clip" }, { "forces.contact.tension" } },
    { "cap", { "spring", "damped", "absolute" }, { "forces.contact.cap" } },
    { "rotation_correction", { "none", "exact" }, { "forces.lubrication.rotation_correction" } },
    { "distribution", { "gaussian", "uniform" }, { "forces.drag_noise.distribution", "forces.lubrication_noise.distribution" } },
    { "integrator", { "verlet", "euler", "other" }, { NULL } },
};
enum { CONVENTIONS = sizeof conventions / sizeof *conventions };

static int place_of(const char *word, const char *const known[])
{
    for (int k = 0; known[k]; k++)
        if (strcmp(word, known[k]) == 0)
            return k;
    return -1;
}

/* Number of letters to change, add or leave out (Levenshtein 1966); words here are short. */
static int letters_apart(const char *a, const char *b)
{
    int row[64];
    const int n = (int)strlen(b) < 63 ? (int)strlen(b) : 63;
    for (int k = 0; k <= n; k++)
        row[k] = k;
    for (int i = 1; *a; a++, i++) {
        int diagonal = row[0];
        row[0] = i;
        for (int k = 1; k <= n; k++) {
            const int changed = diagonal + (b[k - 1] != *a);
            diagonal = row[k];
            row[k] = changed < row[k] + 1 ? changed : row[k] + 1;
            row[k] = row[k] < row[k - 1] + 1 ? row[k] : row[k - 1] + 1;
        }
    }
    return row[n];
}

static const char *nearest(const char *word, const char *const known[])
{
    int best = 0;
    for (int k = 1; known[k]; k++)
        if (letters_apart(word, known[k]) < letters_apart(word, known[best]))
            best = k;
    return known[best];
}

/* "level": must be one of these words. */
static bool choose(const struct capabilities *c, const char *key, const json_t *value, const char *const known[], int *place, char why[WHY_LENGTH])
{
    const char *word = json_string_value(value);
    *place = word ? place_of(word, known) : -1;
    if (*place >= 0)
        return true;
    return word ? why_not(why, "%s: %s: \"%s\" is not known; did you mean \"%s\"?", c->path, key, word, nearest(word, known))
                : why_not(why, "%s: %s must be a word such as \"%s\"", c->path, key, known[0]);
}

static bool only_known(const struct capabilities *c, const char *inside, const json_t *object, const char *const known[], char why[WHY_LENGTH])
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)object, key, value)
        if (place_of(key, known) < 0)
            return why_not(why, "%s: %sunknown key \"%s\"; did you mean \"%s\"?", c->path, inside, key, nearest(key, known));
    return true;
}

static bool read_precision(struct capabilities *c, const json_t *value, char why[WHY_LENGTH])
{
    int place;
    if (!value)
        return true;
    if (json_is_object(value)) {
        const json_t *digits = json_object_get(value, "digits");
        if (!json_is_integer(digits) || json_object_size(value) != 1 || json_integer_value(digits) < 3 || json_integer_value(digits) > 17)
            return why_not(why, "%s: precision must be \"double\", \"float\" or {\"digits\": n} with n from 3 to 17", c->path);
        const int n = (int)json_integer_value(digits);
        snprintf(c->precision, sizeof c->precision, "%d digits", n);
        c->roundoff = n < 16 ? 5 * pow(10, -n) : 0;
        return true;
    }
    if (!choose(c, "precision", value, precisions, &place, why))
        return false;
    snprintf(c->precision, sizeof c->precision, "%s", precisions[place]);
    c->roundoff = place == 1 ? ldexp(1, -24) : 0;
    return true;
}

static bool read_physics(struct capabilities *c, json_t *physics, char why[WHY_LENGTH])
{
    size_t k;
    json_t *word;
    int place;
    if (!physics)
        return true;
    if (!json_is_array(physics))
        return why_not(why, "%s: physics must be a list of words such as [\"contact\", \"drag\"]", c->path);
    json_array_foreach(physics, k, word)
        if (!choose(c, "physics", word, words, &place, why))
            return false;
    c->physics = json_incref(physics);
    return true;
}

static bool read_model(struct capabilities *c, json_t *model, char why[WHY_LENGTH])
{
    const char *known[CONVENTIONS + 1] = { NULL };
    for (int k = 0; k < CONVENTIONS; k++)
        known[k] = conventions[k].key;
    if (!model)
        return true;
    if (!json_is_object(model))
        return why_not(why, "%s: model must be an object such as {\"lever\": \"radius\"}", c->path);
    if (!only_known(c, "model: ", model, known, why))
        return false;
    for (int k = 0; k < CONVENTIONS; k++) {
        const json_t *value = json_object_get(model, known[k]);
        int place;
        if (value && !choose(c, known[k], value, conventions[k].values, &place, why))
            return false;
        if (value && strcmp(known[k], "integrator") == 0)
            c->integrator = (enum integrator)place;
    }
    c->model = json_incref(model);
    return true;
}

static bool read_text(const struct capabilities *c, const json_t *root, const char *key, char *text, size_t room, char why[WHY_LENGTH])
{
    const json_t *value = json_object_get(root, key);
    if (value && !json_is_string(value))
        return why_not(why, "%s: %s must be a text", c->path, key);
    if (value)
        snprintf(text, room, "%s", json_string_value(value));
    return true;
}

static bool read_all(struct capabilities *c, const json_t *root, char why[WHY_LENGTH])
{
    const json_t *contract = json_object_get(root, "contract"), *level = json_object_get(root, "level"), *run_all = json_object_get(root, "run_all");
    int place = 0;
    if (!json_is_object(root))
        return why_not(why, "%s: must be a JSON object", c->path);
    if (!only_known(c, "", root, keys, why))
        return false;
    if (!json_is_string(contract) || strcmp(json_string_value(contract), CONTRACT) != 0)
        return why_not(why, "%s: \"contract\" must be \"%s\", the version that this gate speaks", c->path, CONTRACT);
    if (level && !choose(c, "level", level, levels, &place, why))
        return false;
    c->level = (enum level)place;
    if (run_all && !json_is_boolean(run_all))
        return why_not(why, "%s: run_all must be true or false", c->path);
    c->run_all = json_is_true(run_all);
    return read_text(c, root, "name", c->name, sizeof c->name, why) && read_text(c, root, "version", c->version, sizeof c->version, why)
           && read_precision(c, json_object_get(root, "precision"), why) && read_physics(c, json_object_get(root, "physics"), why)
           && read_model(c, json_object_get(root, "model"), why);
}

void capabilities_default(struct capabilities *c)
{
    *c = (struct capabilities){ .level = LEVEL_A, .precision = "double" };
}

bool capabilities_read(const char *path, struct capabilities *c, char why[WHY_LENGTH])
{
    json_error_t error;
    capabilities_default(c);
    c->given = true;
    snprintf(c->path, sizeof c->path, "%s", path);
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!root)
        return why_not(why, "%s:%d:%d: %s", path, error.line, error.column, error.text);
    const bool good = read_all(c, root, why);
    json_decref(root);
    if (!good)
        capabilities_free(c);
    return good;
}

/* Beside the last word of the command that names a file: `python3 my_adapter.py` is my_adapter.py. */
bool capabilities_beside(const char *command, char path[PATH_LENGTH])
{
    bool found = false;
    for (const char *at = command + strspn(command, " \t"); *at; at += strspn(at, " \t")) {
        char guess[PATH_LENGTH], word[PATH_LENGTH];
        const int n = (int)strcspn(at, " \t");
        snprintf(word, sizeof word, "%.*s", n, at);
        if (snprintf(guess, sizeof guess, "%s.capabilities.json", word) < (int)sizeof guess && access(word, R_OK) == 0 && access(guess, R_OK) == 0) {
            strcpy(path, guess);
            found = true;
        }
        at += n;
    }
    return found;
}

bool capabilities_choose(const char *file, const char *command, const char *level, struct capabilities *c, char why[WHY_LENGTH])
{
    char path[PATH_LENGTH];
    enum level asked;
    capabilities_default(c);
    if (file)
        snprintf(path, sizeof path, "%s", file);
    if ((file || (command && capabilities_beside(command, path))) && !capabilities_read(path, c, why))
        return false;
    if (!level)
        return true;
    if (!level_parse(level, &asked))
        return why_not(why, "there is no level '%s'; there are A, B, C", level);
    if (asked < c->level)
        return why_not(why, "--level %s: the candidate declares level %s, which is below it", level, levels[c->level]);
    c->level = asked;
    return true;
}

void capabilities_free(struct capabilities *c)
{
    json_decref(c->physics);
    json_decref(c->model);
    c->physics = c->model = NULL;
}

bool level_parse(const char *text, enum level *level)
{
    const int place = place_of(text, levels);
    *level = (enum level)(place < 0 ? 0 : place);
    return place >= 0;
}

const char *level_letter(enum level level)
{
    return levels[level];
}

bool capabilities_list(const struct capabilities *c, const char *word)
{
    size_t k;
    json_t *item;
    if (!c || !c->physics)
        return true;
    json_array_foreach(c->physics, k, item)
        if (strcmp(json_string_value(item), word) == 0)
            return true;
    return false;
}

static bool several_radii(const json_t *species)
{
    size_t k;
    json_t *one;
    json_array_foreach(species, k, one)
        if (scene_number(one, "radius", 0) != scene_number(json_array_get(species, 0), "radius", 0))
            return true;
    return false;
}

static bool some_driven(const json_t *species)
{
    size_t k;
    json_t *one;
    json_array_foreach(species, k, one)
    {
        const json_t *motion = json_object_get(one, "motion");
        if (motion && !(json_is_string(motion) && strcmp(json_string_value(motion), "free") == 0))
            return true;
    }
    return false;
}

static bool some_open(const json_t *periodic)
{
    size_t k;
    json_t *one;
    json_array_foreach(periodic, k, one)
        if (json_is_false(one))
            return true;
    return false;
}

static bool other_tables(const json_t *output)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)(uintptr_t)output, key, value)
        if (strcmp(key, "stress") != 0 && strcmp(key, "states") != 0)
            return true;
    return false;
}

static bool is_other_word(const json_t *word, const char *usual)
{
    return json_is_string(word) && strcmp(json_string_value(word), usual) != 0;
}

/* Whether a question has what `word` stands for. */
static bool question_has(const char *word, const char *protocol, const json_t *scene, bool histories)
{
    const json_t *forces = scene_get(scene, "forces"), *contact = json_object_get(forces, "contact"), *species = scene_get(scene, "species");
    const bool moves = strcmp(protocol, "run") == 0;
    if (strcmp(word, "friction") == 0)
        return scene_number(contact, "friction", 0) > 0;
    if (strcmp(word, "dashpot") == 0)
        return json_object_get(contact, "normal_damping") || json_object_get(contact, "restitution") || json_object_get(contact, "tangential_damping");
    if (strcmp(word, "friction-laws") == 0)
        return is_other_word(json_object_get(contact, "law"), "plain");
    if (strcmp(word, "drag-torque") == 0)
        return json_is_true(scene_get(scene, "forces.drag.torque"));
    if (strcmp(word, "histories") == 0)
        return histories;
    if (strcmp(word, "unequal") == 0)
        return several_radii(species);
    if (strcmp(word, "shear") == 0)
        return json_array_size(scene_get(scene, "shear")) > 0;
    if (strcmp(word, "superposed-shear") == 0)
        return json_array_size(scene_get(scene, "shear")) > 1;
    if (strcmp(word, "stages") == 0)
        return scene_get(scene, "stages") != NULL;
    if (strcmp(word, "tilted") == 0)
        return scene_get(scene, "box.cell") || (scene_number(scene, "start.time", 0) != 0 && json_array_size(scene_get(scene, "shear")) > 0);
    if (strcmp(word, "open-box") == 0)
        return some_open(scene_get(scene, "box.periodic"));
    if (strcmp(word, "two-dimensional") == 0)
        return scene_number(scene, "dimensions", 3) == 2;
    if (strcmp(word, "motion") == 0)
        return some_driven(species);
    if (strcmp(word, "random-start") == 0)
        return scene_get(scene, "start.random") || json_is_true(scene_get(scene, "start.thermal"));
    if (strcmp(word, "predicted_verlet") == 0 || strcmp(word, "split") == 0)
        return (moves || strcmp(protocol, "friction") == 0) && json_object_get(scene_get(scene, "dynamics"), word);
    if (strcmp(word, "turn") == 0)
        return json_is_true(scene_get(scene, "output.states.turn"));
    if (strcmp(word, "observers") == 0)
        return moves && other_tables(scene_get(scene, "output"));
    return json_object_get(forces, word) != NULL;       /* the rest are forces; `stress` is none and never needed */
}

bool capabilities_lack(const struct capabilities *c, const char *protocol, const json_t *scene, bool histories, char why[WHY_LENGTH])
{
    if (!c)
        return false;
    for (int k = 0; words[k]; k++)
        if (!capabilities_list(c, words[k]) && question_has(words[k], protocol, scene, histories))
            return !why_not(why, "needs \"%s\", which the candidate does not declare", words[k]);
    for (int k = 0; k < CONVENTIONS; k++)
        for (int p = 0; p < 2 && conventions[k].path[p]; p++) {
            const char *declared = json_string_value(json_object_get(c->model, conventions[k].key));
            const json_t *asked = scene_get(scene, conventions[k].path[p]);
            if (declared && is_other_word(asked, declared))
                return !why_not(why, "asks for %s \"%s\"; the candidate declares \"%s\"", conventions[k].path[p], json_string_value(asked), declared);
        }
    return false;
}

void capabilities_into_scene(const struct capabilities *c, json_t *scene)
{
    for (int k = 0; c && c->model && k < CONVENTIONS; k++)
        for (int p = 0; p < 2 && conventions[k].path[p]; p++) {
            const json_t *declared = json_object_get(c->model, conventions[k].key);
            if (declared && scene_get(scene, conventions[k].path[p]))
                scene_set(scene, conventions[k].path[p], json_string(json_string_value(declared)));
        }
}
