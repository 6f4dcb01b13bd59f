// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/global/on_grains.hpp"

#include "problem/delassus.hpp"

#include <algorithm>

namespace nscd {

// These solvers know one norm of all contacts. Where that is met and an island or a contact is off, they are asked for
// as much more.
SolverReport solve_assembled(Problem &grains, const SolverOptions &options,
                             SolverReport (*solve)(GlobalProblem &, const SolverOptions &))
{
  constexpr int most_times = 4;
  SolverReport report;
  report.iterations = 0;
  SolverOptions asked = options;
  for (int times = 0; times < most_times; ++times) {
    AssembledProblem assembled(grains);
    const SolverReport done = solve(assembled.problem(), asked);
    assembled.write_back(grains);
    const int iterations = report.iterations + done.iterations;
    report = done;
    report.iterations = iterations;
    report.criterion = measure(grains);
    report.converged = solved(report.criterion, options);
    asked.maxiter -= done.iterations;
    const bool only_some = done.converged && is_met_by_sums(report.criterion, options.goal());
    if (report.converged || !only_some || report.at_round_off || asked.maxiter < 1) break;
    asked.tol *= 0.1 / std::max(1.0, excess(report.criterion, options.goal()));
  }
  return report;
}

}    // namespace nscd
