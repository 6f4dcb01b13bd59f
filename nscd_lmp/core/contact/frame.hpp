// SPDX-License-Identifier: GPL-2.0-or-later
// Vectors of one contact along N, T1[, T2], as local laws take them, for problems posed by a Delassus matrix.
#pragma once

#include "contact/carried_velocity.hpp"
#include "contact/friction.hpp"

namespace nscd {

template <int unknowns>
struct Frame;

template <>
struct Frame<1> {
  using Tangent = double;  // always 0
  static constexpr int dim = 1;
  static constexpr std::size_t carried = carried_doubles<double>;
  NSCD_INLINE static Split<double> load(const double *at) { return {at[0], 0}; }
  NSCD_INLINE static void store(double *at, const Split<double> &v) { at[0] = v.n; }
};

template <>
struct Frame<2> {
  using Tangent = double;
  static constexpr int dim = 2;
  static constexpr std::size_t carried = carried_doubles<double>;
  NSCD_INLINE static Split<double> load(const double *at) { return {at[0], at[1]}; }
  NSCD_INLINE static void store(double *at, const Split<double> &v)
  {
    at[0] = v.n;
    at[1] = v.t;
  }
};

template <>
struct Frame<3> {
  using Tangent = Vec4;  // {T1, T2, 0, 0}
  static constexpr int dim = 3;
  static constexpr std::size_t carried = carried_doubles<Vec4>;
  NSCD_INLINE static Split<Vec4> load(const double *at) { return {at[0], Vec4{at[1], at[2], 0, 0}}; }
  NSCD_INLINE static void store(double *at, const Split<Vec4> &v)
  {
    at[0] = v.n;
    at[1] = v.t[0];
    at[2] = v.t[1];
  }
};

// Calls f(Frame<dim>{}).
template <class Function>
void with_frame(int dim, Function f)
{
  if (dim == 1) f(Frame<1>{});
  if (dim == 2) f(Frame<2>{});
  if (dim == 3) f(Frame<3>{});
}

}    // namespace nscd
