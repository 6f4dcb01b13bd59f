// SPDX-License-Identifier: GPL-2.0-or-later
// The problem of grains solved by its Delassus matrix, with any solver of the registry.
#pragma once

#include "solver/global/on_grains.hpp"

inline nscd::SolverReport solve_as_matrix(nscd::Problem &problem, const nscd::SolverOptions &options,
                                          const nscd::SolverEntry &solver)
{
  return nscd::with_mechanics(problem, [&](const auto &mechanics) {
    return nscd::solve_assembled(problem, mechanics, options, solver.solve_global);
  });
}
