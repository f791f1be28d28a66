/*
 * Errors: a function that can fail returns false (or NULL) after writing one clear sentence here. The first error stays;
 * later ones, its consequences, are ignored. Only the program prints and exits, with the code kept here.
 */
#ifndef CORE_ERROR_H
#define CORE_ERROR_H

#include <stdbool.h>
#include <stddef.h>

enum { ERROR_RUN = 1, ERROR_INPUT = 2, ERROR_UNSUPPORTED = 77, ERROR_INTERRUPTED = 130 };      /* exit codes */

struct error { int code; char text[600]; };

bool error_raise(struct error *e, int code, const char *format, ...) __attribute__((format(printf, 3, 4)));
bool error_out_of_memory(struct error *e);
bool error_within(struct error *e, const char *place);       /* puts "place: " before the sentence; true if there is no error */
static inline bool error_raised(const struct error *e) { return e->code != 0; }

#endif
