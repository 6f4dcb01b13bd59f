#include "spins.hpp"

#include "error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Change of the surface velocity by a unit of torque over the step: dt k / (m r).
NSCD_INLINE double change_per_torque(const State &s, int i)
{
  return s.dt * s.grains.force_to_acceleration * s.friction.spin_response * s.bodies[i][3] / s.grains.radius[i];
}

NSCD_INLINE Vec4 smooth_change(const State &s, int i)
{
  if (!s.grains.torque) return Vec4{};
  const double *torque = s.grains.torque + 3 * std::size_t(i);
  return Vec4{torque[0], torque[1], torque[2], 0} * change_per_torque(s, i);
}

}    // namespace

NSCD_HOT void gather_spins(State &s)
{
  auto &spins = s.friction.spins;
  spins.resize(s.bodies.size());
  for (int i = 0; i < s.grains.owned; ++i) {
    spins[i] = start_spin(s, i) + smooth_change(s, i);
    if (!(dot(spins[i], spins[i]) < INFINITY))
      fail("grain ", s.grains.tag[i], " has an angular velocity or torque that is not a finite number");
  }
  std::fill(spins.begin() + s.grains.owned, spins.end(), Vec4{});
}

void add_smooth_spins(State &s, double share)
{
  for (int i = 0; i < s.grains.owned; ++i) s.friction.spins[i] += smooth_change(s, i) * share;
}

NSCD_HOT void write_back_spins(const State &s)
{
  for (int i = 0; i < s.grains.owned; ++i) {
    if (s.bodies[i][3] == 0) continue;
    const Vec4 spin = s.friction.spins[i], contacts = spin - (start_spin(s, i) + smooth_change(s, i));
    const double per_torque = change_per_torque(s, i);
    for (int d = 0; d < 3; ++d) {
      s.grains.omega[3 * std::size_t(i) + d] = spin[d] / s.grains.radius[i];
      if (s.grains.torque) s.grains.torque[3 * std::size_t(i) + d] = contacts[d] / per_torque;
    }
  }
}

}    // namespace nscd
