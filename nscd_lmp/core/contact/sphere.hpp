// SPDX-License-Identifier: GPL-2.0-or-later
// An atom where contacts are sought.
#pragma once

#include "contact/contact.hpp"

namespace nscd {

// `reach` widens the search, 0 for law moreau.
struct Sphere {
  alignas(vec4_alignment) Vec4 centre;  // m, fourth component 0
  double radius;
  double reach;
};

}    // namespace nscd
