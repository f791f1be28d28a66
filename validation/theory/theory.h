/*
 * Closed forms that the gate holds a candidate to. Nothing here includes or calls the solver.
 *
 * Conventions: n points from particle 1 to particle 2; forces are those on a particle; stress is positive in tension;
 * laboratory velocities. Every function names its source and a second origin of its numbers.
 */
#ifndef THEORY_H
#define THEORY_H

#include <stdbool.h>
#include <stddef.h>

/* A sphere of a pair: radius [L], position [L], velocity [L/T], spin [1/T]. */
struct theory_sphere { double radius, x[3], u[3], w[3]; };

/* Force and torque on both spheres, and the stress sum F_1 (x) (x_2 - x_1) [M L^2/T^2] (not divided by a volume). */
struct theory_pair { double force[2][3], torque[2][3], stress[3][3]; };

/* Model constants of Li (2026): what the candidate declares. */
struct theory_lubrication { double viscosity, inner_gap, outer_gap; bool exact_rotation; };
enum theory_law { THEORY_PLAIN, THEORY_CRITICAL, THEORY_SOFT, THEORY_SHIFTED, THEORY_BINARY };
enum theory_load { THEORY_LOAD_SPRING, THEORY_LOAD_DAMPED, THEORY_LOAD_ABSOLUTE };     /* the normal force that friction feels */
struct theory_contact {
    double normal_stiffness, tangential_stiffness, friction;
    bool lever_at_contact;
    /* What follows may be left zero: no dashpot, plain Coulomb friction. */
    enum theory_law law;
    double critical_load;
    bool rough[2];
    double normal_damping, tangential_damping, restitution;     /* gamma_n, gamma_t [1/T], or e in place of gamma_n */
    bool clip;                                                  /* no tension */
    enum theory_load load;
    double mass[2];                                             /* infinite: held or driven */
};
struct theory_repulsion { bool by_energy; double strength, kappa_factor, cutoff; };

/*
 * The pair resistance scalars of the truncated model at dimensionless gap xi: 0 X_A, 1 Y_A, 2 B_1, 3 B_2, 4 C_11, 5 C_12, 6 C_22.
 * Written from the near-field functions of Jeffrey & Onishi (1984) in their variables, lambda = a_2/a_1.
 */
enum { THEORY_XA, THEORY_YA, THEORY_B1, THEORY_B2, THEORY_C11, THEORY_C12, THEORY_C22, THEORY_SCALARS };
extern const char *const theory_scalar_name[THEORY_SCALARS];
void theory_scalars(const struct theory_lubrication *law, double a1, double a2, double distance, double scalar[THEORY_SCALARS]);

/* Grand resistance matrix of a pair, order U_1 U_2 W_1 W_2 (12 x 12, row-major), force = - R u. */
void theory_pair_resistance(const struct theory_lubrication *law, double a1, double a2, const double r[3], double R[144]);

/* Lubrication on a frozen pair, through the matrix. */
void theory_lubrication_pair(const struct theory_lubrication *law, const struct theory_sphere s[2], struct theory_pair *out);

/* Linear spring with tangential history (displacement of surface 1 relative to 2) and Coulomb cap, no time passing. */
void theory_contact_pair(const struct theory_contact *law, const struct theory_sphere s[2], const double history[3],
                         struct theory_pair *out);

/* The same with dashpots and any friction law. Cap of the tangential force at a load; negative: no friction at all. */
void theory_contact_laws_pair(const struct theory_contact *law, const struct theory_sphere s[2], const double history[3],
                              struct theory_pair *out);
double theory_friction_cap(const struct theory_contact *law, double load);
bool theory_contact_grips(const struct theory_contact *law, double overlap, double opening);  /* is there friction at all */
double theory_reduced_mass(const struct theory_contact *law);
double theory_normal_dashpot(const struct theory_contact *law);
/* Speed ratio of a head-on collision with damping ratio b = zeta/(2 sqrt(m k)), tension allowed or clipped; and back. */
double theory_restitution(double b, bool clip);
double theory_damping_ratio(double restitution, bool clip);

/* Exponential repulsion, and its potential. */
void theory_repulsion_pair(const struct theory_repulsion *law, const struct theory_sphere s[2], struct theory_pair *out);
double theory_repulsion_energy(const struct theory_repulsion *law, double a1, double a2, double gap);

/* Head-on collision: speed ratio, and the time from touch to where the free flight afterwards passes zero overlap. */
void theory_head_on(const struct theory_contact *law, double *restitution, double *duration);
/* Tangential impulse of gross sliding over (mu times the closing speed) [M]. */
double theory_sliding_impulse(const struct theory_contact *law);
/* Any collision that does not slide, friction being there or not, from touch at time 0, integrated to 1e-13 (lever and history as declared). */
struct theory_collision { const struct theory_contact *law; struct theory_sphere start[2]; };
bool theory_collide(struct theory_collision *c, double t, struct theory_sphere now[2]);

/* Stokes drag on one sphere in the flow U_inf = G x, G[a][b] = dU_a/dx_b; force, torque, stresslet (20/3) pi eta a^3 E. */
void theory_drag(double viscosity, bool with_torque, const double G[3][3], const struct theory_sphere *s,
                 double force[3], double torque[3], double stresslet[3][3]);

/* What the truncation leaves of angular momentum balance: T_1 + T_2 + r x F_2, for lubrication and for a contact (lever radius). */
void theory_lubrication_torque_residual(const struct theory_lubrication *law, const struct theory_sphere s[2], double residual[3]);
void theory_contact_torque_residual(const struct theory_contact *law, const struct theory_sphere s[2], const double history[3],
                                    double residual[3]);

/* Langevin sphere (Li 2026 eq 4.1, 4.2): per Cartesian component. mass m, friction zeta (6 pi eta a or 8 pi eta a^3 with m -> I). */
double theory_langevin_msd(double kT, double mass, double friction, double t);          /* started from equilibrium */
double theory_langevin_vacf(double kT, double mass, double friction, double t);
/* Covariance of (displacement, velocity) at two times for a sphere at equilibrium: <dx(s) dx(t)>. */
double theory_langevin_msd_covariance(double kT, double mass, double friction, double s, double t);

/*
 * A sphere without noise in the flow U_inf = G x, at time t after `start`: relaxation times m/(6 pi eta a) of the velocity and
 * I/(8 pi eta a^3) of the spin [T].
 */
void theory_free_sphere(const double G[3][3], double relaxation, double spin_relaxation, double t, const struct theory_sphere *start,
                        struct theory_sphere *now);

/*
 * The same in stages of shears with changing rates (driven_sphere.c). `open`: axes that are not periodic; with periodic gradient axes
 * the flow's acceleration carries the sphere along. And the flow itself: G(t), and the way |rate| of each stage's first shear integrates to.
 */
struct theory_rate { int flow, gradient; double mean, slope, amplitude, frequency, phase; };
struct theory_stage { double duration; size_t shears; struct theory_rate shear[4]; };
bool theory_driven_sphere(const struct theory_stage *stage, size_t stages, const bool open[3], double relaxation, double spin_relaxation, double t,
                          const struct theory_sphere *start, struct theory_sphere *now);
void theory_driven_flow(const struct theory_stage *stage, size_t stages, double t, double G[3][3], double *travelled);

/*
 * Coefficient c of sigma_xy = c phi^2 eta rate from the lubrication of affinely moving, affinely spinning (W = Omega_inf) equal spheres
 * placed at random (g = 1 beyond contact), by quadrature over gap and direction. About 9.7 for gaps 1e-3 to 0.05.
 */
double theory_phi2_coefficient(double inner_gap, double outer_gap, double *error_estimate);

/* Lubrication stress of a list of spheres in a periodic cell, brute force over all images within range: the sum of F (x) r over pairs. */
void theory_crowd_stress(const struct theory_lubrication *law, int count, const struct theory_sphere *s,
                         const double cell[3][3] /* rows A B C */, const double G[3][3], double stress[3][3]);

/* Two spheres in time: theory/pair_motion.c. Null laws: the force is not there. */
struct theory_motion {
    double radius[2], density[2];
    const struct theory_lubrication *lubrication;
    const struct theory_contact *contact;
    bool drag, drag_torque;
    double viscosity, gradient[3][3];       /* of the drag and of the flow U_inf = G x */
    double applied[2][3], applied_torque[2][3];     /* constant */
};
struct theory_pair_state { struct theory_sphere s[2]; double history[3]; /* of surface 1 against 2 */ };
double theory_sphere_mass(const struct theory_motion *m, int which);
/* Carry `p` on by `duration` to this relative accuracy per step (1e-12). False: the solution did not get there. */
bool theory_pair_motion(const struct theory_motion *m, double duration, double tolerance, struct theory_pair_state *p);
/* The integral of X_A over the gap h from `from` to `to`: momentum that squeezing takes from a pair, in closed form. */
double theory_squeeze_integral(const struct theory_lubrication *law, double a1, double a2, double from, double to);

/*
 * Encounters of equal spheres in steady shear (encounters.c), flow x, gradient y, rate gradient[0][1] > 0, no friction. One of them, coming from
 * far upstream at y0 > 0 and z0: time integrals of F (x) r, [contact, lubrication][symmetric xy, xx - yy, yy - zz]; `end`: the place where
 * it leaves. False: it does not leave. And what all of them add to stress/(eta rate phi^2), by radial x angular Gauss points.
 */
bool theory_encounter(const struct theory_motion *m, double y0, double z0, double tolerance, double impulse[2][3], double end[3]);
bool theory_sheared_pairs(const struct theory_motion *m, size_t radial, size_t angular, double coefficient[2][3]);

/* Spheres at equilibrium: P/(n kT) of the hard-sphere fluid, of a mixture from number densities and diameters, and the diameter of spheres with the contact k_n (hard_spheres.c). */
double theory_carnahan_starling(double phi);
double theory_mixture_pressure(int species, const double density[], const double diameter[]);
double theory_thermal_diameter(double radius, double stiffness, double kT);

/* Structural Brownian stress xx yy zz xy xz yz of spheres in a periodic cube (structural_stress.c). */
void theory_structural_stress(int count, const double (*x)[3], const double *radius, double edge, double kT, double fraction, double depth,
                              double stress[6]);

#endif
