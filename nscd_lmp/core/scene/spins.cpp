#include "scene/spins.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

// Returns the first grain whose spin is none, or -1.
static NSCD_HOT int load_spins(State &s)
{
  auto &spins = s.friction.spins;
  int unfit = -1;
  for (int i = 0; i < s.grains.owned; ++i) {
    spins[i] = start_spin(s, i) + smooth_spin_kick(s, i);
    if (!(dot(spins[i], spins[i]) < INFINITY) && unfit < 0) unfit = i;
  }
  return unfit;
}

void gather_spins(State &s)
{
  auto &spins = s.friction.spins;
  spins.resize(s.bodies.size());
  const int unfit = load_spins(s);
  if (unfit >= 0)
    fail("grain ", s.grains.tag[unfit], " has an angular velocity or torque that is not a finite number");
  std::fill(spins.begin() + s.grains.owned, spins.end(), Vec4{});
}

void add_smooth_spins(State &s, double share)
{
  for (int i = 0; i < s.moving(); ++i) s.friction.spins[i] += smooth_spin_kick(s, i) * share;
}

NSCD_HOT void write_back_spins(const State &s)
{
  for (int i = 0; i < s.grains.owned; ++i) {
    if (s.bodies[i][3] == 0) continue;
    const Vec4 spin = s.friction.spins[i], contacts = spin - (start_spin(s, i) + smooth_spin_kick(s, i));
    const double per_torque = change_per_torque(s, i);
    for (int d = 0; d < 3; ++d) {
      s.grains.omega[3 * std::size_t(i) + d] = spin[d] / s.grains.radius[i];
      if (s.grains.torque) s.grains.torque[3 * std::size_t(i) + d] = contacts[d] / per_torque;
    }
  }
}

}    // namespace nscd
