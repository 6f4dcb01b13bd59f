// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/spins.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// Returns the first grain whose spin is none, or -1.
static NSCD_HOT int load_spins(State &s)
{
  auto &spins = s.motion.spins;
  int unfit = -1;
  for (int i = 0; i < s.in.grains.owned; ++i) {
    spins[i] = start_spin(s, i) + smooth_spin_kick(s, i);
    if (!(dot(spins[i], spins[i]) < INFINITY) && unfit < 0) unfit = i;
  }
  return unfit;
}

void gather_spins(State &s)
{
  auto &spins = s.motion.spins;
  spins.resize(s.motion.bodies.size());
  const int unfit = load_spins(s);
  if (unfit >= 0)
    fail("grain ", s.in.grains.tag[unfit], " has an angular velocity or torque that is not a finite number");
  std::fill(spins.begin() + s.in.grains.owned, spins.end(), Vec4{});
}

void add_smooth_spins(State &s, double share)
{
  for (int i = 0; i < s.moving(); ++i) s.motion.spins[i] += smooth_spin_kick(s, i) * share;
}

NSCD_HOT void write_back_spins(const State &s)
{
  for (int i = 0; i < s.in.grains.owned; ++i) {
    if (s.motion.bodies[i][3] == 0) continue;
    const Vec4 spin = s.motion.spins[i], contacts = spin - (start_spin(s, i) + smooth_spin_kick(s, i));
    const double per_torque = change_per_torque(s, i);
    for (int d = 0; d < 3; ++d) {
      s.in.grains.omega[3 * std::size_t(i) + d] = spin[d] / s.in.grains.radius[i];
      if (s.in.grains.torque) s.in.grains.torque[3 * std::size_t(i) + d] = contacts[d] / per_torque;
    }
  }
}

}    // namespace nscd
