// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/repeats.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// The k-th of points that fill the unit square evenly (Roberts' sequence R2).
double share(int k, int axis) { return std::fmod((k + 0.5) * (axis ? 0.5698402910 : 0.7548776662), 1.0); }

std::vector<Touch> near(const Obstacle &wall, const Vec4 &point, double within)
{
  std::vector<Touch> touches;
  wall.touch(point, 0, within, touches);
  return touches;
}

// Whether each of them is among the others too, nearly: facets of a smooth surface need not repeat. Those that are just
// within `length` count or not.
bool are_among(const std::vector<Touch> &touches, const std::vector<Touch> &others, double length)
{
  constexpr double share = 1e-3, turn = 0.1;   // of length; rad
  return std::all_of(touches.begin(), touches.end(), [&](const Touch &one) {
    const auto is_one = [&](const Touch &other) {
      const Vec4 turned = one.normal - other.normal;
      return std::abs(one.gap - other.gap) <= share * length && dot(turned, turned) <= turn * turn;
    };
    return one.gap > (1 - share) * length || std::any_of(others.begin(), others.end(), is_one);
  });
}

}    // namespace

void require_alike_at_faces(const Obstacle &wall, const std::string &name, const BoxEdges &box)
{
  constexpr int points = 256;
  const auto edge = [&box](int d) { return Vec4{box.edge[d % 3][0], box.edge[d % 3][1], box.edge[d % 3][2], 0}; };
  const Vec4 corner{box.low[0], box.low[1], box.low[2], 0};
  for (int d = 0; d < 3; ++d)
    for (int k = 0; box.periodic[d] && k < points; ++k) {
      const Vec4 at = corner + edge(d + 1) * share(k, 0) + edge(d + 2) * share(k, 1);
      const auto here = near(wall, at, box.radius), there = near(wall, at + edge(d), box.radius);
      if (are_among(here, there, box.radius) && are_among(there, here, box.radius)) continue;
      fail(name, ": it does not lie alike on the two faces of the box in ", "xyz"[d], ", in which the box is ",
           "periodic, and a grain there would miss a part of it: use a boundary that is not periodic, or a wall that ",
           "ends a radius ahead of the faces or goes on alike by a radius beyond them");
    }
}

}    // namespace nscd
