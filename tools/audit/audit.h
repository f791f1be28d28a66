/*
 * make audit: every number of golden/vectors and every closed form of validation/theory that the checks use, computed a second time in
 * quadruple precision (33 digits) by another derivation. No formula text is shared: forces are derivatives of energies and dissipations,
 * resistances come from lubrication integrals and from the exact two-sphere series, one-sphere drag from Stokes's velocity field.
 *
 * Each file opens with its derivation. Symbols and conventions are those of validation/theory/theory.h.
 */
#ifndef AUDIT_H
#define AUDIT_H

#include "theory.h"

#include <quadmath.h>

typedef __float128 quad;
#define PIQ acosq(-1)      /* M_PIq has a suffix that ISO C does not know */

/* --- books: report.c --- */

/*
 * A quantity: what, by which other derivation, how far the two may differ and why, and which functions of theory.h (separated by spaces)
 * have their second derivation with it. audit_see compares one value; the error is measured against `scale`.
 */
void audit_quantity(const char *what, const char *how, double tolerance, const char *reason, const char *functions);
void audit_see(double theory, quad audit, double scale, const char *where);
void audit_see_list(const double *theory, const quad *audit, int count, double scale, const char *where);
/* A failure that is no difference of two numbers. */
void audit_fault(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Closes the last quantity, prints the summary; 0, or 1 where a bar is not met. `header`: theory.h, whose functions should all be covered;
 * null: do not ask. */
int audit_close(const char *header);

/* --- small things --- */

static inline quad dotq(const quad a[3], const quad b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void crossq(const quad a[3], const quad b[3], quad out[3])
{
    const quad c[3] = { a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0] };
    for (int k = 0; k < 3; k++)
        out[k] = c[k];
}
/* Double exponential quadrature of a smooth f over (from, to), to about 25 digits; the ends may be singular. quadrature.c */
quad integral(quad (*f)(quad x, const void *with), const void *with, quad from, quad to);
/* Gauss-Legendre points in (-1, 1). */
void gauss_points(int n, quad *point, quad *weight);
/*
 * y' = f(t, y), n variables, from t = 0 over `duration`: Gragg's midpoint rule extrapolated in the step (Bulirsch & Stoer), error per step
 * below `tolerance` times scale[k]. Where f has a corner steps shorten until it does not matter. Stops early, returning the time, when
 * `until` (may be null) turns from negative to positive; that moment is found by halving.
 */
quad solve(void (*f)(quad t, const quad *y, quad *dydt, const void *with), const void *with, int n, quad *y, quad duration, double tolerance,
           const double *scale, quad (*until)(const quad *y, const void *with));
enum { MOST_VARIABLES = 32 };

/* --- near contact: near_field.c, two_spheres.c --- */

/* The seven scalars of theory_scalars, with the same cut-offs, from lubrication integrals. */
void near_field_scalars(quad viscosity, quad inner, quad outer, bool exact, quad a1, quad a2, quad distance, quad scalar[THEORY_SCALARS]);
/* Coefficients of 1/xi and of ln(1/xi) in the seven scalars. */
void near_field_coefficients(quad viscosity, quad a1, quad a2, quad inverse[THEORY_SCALARS], quad logarithm[THEORY_SCALARS]);
void audit_two_spheres(void);

/* --- pairs: pair.c --- */

/* A pair in quadruple precision: places and motions. Virtual motions are put into it to take derivatives. */
struct quad_pair { quad radius[2], x[2][3], u[2][3], w[2][3]; };
struct quad_pair quad_pair_of(const struct theory_sphere s[2]);
struct quad_answer { quad force[2][3], torque[2][3], stress[3][3], balance[3] /* T_1 + T_2 + r x F_2 */; };

/* The dissipation of a lubricated pair is a sum of squares, c (d . v)^2 over the modes of motion that cost anything: squeezing, sliding, rolling. */
struct modes { int count; quad size[5], motion[5][12]; /* order U_1 U_2 W_1 W_2 */ };
struct modes lubrication_modes(const struct theory_lubrication *law, const struct quad_pair *p);
void lubrication_answer(const struct theory_lubrication *law, const struct quad_pair *p, struct quad_answer *out);
void contact_answer(const struct theory_contact *law, const struct quad_pair *p, const quad history[3], struct quad_answer *out);
void repulsion_answer(const struct theory_repulsion *law, const struct quad_pair *p, struct quad_answer *out);
/* Stokes's flow around one sphere: drag, torque, stresslet in the flow G x. sphere.c */
void drag_answer(quad viscosity, bool torque, quad G[3][3], quad a, const quad x[3], const quad u[3], const quad w[3], quad force[3],
                 quad moment[3], quad stresslet[3][3]);
quad damping_ratio_of(quad restitution, bool clip);         /* zeta/(2 sqrt(m k)) of a head-on impact: collisions.c */

/* --- what is audited --- */

void audit_vectors(const char *folder);
void audit_pairs(void);
void audit_spheres(void);
void audit_collisions(void);
void audit_impacts(void);
void audit_motion(void);
void audit_crowds(void);

#endif
