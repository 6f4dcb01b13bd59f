// SPDX-License-Identifier: GPL-2.0-or-later
// What a visit of one contact works on, in every sweep. Its own block of W is OwnBlock (contact/discs.hpp).
#pragma once

#include "contact/discs.hpp"

#include <cmath>
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

template <class Tangent>
NSCD_INLINE Split<Tangent> part_way(const Split<Tangent> &from, const Split<Tangent> &to, double share)
{
  return {from.n + share * (to.n - from.n), from.t + (to.t - from.t) * share};
}

// A visit of a frictional contact that does `share` of its step.
template <class Law, class Tangent>
NSCD_INLINE FrictionalLocal<Tangent> visit_partly(const FrictionalLocal<Tangent> &now, const Split<Tangent> &v,
                                                  const OwnBlock<Tangent> &own, double parameter, double share)
{
  FrictionalLocal<Tangent> next = Law::visit(now, v, own, parameter);
  if (share != 1) {
    next.p = part_way(now.p, next.p, share);
    next.v = part_way(v, next.v, share);
  }
  return next;
}

// Visits of one contact in a sweep where its block is bounded by a diagonal: until they change little.
constexpr int most_visits = 20;

// The velocities that a change of impulses makes at most, m/s.
template <class Tangent>
NSCD_INLINE double most_of(const OwnBlock<Tangent> &own, const Split<Tangent> &change)
{
  double sum = own.w * std::abs(change.n);
  for_each_disc([&](std::size_t d, const auto &one) NSCD_INLINED { sum += own.discs[d].w * length(one); }, change.t);
  return sum;
}

// change . (next - last), with the block over W_nn as weight.
template <class Tangent>
NSCD_INLINE double weighed(const OwnBlock<Tangent> &own, const Split<Tangent> &change, const Split<Tangent> &next,
                           const Split<Tangent> &last)
{
  double sum = change.n * (next.n - last.n);
  for_each_disc([&](std::size_t d, const auto &by, const auto &one, const auto &other) NSCD_INLINED {
    sum = sum + own.discs[d].ratio * inner(by, one - other);
  }, change.t, next.t, last.t);
  return sum;
}

}    // namespace nscd
