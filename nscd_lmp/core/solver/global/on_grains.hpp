// SPDX-License-Identifier: GPL-2.0-or-later
// Solvers of all contacts at once, on grains: by the Delassus matrix of these.
#pragma once

#include "solver/solver.hpp"

namespace nscd {

// Solves the problem of grains by a solver of all contacts at once; the criterion is then that of the bodies.
SolverReport solve_assembled(Problem &grains, const SolverOptions &options,
                             SolverReport (*solve)(GlobalProblem &, const SolverOptions &));

// The same as a registry's entry wants it.
template <SolverReport (*solve)(GlobalProblem &, const SolverOptions &)>
SolverReport on_grains(Problem &grains, const SolverOptions &options)
{
  return solve_assembled(grains, options, solve);
}

}    // namespace nscd
