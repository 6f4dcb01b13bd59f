// SPDX-License-Identifier: GPL-2.0-or-later
// The active set (active_set.cpp), for AUTO and for the registry.
#pragma once

#include "base/error.hpp"
#include "solver/solver.hpp"

namespace nscd {

struct FactorisedFaces {
  static constexpr double default_parameter = 0;

  static SolverReport solve(GlobalProblem &problem, const Frame<> &, const SolverOptions &options);
  template <class F>
  static SolverReport solve(GlobalProblem &, const F &, const SolverOptions &)
  {
    fail("solver active_set is for contacts without friction: choose another");
  }
};

}    // namespace nscd
