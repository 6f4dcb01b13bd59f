// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/global_problem.hpp"

#include <cmath>

namespace nscd {

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
