// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/tangents.hpp"

#include <cmath>

namespace nscd {

int unknowns(Model model)
{
  int count = 1;
  with_friction(model, [&]<class M>(M) { count = M::unknowns; });
  return count;
}

Tangents tangents(const Vec4 &n, Model model)
{
  if (model == Model::planar) return {Planar::tangent(n), Vec4{0, 0, 1, 0}};
  // The axis that is farthest from the normal.
  int axis = 0;
  for (int d = 1; d < 3; ++d)
    if (std::abs(n[d]) < std::abs(n[axis])) axis = d;
  Vec4 first{};
  first[axis] = 1;
  first -= n * n[axis];
  first /= length(first);
  return {first, cross(n, first)};
}

}    // namespace nscd
