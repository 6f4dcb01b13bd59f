// SPDX-License-Identifier: GPL-2.0-or-later
// What a contact has beside its normal direction where there is friction: tangential velocity and impulse, spins.
//
// A scene is frictionless (one unknown per contact, no spins), planar (two) or spatial (three); chosen once, when
// the step is made. Frictionless contacts stay one cache line, and nothing below is touched for them.
//
// The spin of a grain is kept as its surface velocity s = r omega (m/s). Then no radius is needed at a contact,
//   u_t = (v_i - v_j)_t - (s_i + s_j) x n
// and an impulse p_t on i, -p_t on j changes both spins by -k/m n x p_t, k = m r^2 / I: 5/2 for a sphere, 2 for a disc.
// A contact's own block of the Delassus matrix is therefore diagonal: W_nn, and W_tt = (1 + k) W_nn in every direction.
#pragma once

#include "base/hot.hpp"
#include "base/storage.hpp"
#include "contact/contact.hpp"

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace nscd {

enum class Model { frictionless, planar, spatial };

constexpr double sphere_spin_response = 2.5;  // m r^2 / I
constexpr double disc_spin_response = 2;

// A vector at a contact, split into its normal and its tangential part.
template <class Tangent>
struct Split {
  double n = 0;
  Tangent t = Tangent{};
};

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

// Radius of Coulomb's disc; `mu` may be infinite (stick).
NSCD_INLINE double coulomb_radius(double mu, double impulse) { return impulse > 0 ? mu * impulse : 0.0; }

// `dimension 2`: the tangent is t = (-n_y, n_x), the spin is that about z.
struct Planar {
  using Tangent = double;
  struct Slide {
    double impulse;  // along t, on body i, N s
    double bias;     // m/s, e_t times the tangential velocity before
    double mu;
  };
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
  struct Slide {
    alignas(vec4_alignment) Vec4 impulse;  // on body i, N s
    double bias[3];
    double mu;
  };
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
static_assert(sizeof(Spatial::Slide) == 64);

NSCD_INLINE double bias(const Planar::Slide &slide) { return slide.bias; }
NSCD_INLINE Vec4 bias(const Spatial::Slide &slide) { return Vec4{slide.bias[0], slide.bias[1], slide.bias[2], 0}; }
inline void set_bias(Planar::Slide &slide, double value) { slide.bias = value; }
inline void set_bias(Spatial::Slide &slide, const Vec4 &value)
{
  for (int d = 0; d < 3; ++d) slide.bias[d] = value[d];
}

// Velocity of the contact without biases.
template <class Model>
NSCD_INLINE Split<typename Model::Tangent> velocity(const Contact &c, const Body *bodies, const Vec4 *spins)
{
  const Vec4 difference = bodies[c.i] - bodies[c.j];
  const double n = dot(c.normal, difference);
  return {n, Model::slip(c.normal, difference, n, Model::spin(spins[c.i]) + Model::spin(spins[c.j]))};
}

// Hands a tangential impulse to both bodies.
template <class Model>
NSCD_INLINE void apply_tangential(const Contact &c, const typename Model::Tangent &dp, double spin_response,
                                  Body *bodies, Vec4 *spins)
{
  const Body bi = bodies[c.i], bj = bodies[c.j];
  const Vec4 push = Model::in_space(c.normal, dp);
  const auto turn = Model::turned(c.normal, dp) * spin_response;
  bodies[c.i] = bi + push * bi[3];
  bodies[c.j] = bj - push * bj[3];
  Model::set_spin(spins[c.i], Model::spin(spins[c.i]) - turn * bi[3]);
  Model::set_spin(spins[c.j], Model::spin(spins[c.j]) - turn * bj[3]);
}

// What a solver sees of it. `planar` or `spatial` lies beside the contacts, the other is null.
struct Sliding {
  Model model = Model::frictionless;
  double spin_response = 0;
  Vec4 *spins = nullptr;   // one a body
  Planar::Slide *planar = nullptr;
  Spatial::Slide *spatial = nullptr;

  template <class M>
  typename M::Slide *slides() const
  {
    if constexpr (std::is_same_v<M, Planar>) return planar;
    else return spatial;
  }
};

// Calls f(Planar{}) or f(Spatial{}), or nothing for a frictionless scene.
template <class Function>
void with_friction(Model model, Function f)
{
  if (model == Model::planar) f(Planar{});
  if (model == Model::spatial) f(Spatial{});
}

}    // namespace nscd
