// SPDX-License-Identifier: GPL-2.0-or-later
// From the arrays that a step is handed to its bodies: free velocities, predicted centres, free spins.
#pragma once

#include "scene/state.hpp"

#include <cmath>

namespace nscd {

// Squares of speeds, (m/s)^2: what the smooth forces change, and before or after them.
struct Largest {
  double kick2 = 0, speed2 = 0;
  double smallest_radius = INFINITY;
  int unfit = -1;   // the first atom whose values are none to work with
};

// Sets the velocities of atoms that are held to 0.
void hold_still(const Grains &grains);

// Whether a moving grain has a torque that no spin takes.
bool has_unread_torque(const Grains &grains);

// Bodies and spheres of the owned atoms: free velocities, predicted positions. Contacts are sought at q_k + prediction
// dt v_k, and look_ahead dt |v| around. Raises Error for a value that is no finite number, a radius or mass that is not
// positive.
Largest gather_owned(State &state, double prediction, double look_ahead);

// What follows once the largest speeds of all ranks are known, and what other ranks' grains do: images, obstacles, the
// distance up to which pairs are watched.
void gather_images(State &state, double prediction, double look_ahead, const Largest &largest);

}    // namespace nscd
