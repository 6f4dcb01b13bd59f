// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of one contact as numbers in a row: along N, then along the axes of its discs, for problems posed by a
// Delassus matrix. Frame<> has the normal alone, Frame<1> a tangent in the plane, Frame<2> two in space.
#pragma once

#include "base/error.hpp"
#include "contact/carried_velocity.hpp"
#include "contact/discs.hpp"

namespace nscd {

template <int axes>
struct AlongAxes {
  using Vector = Vec4;  // the axes' numbers first, then 0
};
template <>
struct AlongAxes<1> {
  using Vector = double;
};

template <int... axes>
struct Frame {
  using Tangent = Together<typename AlongAxes<axes>::Vector...>;
  using Vector = Split<Tangent>;
  static constexpr int dim = (1 + ... + axes);
  static constexpr std::size_t discs = sizeof...(axes);
  static constexpr std::array<int, discs + 1> groups{1, axes...};   // of rows that no direction tells apart
  static constexpr std::size_t carried = carried_doubles<Tangent>;

  NSCD_INLINE static Vector load(const double *at)
  {
    Vector v{at[0], {}};
    walk(at + 1, v.t, [](const double *from, double &x) NSCD_INLINED { x = *from; });
    return v;
  }
  NSCD_INLINE static void store(double *at, Vector v)
  {
    at[0] = v.n;
    walk(at + 1, v.t, [](double *to, double &x) NSCD_INLINED { *to = x; });
  }

 private:
  template <class Pointer, class F>
  NSCD_INLINE static void walk(Pointer at, Tangent &t, F f)
  {
    if constexpr (discs > 0)
      for_each_disc([&](std::size_t d, auto &vector) NSCD_INLINED {
        if constexpr (requires { vector[0]; }) {
          for (int i = 0; i < groups[d + 1]; ++i) {
            double x = vector[i];
            f(at++, x);
            vector[i] = x;
          }
        } else {
          f(at++, vector);
        }
      }, t);
  }
};

// Calls f with the frame of contacts that have so many unknowns: of a scene's, which slide and do nothing else. Raises
// Error for others.
template <class Function>
void with_frame(int dim, Function f)
{
  switch (dim) {
    case 1: return f(Frame<>{});
    case 2: return f(Frame<1>{});
    case 3: return f(Frame<2>{});
    default: fail("contacts that slide have 1, 2 or 3 unknowns, not ", dim);
  }
}

}    // namespace nscd
