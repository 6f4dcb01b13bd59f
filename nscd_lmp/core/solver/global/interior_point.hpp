// SPDX-License-Identifier: GPL-2.0-or-later
// The interior point (interior_point.cpp), for AUTO and for the registry.
#pragma once

#include "problem/criterion.hpp"
#include "solver/solver.hpp"

#include <span>

namespace nscd {

// What is needed of a frame where nothing is compiled for each.
struct MeasuredFrame {
  std::span<const int> groups;
  Criterion (*measured)(const GlobalProblem &problem, const double *u);
};

class InteriorPoint {
 public:
  static constexpr double default_parameter = 0;

  template <class F>
  static SolverReport solve(GlobalProblem &problem, const F &, const SolverOptions &options)
  {
    static_assert(F::dim <= most_unknowns);
    find_diagonals<F>(problem);
    constexpr auto measured = [](const GlobalProblem &p, const double *u) { return measure(p, F{}, u, nullptr); };
    return search(problem, {F::groups, measured}, options);
  }

 private:
  static constexpr int most_unknowns = 6;  // of a contact
  static SolverReport search(GlobalProblem &problem, const MeasuredFrame &frame, const SolverOptions &options);
};

}    // namespace nscd
