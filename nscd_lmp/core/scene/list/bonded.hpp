// SPDX-License-Identifier: GPL-2.0-or-later
// Bonded grains, whose pairs LAMMPS leaves out of the neighbor list unless it is told not to.
#pragma once

#include "scene/views.hpp"

namespace nscd {

struct Bonded {
  const int *const *partners = nullptr;   // (owned) cumulative numbers of partners 1, 2 and 3 bonds away
  bool listed[3] = {true, true, true};    // whether the neighbor list holds pairs 1, 2, 3 bonds apart

  bool all_listed() const { return listed[0] && listed[1] && listed[2]; }
};

// Tag of an owned grain of the group with a bonded partner that the list leaves out; 0 if there is none.
std::int32_t find_unlisted(const Bonded &bonded, const Grains &grains);

// Raises Error for such a grain; 0 is none.
void require_listed(std::int32_t grain);

}    // namespace nscd
