// SPDX-License-Identifier: GPL-2.0-or-later
// How impulses move spheres and discs: the dynamics of scenes with friction.
//
// The spin of a grain is kept as its surface velocity s = r omega (m/s). Then no radius is needed at a contact,
//   u_t = (v_i - v_j)_t - (s_i + s_j) x n
// and an impulse p_t on i, -p_t on j changes both spins by -k/m n x p_t, k = m r^2 / I: 5/2 for a sphere, 2 for a disc.
// A contact's own block of the Delassus matrix is therefore diagonal: W_nn, and W_tt = (1 + k) W_nn in every direction.
//
// Dynamics load the bodies of a contact as a Pair, whose velocities a contact's parts read, to which wrenches are
// added, and store it. A wrench is what impulses at a contact come to.
#pragma once

#include "contact/space.hpp"

namespace nscd {

constexpr double sphere_spin_response = 2.5;  // m r^2 / I
constexpr double disc_spin_response = 2;

template <class Space_>
class Spheres {
 public:
  using Space = Space_;
  using Spin = typename Space::Tangent;
  static constexpr bool blocks_are_diagonal = true;

  // On body i; -push on body j. A turn lowers a spin, by turn k / m.
  struct Wrench {
    alignas(vec4_alignment) Vec4 push{};   // N s
    alignas(Spin) Spin turn_i{}, turn_j{};

    NSCD_INLINE friend Wrench operator+(const Wrench &a, const Wrench &b)
    {
      return {a.push + b.push, a.turn_i + b.turn_i, a.turn_j + b.turn_j};
    }
  };

  class Pair {
   public:
    NSCD_INLINE Pair(const Spheres &all, const Contact &c, std::size_t) :
        i_(all.bodies_[c.i]), j_(all.bodies_[c.j]), spin_i_(Space::spin(all.spins_[c.i])),
        spin_j_(Space::spin(all.spins_[c.j])), response_(all.response_)
    {
    }

    NSCD_INLINE double mobility() const { return i_[3] + j_[3]; }   // 1/m_i + 1/m_j, 1/kg
    NSCD_INLINE double normal(const Vec4 &n) const { return dot(n, i_ - j_); }
    NSCD_INLINE Spin slip(const Vec4 &n, double normal) const
    {
      return Space::slip(n, i_ - j_, normal, spin_i_ + spin_j_);
    }
    // Of bodies i and j as they are kept, m/s.
    NSCD_INLINE const Spin &spin_i() const { return spin_i_; }
    NSCD_INLINE const Spin &spin_j() const { return spin_j_; }

    NSCD_INLINE static Wrench along_normal(const Vec4 &n, double impulse) { return {n * impulse, Spin{}, Spin{}}; }
    NSCD_INLINE static Wrench at_contact(const Vec4 &n, const Spin &impulse)
    {
      const Spin turned = Space::turned(n, impulse);
      return {Space::in_space(n, impulse), turned, turned};
    }
    // With a normal impulse beside it, which turns nothing.
    NSCD_INLINE static Wrench with_normal(const Vec4 &n, double impulse, const Wrench &other)
    {
      return {n * impulse + other.push, other.turn_i, other.turn_j};
    }
    // `on_i` and `on_j` are moments over the bodies' radii, N s.
    NSCD_INLINE static Wrench moments(const Spin &on_i, const Spin &on_j) { return {Vec4{}, -on_i, -on_j}; }

    NSCD_INLINE void add(const Wrench &w)
    {
      const double at_i = i_[3], at_j = j_[3];
      i_ = i_ + w.push * at_i;
      j_ = j_ - w.push * at_j;
      spin_i_ = spin_i_ - w.turn_i * response_ * at_i;
      spin_j_ = spin_j_ - w.turn_j * response_ * at_j;
    }

    NSCD_INLINE void store(const Spheres &all, const Contact &c) const
    {
      all.bodies_[c.i] = i_;
      all.bodies_[c.j] = j_;
      Space::set_spin(all.spins_[c.i], spin_i_);
      Space::set_spin(all.spins_[c.j], spin_j_);
    }

   private:
    alignas(vec4_alignment) Vec4 i_, j_;
    alignas(Spin) Spin spin_i_, spin_j_;
    double response_;
  };

  Spheres(Body *bodies, Vec4 *spins, double response) :
      bodies_(bodies), spins_(spins), response_(response), ratio_(1 + response)
  {
  }

  NSCD_INLINE void prefetch(const Contact &c) const
  {
    fetch_bodies(c, bodies_);
    fetch_bodies(c, spins_);
  }

  // The normal impulse `dp` (N s) of contact k, to both bodies.
  NSCD_INLINE void push(const Contact &c, std::size_t, double dp) const { apply_impulse(c, dp, bodies_); }

  // W_tt / W_nn of a contact alone.
  NSCD_INLINE double slide_ratio() const { return ratio_; }

  // What one wrench, on body b as the first or second of its contact, does along another.
  double inner(int b, const Wrench &one, bool one_first, const Wrench &other, bool other_first) const
  {
    const double mobility = bodies_[b][3], push = one_first == other_first ? mobility : -mobility;
    return push * dot(one.push, other.push) +
        mobility * response_ * nscd::inner(one_first ? one.turn_i : one.turn_j,
                                           other_first ? other.turn_i : other.turn_j);
  }

 private:
  Body *bodies_;
  Vec4 *spins_;
  double response_, ratio_;
};

// Spheres that nothing turns: the dynamics of scenes without friction.
class Translating {
 public:
  struct Wrench {
    alignas(vec4_alignment) Vec4 push{};
  };

  class Pair {
   public:
    NSCD_INLINE Pair(const Translating &all, const Contact &c, std::size_t) :
        i_(all.bodies_[c.i]), j_(all.bodies_[c.j])
    {
    }
    NSCD_INLINE double mobility() const { return i_[3] + j_[3]; }
    NSCD_INLINE double normal(const Vec4 &n) const { return dot(n, i_ - j_); }
    NSCD_INLINE static Wrench along_normal(const Vec4 &n, double impulse) { return {n * impulse}; }
    NSCD_INLINE void add(const Wrench &w)
    {
      const double at_i = i_[3], at_j = j_[3];
      i_ = i_ + w.push * at_i;
      j_ = j_ - w.push * at_j;
    }
    NSCD_INLINE void store(const Translating &all, const Contact &c) const
    {
      all.bodies_[c.i] = i_;
      all.bodies_[c.j] = j_;
    }

   private:
    alignas(vec4_alignment) Vec4 i_, j_;
  };

  static constexpr bool blocks_are_diagonal = true;
  explicit Translating(Body *bodies) : bodies_(bodies) {}
  NSCD_INLINE void push(const Contact &c, std::size_t, double dp) const { apply_impulse(c, dp, bodies_); }
  NSCD_INLINE void prefetch(const Contact &c) const { fetch_bodies(c, bodies_); }
  double inner(int b, const Wrench &one, bool one_first, const Wrench &other, bool other_first) const
  {
    const double mobility = bodies_[b][3], push = one_first == other_first ? mobility : -mobility;
    return push * dot(one.push, other.push);
  }

 private:
  Body *bodies_;
};

}    // namespace nscd
