/* What the gate prints while it runs. */
#ifndef TERMINAL_H
#define TERMINAL_H

#include "report.h"

void terminal_open(const struct provenance *p);                 /* the first line, and the heads of the columns */
void terminal_case(const struct finished_case *done);           /* one line, and what is wrong in full sentences */
/* Terms, names by verdict, time; ends with the counts. */
void terminal_close(const struct provenance *p, const struct finished_case *done, size_t count, struct tally t);

/* The numbers of a result as short text: at most `room` characters; "-" where there is none. */
void terminal_number(char *text, size_t room, double x);
void terminal_error(char *text, size_t room, const struct result *r);   /* "3.1e-13", or "p 0.04" */

#endif
