// SPDX-License-Identifier: GPL-2.0-or-later
// Sweeps of a problem with friction along the normals alone.
#pragma once

#include "solver/across_ranks.hpp"
#include "solver/solver.hpp"

namespace nscd {

// Visits along the normals, as without friction, with the tangential impulses as they are and normal ones not below
// what Coulomb's law needs for them, until no contact approaches faster than it may: friction makes that slow, and
// changes nothing that can be seen (docs/solvers.md). Returns the sweeps that they come to. Defined in
// normal_sweeps_of.hpp.
template <class M>
int part_normals(Problem &problem, const M &mechanics);

extern template int part_normals(Problem &, const Frictional<Planar> &);
extern template int part_normals(Problem &, const Frictional<Spatial> &);

// measure_across(), after part_normals() where approaches are all that the goal still asks for: from the budget on, or
// wherever no answer is accepted. `sweeps` counts what these come to.
template <class M>
Criterion measure_parted(Problem &problem, const M &mechanics, const SolverOptions &options, const Goal &goal,
                         int &sweeps, const double *carried = nullptr)
{
  const Criterion seen = measure_across(problem, mechanics, goal, carried);
  const bool due = options.budget.sweeps == 0 || goal.worst == off_of_accepted;
  if (!due || !is_met_by_sums(seen, goal) || !(seen.approach > 1)) return seen;
  sweeps += part_normals(problem, mechanics);
  return measure_across(problem, mechanics, goal, carried);
}

}    // namespace nscd
