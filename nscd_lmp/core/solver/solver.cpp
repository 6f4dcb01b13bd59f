// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/solver.hpp"

#include "base/registry.hpp"

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

static double judged(const Criterion &criterion, Stop stop)
{
  return stop == Stop::paper ? criterion.total() : std::max(criterion.relative, criterion.island);
}

double judged(const Criterion &criterion, const SolverOptions &options) { return judged(criterion, options.stop); }

bool meets(const Criterion &criterion, const Goal &goal)
{
  const bool none_is_off = goal.stop == Stop::paper || criterion.worst <= goal.worst;
  return judged(criterion, goal.stop) < goal.tol && none_is_off && criterion.approach <= 1;
}

bool solved(const Criterion &criterion, const SolverOptions &options) { return meets(criterion, options.goal()); }

double excess(const Criterion &criterion, const Goal &goal)
{
  const double worst = goal.stop == Stop::paper ? 0 : criterion.worst / goal.worst;
  return std::max({criterion.approach, worst, judged(criterion, goal.stop) / goal.tol});
}

// Where the sums are not met contacts and islands need not have been looked at.
static double badness(const Criterion &criterion, const Goal &goal)
{
  if (is_met_by_sums(criterion, goal)) return excess(criterion, goal);
  return std::max(criterion.approach, (goal.stop == Stop::paper ? criterion.total() : criterion.relative) / goal.tol);
}

bool is_better(const Criterion &one, const Criterion &other, const SolverOptions &options)
{
  const Goal goal = options.goal();
  const bool met = is_met_by_sums(one, goal), was_met = is_met_by_sums(other, goal);
  return met != was_met ? met : badness(one, goal) < badness(other, goal);
}

}    // namespace nscd
