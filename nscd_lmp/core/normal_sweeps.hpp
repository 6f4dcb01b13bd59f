// Sweeps of a problem with friction along the normals alone.
#pragma once

#include "problem.hpp"

namespace nscd {

// Sweeps along the normals, as without friction, with the tangential impulses as they are: until no contact approaches
// faster than it may. Friction makes that slow, and is not worth it (docs/solvers.md). Returns how many.
int part_normals(Problem &problem);

}    // namespace nscd
