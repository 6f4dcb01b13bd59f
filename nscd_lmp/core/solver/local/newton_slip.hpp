// SPDX-License-Identifier: GPL-2.0-or-later
// What EAL and EBP have in common where a contact slips: the Newton step across the sliding direction.
#pragma once

#include "solver/nlgs.hpp"

namespace nscd {

// Change of the impulse of one disc across the unit vector t, from the row of (A_c, B_c) perpendicular to t:
//   (1 - m + m rho W_tt) dp_b = -(1 - m) p_b - m rho u_b,   m = radius / |tau_t| in [0, 1]        (docs/friction.md)
// rho is a multiple of `w_inverse` = 1 / W_nn; `u`: velocity with the impulses as they are. In the plane nothing is
// across.
template <class Vector>
NSCD_INLINE Vector step_across(const Vector &t, const Vector &p, const Vector &u, double m, double rho,
                               double w_inverse, const Disc &disc)
{
  const double stiffness = 1 - m + m * rho * disc.ratio;
  const Vector right = p * (m - 1) - u * (m * rho * w_inverse);
  return (right - t * inner(right, t)) * (1 / stiffness);
}

// The chi of a contact that is open: no impulse, and the velocity that the bodies will then have.
template <class Tangent>
NSCD_INLINE FrictionalLocal<Tangent> opened(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                            const OwnBlock<Tangent> &own)
{
  FrictionalLocal<Tangent> next;
  next.v.n = v.n - chi.p.n * own.w;
  for_each_disc([&](std::size_t d, const auto &p, const auto &u, auto &to) NSCD_INLINED {
    to = u - p * own.discs[d].w;
  }, chi.p.t, v.t, next.v.t);
  return next;
}

// The chi of a contact that sticks: v~ = 0.
template <class Tangent>
NSCD_INLINE FrictionalLocal<Tangent> stuck(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                           const OwnBlock<Tangent> &own)
{
  FrictionalLocal<Tangent> next;
  next.p.n = chi.p.n - v.n * own.w_inverse;
  for_each_disc([&](std::size_t d, const auto &p, const auto &u, auto &to) NSCD_INLINED {
    to = p - u * own.discs[d].w_inverse;
  }, chi.p.t, v.t, next.p.t);
  return next;
}

}    // namespace nscd
