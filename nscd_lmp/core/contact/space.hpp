// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors at a contact, in the plane and in space.
#pragma once

#include "base/hot.hpp"
#include "contact/contact.hpp"

#include <cmath>
#include <cstdint>

namespace nscd {

NSCD_INLINE double inner(double a, double b) { return a * b; }
NSCD_INLINE double inner(const Vec4 &a, const Vec4 &b) { return dot(a, b); }
NSCD_INLINE double length(double a) { return std::abs(a); }
NSCD_INLINE double length(const Vec4 &a) { return std::sqrt(dot(a, a)); }

using Places = std::int64_t __attribute__((vector_size(32)));

NSCD_INLINE Vec4 magnitudes(const Vec4 &a)
{
  constexpr std::int64_t all = 0x7FFFFFFFFFFFFFFF;
  return (Vec4)((Places)a & Places{all, all, all, all});
}

// y, z, x: one shuffle, which GCC and clang both make of it. Their built-in functions for it differ.
NSCD_INLINE Vec4 in_turn(const Vec4 &a) { return Vec4{a[1], a[2], a[0], a[3]}; }

// The fourth component is 0 if those of a and b are finite.
NSCD_INLINE Vec4 cross(const Vec4 &a, const Vec4 &b)
{
  return in_turn(a * in_turn(b) - in_turn(a) * b);
}

NSCD_INLINE Vec4 without_fourth(const Vec4 &a)
{
  constexpr std::int64_t all = -1;
  return (Vec4)((Places)a & Places{all, all, all, 0});
}

// The orthogonal projection on the ball of this radius, which may be infinite.
template <class Tangent>
NSCD_INLINE Tangent onto_ball(const Tangent &t, double radius)
{
  const double length2 = inner(t, t);
  return length2 <= radius * radius ? t : t * (radius / std::sqrt(length2));
}

template <class Space>
struct Slide;

// `dimension 2`: the tangent is t = (-n_y, n_x), the spin is that about z.
struct Planar {
  using Tangent = double;
  using Slide = nscd::Slide<Planar>;
  static constexpr int unknowns = 2;

  NSCD_INLINE static Vec4 tangent(const Vec4 &n) { return Vec4{-n[1], n[0], 0, 0}; }
  NSCD_INLINE static double spin(const Vec4 &s) { return s[2]; }
  NSCD_INLINE static void set_spin(Vec4 &s, double spin) { s[2] = spin; }
  // n x p_t.
  NSCD_INLINE static double turned(const Vec4 &, double impulse) { return impulse; }
  NSCD_INLINE static double slip(const Vec4 &n, const Vec4 &difference, double, double spins)
  {
    return n[0] * difference[1] - n[1] * difference[0] - spins;
  }
  NSCD_INLINE static Vec4 in_space(const Vec4 &n, double t) { return tangent(n) * t; }
  NSCD_INLINE static double tangential(const Vec4 &, double t) { return t; }
  NSCD_INLINE static double from_space(const Vec4 &n, const Vec4 &t) { return dot(tangent(n), t); }
};

// No tangent frame: tangential vectors lie in space, perpendicular to n. Nothing can depend on how one turns a frame.
struct Spatial {
  using Tangent = Vec4;  // fourth component 0
  using Slide = nscd::Slide<Spatial>;
  static constexpr int unknowns = 3;

  NSCD_INLINE static Vec4 spin(const Vec4 &s) { return s; }
  NSCD_INLINE static void set_spin(Vec4 &s, const Vec4 &spin) { s = spin; }
  NSCD_INLINE static Vec4 turned(const Vec4 &n, const Vec4 &impulse) { return cross(n, impulse); }
  NSCD_INLINE static Vec4 slip(const Vec4 &n, const Vec4 &difference, double normal, const Vec4 &spins)
  {
    return without_fourth(difference - n * normal - cross(spins, n));
  }
  NSCD_INLINE static Vec4 in_space(const Vec4 &, const Vec4 &t) { return t; }
  // Without what round-off has left along the normal.
  NSCD_INLINE static Vec4 tangential(const Vec4 &n, const Vec4 &t) { return t - n * dot(n, t); }
  NSCD_INLINE static Vec4 from_space(const Vec4 &n, const Vec4 &t) { return tangential(n, t); }
};

}    // namespace nscd
