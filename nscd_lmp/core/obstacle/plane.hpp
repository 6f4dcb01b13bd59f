// SPDX-License-Identifier: GPL-2.0-or-later
// A plane wall: the half-space behind it is solid.
#pragma once

#include "contact/contact.hpp"
#include "contact/material.hpp"

namespace nscd {

// `point` on the plane, `normal` into the free side (any length; made unit by Settings).
struct Plane {
  double point[3];
  double normal[3];
  OwnMaterial own{};   // what it has not is that of contacts without a material of their own
};

// n.x - offset is the height above the plane, m.
struct Height {
  alignas(vec4_alignment) Vec4 normal;
  double offset;
  explicit Height(const Plane &plane) :
      normal{plane.normal[0], plane.normal[1], plane.normal[2], 0},
      offset(dot(normal, Vec4{plane.point[0], plane.point[1], plane.point[2], 0}))
  {
  }
  double of(const Vec4 &centre) const { return dot(normal, centre) - offset; }
};

}    // namespace nscd
