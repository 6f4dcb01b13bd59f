// SPDX-License-Identifier: GPL-2.0-or-later
// What a solver of the contact problem is, and the one list of them.
//
// A solver is a function; its file registers it, and every choice list (fix nscd, attach, solve, the command line),
// test and legend reads the registry. Adding one means adding one file: to local/ a law inside NLGS, to global/
// anything else.
#pragma once

#include "problem/criterion.hpp"
#include "problem/global_problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace nscd {

struct SolverReport {
  int iterations = 0;
  bool converged = true;      // or accepted
  bool accepted = false;      // above tol, but good enough for what it has cost
  bool at_round_off = false;  // no solver gets further
  bool ran_away = false;      // velocities are not those of the impulses any more
  Criterion criterion;
};

// Sweeps with friction end where more of them change nothing that can be seen (docs/friction_accuracy.md).
constexpr double accepted_tolerances = 30, most_accepted = 0.1;

// When an answer may be accepted: after so many sweeps and visits of contacts, since sweeps of few cost nothing.
struct Budget {
  int sweeps = 0;   // 0: never
  double visits = 0;
  int most = std::numeric_limits<int>::max();   // sweeps that there may be: what is good enough then is accepted too
  int spent = 0;    // by those that come before in the same step

  // The first sweep after which it may be; 0: never.
  int of(std::size_t contacts) const
  {
    if (sweeps == 0) return 0;
    return std::max(1, int(std::min(std::max(double(sweeps), visits / double(contacts)), double(most))) - spent);
  }
};

struct SolverOptions {
  double tol = 1e-7;
  int maxiter = 1000;
  double parameter = 1;  // rho or gamma as a multiple of 1/W_nn
  Stop stop = Stop::paper;
  Budget budget{};   // for an answer within accepted_goal()
  Goal goal() const { return {stop, tol}; }
  // Of the natural map; the same bound on approaches.
  Goal accepted_goal() const
  {
    return {stop, std::min(accepted_tolerances * tol, most_accepted), off_of_accepted};
  }
  bool goes_on = false;    // another solve carries the answer on: none is kept on the way
  double alternative = 0;  // sweeps that another solver would cost: give up if more seem to be needed; 0: never
  std::vector<SolverReport> *history = nullptr;  // gets a row whenever the criterion is measured, if given
};

// What the stopping rule looks at, and whether it is met.
double judged(const Criterion &criterion, const SolverOptions &options);
bool solved(const Criterion &criterion, const SolverOptions &options);
bool meets(const Criterion &criterion, const Goal &goal);

// How many times too large the sums, the worst contact or the worst island are.
double excess(const Criterion &criterion, const Goal &goal);

// Whether one iterate is nearer to the goal than another.
bool is_better(const Criterion &one, const Criterion &other, const SolverOptions &options);

struct SolverEntry {
  int order;                         // place in choice lists and legends
  std::string_view name;             // keyword
  std::string_view title;            // for legends
  std::string_view kind;             // "local law": of NLGS; "global": all contacts at once
  std::string_view parameter = "";   // "rho", "gamma" or none
  double default_parameter = 0;      // multiple of 1/W_nn
  bool friction;                     // whether it takes contacts with friction
  bool ranks;                        // whether its iterations go across ranks; others are solve_by_ranks' inner solver
  SolverReport (*solve)(Problem &, const SolverOptions &);              // grains
  SolverReport (*solve_global)(GlobalProblem &, const SolverOptions &);  // any Delassus matrix
};

const std::vector<SolverEntry> &solvers();

// Those that take contacts with friction.
std::vector<SolverEntry> frictional_solvers();

// Raises Error naming the choices.
const SolverEntry &find_solver(std::string_view name);

struct RegisterSolver {
  explicit RegisterSolver(const SolverEntry &entry);
};

}    // namespace nscd
