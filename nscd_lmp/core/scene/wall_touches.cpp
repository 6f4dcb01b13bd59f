// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/wall_touches.hpp"

#include "obstacle/moved.hpp"
#include "scene/gap.hpp"
#include "scene/slides.hpp"

#include <algorithm>
#include <cmath>

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

void add_touch(WallLoad &load, const WallTouch &touch, const std::array<double, 3> &about)
{
  constexpr std::size_t torque = 3, contacts = 6;
  double arm[3], on_wall[3];
  for (std::size_t d = 0; d < 3; ++d) {
    on_wall[d] = -touch.force[int(d)];
    arm[d] = touch.place[int(d)] - about[d];
    load[d] += on_wall[d];
  }
  load[torque] += arm[1] * on_wall[2] - arm[2] * on_wall[1];
  load[torque + 1] += arm[2] * on_wall[0] - arm[0] * on_wall[2];
  load[torque + 2] += arm[0] * on_wall[1] - arm[1] * on_wall[0];
  load[contacts] += std::hypot(on_wall[0], on_wall[1], on_wall[2]) > 0;
}

std::array<double, 3> torque_point(const Obstacle &wall)
{
  std::array<double, 3> point{};
  const auto *moved = dynamic_cast<const Moved *>(&wall);
  for (std::size_t d = 0; moved && moved->course().rotates && d < 3; ++d) point[d] = moved->course().point[int(d)];
  return point;
}

}    // namespace nscd
