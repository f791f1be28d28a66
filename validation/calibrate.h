/*
 * False alarms, counted: the statistical checks with many seeds on a candidate that is right.
 *
 * A row per seed offset is appended to a CSV file as it ends: verdicts and the first p-value of every statistical result. A file of the
 * same statistical cases is continued where it ends, with a line that names the candidate wherever that is another build; a file of other
 * cases is refused. The summary is read from the file alone.
 */
#ifndef CALIBRATE_H
#define CALIBRATE_H

#include "run.h"

/* Offsets 1 to `seeds`. False with a reason: the file belongs to other cases, or cannot be written. */
bool calibrate_run(struct run_plan *plan, const struct provenance *p, unsigned seeds, const char *file, char why[WHY_LENGTH]);

/*
 * Prints, for every check, how many p-values lie below 0.01, 0.001 and 1e-4, the smallest, and the Kolmogorov-Smirnov p of their being
 * uniform; then the count of false verdicts and its bound. 0, or 1 when a verdict was false.
 */
int calibrate_summary(const char *file, char why[WHY_LENGTH]);

#endif
