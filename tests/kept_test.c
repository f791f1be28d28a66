/* Long tables that go on where they stopped (validation/checks/kept.h): what is found again, and what is not. */
#include "checks/kept.h"
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char folder[] = "/tmp/kept-test-XXXXXX";

static bool find(const char *point, int realisation, const char *scene, double first[2])
{
    const struct candidate candidate = { .command = "true" };
    const struct gate_case one = { .name = "long", .about = "a table" };
    struct check_run run = { .gate_case = &one, .candidate = &candidate, .keep = folder };
    struct kept k;
    double core[2], own[2], reference[2];
    if (!kept_open(&k, &run, "a,b", 2))
        return false;
    const bool found = kept_find(&k, point, realisation, scene, core, own, reference);
    if (found) {
        first[0] = own[0];
        first[1] = reference[1];
    }
    kept_close(&k);
    results_free(&run.results);
    return found;
}

static void lines_are_found_again(void)
{
    const struct candidate candidate = { .command = "true" };
    const struct gate_case one = { .name = "long", .about = "a table" };
    struct check_run run = { .gate_case = &one, .candidate = &candidate, .keep = folder };
    struct kept k;
    double got[2] = { 0, 0 };
    check_true(mkdtemp(folder) != NULL, "a folder");
    check_true(kept_open(&k, &run, "a,b", 2), "open");
    kept_add(&k, "phi 0.50 mu 0", 3, "00000000deadbeef", (double[]){ 1.5, 2.5 }, (double[]){ 0.1 + 0.2, 2 }, (double[]){ 3, 1.0 / 3 });
    kept_close(&k);
    check_true(find("phi 0.50 mu 0", 3, "00000000deadbeef", got), "the same realisation of the same scene");
    check_close(got[0], 0.3, 1e-14, "a value of the candidate");
    check_close(got[1], 1.0 / 3, 1e-14, "a value of the reference");
    check_true(!find("phi 0.50 mu 0", 4, "00000000deadbeef", got), "another realisation is not there");
    check_true(!find("phi 0.50 mu 1", 3, "00000000deadbeef", got), "nor another point");
    check_true(!find("phi 0.50 mu 0", 3, "00000000deadbee0", got), "nor another scene");
}

/* A run that was killed between the two lines of a realisation, or within a line. */
static void half_a_realisation_does_not_count(void)
{
    char path[PATH_LENGTH];
    double got[2];
    path_join(path, folder, "long.csv");
    FILE *f = fopen(path, "a");
    check_true(f != NULL, "append");
    fprintf(f, "phi 0.55 mu 0,0,candidate,00000000deadbeef,x,1.0,1,2\n");
    fclose(f);
    check_true(!find("phi 0.55 mu 0", 0, "00000000deadbeef", got), "one code alone is no realisation");
    check_true(find("phi 0.50 mu 0", 3, "00000000deadbeef", got), "and spoils nothing else");
    f = fopen(path, "a");
    fprintf(f, "phi 0.55 mu 0,1,cand");
    fclose(f);
    check_true(!find("phi 0.50 mu 0", 3, "00000000deadbeef", got), "a torn line is an error of the file, said with its place");
    folder_remove(folder);
}

static void scenes_differ_by_what_they_are(void)
{
    char one[17], two[17];
    json_t *a = json_pack("{s{sf} si}", "fluid", "kT", 0.31, "seed", 4), *b = json_pack("{si s{sf}}", "seed", 4, "fluid", "kT", 0.31);
    kept_hash(a, one);
    kept_hash(b, two);
    check_true(strcmp(one, two) == 0, "order of the keys does not matter");
    json_object_set_new(b, "seed", json_integer(5));
    kept_hash(b, two);
    check_true(strcmp(one, two) != 0, "a number does");
    json_decref(a);
    json_decref(b);
}

static const struct unit_test tests[] = {
    { "a finished realisation is found again, for its scene alone", lines_are_found_again },
    { "half a realisation does not count; a torn file is said", half_a_realisation_does_not_count },
    { "the hash of a scene", scenes_differ_by_what_they_are },
    { NULL, NULL },
};
const struct suite kept_suite = { "kept", tests };
