// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/planar.hpp"

#include "base/error.hpp"

namespace nscd {

void require_planar(const State &s)
{
  const Grains &g = s.in.grains;
  for (int i = 0; i < g.owned; ++i) {
    const std::size_t z = 3 * std::size_t(i) + 2;
    if (g.x[z] != g.x[2])
      fail("grain ", g.tag[i], " is at z = ", g.x[z], ", off the plane z = ", g.x[2],
           " of a planar scene (dimension 2): use `set group all z 0`, or dimension 3");
    if (g.moves(i) && (g.v[z] != 0 || g.f[z] != 0))
      fail("grain ", g.tag[i], " has a velocity ", g.v[z] + 0.0, " or force ", g.f[z] + 0.0,
           " along z in a planar scene (dimension 2): add `fix ID all enforce2d`, or use dimension 3");
  }
}

}    // namespace nscd
