/*
 * audit [AREA ...]: everything once more, by other derivations (audit.h), or some areas of it: vectors, series, spheres, collisions, impacts, motion, crowds.
 * Run where golden/ and validation/ are.
 */
#include "audit.h"

#include <stdio.h>
#include <string.h>

static void audit_golden(void) { audit_vectors("golden/vectors"); }

static const struct { const char *name; void (*run)(void); } area[] = {
    { "vectors", audit_golden },        { "series", audit_two_spheres }, { "spheres", audit_spheres },
    { "collisions", audit_collisions }, { "impacts", audit_impacts },    { "motion", audit_motion },
    { "crowds", audit_crowds },
};
enum { AREAS = sizeof area / sizeof *area };

int main(int argc, char **argv)
{
    for (int k = 1; k < argc; k++) {
        bool known = false;
        for (int a = 0; a < AREAS; a++)
            known = known || strcmp(argv[k], area[a].name) == 0;
        if (!known) {
            fprintf(stderr, "audit: there is no area '%s'; there are vectors, series, spheres, collisions, impacts, motion, crowds\n", argv[k]);
            return 2;
        }
    }
    for (int a = 0; a < AREAS; a++) {
        bool wanted = argc == 1;
        for (int k = 1; k < argc; k++)
            wanted = wanted || strcmp(argv[k], area[a].name) == 0;
        if (wanted)
            area[a].run();
    }
    return audit_close(argc == 1 ? "validation/theory/theory.h" : NULL);
}
