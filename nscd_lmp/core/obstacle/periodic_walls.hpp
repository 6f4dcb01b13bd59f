// Walls in periodic boxes.
#pragma once

#include "settings/settings.hpp"

#include <vector>

namespace nscd {

struct BoxEdges {
  double edge[3][3];    // vectors along the box' edges, m
  bool periodic[3];
};

// Raises Error for a plane that is another one in the next image of the box: one whose normal is not perpendicular to
// every edge along which the box is periodic.
void require_walls_repeat(const Settings &settings, const BoxEdges &box);

}    // namespace nscd
