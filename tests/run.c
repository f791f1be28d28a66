/*
 * Runs the unit tests: `unit-tests [SUITE ...]`. CUnit keeps the books; we print one line per test (the name before it
 * runs, so that a crash is attributable) and close with `N passed, N failed`.
 */
#include "suite.h"

#include <CUnit/CUnit.h>
#include <CUnit/TestRun.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SUITES(each)                                                                                                     \
    each(box) each(packing) each(dynamics) each(force) each(scene) each(theory) each(theory_motion) each(theory_pair)    \
    each(statistics) each(tables) each(gate) each(collision) each(checkpoint) each(stages)    \
    each(observers) each(blocks) each(faults) each(export) each(sweeps) each(published_shear) each(engine) each(verdict) each(golden) each(kept) each(levels) each(pattern) each(contract)
#define DECLARE(name) extern const struct suite name##_suite;
#define ADDRESS(name) &name##_suite,

SUITES(DECLARE)
static const struct suite *const suites[] = { SUITES(ADDRESS) };

void check_close(double measured, double expected, double tolerance, const char *what)
{
    const bool good = fabs(measured - expected) <= tolerance;
    if (!good)
        printf("\n    %s: measured %.17g, expected %.17g, difference %.3g, allowed %.3g", what, measured, expected,
               measured - expected, tolerance);
    CU_assertImplementation(good, 0, what, "", "", CU_FALSE);
}

void check_relative(double measured, double expected, double tolerance, const char *what)
{
    check_close(measured, expected, tolerance * fabs(expected), what);
}

void check_true(bool holds, const char *what)
{
    if (!holds)
        printf("\n    %s: does not hold", what);
    CU_assertImplementation(holds, 0, what, "", "", CU_FALSE);
}

static void before(const CU_pTest test, const CU_pSuite suite)
{
    printf("%-12s %-56s ", suite->pName, test->pName);
    fflush(stdout);
}

static void after(const CU_pTest test, const CU_pSuite suite, const CU_pFailureRecord failure)
{
    (void)test;
    (void)suite;
    printf(failure ? "\n    FAILED\n" : "ok\n");
}

int main(int argc, char **argv)
{
    if (CU_initialize_registry() != CUE_SUCCESS)
        return 2;
    CU_set_test_start_handler(before);
    CU_set_test_complete_handler(after);
    for (size_t s = 0; s < sizeof suites / sizeof *suites; s++) {
        bool wanted = argc == 1;
        for (int k = 1; k < argc; k++)
            wanted = wanted || strcmp(argv[k], suites[s]->name) == 0;
        if (!wanted)
            continue;
        CU_pSuite added = CU_add_suite(suites[s]->name, NULL, NULL);
        for (const struct unit_test *t = suites[s]->test; t->name; t++)
            CU_add_test(added, t->name, t->run);
    }
    CU_run_all_tests();
    const unsigned run = CU_get_number_of_tests_run(), failed = CU_get_number_of_tests_failed();
    CU_cleanup_registry();
    printf("%u passed, %u failed\n", run - failed, failed);
    return run == 0 || failed > 0;
}
