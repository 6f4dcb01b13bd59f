// SPDX-License-Identifier: GPL-2.0-or-later
// Solvers of all contacts at once, on grains: by the Delassus matrix of these.
#pragma once

#include "problem/delassus.hpp"
#include "solver/any_mechanics.hpp"

#include <algorithm>

namespace nscd {

// Solves the problem of grains by solve(GlobalProblem &, options); the criterion is then that of the bodies.
// Such solvers know one norm of all contacts. Where that is met and an island or a contact is off, they are asked for
// as much more.
template <class M, class Solve>
SolverReport solve_assembled(Problem &grains, const M &mechanics, const SolverOptions &options, Solve solve)
{
  constexpr int most_times = 4;
  SolverReport report;
  report.iterations = 0;
  SolverOptions asked = options;
  for (int times = 0; times < most_times; ++times) {
    AssembledProblem assembled(grains, mechanics);
    const SolverReport done = solve(assembled.problem(), asked);
    assembled.write_back(grains, mechanics);
    const int iterations = report.iterations + done.iterations;
    report = done;
    report.iterations = iterations;
    report.criterion = measure(grains, mechanics, nullptr);
    report.converged = solved(report.criterion, options);
    asked.maxiter -= done.iterations;
    const bool only_some = done.converged && is_met_by_sums(report.criterion, options.goal());
    if (report.converged || !only_some || report.at_round_off || asked.maxiter < 1) break;
    asked.tol *= 0.1 / std::max(1.0, excess(report.criterion, options.goal()));
  }
  return report;
}

// The same of a struct whose solve() takes any frame; a matrix it is handed goes to that as it is.
template <class Solver>
struct Assembled {
  static constexpr double default_parameter = Solver::default_parameter;

  template <class M>
  static SolverReport solve(Problem &grains, const M &mechanics, const SolverOptions &options)
  {
    return solve_assembled(grains, mechanics, options, [](GlobalProblem &problem, const SolverOptions &asked) {
      return Solver::solve(problem, typename M::Frame{}, asked);
    });
  }

  template <class F>
  static SolverReport solve(GlobalProblem &problem, const F &frame, const SolverOptions &options)
  {
    return Solver::solve(problem, frame, options);
  }
};

}    // namespace nscd
