// SPDX-License-Identifier: GPL-2.0-or-later
// What of a scene that has taken no step yet is likely to be a mistake; told once, and nothing is refused.
#pragma once

#include "parallel/ranks.hpp"
#include "scene/views.hpp"

#include <string>
#include <vector>

namespace nscd {

// `atoms`: of all ranks. The same on all of them. Of `grains` owned, radius, mass, tag, mask and group are looked at.
std::vector<std::string> doubts(const Grains &grains, double atoms, Ranks *ranks);

}    // namespace nscd
