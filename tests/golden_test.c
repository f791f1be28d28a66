/*
 * Pages and data that are made: golden vectors (golden/vectors) are what tools/golden makes from validation/theory now, byte for byte. `make vectors`
 * holds the solver to them. docs/verdicts.md is what its script makes of the cases.
 */
#include "suite.h"
#include "vectors.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *const file[] = { "applied",       "contact-friction", "contact-frictionless", "contact-laws",         "drag",       "lubrication-forces",
                                    "lubrication-resistance", "lubrication-scalars", "noise-one-body", "noise-pair", "repulsion" };
enum { FILES = sizeof file / sizeof *file };

/* Whether two files have the same bytes. */
static bool same_bytes(const char *one, const char *two)
{
    FILE *a = fopen(one, "rb"), *b = fopen(two, "rb");
    bool same = a && b;
    for (int c = 0; same && c != EOF;) {
        c = getc(a);
        same = c == getc(b);
    }
    if (a)
        fclose(a);
    if (b)
        fclose(b);
    return same;
}

static void vectors_are_what_the_generator_makes(void)
{
    char folder[] = "/tmp/golden-XXXXXX", golden[256], made[256];
    int files = 0;
    check_true(mkdtemp(folder) != NULL, "a folder for vectors");
    check_true(vectors_write_all(folder, &files), "vectors are written");
    check_close(files, FILES, 0.0, "files");
    for (int k = 0; k < FILES; k++) {
        snprintf(golden, sizeof golden, "golden/vectors/%s.json", file[k]);
        snprintf(made, sizeof made, "%s/%s.json", folder, file[k]);
        check_true(same_bytes(golden, made), golden);
        unlink(made);
    }
    rmdir(folder);
}

static void wrong_folders_are_said(void)
{
    int files;
    check_true(!vectors_write_all("/nowhere/at/all", &files), "a folder that is not there is refused");
}

/* What the cases say stands in docs/verdicts.md; the tables of quantities are compared with a run by `make verdicts`. */
static void verdicts_page_is_made_from_the_cases(void)
{
    check_true(system("python3 tools/docs/verdicts.py >build/verdicts.txt 2>&1 || { cat build/verdicts.txt; exit 1; }") == 0, "docs/verdicts.md is current");
}

static const struct unit_test tests[] = {
    { "golden vectors are what the generator makes", vectors_are_what_the_generator_makes },
    { "a folder that is not there", wrong_folders_are_said },
    { "docs/verdicts.md is made from the cases", verdicts_page_is_made_from_the_cases },
    { NULL, NULL },
};

const struct suite golden_suite = { "golden", tests };
