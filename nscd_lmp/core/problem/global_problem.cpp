// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/global_problem.hpp"

#include <algorithm>

namespace nscd {

namespace {

// Gershgorin's bound, N against T: diag(w, wt, wt) - block is positive semidefinite.
Diagonal majorant(const double *block, int dim)
{
  Diagonal d{block[0], 0, true};
  if (dim == 1) return d;
  const auto at = [&](int i, int j) { return 0.5 * (block[dim * i + j] + block[dim * j + i]); };
  double coupling = std::abs(at(0, 1));
  d.wt = at(1, 1);
  bool isotropic = true;
  if (dim == 3) {
    coupling = std::hypot(coupling, at(0, 2));
    const double half = 0.5 * (at(1, 1) - at(2, 2)), mean = 0.5 * (at(1, 1) + at(2, 2));
    const double radius = std::hypot(half, at(1, 2));
    d.wt = mean + radius;
    isotropic = radius <= 1e-14 * mean;
  }
  d.exact = isotropic && coupling <= 1e-14 * d.w;
  if (d.exact) return d;
  d.w += coupling;
  d.wt += coupling;
  return d;
}

}    // namespace

void find_diagonals(GlobalProblem &problem)
{
  problem.diagonals.assign(problem.contacts(), {});
  for (std::size_t k = 0; k < problem.contacts(); ++k)
    if (const double *block = problem.w.diagonal(k)) problem.diagonals[k] = majorant(block, problem.dim());
}

double free_norm(const GlobalProblem &problem)
{
  double sum = 0;
  const int dim = problem.dim();
  for (std::size_t k = 0; k < problem.contacts(); ++k) {
    const double *block = problem.w.diagonal(k);
    for (int i = 0; block && *block != 0 && i < dim; ++i) sum += problem.q[k * dim + i] * problem.q[k * dim + i];
  }
  return std::sqrt(sum);
}

}    // namespace nscd
