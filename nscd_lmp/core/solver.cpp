#include "solver.hpp"

#include "registry.hpp"

#include <algorithm>

namespace nscd {

static Registry<SolverEntry> &registry()
{
  static Registry<SolverEntry> list;
  return list;
}

RegisterSolver::RegisterSolver(const SolverEntry &entry) { registry().add(entry); }

const std::vector<SolverEntry> &solvers() { return registry().entries(); }

std::vector<SolverEntry> frictional_solvers()
{
  std::vector<SolverEntry> some;
  for (const SolverEntry &entry : solvers())
    if (entry.friction) some.push_back(entry);
  return some;
}

const SolverEntry &find_solver(std::string_view name) { return registry().find("solver", name); }

double judged(const Criterion &criterion, const SolverOptions &options)
{
  return options.stop == Stop::paper ? criterion.total() : std::max(criterion.relative, criterion.island);
}

bool solved(const Criterion &criterion, const SolverOptions &options)
{
  const bool none_is_off = options.stop == Stop::paper || criterion.worst <= off_of_solved;
  return judged(criterion, options) < options.tol && none_is_off && criterion.approach <= 1;
}

double excess(const Criterion &criterion, const SolverOptions &options)
{
  const double worst = options.stop == Stop::paper ? 0 : criterion.worst / off_of_solved;
  return std::max({criterion.approach, worst, judged(criterion, options) / options.tol});
}

}    // namespace nscd
