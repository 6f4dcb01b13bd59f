// SPDX-License-Identifier: GPL-2.0-or-later
// A part of contacts that only tests have: resistance to twisting.
//
//   |m| <= mu_t r p_n,  against the relative spin about the normal,  m / r = p_w,  u_w = r n.(omega_i - omega_j)
//
// A number in space: the moment on body i is p_w r n. `weight_i` and `weight_j` as in roll.hpp. Seen from the other
// body the normal and the difference of spins both change sign, so the number stays.
#pragma once

#include "contact/slide.hpp"

struct Twist : nscd::Bounded<double> {
  using Vector = double;
  static constexpr int axes = 1;
  static constexpr bool stands_alone = false;   // its W over W_nn differs from contact to contact
  static constexpr bool mirrors = false;
  double weight_i, weight_j;

  template <class Pair>
  NSCD_INLINE double velocity(const Pair &pair, const nscd::Vec4 &n, double) const
  {
    return nscd::dot(n, pair.spin_i() * weight_i - pair.spin_j() * weight_j);
  }
  template <class Pair>
  NSCD_INLINE auto wrench(const Pair &pair, const nscd::Vec4 &n, double impulse) const
  {
    return pair.moments(n * (impulse * weight_i), n * (impulse * -weight_j));
  }
};
