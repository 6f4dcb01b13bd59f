// SPDX-License-Identifier: GPL-2.0-or-later
// Which material a contact is of.
#pragma once

#include "base/hot.hpp"
#include "scene/contact_geometry.hpp"
#include "scene/state.hpp"

namespace nscd {

NSCD_INLINE MaterialNumber material_of(const State &s, const Candidate &c)
{
  const Materials &materials = s.in.materials;
  if (is_wall(c)) return materials.of_wall(wall_of(c.atom_j));
  if (!materials.by_type()) return materials.of_pairs();
  return materials.of_pair(s.in.grains.type[c.atom_i], s.in.grains.type[c.atom_j]);
}

// What the contacts from `first` on have of their materials; slides without impulse and bias.
void place_materials(State &state, std::size_t first);

}    // namespace nscd
