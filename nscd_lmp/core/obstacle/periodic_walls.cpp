// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/periodic_walls.hpp"

#include "base/error.hpp"

#include <cmath>

namespace nscd {

static double length(const double *a) { return std::hypot(a[0], a[1], a[2]); }

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

void require_walls_repeat(std::span<const Plane> walls, const BoxEdges &box)
{
  constexpr double round_off = 1e-9;
  for (std::size_t wall = 0; wall < walls.size(); ++wall) {
    const double *normal = walls[wall].normal;
    for (int d = 0; d < 3; ++d) {
      if (!box.periodic[d]) continue;
      const double slant = dot(normal, box.edge[d]) / (length(normal) * length(box.edge[d]));
      if (std::abs(slant) > round_off)
        fail("wall ", wall + 1, ": its normal has a component ", slant, " along ", "xyz"[d], ", in which the box is ",
             "periodic and the plane is not: use a normal without it, or a boundary that is not periodic");
    }
  }
}

}    // namespace nscd
