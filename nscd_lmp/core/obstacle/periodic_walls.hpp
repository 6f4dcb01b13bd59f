// SPDX-License-Identifier: GPL-2.0-or-later
// Walls in periodic boxes.
#pragma once

#include "obstacle/plane.hpp"

#include <span>

namespace nscd {

struct BoxEdges {
  double edge[3][3];    // vectors along the box' edges, m
  bool periodic[3];
};

// Raises Error for a plane that is another one in the next image of the box: one whose normal is not perpendicular to
// every edge along which the box is periodic.
void require_walls_repeat(std::span<const Plane> walls, const BoxEdges &box);

}    // namespace nscd
