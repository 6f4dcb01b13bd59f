// SPDX-License-Identifier: GPL-2.0-or-later
// Spins of grains: LAMMPS' angular velocities in and out, as surface velocities s = r omega between.
#pragma once

#include "base/hot.hpp"
#include "scene/state.hpp"

namespace nscd {

// Fills state.motion.spins with the free spins s_k + dt k T / (m r), 0 for walls. Raises Error for one that is not
// finite.
void gather_spins(State &state);

// Adds `share` times the change that the smooth torques of the step make.
void add_smooth_spins(State &state, double share);

// Angular velocities of the moving grains, and mean contact torques, into the arrays.
void write_back_spins(const State &state);

// Change of an owned grain's surface velocity by a unit of torque over the step: dt k / (m r).
NSCD_INLINE double change_per_torque(const State &s, int i)
{
  const Grains &g = s.in.grains;
  return s.in.dt * g.force_to_acceleration * s.friction.spin_response * s.motion.bodies[i][3] / g.radius[i];
}

// What the smooth torques change of a grain's surface velocity in the step, m/s.
NSCD_INLINE Vec4 smooth_spin_kick(const State &s, int i)
{
  if (i >= s.in.grains.owned) return s.motion.copies.spin_kick[i - s.in.grains.owned];
  if (!s.in.grains.torque) return Vec4{};
  const double *torque = s.in.grains.torque + 3 * std::size_t(i);
  return Vec4{torque[0], torque[1], torque[2], 0} * change_per_torque(s, i);
}

// Surface velocity of a grain at the start of the step.
NSCD_INLINE Vec4 start_spin(const State &s, int i)
{
  if (i >= s.in.grains.owned) return s.motion.copies.start_spin[i - s.in.grains.owned];
  const double *w = s.in.grains.omega + 3 * std::size_t(i);
  return Vec4{w[0], w[1], w[2], 0} * s.in.grains.radius[i];
}

}    // namespace nscd
