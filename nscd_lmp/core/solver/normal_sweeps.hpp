// SPDX-License-Identifier: GPL-2.0-or-later
// Sweeps of a problem with friction along the normals alone.
#pragma once

#include "solver/solver.hpp"

namespace nscd {

// Visits along the normals, as without friction, with the tangential impulses as they are and normal ones not below
// what Coulomb's law needs for them, until no contact approaches faster than it may: friction makes that slow, and
// changes nothing that can be seen (docs/solvers.md). Returns the sweeps that they come to.
int part_normals(Problem &problem);

// measure_across(), after part_normals() where approaches are all that the goal still asks for: from the budget on, or
// wherever no answer is accepted. `sweeps` counts what these come to.
Criterion measure_parted(Problem &problem, const SolverOptions &options, const Goal &goal, int &sweeps,
                         const double *carried = nullptr);

}    // namespace nscd
