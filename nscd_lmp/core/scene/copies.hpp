// SPDX-License-Identifier: GPL-2.0-or-later
// Grains of other ranks as this one has them: their bodies and, from their owners, how they move and where they are.
// Of all of these a scene on one rank needs none.
#pragma once

#include "scene/state.hpp"

namespace nscd {

// With a new list, after atoms.owner is known for images of owned grains: gives the grains of other ranks their bodies
// (state.atoms.owner, state.motion.copies.count). Collective, as all below.
void plan_copies(State &state);

// At the start of a step: how they move.
void share_motion(State &state);

// And where they are.
void share_places(State &state);

// Their velocities, after a solve.
void refresh_copies(State &state);

}    // namespace nscd
