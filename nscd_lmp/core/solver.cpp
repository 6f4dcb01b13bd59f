#include "solver.hpp"

#include "registry.hpp"

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
  return options.stop == Stop::paper ? criterion.total() : criterion.relative;
}

bool solved(const Criterion &criterion, const SolverOptions &options)
{
  return judged(criterion, options) < options.tol && !(criterion.approach > options.approach);
}

}    // namespace nscd
