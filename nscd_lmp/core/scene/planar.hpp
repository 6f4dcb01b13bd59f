// SPDX-License-Identifier: GPL-2.0-or-later
// Planar scenes, `dimension 2`: what must lie in the plane.
#pragma once

#include "scene/state.hpp"

namespace nscd {

// Raises Error for an atom at another z than the first, or a moving one with a velocity or force along z.
void require_planar(const State &state);

}    // namespace nscd
