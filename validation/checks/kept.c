#include "kept.h"
#include "dense.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

bool kept_open(struct kept *k, struct check_run *run, const char *columns, int values)
{
    char why[WHY_LENGTH], file[160], all[1024];
    *k = (struct kept){ .run = run, .columns = columns, .values = values };
    if (!run->keep)
        return true;
    const struct candidate reference = { .command = dense_reference() };
    candidate_hash(run->candidate, k->program[0]);
    candidate_hash(&reference, k->program[1]);
    snprintf(file, sizeof file, "%s.csv", run->gate_case->name);
    path_join(k->path, run->keep, file);
    snprintf(all, sizeof all, "point$,realisation,code$,scene$,core_seconds,%s", columns);
    if (!folder_make(run->keep, why))
        return check_garbage(run, why), false;
    if (access(k->path, F_OK) == 0) {
        k->any = table_read(k->path, all, &k->found, why);
        return k->any || (check_garbage(run, why), false);
    }
    FILE *f = fopen(k->path, "w");
    if (!f) {
        snprintf(why, sizeof why, "cannot write %s", k->path);
        return check_garbage(run, why), false;
    }
    fprintf(f, "# %s\n# averages of single realisations, both codes from the same start; `scene`: hash of the scene; `program`: version of the gate and hash of the program\n"
               "# candidate: %s\n# reference: %s\n"
               "point,realisation,code,scene,program,core_seconds,%s\n",
            run->gate_case->about, run->candidate->command, dense_reference(), columns);
    fclose(f);
    return true;
}

void kept_hash(const json_t *scene, char hex[17])
{
    char *text = json_dumps(scene, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    uint64_t hash = HASH_START;
    for (const char *c = text; c && *c; c++)
        hash = (hash ^ (unsigned char)*c) * UINT64_C(1099511628211);
    snprintf(hex, 17, "%016llx", (unsigned long long)hash);
    free(text);
}

bool kept_find(const struct kept *k, const char *point, int realisation, const char *scene, double core_seconds[2], double *candidate, double *reference)
{
    bool have[2] = { false, false };
    for (size_t r = 0; k->any && r < k->found.rows; r++) {
        if (table_at(&k->found, r, 1) != realisation || strcmp(table_word(&k->found, r, 0), point) != 0 || strcmp(table_word(&k->found, r, 3), scene) != 0)
            continue;
        const int code = strcmp(table_word(&k->found, r, 2), "candidate") != 0;
        have[code] = true;
        core_seconds[code] = table_at(&k->found, r, 4);
        for (int v = 0; v < k->values; v++)
            (code ? reference : candidate)[v] = table_at(&k->found, r, 5 + (size_t)v);
    }
    return have[0] && have[1];
}

void kept_add(const struct kept *k, const char *point, int realisation, const char *scene, const double core_seconds[2], const double *candidate,
              const double *reference)
{
    FILE *f = k->path[0] ? fopen(k->path, "a") : NULL;
    if (!f)
        return;
    for (int code = 0; code < 2; code++) {
        fprintf(f, "%s,%d,%s,%s,%s %s,%.1f", point, realisation, code ? "reference" : "candidate", scene, GATE_VERSION, k->program[code], core_seconds[code]);
        for (int v = 0; v < k->values; v++)
            fprintf(f, ",%.15g", (code ? reference : candidate)[v]);
        fprintf(f, "\n");
    }
    fclose(f);
}

void kept_close(struct kept *k)
{
    if (k->any)
        table_free(&k->found);
}
