/*
 * Questions that are answered elsewhere (docs/adapter.md, "Runs made elsewhere"): a check asks as ever, and where the folder of exported questions holds
 * the answer it is taken. Where it does not, invented numbers are handed back so that the check asks on; this is done twice with different numbers, and
 * what was asked both times does not hang on them: those questions are written out. Nothing judged from invented numbers is kept.
 */
#ifndef OFFLINE_H
#define OFFLINE_H

#include "check.h"

struct offline {
    const char *root;           /* the exported folder */
    const char *gate_case;      /* name; questions are below root/gate_case */
    unsigned pass;              /* 1 or 2: which invented numbers */
    size_t missing;             /* questions of this pass without an answer */
    struct missing { char place[256]; uint64_t hash; } *question;
};

/* The answer to the question in work/<place>, place = `folder` beyond `work`; files are linked into `out`. False: there is none; it has been noted. */
bool offline_find(struct offline *o, const char *work, const char *folder, const char *out, struct candidate_answer *answer);
/* Whether something judged now would rest on invented numbers. */
bool offline_waits(const struct candidate *c);
/* Invented numbers of the form that the question asks for. */
bool offline_pretend(const struct offline *o, const struct question *q, const char *out);
void offline_free(struct offline *o);

/*
 * One case: results are those of check_judge if everything was answered; else what waits has been written below `root`, and one inconclusive result says
 * how much it is.
 */
void offline_judge(struct check_run *run, const struct check *check, int p_values, unsigned seed_offset, const char *root);

/* questions.txt, run.sh and README.txt of the folder. `waiting`: questions without an answer. False with a reason. */
bool offline_list(const char *root, size_t *questions, size_t *waiting, char why[WHY_LENGTH]);

#endif
