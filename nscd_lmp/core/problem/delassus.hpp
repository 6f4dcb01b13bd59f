// SPDX-License-Identifier: GPL-2.0-or-later
// The Delassus matrix of grains, W = H^T M^-1 H, and what else solvers of all contacts at once are handed.
#pragma once

#include "problem/global_problem.hpp"
#include "problem/problem.hpp"

#include <vector>

namespace nscd {

// The contact problem of grains, posed by its matrix along N and tangents().
class AssembledProblem {
 public:
  // Defined in delassus_of.hpp, where a mechanics that is not a scene's finds it.
  template <class M>
  AssembledProblem(const Problem &grains, const M &mechanics);
  AssembledProblem(const AssembledProblem &) = delete;
  AssembledProblem &operator=(const AssembledProblem &) = delete;

  GlobalProblem &problem() { return problem_; }

  // Hands the solution to contacts and bodies.
  template <class M>
  void write_back(Problem &grains, const M &mechanics) const;

 private:
  BlockMatrix w_;
  std::vector<double> q_, mu_, start_, p_;
  GlobalProblem problem_;
};

// W alone.
BlockMatrix delassus(const Problem &grains);

}    // namespace nscd
