// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a wall of any shape fits a periodic box: asked at many places of the box' faces.
#pragma once

#include "obstacle/obstacle.hpp"

#include <string>

namespace nscd {

// A grain at a periodic face touches the wall on this side of it alone. So within a radius of the largest grain the
// wall has to lie alike on both faces; raises Error where it does not. `name`: "wall 2".
void require_alike_at_faces(const Obstacle &wall, const std::string &name, const BoxEdges &box);

// Whether grains at the two faces across edge d of the box can touch it.
bool is_touched_at_faces(const Obstacle &wall, const BoxEdges &box, int d);

}    // namespace nscd
