// SPDX-License-Identifier: GPL-2.0-or-later
// Says of most points that are far from a surface that they are: a grid of the box round it, whose cells know how near
// any of their points can be. What that costs does not depend on the triangles or the grain.
#pragma once

#include "obstacle/triangle_tree.hpp"

#include <span>
#include <vector>

namespace nscd {

class DistanceGrid {
 public:
  // Of the triangles that the tree has put in order.
  DistanceGrid(std::span<const Triangle> triangles, const TriangleTree &tree);

  const BoxAround &bounds() const { return bounds_; }
  // Whether no point of the surface is as near as `reach` (m); false does not say that one is.
  bool is_beyond(const Vec4 &point, double reach) const
  {
    const double outside2 = bounds_.distance2(point), reach2 = reach * reach;
    if (outside2 > reach2) return true;
    // Of a point outside the box every point in it is farther than from the nearest point of the box.
    const double bound = bound_[cell_of(point)];
    return outside2 + bound * bound > reach2;
  }

 private:
  std::size_t cell_of(const Vec4 &point) const
  {
    std::size_t cell = 0;
    for (int d = 2; d >= 0; --d) {
      const double place = (point[d] - bounds_.low[d]) * per_metre_[d];
      cell = cell * std::size_t(count_[d]) + std::size_t(place > 0 ? std::min(place, count_[d] - 1.0) : 0.0);
    }
    return cell;
  }
  void choose_cells(double most);

  BoxAround bounds_;
  int count_[3];
  double edge_[3], per_metre_[3];
  std::vector<float> bound_;   // m
};

}    // namespace nscd
