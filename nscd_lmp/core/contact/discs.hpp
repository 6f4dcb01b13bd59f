// SPDX-License-Identifier: GPL-2.0-or-later
// A contact's impulse or velocity, split into its normal and its other parts. The impulse of each other part is bounded
// by a coefficient times the normal one, so it lies in a disc: a vector for each disc. One disc is that vector itself.
#pragma once

#include "base/hot.hpp"
#include "contact/space.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace nscd {

// One after another; `rest` are Discs of those that follow. Contacts without friction have none.
template <class... Vectors>
struct Discs {};

template <class Vector>
struct Discs<Vector> {
  alignas(Vector) Vector first{};
};

template <class Vector, class... Others>
struct Discs<Vector, Others...> {
  alignas(Vector) Vector first{};
  Discs<Others...> rest{};
};

// What vectors of these parts together are.
template <class... Vectors>
struct TogetherOf {
  using type = Discs<Vectors...>;
};
template <class Vector>
struct TogetherOf<Vector> {
  using type = Vector;
};
template <class... Vectors>
using Together = typename TogetherOf<Vectors...>::type;

template <class Tangent>
constexpr std::size_t disc_count = 1;
template <class... Vectors>
constexpr std::size_t disc_count<Discs<Vectors...>> = sizeof...(Vectors);

// Calls f(number, vector of `one`, vector of each of the others) for each disc.
template <std::size_t number = 0, class F, class Tangent, class... More>
NSCD_INLINE void for_each_disc(F &&f, Tangent &&one, More &&...more)
{
  if constexpr (disc_count<std::remove_cvref_t<Tangent>> == 0) {
    return;
  } else if constexpr (requires { one.first; }) {
    f(number, one.first, more.first...);
    if constexpr (requires { one.rest; }) for_each_disc<number + 1>(f, one.rest, more.rest...);
  } else {
    f(number, one, more...);
  }
}

template <class... V>
NSCD_INLINE Discs<V...> operator+(Discs<V...> a, const Discs<V...> &b)
{
  for_each_disc([](std::size_t, auto &x, const auto &y) NSCD_INLINED { x = x + y; }, a, b);
  return a;
}

template <class... V>
NSCD_INLINE Discs<V...> operator-(Discs<V...> a, const Discs<V...> &b)
{
  for_each_disc([](std::size_t, auto &x, const auto &y) NSCD_INLINED { x = x - y; }, a, b);
  return a;
}

template <class... V>
NSCD_INLINE Discs<V...> operator*(Discs<V...> a, double factor)
{
  for_each_disc([factor](std::size_t, auto &x) NSCD_INLINED { x = x * factor; }, a);
  return a;
}

template <class... V>
NSCD_INLINE double inner(const Discs<V...> &a, const Discs<V...> &b)
{
  double sum = 0;
  for_each_disc([&sum](std::size_t, const auto &x, const auto &y) NSCD_INLINED { sum += inner(x, y); }, a, b);
  return sum;
}

template <class Tangent>
struct Split {
  double n = 0;
  Tangent t = Tangent{};
};

// What a visit needs of one disc.
struct Disc {
  double w, w_inverse;   // W_tt, 1/kg, the same in all directions, and its inverse
  double ratio;          // W_tt / W_nn
  double mu;             // infinite for stick
};

// The contact's own part of its problem: its block of W, diagonal or bounded by a diagonal, and its discs.
template <class Tangent>
struct OwnBlock {
  double w, w_inverse;   // W_nn, 1/kg, and its inverse
  std::array<Disc, disc_count<Tangent>> discs;
};

// Radius of a disc; `mu` may be infinite (stick).
NSCD_INLINE double coulomb_radius(double mu, double impulse) { return impulse > 0 ? mu * impulse : 0.0; }

}    // namespace nscd
