// Nonlinear Gauss-Seidel (section 3.2): sweep over the contacts, solve each with the others held, until the
// criterion is met. The local law is a template argument, so each law gets its own inlined loop.
//
// Makes exact: the motion (bodies always carry the impulses of the contacts). Fails by stalling: the sweeps
// needed grow with the length of force chains (about 0.93 N^2 a decade on a column of N) and with the mass
// ratio of a heavy body on a light one.
//
// Source: Jean & Moreau (1992), Jean (1999). Deviation: no relaxation.
#pragma once

#include "solver.hpp"
#include "hot.hpp"

#include <cmath>
#include <cstddef>

namespace nscd {

// What a local law works on: the impulse and (1 + e) v~.
struct Local {
  double impulse;
  double velocity;
};

// One sweep. Returns the sum over the contacts of the velocity that each visit corrected, m/s.
template <class Law>
NSCD_HOT double sweep(Problem &problem, [[maybe_unused]] double *carried, double parameter)
{
  Body *const bodies = problem.bodies.data();
  Contact *const contacts = problem.contacts.data();
  const std::size_t n = problem.contacts.size();
  double corrected = 0;
  for (std::size_t k = 0; k < n; ++k) {
    Contact &c = contacts[k];
    const Body bi = bodies[c.i], bj = bodies[c.j];
    const double v = dot(c.normal, bi - bj) + c.bias;
    Local local{c.impulse, 0};
    if constexpr (Law::carries_velocity) local.velocity = carried[k];
    local = Law::visit(local, v, c.w_inverse, parameter);
    if constexpr (Law::carries_velocity) carried[k] = local.velocity;
    const double dp = local.impulse - c.impulse;
    c.impulse = local.impulse;
    bodies[c.i] = bi + c.normal * (dp * bi[3]);
    bodies[c.j] = bj - c.normal * (dp * bj[3]);
    corrected += std::abs(dp) * (bi[3] + bj[3]);
  }
  return corrected;
}

// The criterion costs a pass of its own, so far from convergence it is not taken: (42) is bounded by about
// what the last sweep corrected. Close to it the passes are spread so that the count overshoots by < 2 %.
template <class Law>
SolverReport nlgs(Problem &problem, const SolverOptions &options)
{
  constexpr int always_checked = 4;
  SolverReport report;
  const std::size_t n = problem.contacts.size();
  if (n == 0) return report;
  if (Law::carries_velocity) problem.workspace.assign(n, 0.0);
  double *const velocity = Law::carries_velocity ? problem.workspace.data() : nullptr;
  int next_check = 0;
  report.converged = false;
  for (int s = 1; s <= options.maxiter && !report.converged; ++s) {
    const double corrected = sweep<Law>(problem, velocity, options.parameter);
    report.iterations = s;
    const bool close = !(corrected > 4 * options.tol * double(n)) && s >= next_check;
    if (s > always_checked && !close && s < options.maxiter) continue;
    report.criterion = measure(problem, velocity);
    report.converged = report.criterion.total() < options.tol;
    next_check = s + 1 + s / 64;
  }
  return report;
}

}    // namespace nscd
