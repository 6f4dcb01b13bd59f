// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/wall_touches.hpp"

#include "scene/gap.hpp"
#include "scene/slides.hpp"

namespace nscd {

void collect_wall_touches(const State &s, std::vector<WallTouch> &found)
{
  found.clear();
  const double per_impulse = 1 / (s.in.dt * s.in.grains.force_to_acceleration);
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const ContactInfo &info = s.table.infos[k];
    if (info.atom_j >= 0) continue;
    const Contact &c = s.table.contacts[k];
    const Sphere grain = in_arrays(s, info.atom_i);
    const double apart = std::isinf(info.gap) ? 0 : info.gap;   // it has passed the feature
    found.push_back({wall_of(info.atom_j), info.atom_i, grain.centre - c.normal * (grain.radius + apart),
                     (c.normal * c.impulse + tangential_impulse(s, k)) * per_impulse});
  }
}

}    // namespace nscd
