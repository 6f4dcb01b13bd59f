// SPDX-License-Identifier: GPL-2.0-or-later
// How much displacements of grains differ: two of them come nearer to each other by no more than that.
#pragma once

#include "scene/state.hpp"

#include <cmath>
#include <vector>

namespace nscd {

// The smallest box that some displacements lie in, m.
struct Bounds {
  alignas(vec4_alignment) Vec4 lo{INFINITY, INFINITY, INFINITY, 0};
  alignas(vec4_alignment) Vec4 hi{-INFINITY, -INFINITY, -INFINITY, 0};

  void include(const Vec4 &d)
  {
    lo = d < lo ? d : lo;
    hi = d > hi ? d : hi;
  }
  void include(const Bounds &other)
  {
    lo = other.lo < lo ? other.lo : lo;
    hi = other.hi > hi ? other.hi : hi;
  }
  // Of what is in both; what may be in this box less what may be in the other; as far around.
  Bounds common(const Bounds &other) const
  {
    return {other.lo > lo ? other.lo : lo, other.hi < hi ? other.hi : hi};
  }
  Bounds less(const Bounds &other) const { return {lo - other.hi, hi - other.lo}; }
  Bounds wider(double by) const { return {lo - Vec4{by, by, by, 0}, hi + Vec4{by, by, by, 0}}; }
  // Between one of this box and one of the other, at most; 0 if there is none in one of them.
  double farthest(const Bounds &other) const;
};

// Of all ranks' boxes, the box of all. Collective.
void unite(Halo *halo, std::span<Bounds> boxes);

// Along each axis, the box of the displacements of all grains that are in the same slice. For orthogonal boxes.
class Profile {
 public:
  // Collective. `place(i)`: of the owned atoms; `box(i)`: of its displacements; `periodic`: along an axis.
  template <class Place, class BoxOf>
  void gather(Halo *halo, int owned, const bool (&periodic)[3], Place place, BoxOf box);

  // Between two grains that are `reach` apart, at most.
  double farthest(double reach) const;

  // Of grains within `reach` of the centre, those of other ranks and images included.
  Bounds around(const Vec4 &centre, double reach) const;

 private:
  static constexpr int slices = 64;
  int slice_of(double place, int axis) const;
  Bounds between(double from, double to, int axis) const;

  Bounds extent_;
  bool periodic_[3] = {};
  std::vector<Bounds> boxes_;    // (3 axes, slices)
};

template <class Place, class BoxOf>
void Profile::gather(Halo *halo, int owned, const bool (&periodic)[3], Place place, BoxOf box)
{
  for (int axis = 0; axis < 3; ++axis) periodic_[axis] = periodic[axis];
  extent_ = {};
  for (int i = 0; i < owned; ++i) extent_.include(place(i));
  unite(halo, {&extent_, 1});
  boxes_.assign(3 * slices, {});
  for (int i = 0; i < owned; ++i) {
    const Vec4 at = place(i);
    const Bounds of = box(i);
    for (int axis = 0; axis < 3; ++axis) boxes_[axis * slices + slice_of(at[axis], axis)].include(of);
  }
  unite(halo, boxes_);
}

}    // namespace nscd
