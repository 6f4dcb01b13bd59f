// SPDX-License-Identifier: GPL-2.0-or-later
// What a visit of one contact works on, in every sweep.
#pragma once

#include "contact/friction.hpp"

#include <cstddef>

namespace nscd {

// What a local law works on: the impulse and (1 + e) v~.
struct Local {
  double impulse;
  double velocity;
};

// The same under friction: impulse, and the velocity of laws that carry it.
template <class Tangent>
struct FrictionalLocal {
  Split<Tangent> p = {};
  Split<Tangent> v = {};
};

// The contact's own part of its problem: its block of W and the inverse, and Coulomb's coefficient, infinite for stick.
struct OwnBlock {
  double w, wt;                  // W_nn and W_tt, 1/kg
  double w_inverse, wt_inverse;  // kg
  double ratio;                  // W_tt / W_nn
  double mu;
};

template <class Tangent>
NSCD_INLINE Split<Tangent> part_way(const Split<Tangent> &from, const Split<Tangent> &to, double share)
{
  return {from.n + share * (to.n - from.n), from.t + (to.t - from.t) * share};
}

// A visit of a frictional contact that does `share` of its step.
template <class Law, class Tangent>
NSCD_INLINE FrictionalLocal<Tangent> visit_partly(const FrictionalLocal<Tangent> &now, const Split<Tangent> &v,
                                                  const OwnBlock &own, double parameter, double share)
{
  FrictionalLocal<Tangent> next = Law::visit(now, v, own, parameter);
  if (share != 1) {
    next.p = part_way(now.p, next.p, share);
    next.v = part_way(v, next.v, share);
  }
  return next;
}

}    // namespace nscd
