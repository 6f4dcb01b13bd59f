// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/spread.hpp"

#include <algorithm>

namespace nscd {

double Bounds::farthest(const Bounds &other) const
{
  const Vec4 ahead = hi - other.lo, behind = other.hi - lo, most = ahead > behind ? ahead : behind;
  return most[0] >= 0 ? std::sqrt(dot(most, most)) : 0;   // no box is from +inf to -inf
}

void unite(Halo *halo, std::span<Bounds> boxes)
{
  if (!halo) return;
  std::vector<double> ends;
  for (const Bounds &box : boxes)
    for (int d = 0; d < 3; ++d) ends.insert(ends.end(), {box.hi[d], -box.lo[d]});
  halo->max(ends);
  const double *end = ends.data();
  for (Bounds &box : boxes)
    for (int d = 0; d < 3; ++d, end += 2) box.hi[d] = end[0], box.lo[d] = -end[1];
}

int Profile::slice_of(double place, int axis) const
{
  const double width = extent_.hi[axis] - extent_.lo[axis];
  return width > 0 ? int(std::clamp((place - extent_.lo[axis]) / width * slices, 0.0, slices - 1.0)) : 0;
}

// Beyond the outermost grains of an axis along which the scene is periodic there may be images of any.
Bounds Profile::between(double from, double to, int axis) const
{
  const bool anywhere = periodic_[axis] && (from < extent_.lo[axis] || to > extent_.hi[axis]);
  const int first = anywhere ? 0 : slice_of(from, axis), last = anywhere ? slices - 1 : slice_of(to, axis);
  Bounds box;
  for (int k = first; k <= last; ++k) box.include(boxes_[axis * slices + k]);
  return box;
}

// By the axis that tells most.
double Profile::farthest(double reach) const
{
  double least = INFINITY;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = extent_.lo[axis], width = (extent_.hi[axis] - lo) / slices;
    double most = 0;
    for (int k = 0; k < slices; ++k) {
      const Bounds near = between(lo + k * width - reach, lo + (k + 1) * width + reach, axis);
      most = std::max(most, boxes_[axis * slices + k].farthest(near));
    }
    least = std::min(least, most);
  }
  return least;
}

// In the slices of every axis at once.
Bounds Profile::around(const Vec4 &centre, double reach) const
{
  Bounds found{-Bounds{}.lo, -Bounds{}.hi};
  for (int axis = 0; axis < 3; ++axis)
    found = found.common(between(centre[axis] - reach, centre[axis] + reach, axis));
  return found;
}

}    // namespace nscd
