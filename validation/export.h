/* The folder of `gate export`: which options its questions belong to, so that `gate judge` asks the same (gate-export.json in it). */
#ifndef EXPORT_H
#define EXPORT_H

#include "offline.h"

/* Whether the option decides what is asked, and so belongs to the folder. */
bool export_keeps(const char *option);
/* Makes the folder, which must be empty or not there, and notes options ("--layer", "pair", ...); a capabilities file is copied into it. */
bool export_begin(const char *folder, int count, char **options, const char *capabilities, char why[WHY_LENGTH]);
/* The options of an exported folder, as an object that the caller owns. */
bool export_options(const char *folder, json_t **options, char why[WHY_LENGTH]);

#endif
