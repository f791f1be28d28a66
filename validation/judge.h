/* One case against one candidate: what it declares is respected, conventions are named, answers come from it or from an exported folder. */
#ifndef JUDGE_H
#define JUDGE_H

#include "check.h"

/* run->gate_case, candidate and work are set; `offline`: the exported folder, or null. */
void judge_case(struct check_run *run, const struct check *check, int p_values, unsigned seed_offset, const char *offline);

#endif
