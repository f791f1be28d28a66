/* Text inside XML and HTML: one escape for both. */
#ifndef MARKUP_H
#define MARKUP_H

#include <stdio.h>

void markup_text(FILE *file, const char *text); /* & < > " escaped, control characters dropped */

#endif
