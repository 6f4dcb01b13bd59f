// SPDX-License-Identifier: GPL-2.0-or-later
// A triangle, and how far a point is from it.
#pragma once

#include "contact/space.hpp"

#include <algorithm>
#include <limits>

namespace nscd {

struct Triangle {
  alignas(vec4_alignment) Vec4 corner[3];   // m, fourth component 0
};

// The square of the distance, m^2.
inline double distance2(const Vec4 &point, const Triangle &triangle)
{
  const Vec4 *const corner = triangle.corner;
  const Vec4 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const Vec4 edge = corner[(k + 1) % 3] - corner[k], from = point - corner[k];
    inside = inside && dot(cross(normal, edge), from) >= 0;
    const Vec4 apart = from - edge * std::clamp(dot(from, edge) / dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, dot(apart, apart));
  }
  if (!inside) return nearest;
  const double height = dot(normal, point - corner[0]);
  return height * height / dot(normal, normal);
}

}    // namespace nscd
