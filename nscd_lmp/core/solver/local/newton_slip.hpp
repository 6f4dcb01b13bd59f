// SPDX-License-Identifier: GPL-2.0-or-later
// What EAL and EBP have in common where a contact slips: the Newton step across the sliding direction.
#pragma once

#include "solver/nlgs.hpp"

namespace nscd {

// Change of the tangential impulse across the unit vector t, from the row of (A_c, B_c) perpendicular to t:
//   (1 - m + m rho W_tt) dp_b = -(1 - m) p_b - m rho u_b,   m = radius / |tau_t| in [0, 1]        (docs/friction.md)
// `u`: tangential velocity with the impulses as they are. In the plane nothing is across.
template <class Tangent>
NSCD_INLINE Tangent step_across(const Tangent &t, const Tangent &p, const Tangent &u, double m, double rho,
                                const OwnBlock &own)
{
  const double stiffness = 1 - m + m * rho * own.ratio;
  const Tangent right = p * (m - 1) - u * (m * rho * own.w_inverse);
  return (right - t * inner(right, t)) * (1 / stiffness);
}

// The chi of a contact that is open: no impulse, and the velocity that the bodies will then have.
template <class Tangent>
NSCD_INLINE FrictionalLocal<Tangent> opened(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                            const OwnBlock &own)
{
  return {.v = {v.n - chi.p.n * own.w, v.t - chi.p.t * own.wt}};
}

// The chi of a contact that sticks: v~ = 0.
template <class Tangent>
NSCD_INLINE FrictionalLocal<Tangent> stuck(const FrictionalLocal<Tangent> &chi, const Split<Tangent> &v,
                                           const OwnBlock &own)
{
  return {.p = {chi.p.n - v.n * own.w_inverse, chi.p.t - v.t * own.wt_inverse}};
}

}    // namespace nscd
