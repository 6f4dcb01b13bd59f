// SPDX-License-Identifier: GPL-2.0-or-later
// The natural map of a contact, in velocities: 0 where its law holds.
#pragma once

#include "contact/discs.hpp"

#include <cmath>

namespace nscd {

// w (p - max(0, p - v / w)) without cancellation, and v if that is no number.
NSCD_INLINE double natural_normal(double w, double p, double v) { return w * p < v ? w * p : v; }

// The length of wt (p - proj(p - v / wt, B(0, radius))).
template <class Tangent>
NSCD_INLINE double natural_tangential(double wt, double radius, const Tangent &p, const Tangent &v)
{
  const Tangent trial = p - v * (1 / wt);
  const bool sticks = inner(trial, trial) <= radius * radius;
  return sticks ? length(v) : wt * length(p - onto_ball<Tangent>(trial, radius));
}

}    // namespace nscd
