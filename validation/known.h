/*
 * Accepted failures: a file that the owner of a candidate keeps beside it, so that CI is red only on what is new, on what
 * has healed (the entry must go), and on what has been accepted for too long.
 *
 *     { "known": [ { "case": "drag", "quantity": "*: stresslet", "reason": "...", "expires": "2027-03-31" } ] }
 *
 * `quantity` is a shell pattern for the quantities meant; absent: all of the case. docs/known.schema.json
 */
#ifndef KNOWN_H
#define KNOWN_H

#include "report.h"

struct known_entry { const char *case_name, *quantity, *reason, *expires; bool expired; };
struct known_list { json_t *json; struct known_entry *item; size_t count; };

/* `today` as YYYY-MM-DD: an entry is valid up to and on its day. Every entry must name a case of the suite. */
bool known_load(const char *path, const struct suite_of_cases *suite, const char *today, struct known_list *list,
                char why[WHY_LENGTH]);
void known_free(struct known_list *list);

/* Marks the results that an entry accepts, and sets verdict, standing and remark of the case. A null list: nothing is known. */
void known_settle(const struct known_list *list, struct finished_case *done);

#endif
