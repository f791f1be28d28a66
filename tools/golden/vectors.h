/*
 * Golden vectors: inputs and expected outputs of one physics term per file, as JSON (docs/vectors.schema.json), so that a project can
 * embed them in its own tests without our programs. Expected values come from validation/theory; nothing here knows the solver.
 *
 * A vector is a bag of named numbers. Each number is written twice: with 17 significant digits, and as a hexadecimal float, in objects
 * of the same shape (`input` and `input_hex`, `expected` and `expected_hex`). Both are exact.
 */
#ifndef VECTORS_H
#define VECTORS_H

#include "theory.h"

#include <stdio.h>

enum { FIELDS = 24, LONGEST = 144 };

/* Named numbers, lists of numbers, and words, in the order in which they are added. */
struct fields {
    int count;
    struct { const char *name, *word; int length /* 0: one number */; double value[LONGEST]; } item[FIELDS];
};
void add_number(struct fields *f, const char *name, double value);
void add_list(struct fields *f, const char *name, const double *value, int length);
void add_word(struct fields *f, const char *name, const char *word);

/*
 * `valid`: follows from the model whose numbers the group states. `acceptable`: rests also on the convention that the first flag
 * names; a code that has chosen otherwise may differ.
 */
struct vector {
    const char *comment, *result, *flags;       /* flags: separated by spaces, from the file's list; may be empty */
    struct fields input, expected;
    double force_scale, torque_scale, stress_scale, covariance_scale;      /* what an error is measured against; 0: not said */
};

struct vector_file {
    FILE *file;
    const char *term;
    int groups, vectors;        /* written so far; vectors of the whole file */
    int in_group;
};
/* `flags`: pairs of name and meaning, ended by a null. */
bool file_open(struct vector_file *f, const char *folder, const char *term, const char *about, const char *const flags[], double tolerance,
               const char *reason);
void file_group(struct vector_file *f, const char *kind, const char *about, const struct fields *model);
void file_vector(struct vector_file *f, const struct vector *v);
bool file_close(struct vector_file *f);

/* --- states: states.c --- */

/* Uniform numbers without a library: the same bits everywhere. */
struct dice { unsigned long long state; };
double dice_number(struct dice *d);                                     /* a multiple of 0.001 in [-1, 1] */
void dice_vector(struct dice *d, double size, double v[3]);
extern const double ratios[6];                                          /* a_2/a_1; a_1 is 1.3 */
void dice_pair(struct dice *d, double ratio, double xi, struct theory_sphere s[2]);
void exchange(struct theory_sphere s[2], double history[3]);            /* the same pair with the labels 1 and 2 exchanged */
double gap_of(const struct theory_sphere s[2]);                         /* 2 h/(a_1 + a_2) */
double speed_of(const struct theory_sphere *s), spin_of(const struct theory_sphere *s);
void add_pair(struct fields *f, const struct theory_sphere s[2]);       /* gap, radii, positions, velocities, spins */
void add_pair_answer(struct fields *f, const struct theory_pair *p);

/* --- one function a file --- */

bool vectors_contact_frictionless(const char *folder);
bool vectors_contact_friction(const char *folder);
bool vectors_contact_laws(const char *folder);
bool vectors_drag(const char *folder);
bool vectors_repulsion(const char *folder);
bool vectors_applied(const char *folder);
bool vectors_lubrication_scalars(const char *folder);
bool vectors_lubrication_resistance(const char *folder);
bool vectors_lubrication_forces(const char *folder);
bool vectors_noise_one_body(const char *folder);
bool vectors_noise_pair(const char *folder);
bool vectors_write_all(const char *folder, int *files);                 /* false: a file could not be written; said on stderr */

#endif
