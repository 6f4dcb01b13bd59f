// SPDX-License-Identifier: GPL-2.0-or-later
// The interior point (interior_point.cpp), for AUTO and for the registry.
#pragma once

#include "base/error.hpp"
#include "solver/solver.hpp"

namespace nscd {

class InteriorPoint {
 public:
  static constexpr double default_parameter = 0;
  // A contact has one cone here.
  template <class F>
  static constexpr bool takes = F::discs <= 1;

  template <class F>
  static SolverReport solve(GlobalProblem &problem, const F &, const SolverOptions &options)
  {
    if constexpr (!takes<F>) fail("solver interior_point is for contacts that only slide: choose another");
    find_diagonals<F>(problem);
    return solve(problem, options);
  }

 private:
  static SolverReport solve(GlobalProblem &problem, const SolverOptions &options);
};

}    // namespace nscd
