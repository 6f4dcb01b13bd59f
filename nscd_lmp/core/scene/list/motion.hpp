// SPDX-License-Identifier: GPL-2.0-or-later
// What grains do in a step, or can do, as far as pairs are concerned that the neighbor list may lack.
#pragma once

#include "scene/state.hpp"

namespace nscd {

// From where, and two displacements of each body: either may be the one that brings two grains together. m
struct AtomMotion {
  AlignedVector<Vec4> from;          // (owned + ghosts) centres
  AlignedVector<Vec4> one, other;    // (moving())
};

// Before contacts act: from q_k to where they are sought, `prediction` of a step with v_k, and then `look_ahead` of one
// with the velocities before and after the smooth forces.
void free_motion(AtomMotion &motion, const State &state, double prediction, double look_ahead);

// After the solve: the displacement, and `look_ahead` of a step with v_{k+1}, which law gap constrains.
void solved_motion(AtomMotion &motion, const State &state, double look_ahead);

// After the step: from q_{k+1}, with v_{k+1}, for `share` of the next one.
void next_motion(AtomMotion &motion, const State &state, double share);

}    // namespace nscd
