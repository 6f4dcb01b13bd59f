// SPDX-License-Identifier: GPL-2.0-or-later
// Dynamics that only tests have: bodies of any shape, which touch at the ends of arms. A push along the normal turns
// them, so no part of a contact stands alone.
//
//   u = v_i + omega_i x a_i - v_j - omega_j x a_j,   dv = P / m,   d omega = I^-1 (a x P + M)
#pragma once

#include "contact/space.hpp"

#include <array>

class RigidBodies {
 public:
  using Vec4 = nscd::Vec4;
  using Contact = nscd::Contact;
  static constexpr bool blocks_are_diagonal = false;

  struct Arms {
    alignas(nscd::vec4_alignment) Vec4 i, j;   // from the centres to where they touch, m
  };
  struct Inertia {
    alignas(nscd::vec4_alignment) std::array<Vec4, 3> inverse;   // columns, in space, 1 / (kg m^2)
    NSCD_INLINE Vec4 turn(const Vec4 &torque) const
    {
      return inverse[0] * torque[0] + inverse[1] * torque[1] + inverse[2] * torque[2];
    }
  };

  struct Wrench {
    alignas(nscd::vec4_alignment) Vec4 push{}, torque_i{}, torque_j{};
    NSCD_INLINE friend Wrench operator+(const Wrench &a, const Wrench &b)
    {
      return {a.push + b.push, a.torque_i + b.torque_i, a.torque_j + b.torque_j};
    }
  };

  class Pair {
   public:
    NSCD_INLINE Pair(const RigidBodies &all, const Contact &c, std::size_t k) :
        i_(all.bodies_[c.i]), j_(all.bodies_[c.j]), omega_i_(all.omegas_[c.i]), omega_j_(all.omegas_[c.j]),
        arms_(all.arms_[k]), inertia_i_(all.inertias_[c.i]), inertia_j_(all.inertias_[c.j])
    {
    }

    NSCD_INLINE double mobility() const { return i_[3] + j_[3]; }
    NSCD_INLINE double normal(const Vec4 &n) const { return nscd::dot(n, difference()); }
    NSCD_INLINE Vec4 slip(const Vec4 &n, double normal) const { return difference() - n * normal; }
    NSCD_INLINE const Vec4 &spin_i() const { return omega_i_; }
    NSCD_INLINE const Vec4 &spin_j() const { return omega_j_; }

    NSCD_INLINE Wrench at_contact(const Vec4 &, const Vec4 &impulse) const
    {
      return {impulse, nscd::cross(arms_.i, impulse), -nscd::cross(arms_.j, impulse)};
    }
    NSCD_INLINE Wrench along_normal(const Vec4 &n, double impulse) const { return at_contact(n, n * impulse); }
    NSCD_INLINE Wrench with_normal(const Vec4 &n, double impulse, const Wrench &other) const
    {
      return along_normal(n, impulse) + other;
    }
    NSCD_INLINE static Wrench moments(const Vec4 &on_i, const Vec4 &on_j) { return {Vec4{}, on_i, on_j}; }

    NSCD_INLINE void add(const Wrench &w)
    {
      i_ += w.push * i_[3];
      j_ -= w.push * j_[3];
      omega_i_ += inertia_i_.turn(w.torque_i);
      omega_j_ += inertia_j_.turn(w.torque_j);
    }
    NSCD_INLINE void store(const RigidBodies &all, const Contact &c) const
    {
      all.bodies_[c.i] = i_;
      all.bodies_[c.j] = j_;
      all.omegas_[c.i] = omega_i_;
      all.omegas_[c.j] = omega_j_;
    }

   private:
    NSCD_INLINE Vec4 difference() const
    {
      const Vec4 at_i = i_ + nscd::cross(omega_i_, arms_.i), at_j = j_ + nscd::cross(omega_j_, arms_.j);
      return nscd::without_fourth(at_i - at_j);
    }

    alignas(nscd::vec4_alignment) Vec4 i_, j_, omega_i_, omega_j_;
    const Arms &arms_;
    const Inertia &inertia_i_, &inertia_j_;
  };

  // Beside the bodies; `arms` beside the contacts.
  RigidBodies(nscd::Body *bodies, Vec4 *omegas, const Inertia *inertias, const Arms *arms) :
      bodies_(bodies), omegas_(omegas), inertias_(inertias), arms_(arms)
  {
  }

  NSCD_INLINE void prefetch(const Contact &) const {}
  NSCD_INLINE void push(const Contact &c, std::size_t k, double dp) const
  {
    Pair pair(*this, c, k);
    pair.add(pair.along_normal(c.normal, dp));
    pair.store(*this, c);
  }
  double inner(int b, const Wrench &one, bool one_first, const Wrench &other, bool other_first) const
  {
    const double sign = one_first == other_first ? 1 : -1;
    const Vec4 torque = one_first ? one.torque_i : one.torque_j;
    return sign * bodies_[b][3] * nscd::dot(one.push, other.push) +
        nscd::dot(torque, inertias_[b].turn(other_first ? other.torque_i : other.torque_j));
  }

 private:
  nscd::Body *bodies_;
  Vec4 *omegas_;
  const Inertia *inertias_;
  const Arms *arms_;
};
