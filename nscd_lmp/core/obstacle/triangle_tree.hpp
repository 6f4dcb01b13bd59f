// SPDX-License-Identifier: GPL-2.0-or-later
// Finds the triangles near a point: a tree of boxes, each round those of its four children, down to single triangles.
// A tree and not a grid, since then neither one large triangle among small ones nor grains larger than the triangles
// cost more than a few boxes, and the memory is bounded by the number of triangles.
#pragma once

#include "base/storage.hpp"
#include "obstacle/triangle.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace nscd {

struct BoxAround {
  double low[3], high[3];   // m

  void include(const BoxAround &other)
  {
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], other.low[d]);
      high[d] = std::max(high[d], other.high[d]);
    }
  }
  // The square of the distance of a point, m^2.
  double distance2(const Vec4 &point) const
  {
    double sum = 0;
    for (int d = 0; d < 3; ++d) {
      const double out = std::max(std::max(low[d] - point[d], point[d] - high[d]), 0.0);
      sum += out * out;
    }
    return sum;
  }
};

BoxAround box_around(std::span<const Triangle> triangles);

class TriangleTree {
 public:
  // Puts the triangles, of which there is one at least, into the order of the leaves.
  explicit TriangleTree(AlignedVector<Triangle> &triangles);

  // Calls f(k) for all triangles that are no farther from the point than `reach` (m), and for others. `f` may make
  // reach smaller.
  template <class F>
  void visit(const Vec4 &point, const double &reach, F f) const
  {
    const Vec4 place = point - middle_;
    const Four x = broadcast(float(place[0])), y = broadcast(float(place[1])), z = broadcast(float(place[2]));
    std::int32_t left[3 * deepest];   // nodes
    int count = 0;
    left[count++] = 0;
    while (count > 0) {
      const Node &node = nodes_[std::size_t(left[--count])];
      const Four dx = outside(node, 0, x), dy = outside(node, 1, y), dz = outside(node, 2, z);
      const float within = float(reach) + round_off_;
      const Which near = dx * dx + dy * dy + dz * dz <= broadcast(within * within);
      for (int k = 0; k < 4; ++k) {
        if (!near[k]) continue;
        if (node.child[k] > 0) left[count++] = node.child[k];
        else if (node.child[k] < 0) f(-1 - node.child[k]);
      }
    }
  }

 private:
  using Four = float __attribute__((vector_size(16)));
  using Which = std::int32_t __attribute__((vector_size(16)));
  // Floats, which are rounded outwards by what `round_off_` adds to each reach.
  struct alignas(64) Node {
    Four low[3], high[3];    // of its children, from the middle, m
    std::int32_t child[4];   // > 0: a node, < 0: the triangle -1 - child, 0: none
  };
  static constexpr int deepest = 20;   // 4^16 triangles are more than an int counts

  static Four broadcast(float a) { return Four{a, a, a, a}; }
  static Four outside(const Node &node, int d, const Four &at)
  {
    const Four below = node.low[d] - at, above = at - node.high[d];
    const Four most = below > above ? below : above;
    return most > 0.0f ? most : broadcast(0);
  }
  std::int32_t divide(std::span<const Triangle> triangles, std::span<std::int32_t> order, std::int32_t first);

  AlignedVector<Node> nodes_;
  alignas(vec4_alignment) Vec4 middle_;
  float round_off_;
};

}    // namespace nscd
