/*
 * The friction step pair by pair: one factor after the other, forward over dt/2 and backward over dt/2
 *
 *     v' = B P_1 P_2 ... P_K  P_K ... P_2 P_1 B v        (the rightmost acts first)
 *
 *     B     drag and its noise of every lone particle      each factor is the midpoint (Cayley) step of core/friction.h over dt/2,
 *     P_k   lubrication of pair k and its noise            with that part of R and noise of its own
 *
 * Pairs are in the order of their smaller tag, then of the larger, then of the image in the never-remapped lattice: an order that no
 * list, no loop and no wrapping changes. Other labels are another order, and the path differs by that; it is second order in dt.
 *
 * Each factor keeps momentum (P) and the Maxwell distribution exactly, so the product does, at any dt. What the order biases is how fast
 * friction acts: factors that share a particle do not commute. Global diffusion and terminal velocity are therefore right only while
 * X_A dt/m_eff is small (docs/integrators.md). There is nothing to iterate and no residual.
 *
 * Source: Shardlow (2003), for dissipative particle dynamics; Strang (1968) for the order of the factors.
 */
#ifndef CORE_SWEEPS_H
#define CORE_SWEEPS_H

#include "core/friction.h"

/* U, W over dt at fixed positions. `f->change` is (v' - v)/2 afterwards; the stress is that of the impulses applied. */
bool sweeps_step(struct friction *f, struct suspension *s, struct error *e);

#endif
