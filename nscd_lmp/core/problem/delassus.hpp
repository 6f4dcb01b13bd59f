// The Delassus matrix of grains, W = H^T M^-1 H, and what else solvers of all contacts at once are handed.
#pragma once

#include "problem/global_problem.hpp"
#include "problem/problem.hpp"
#include "solver/solver.hpp"

#include <vector>

namespace nscd {

// The contact problem of grains, posed by its matrix along N and tangents().
class AssembledProblem {
 public:
  explicit AssembledProblem(const Problem &grains);
  AssembledProblem(const AssembledProblem &) = delete;
  AssembledProblem &operator=(const AssembledProblem &) = delete;

  GlobalProblem &problem() { return problem_; }

  // Hands the solution to contacts and bodies.
  void write_back(Problem &grains) const;

 private:
  BlockMatrix w_;
  std::vector<double> q_, mu_, start_, p_;
  GlobalProblem problem_;
};

// Solves the problem of grains by a solver of all contacts at once; the criterion is then that of the bodies.
SolverReport solve_assembled(Problem &grains, const SolverOptions &options,
                             SolverReport (*solve)(GlobalProblem &, const SolverOptions &));

// The same as a registry's entry wants it.
template <SolverReport (*solve)(GlobalProblem &, const SolverOptions &)>
SolverReport on_grains(Problem &grains, const SolverOptions &options)
{
  return solve_assembled(grains, options, solve);
}

// W alone.
BlockMatrix delassus(const Problem &grains);

}    // namespace nscd
