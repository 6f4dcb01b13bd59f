// Spins of grains: LAMMPS' angular velocities in and out, as surface velocities s = r omega between.
#pragma once

#include "hot.hpp"
#include "state.hpp"

namespace nscd {

// Fills state.friction.spins with the free spins s_k + dt k T / (m r), 0 for walls. Raises Error for one that is not
// finite.
void gather_spins(State &state);

// Adds `share` times the change that the smooth torques of the step make.
void add_smooth_spins(State &state, double share);

// Angular velocities of the moving grains, and mean contact torques, into the arrays.
void write_back_spins(const State &state);

// Surface velocity of an owned atom at the start of the step.
NSCD_INLINE Vec4 start_spin(const State &s, int i)
{
  const double *w = s.grains.omega + 3 * std::size_t(i);
  return Vec4{w[0], w[1], w[2], 0} * s.grains.radius[i];
}

}    // namespace nscd
