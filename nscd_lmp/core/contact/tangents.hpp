// SPDX-License-Identifier: GPL-2.0-or-later
// Frames at contacts, for whoever wants components: custom solvers, Delassus matrices.
#pragma once

#include "contact/mechanics.hpp"

namespace nscd {

// Unknowns per contact: 1, 2 or 3.
int unknowns(Model model);

// Two unit vectors with which the normal makes a right-handed frame. In the plane the first is (-n_y, n_x).
struct Tangents {
  alignas(vec4_alignment) Vec4 first, second;
};
Tangents tangents(const Vec4 &normal, Model model);

// A vector at a contact as numbers in a row, along N, then along the tangents of each of its discs; and back.
class Axes {
 public:
  explicit Axes(const Vec4 &normal) : normal_(normal), t_(tangents(normal, Model::spatial)) {}

  template <class Tangent>
  void read(const Split<Tangent> &v, double *to) const
  {
    *to++ = v.n;
    for_each_disc([&](std::size_t, const auto &one) { to = read_disc(one, to); }, v.t);
  }
  template <class Tangent>
  Split<Tangent> vector(const double *from) const
  {
    Split<Tangent> v{*from++, {}};
    for_each_disc([&](std::size_t, auto &one) { from = make_disc(one, from); }, v.t);
    return v;
  }

 private:
  static double *read_disc(double one, double *to) { *to++ = one; return to; }
  double *read_disc(const Vec4 &one, double *to) const
  {
    *to++ = dot(t_.first, one);
    *to++ = dot(t_.second, one);
    return to;
  }
  static const double *make_disc(double &one, const double *from) { one = *from++; return from; }
  const double *make_disc(Vec4 &one, const double *from) const
  {
    one = Spatial::from_space(normal_, t_.first * from[0] + t_.second * from[1]);
    return from + 2;
  }

  alignas(vec4_alignment) Vec4 normal_;
  Tangents t_;
};

}    // namespace nscd
