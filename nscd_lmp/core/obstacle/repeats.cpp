// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/repeats.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// The k-th of points that fill the unit square evenly (Roberts' sequence R2).
double share(int k, int axis) { return std::fmod((k + 0.5) * (axis ? 0.5698402910 : 0.7548776662), 1.0); }

Vec4 edge(const BoxEdges &box, int d)
{
  const auto &e = box.edge[d % 3];
  return Vec4{e[0], e[1], e[2], 0};
}

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

constexpr int points = 256;

// The k-th of places on the lower face across edge d; the same one on the upper face is an edge farther.
Vec4 place_on_face(const BoxEdges &box, int d, int k)
{
  return Vec4{box.low[0], box.low[1], box.low[2], 0} + edge(box, d + 1) * share(k, 0) + edge(box, d + 2) * share(k, 1);
}

// Where a grain's centre cannot be.
bool is_solid(const std::vector<Touch> &touches)
{
  return std::any_of(touches.begin(), touches.end(), [](const Touch &touch) { return touch.gap < 0; });
}

}    // namespace

void require_alike_at_faces(const Obstacle &wall, const std::string &name, const BoxEdges &box)
{
  for (int d = 0; d < 3; ++d)
    for (int k = 0; box.periodic[d] && k < points; ++k) {
      const Vec4 at = place_on_face(box, d, k);
      const auto here = near(wall, at, box.radius), there = near(wall, at + edge(box, d), box.radius);
      if (is_solid(here) && is_solid(there)) continue;
      if (is_solid(here) == is_solid(there) && are_among(here, there, box.radius) && are_among(there, here, box.radius))
        continue;
      fail(name, ": it does not lie alike on the two faces of the box in ", "xyz"[d], ", in which the box is ",
           "periodic, and a grain there would miss a part of it: use a boundary that is not periodic, or a wall that ",
           "ends a radius ahead of the faces or goes on alike by a radius beyond them");
    }
}

bool is_touched_at_faces(const Obstacle &wall, const BoxEdges &box, int d)
{
  for (int k = 0; k < points; ++k)
    for (const int side : {0, 1}) {
      const auto touches = near(wall, place_on_face(box, d, k) + edge(box, d) * double(side), box.radius);
      if (!touches.empty() && !is_solid(touches)) return true;
    }
  return false;
}

}    // namespace nscd
