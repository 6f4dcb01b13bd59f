// SPDX-License-Identifier: GPL-2.0-or-later
// The velocities that EBP and EAL carry from visit to visit under friction, in a solver's workspace.
// Solvers with momentum keep the impulses of the sweep before in the same layout.
#pragma once

#include "contact/discs.hpp"

#include <cstddef>
#include <cstring>

namespace nscd {

// Doubles a contact takes there: the normal velocity, then the tangential one.
template <class Tangent>
constexpr std::size_t carried_doubles = (disc_count<Tangent> > 0 ? sizeof(Tangent) / sizeof(double) : 0) + 1;

template <class Tangent>
NSCD_INLINE Split<Tangent> load_carried(const double *at)
{
  Split<Tangent> v;
  v.n = *at;
  if constexpr (disc_count<Tangent> > 0) std::memcpy(static_cast<void *>(&v.t), at + 1, sizeof(Tangent));
  return v;
}

template <class Tangent>
NSCD_INLINE void store_carried(double *at, const Split<Tangent> &v)
{
  *at = v.n;
  if constexpr (disc_count<Tangent> > 0) std::memcpy(at + 1, &v.t, sizeof(Tangent));
}

}    // namespace nscd
