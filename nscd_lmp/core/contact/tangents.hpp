// SPDX-License-Identifier: GPL-2.0-or-later
// Frames at contacts, for whoever wants components: custom solvers, Delassus matrices.
#pragma once

#include "contact/friction.hpp"

namespace nscd {

// Unknowns per contact: 1, 2 or 3.
int unknowns(Model model);

// Two unit vectors with which the normal makes a right-handed frame. In the plane the first is (-n_y, n_x).
struct Tangents {
  alignas(vec4_alignment) Vec4 first, second;
};
Tangents tangents(const Vec4 &normal, Model model);

}    // namespace nscd
