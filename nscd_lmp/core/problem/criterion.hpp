// SPDX-License-Identifier: GPL-2.0-or-later
// The stopping criterion of Barboteu & Dumont (2017), equation (42), and a relative residual beside it.
//
//   eps_glob = 1/N_c sum_c [ eps_motion + eps_bc + eps_pen ]
//   eps_motion = |v~ - v~_m|   the local solver's own velocity against the one that the bodies have
//   eps_bc     = |v~ . p + mu p_n |u_t||   the bipotential, 0 iff Signorini's and Coulomb's laws hold
//   eps_pen    = -min(0, v~_n) penetration
//
// Deviation: (28) has the indicator of p in K_mu inside the bipotential, infinite for a tensile impulse. EBP,
// EAL and PDAS (gamma != 1) can pass through p < 0 with v~ = 0, which (42) as printed would accept; the
// indicator enters eps_bc as the velocity W~_nn |min(0, p)| instead. With friction, eps_bc also takes residuals in
// velocities: max(0, min(v, W_nn p)) where a contact pushes and separates, and W_tt |p_t - proj(p_t - u_t/W_tt,
// B(0, mu p_n))| where Coulomb's law does not hold. The bipotential of small grains is too small a number to see either
// of them, and it is infinite for stick.
//
// (42) adds m/s and N m, so it means nothing across scales. Reported beside it is the natural map used in
// the FCLIB comparisons (Acary, Bremond, Huber 2018), in velocities:
//   relative = || W_nn (p - max(0, p - v/W_nn)),  W_tt (p_t - proj(...)) ||_2 / || v_free ||_2.
// A sum says nothing of a single contact: closer_look.hpp.
#pragma once

#include "contact/frame.hpp"
#include "problem/global_problem.hpp"
#include "problem/problem.hpp"

namespace nscd {

struct Criterion {
  double motion = 0;
  double bipotential = 0;
  double penetration = 0;
  double relative = 0;
  double island = 0;    // not below `relative`; with the next two, closer_look.hpp
  double worst = 0;
  double typical = 0;   // of what forces do in a step
  double approach = 0;  // a contact's -v_n over what may be left of it, the largest
  double total() const { return motion + bipotential + penetration; }
};

// Whether the sums over all contacts meet the goal, whatever single contacts or islands do.
bool is_met_by_sums(const Criterion &criterion, const Goal &goal);

// `local_velocity`: the (1 + e) v~ that a local solver carries, one a contact (with friction as carried_velocity.hpp
// lays them out), or nullptr if it carries none.
Criterion measure(const Problem &problem, const double *local_velocity = nullptr);
// The same for whom knows the mechanics; defined in criterion_of.hpp, where another mechanics finds it.
template <class M>
Criterion measure(const Problem &problem, const M &mechanics, const double *local_velocity);

// The same of p with the velocities u (n, dim) that it gives; F is the frame of the contacts.
template <class F>
Criterion measure(const GlobalProblem &problem, const F &frame, const double *u, const double *local_velocity);

extern template Criterion measure(const Problem &, const Frictionless &, const double *);
extern template Criterion measure(const Problem &, const Frictional<Planar> &, const double *);
extern template Criterion measure(const Problem &, const Frictional<Spatial> &, const double *);
extern template Criterion measure(const GlobalProblem &, const Frame<> &, const double *, const double *);
extern template Criterion measure(const GlobalProblem &, const Frame<1> &, const double *, const double *);
extern template Criterion measure(const GlobalProblem &, const Frame<2> &, const double *, const double *);

}    // namespace nscd
