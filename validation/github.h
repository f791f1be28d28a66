/*
 * What GitHub Actions shows: annotations beside the code, at most ten (GitHub shows no more), and a Markdown page of the step.
 * Both are written where the environment says that GitHub runs us: GITHUB_ACTIONS=true, GITHUB_STEP_SUMMARY=FILE.
 */
#ifndef GITHUB_H
#define GITHUB_H

#include "report.h"

#include <stdio.h>

/*
 * `known_file`: where annotations about healed and expired entries point to; may be null. Those about the physics point to the
 * candidate's own file, the first word of its command that is a file below the current folder.
 */
void github_annotate(FILE *out, const struct provenance *p, const struct finished_case *done, size_t count, const char *known_file);
void github_summary(FILE *out, const struct provenance *p, const struct finished_case *done, size_t count);

/* Both, if we run in GitHub Actions; else nothing. The summary is appended. False if it cannot be written. */
bool github_report(const struct provenance *p, const struct finished_case *done, size_t count, const char *known_file,
                   char why[WHY_LENGTH]);

#endif
