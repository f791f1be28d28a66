/* Golden vectors as JSON text: one line for each object of numbers, so that a difference between two versions is readable. */
#include "vectors.h"

#include <string.h>

void add_number(struct fields *f, const char *name, double value)
{
    f->item[f->count].name = name;
    f->item[f->count].word = NULL;
    f->item[f->count].length = 0;
    f->item[f->count++].value[0] = value == 0.0 ? 0.0 : value;      /* no negative zeros: they mean nothing here */
}

void add_list(struct fields *f, const char *name, const double *value, int length)
{
    f->item[f->count].name = name;
    f->item[f->count].word = NULL;
    f->item[f->count].length = length;
    for (int k = 0; k < length; k++)
        f->item[f->count].value[k] = value[k] == 0.0 ? 0.0 : value[k];
    f->count++;
}

void add_word(struct fields *f, const char *name, const char *word)
{
    f->item[f->count].name = name;
    f->item[f->count++].word = word;
}

static void put_object(FILE *file, const char *indent, const char *key, const struct fields *f, bool hex)
{
    const char *number = hex ? "\"%a\"" : "%.17g", *separator = "";
    fprintf(file, "%s\"%s%s\": {", indent, key, hex ? "_hex" : "");
    for (int k = 0; k < f->count; k++) {
        if (f->item[k].word && hex)
            continue;
        fprintf(file, "%s\"%s\": ", separator, f->item[k].name);
        separator = ", ";
        if (f->item[k].word)
            fprintf(file, "\"%s\"", f->item[k].word);
        else if (f->item[k].length == 0)
            fprintf(file, number, f->item[k].value[0]);
        else
            for (int v = 0; v < f->item[k].length; v++) {
                fputs(v ? ", " : "[", file);
                fprintf(file, number, f->item[k].value[v]);
                fputs(v + 1 == f->item[k].length ? "]" : "", file);
            }
    }
    fputs("}", file);
}

bool file_open(struct vector_file *f, const char *folder, const char *term, const char *about, const char *const flags[], double tolerance,
               const char *reason)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.json", folder, term);
    *f = (struct vector_file){ .file = fopen(path, "w"), .term = term };
    if (!f->file) {
        fprintf(stderr, "vectors: cannot write %s\n", path);
        return false;
    }
    fprintf(f->file, "{\n\"suite\": \"sheargate vectors\",\n\"version\": \"1.0\",\n\"licence\": \"CC0-1.0\",\n\"term\": \"%s\",\n\"about\": \"%s\",\n"
                     "\"generator\": \"tools/golden: make vectors\",\n",
            term, about);
    fputs("\"conventions\": \"n points from sphere 1 to sphere 2. Forces and torques are those on a sphere. Positions, velocities and spins are "
          "laboratory ones. Lists run over x y z of sphere 1, then of sphere 2; matrices are row by row. Stress is F_1 (x) (x_2 - x_1) of the pair, "
          "first index force, positive in tension, not divided by a volume.\",\n"
          "\"units\": \"any consistent set of length L, mass M, time T: radius, position, history L; velocity L/T; spin, gradient 1/T; density M/L^3; "
          "viscosity M/(L T); kT, stress M L^2/T^2; force M L/T^2; torque M L^2/T^2; stiffness M/T^2; gaps 2 h/(a_1 + a_2) are numbers\",\n",
          f->file);
    fprintf(f->file, "\"agreement\": {\"tolerance\": %g, \"reason\": \"%s\"},\n\"flags\": {", tolerance, reason);
    for (int k = 0; flags[k]; k += 2)
        fprintf(f->file, "%s\n  \"%s\": \"%s\"", k ? "," : "", flags[k], flags[k + 1]);
    fputs("\n},\n\"groups\": [", f->file);
    return true;
}

void file_group(struct vector_file *f, const char *kind, const char *about, const struct fields *model)
{
    fputs(f->groups++ ? "\n]},\n" : "\n", f->file);
    fprintf(f->file, "{\"kind\": \"%s\", \"about\": \"%s\",\n", kind, about);
    put_object(f->file, " ", "model", model, false);
    fputs(",\n", f->file);
    put_object(f->file, " ", "model", model, true);
    fputs(",\n \"vectors\": [", f->file);
    f->in_group = 0;
}

static void put_scale(FILE *file, const char *name, double value, const char **separator)
{
    if (value > 0.0) {
        fprintf(file, "%s\"%s\": %.3g", *separator, name, value);
        *separator = ", ";
    }
}

void file_vector(struct vector_file *f, const struct vector *v)
{
    fprintf(f->file, "%s\n {\"id\": \"%s-%d\", \"result\": \"%s\", \"comment\": \"%s\", \"flags\": [", f->in_group++ ? "," : "", f->term,
            ++f->vectors, v->result, v->comment);
    const char *separator = "";
    for (const char *at = v->flags; *at; at += strspn(at, " ")) {
        const int length = (int)strcspn(at, " ");
        fprintf(f->file, "%s\"%.*s\"", separator, length, at);
        separator = ", ";
        at += length;
    }
    fputs("],\n", f->file);
    for (int hex = 0; hex < 2; hex++) {
        put_object(f->file, "  ", "input", &v->input, hex);
        fputs(",\n", f->file);
    }
    for (int hex = 0; hex < 2; hex++) {
        put_object(f->file, "  ", "expected", &v->expected, hex);
        fputs(",\n", f->file);
    }
    fputs("  \"scale\": {", f->file);
    separator = "";
    put_scale(f->file, "force", v->force_scale, &separator);
    put_scale(f->file, "torque", v->torque_scale, &separator);
    put_scale(f->file, "stress", v->stress_scale, &separator);
    put_scale(f->file, "covariance", v->covariance_scale, &separator);
    fputs("}}", f->file);
}

bool file_close(struct vector_file *f)
{
    fprintf(f->file, "\n]}\n],\n\"count\": %d\n}\n", f->vectors);
    const bool good = !ferror(f->file);
    if (fclose(f->file) == 0 && good)
        return true;
    fprintf(stderr, "vectors: %s.json: cannot be written in full: disk full?\n", f->term);
    return false;
}
