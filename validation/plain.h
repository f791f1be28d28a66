/*
 * Questions and answers as plain text (docs/adapter.md), for programs without JSON: lines `name value`, tables of fixed columns that
 * Fortran reads and writes with list-directed statements.
 */
#ifndef PLAIN_H
#define PLAIN_H

#include "tables.h"

/* Writes case.txt: every scalar of both objects, and lines that save work (forces, cell, gradient, volume). */
bool plain_write_case(const char *folder, const json_t *question, const json_t *scene, char why[WHY_LENGTH]);
bool plain_write_states(const char *folder, const struct state_row *row, size_t rows, char why[WHY_LENGTH]);
bool plain_write_contacts(const char *folder, const struct contact_row *row, size_t rows, char why[WHY_LENGTH]);

/* What the answer to a question may hold. */
struct plain_shape {
    const char *protocol;
    size_t particles;           /* of a state */
    bool turn;                  /* trajectory has turn_x, turn_y, turn_z */
};

/*
 * Where the candidate wrote a .txt and no file of the usual name: makes forces.csv, stress.csv, trajectory.csv, noise_*.npy, friction.npy of
 * it in `out`. False where a .txt is no such table; why has file, line and value.
 */
bool plain_answers(const char *out, const struct plain_shape *shape, char why[WHY_LENGTH]);

/* Writes NPY 1.0, shape (rows, particles, 6). */
bool npy_write(const char *path, size_t rows, size_t particles, const double *value, char why[WHY_LENGTH]);

#endif
