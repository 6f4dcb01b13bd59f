// SPDX-License-Identifier: GPL-2.0-or-later
// A part of contacts that only tests have: resistance to rolling.
//
//   |m| <= mu_r r p_n,  against the relative spin across the normal,  m / r = p_r,  u_r = r (omega_i - omega_j)_t
//
// `weight_i` and `weight_j` make that of the spins that the dynamics keep: r / r_i and r / r_j of surface velocities
// r_i omega_i, r twice of angular velocities. W couples it to sliding where a contact's bodies differ.
#pragma once

#include "contact/slide.hpp"

template <class Space_>
struct Roll : nscd::Bounded<typename Space_::Tangent> {
  using Space = Space_;
  using Vector = typename Space::Tangent;
  static constexpr int axes = Space::unknowns - 1;
  static constexpr bool stands_alone = false;
  static constexpr bool mirrors = true;
  double weight_i, weight_j;

  template <class Pair>
  NSCD_INLINE Vector velocity(const Pair &pair, const nscd::Vec4 &n, double) const
  {
    return Space::tangential(n, pair.spin_i() * weight_i - pair.spin_j() * weight_j);
  }
  template <class Pair>
  NSCD_INLINE auto wrench(const Pair &pair, const nscd::Vec4 &, const Vector &impulse) const
  {
    return pair.moments(impulse * weight_i, impulse * -weight_j);
  }
};
