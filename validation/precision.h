/*
 * What a declared precision costs: every deterministic tolerance is raised by K eps, eps the unit roundoff declared, K = 4 C sqrt(n) with the condition
 * number C of the question and n its steps (docs/adapter.md).
 */
#ifndef PRECISION_H
#define PRECISION_H

#include "check.h"

/* Beyond this nothing is judged: a result that is only as good as that is no verdict. */
#define ALLOWANCE_AT_MOST 0.01

/* How much a relative change of the numbers given changes the answer: the largest (|x| + a)/|h| over pairs within reach, 1 without pairs. */
double question_condition(const json_t *scene, const struct state_row *row, size_t rows);
/* Number of steps of a run, and dt; what cannot be read off is a million, and NaN. */
double question_steps(const json_t *scene);
double question_dt(const json_t *scene);
/* Raises run->allowance for this question, where the candidate is no double. */
void precision_allow(struct check_run *run, const struct question *q);
/*
 * Takes gaps out of the parameters of a case ("xi", "kappas") that lie so close to where a force begins or ends that rounded positions may be on the other
 * side. Returns parameters that the caller owns.
 */
json_t *precision_parameters(const struct capabilities *c, const json_t *parameters, const json_t *scene);
/* Raises run->allowance to this, with a reason that begins "for". */
void allow(struct check_run *run, double allowance, const char *reason, ...) __attribute__((format(printf, 3, 4)));

#endif
