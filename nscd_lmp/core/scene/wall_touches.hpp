// SPDX-License-Identifier: GPL-2.0-or-later
// What contacts with walls have given in a step, for those who ask what a wall carries.
#pragma once

#include "scene/state.hpp"

#include <array>
#include <vector>

namespace nscd {

struct WallTouch {
  int wall, grain;                          // grain: index among those of this rank
  alignas(vec4_alignment) Vec4 place;       // m, on the wall's surface, at the end of the step
  alignas(vec4_alignment) Vec4 force;       // on the grain, mean of the step, in units of force
};

// Those of the step just taken, while its arrays are there. Contacts that push nothing are among them.
void collect_wall_touches(const State &state, std::vector<WallTouch> &found);

// What a wall carries: the force on it (3), its torque about a point (3), and how many contacts push.
using WallLoad = std::array<double, 7>;
void add_touch(WallLoad &load, const WallTouch &touch, const std::array<double, 3> &about);

// What torques of a wall are about: the point of its rotation, else the origin, m.
std::array<double, 3> torque_point(const Obstacle &wall);

}    // namespace nscd
