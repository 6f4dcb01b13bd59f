// SPDX-License-Identifier: GPL-2.0-or-later
// Solvers as the registry wants them, of structs whose solve() takes any mechanics or any frame.
#pragma once

#include "solver/solver.hpp"

namespace nscd {

template <class Solver>
SolverReport on_any_grains(Problem &problem, const SolverOptions &options)
{
  return with_mechanics(problem, [&](const auto &mechanics) { return Solver::solve(problem, mechanics, options); });
}

template <class Solver>
SolverReport on_any_matrix(GlobalProblem &problem, const SolverOptions &options)
{
  SolverReport report;
  with_frame(problem.dim(), [&]<class F>(const F &frame) { report = Solver::solve(problem, frame, options); });
  return report;
}

}    // namespace nscd
