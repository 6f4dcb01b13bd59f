// SPDX-License-Identifier: GPL-2.0-or-later
// What contacts do to their bodies: the dynamics of these, and the parts that a contact has beside its normal one.
//
// A scene has one mechanics, chosen when it begins: Frictionless, Frictional<Planar> or Frictional<Spatial>. Sweeps,
// criterion, assembly and warm start take it as a template argument, so none pays for parts that it has not. A new part
// is a file as slide.hpp, new dynamics are one as spheres.hpp, and what they make together is a line at the end of this
// one. tests/core/parts has such files.
#pragma once

#include "contact/frame.hpp"
#include "contact/slide.hpp"
#include "contact/spheres.hpp"

#include <cstddef>
#include <tuple>
#include <utility>

namespace nscd {

template <class Dynamics_, class... Parts>
class Mechanics {
 public:
  using Dynamics = Dynamics_;
  using Pair = typename Dynamics::Pair;
  using Wrench = typename Dynamics::Wrench;
  using Tangent = Together<typename Parts::Vector...>;
  using Vector = Split<Tangent>;
  using Own = OwnBlock<Tangent>;
  using Frame = nscd::Frame<Parts::axes...>;
  static constexpr std::size_t parts = sizeof...(Parts);
  // Whether a contact's own block of W is diagonal, or has to be bounded by one (own_blocks.hpp).
  static constexpr bool diagonal = Dynamics::blocks_are_diagonal && (Parts::stands_alone && ...);
  template <std::size_t part>
  using Part = std::tuple_element_t<part, std::tuple<Parts...>>;

  // `beside`: each part's, beside the contacts.
  explicit Mechanics(const Dynamics &dynamics, Parts *...beside) : dynamics_(dynamics), beside_(beside...) {}
  // Where they are not diagonal, beside the contacts (problem/own_blocks.hpp).
  void take_own_blocks(const Own *own) { own_ = own; }

  const Dynamics &dynamics() const { return dynamics_; }
  template <std::size_t part>
  NSCD_INLINE Part<part> &beside(std::size_t k) const
  {
    return std::get<part>(beside_)[k];
  }

  NSCD_INLINE void prefetch(const Contact &c) const { dynamics_.prefetch(c); }
  NSCD_INLINE Pair load(const Contact &c, std::size_t k) const { return Pair(dynamics_, c, k); }
  NSCD_INLINE void store(const Contact &c, const Pair &pair) const { pair.store(dynamics_, c); }

  // Of contact k, m/s.
  NSCD_INLINE Vector velocity_without_biases(const Contact &c, std::size_t k, const Pair &pair) const
  {
    Vector v{pair.normal(c.normal), {}};
    each_part(v.t, [&](auto &part, auto &u) NSCD_INLINED { u = part.velocity(pair, c.normal, v.n); }, k);
    return v;
  }
  NSCD_INLINE Vector velocity(const Contact &c, std::size_t k, const Pair &pair) const
  {
    Vector v = velocity_without_biases(c, k, pair);
    v.n = v.n + c.bias;
    each_part(v.t, [&](auto &part, auto &u) NSCD_INLINED { u = u + bias(part); }, k);
    return v;
  }
  NSCD_INLINE Vector velocity(const Contact &c, std::size_t k) const { return velocity(c, k, load(c, k)); }

  // The impulse of contact k, N s; its normal part is the contact's.
  NSCD_INLINE Vector impulse(const Contact &c, std::size_t k) const
  {
    Vector p{c.impulse, {}};
    each_part(p.t, [](auto &part, auto &impulse) NSCD_INLINED { impulse = part.impulse; }, k);
    return p;
  }
  NSCD_INLINE void set_impulse(Contact &c, std::size_t k, const Vector &p) const
  {
    c.impulse = p.n;
    each_part(p.t, [](auto &part, const auto &impulse) NSCD_INLINED { part.impulse = impulse; }, k);
  }

  // What an impulse of contact k comes to.
  NSCD_INLINE Wrench wrench(const Contact &c, std::size_t k, const Pair &pair, const Vector &p) const
  {
    if constexpr (parts == 0) return pair.along_normal(c.normal, p.n);
    else return pair.with_normal(c.normal, p.n, wrench_of_parts<0>(c, k, pair, p.t));
  }

  // Hands a change of contact k's impulse to its bodies, one part after another.
  NSCD_INLINE void push(const Contact &c, std::size_t k, const Vector &dp) const
  {
    dynamics_.push(c, k, dp.n);
    each_part(dp.t, [&](auto &part, const auto &impulse) NSCD_INLINED { push_one(c, k, part, impulse); }, k);
  }
  // That of one part.
  template <std::size_t part>
  NSCD_INLINE void push_part(const Contact &c, std::size_t k, const typename Part<part>::Vector &dp) const
  {
    push_one(c, k, beside<part>(k), dp);
  }

  // Calls f(coefficient) for each part.
  template <class F>
  void each_coefficient(std::size_t k, F f) const
  {
    std::apply([&](auto *...beside) { (f(beside[k].mu), ...); }, beside_);
  }

  // `w` is W_nn of the contact, which sweeps have from its bodies, and the criterion from the contact.
  NSCD_INLINE Own own(const Contact &c, std::size_t k, double w) const
  {
    if constexpr (!diagonal) return own_[k];
    else {
      Own block{w, c.w_inverse, {}};
      if constexpr (parts > 0)
        std::apply([&](auto *...beside) NSCD_INLINED {
          std::size_t number = 0;
          ((block.discs[number++] = alone(block, beside[k])), ...);
        }, beside_);
      return block;
    }
  }

  // Without what is along the normal, which round-off leaves.
  NSCD_INLINE static Tangent tangential(const Contact &c, Tangent t)
  {
    for_each_disc([&](std::size_t, auto &one) NSCD_INLINED { one = flattened(c.normal, one); }, t);
    return t;
  }

 private:
  NSCD_INLINE static double flattened(const Vec4 &, double t) { return t; }
  NSCD_INLINE static Vec4 flattened(const Vec4 &n, const Vec4 &t) { return Spatial::tangential(n, t); }

  template <class One>
  NSCD_INLINE void push_one(const Contact &c, std::size_t k, const One &part, const typename One::Vector &dp) const
  {
    Pair pair = load(c, k);
    pair.add(part.wrench(pair, c.normal, dp));
    store(c, pair);
  }

  // Calls f(what lies beside contact k, its vector in `t`) for each part.
  template <class T, class F>
  NSCD_INLINE void each_part(T &&t, F f, std::size_t k) const
  {
    if constexpr (parts > 0)
      std::apply([&](auto *...beside) NSCD_INLINED { each_part_of(t, f, beside[k]...); }, beside_);
  }
  template <class T, class F, class One, class... Others>
  NSCD_INLINE static void each_part_of(T &t, F &f, One &one, Others &...others)
  {
    if constexpr (requires { t.first; }) {
      f(one, t.first);
      if constexpr (sizeof...(Others) > 0) each_part_of(t.rest, f, others...);
    } else {
      f(one, t);
    }
  }

  template <std::size_t part, class T>
  NSCD_INLINE Wrench wrench_of_parts(const Contact &c, std::size_t k, const Pair &pair, const T &t) const
  {
    if constexpr (requires { t.rest; })
      return beside<part>(k).wrench(pair, c.normal, t.first) + wrench_of_parts<part + 1>(c, k, pair, t.rest);
    else if constexpr (requires { t.first; }) return beside<part>(k).wrench(pair, c.normal, t.first);
    else return beside<part>(k).wrench(pair, c.normal, t);
  }

  template <class One>
  NSCD_INLINE Disc alone(const Own &block, const One &part) const
  {
    const double ratio = One::ratio(dynamics_);
    return {block.w * ratio, block.w_inverse * (1 / ratio), ratio, part.mu};
  }

  Dynamics dynamics_;
  std::tuple<Parts *...> beside_;
  const Own *own_ = nullptr;
};

using Frictionless = Mechanics<Translating>;
template <class Space>
using Frictional = Mechanics<Spheres<Space>, Slide<Space>>;

enum class Model { frictionless, planar, spatial };

// Calls f(Planar{}) or f(Spatial{}), or nothing for a frictionless scene.
template <class Function>
void with_friction(Model model, Function f)
{
  if (model == Model::planar) f(Planar{});
  if (model == Model::spatial) f(Spatial{});
}

// The parts of a scene's contacts beside the normal one. `planar` or `spatial` lies beside the contacts, the other is
// null.
struct Sliding {
  Model model = Model::frictionless;
  double spin_response = 0;
  Vec4 *spins = nullptr;   // one a body
  Slide<Planar> *planar = nullptr;
  Slide<Spatial> *spatial = nullptr;

  template <class Space>
  Slide<Space> *slides() const
  {
    if constexpr (std::is_same_v<Space, Planar>) return planar;
    else return spatial;
  }
  template <class Space>
  Frictional<Space> mechanics(Body *bodies) const
  {
    return Frictional<Space>(Spheres<Space>(bodies, spins, spin_response), slides<Space>());
  }
};

// Calls f with the scene's mechanics.
template <class Function>
auto with_mechanics(const Sliding &sliding, Body *bodies, Function f)
{
  switch (sliding.model) {
    case Model::planar: return f(sliding.mechanics<Planar>(bodies));
    case Model::spatial: return f(sliding.mechanics<Spatial>(bodies));
    default: return f(Frictionless(Translating(bodies)));
  }
}

// Of a contact of spheres, without biases; bodies and spins as they are kept.
template <class Space>
NSCD_INLINE Split<typename Space::Tangent> velocity(const Contact &c, const Body *bodies, const Vec4 *spins)
{
  const Vec4 difference = bodies[c.i] - bodies[c.j];
  const double n = dot(c.normal, difference);
  return {n, Space::slip(c.normal, difference, n, Space::spin(spins[c.i]) + Space::spin(spins[c.j]))};
}

}    // namespace nscd
