// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/bonded.hpp"

#include "base/error.hpp"

namespace nscd {

std::int32_t find_unlisted(const Bonded &bonded, const Grains &g)
{
  if (!bonded.partners || bonded.all_listed()) return 0;
  for (int i = 0; i < g.owned; ++i) {
    if (!g.moves(i)) continue;
    for (int bonds = 0, before = 0; bonds < 3; ++bonds) {
      const int to_here = bonded.partners[i][bonds];
      if (to_here > before && !bonded.listed[bonds]) return g.tag[i];
      before = to_here;
    }
  }
  return 0;
}

void require_listed(std::int32_t grain)
{
  if (grain > 0)
    fail("grain ", grain, " is bonded, and special_bonds leaves bonded pairs out of the neighbor list, so that they ",
         "would pass through each other: use `special_bonds lj 1 1 1`; pairs that are to overlap can be left out by "
         "`neigh_modify exclude`");
}

}    // namespace nscd
