/* Vectors and 3x3 matrices: the few operations that the equations use. */
#ifndef CORE_VEC3_H
#define CORE_VEC3_H

#include <math.h>

typedef struct { double x, y, z; } vec3;
typedef struct { double m[3][3]; } mat3;            /* m[row][column] */

static inline vec3 vec(double x, double y, double z) { return (vec3){ x, y, z }; }
static inline vec3 plus(vec3 a, vec3 b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline vec3 minus(vec3 a, vec3 b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline vec3 scaled(vec3 a, double s) { return vec(a.x * s, a.y * s, a.z * s); }
static inline double dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline double norm(vec3 a) { return sqrt(dot(a, a)); }

static inline vec3 cross(vec3 a, vec3 b)
{
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/* The part of a perpendicular to the unit vector n: (I - n n) a. */
static inline vec3 across(vec3 a, vec3 n) { return minus(a, scaled(n, dot(a, n))); }

static inline vec3 mat3_times(const mat3 *A, vec3 b)
{
    return vec(A->m[0][0] * b.x + A->m[0][1] * b.y + A->m[0][2] * b.z,
               A->m[1][0] * b.x + A->m[1][1] * b.y + A->m[1][2] * b.z,
               A->m[2][0] * b.x + A->m[2][1] * b.y + A->m[2][2] * b.z);
}

static inline mat3 mat3_product(const mat3 *A, const mat3 *B)
{
    mat3 C;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            C.m[r][c] = A->m[r][0] * B->m[0][c] + A->m[r][1] * B->m[1][c] + A->m[r][2] * B->m[2][c];
    return C;
}

static inline vec3 mat3_column(const mat3 *A, int c) { return vec(A->m[0][c], A->m[1][c], A->m[2][c]); }

/* A += s a (x) b */
static inline void mat3_add_outer(mat3 *A, double s, vec3 a, vec3 b)
{
    const double u[3] = { a.x, a.y, a.z }, v[3] = { b.x, b.y, b.z };
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            A->m[r][c] += s * u[r] * v[c];
}

#endif
