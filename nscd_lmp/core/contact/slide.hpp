// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a contact that keeps its bodies from sliding against each other: Coulomb's friction.
//
//   u_t = 0 where |p_t| < mu p_n,   p_t = -mu p_n u_t / |u_t| otherwise
//
// A part is what lies beside a contact, and how that acts on the contact's bodies: its velocity, what its impulse does,
// and its own W over W_nn where no other part moves with it. mechanics.hpp puts parts together.
#pragma once

#include "contact/discs.hpp"

#include <type_traits>

namespace nscd {

// What any part has whose impulse, a number or a vector in space, is bounded by mu p_n.
template <class Vector>
struct Bounded;

template <>
struct Bounded<double> {
  double impulse;  // along t, on body i, N s
  double bias;     // m/s, e_t times the tangential velocity before
  double mu;
};

template <>
struct Bounded<Vec4> {
  alignas(vec4_alignment) Vec4 impulse;  // on body i, N s
  double bias[3];
  double mu;
};

NSCD_INLINE double bias(const Bounded<double> &part) { return part.bias; }
NSCD_INLINE Vec4 bias(const Bounded<Vec4> &part) { return Vec4{part.bias[0], part.bias[1], part.bias[2], 0}; }
inline void set_bias(Bounded<double> &part, double value) { part.bias = value; }
inline void set_bias(Bounded<Vec4> &part, const Vec4 &value)
{
  for (int d = 0; d < 3; ++d) part.bias[d] = value[d];
}

template <class Space_>
struct Slide : Bounded<typename Space_::Tangent> {
  using Space = Space_;
  using Vector = typename Space::Tangent;
  static constexpr int axes = Space::unknowns - 1;
  // Whether W couples it to no other part of its contact, and its own W over W_nn is the same at all contacts.
  static constexpr bool stands_alone = true;
  // Where its impulse is a number: whether that changes sign when it is seen from the other body.
  static constexpr bool mirrors = false;

  // m/s, without bias; `normal` is the contact's normal velocity.
  template <class Pair>
  NSCD_INLINE Vector velocity(const Pair &pair, const Vec4 &n, double normal) const
  {
    return pair.slip(n, normal);
  }
  template <class Pair>
  NSCD_INLINE auto wrench(const Pair &pair, const Vec4 &n, const Vector &impulse) const
  {
    return pair.at_contact(n, impulse);
  }
  template <class Dynamics>
  NSCD_INLINE static double ratio(const Dynamics &dynamics)
  {
    return dynamics.slide_ratio();
  }
};
static_assert(sizeof(Slide<Spatial>) == 64 && sizeof(Slide<Planar>) == 24);

}    // namespace nscd
