// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/triangle_tree.hpp"

#include <numeric>

namespace nscd {

namespace {

constexpr double float_round_off = 1e-6;   // of the size: that of coordinates from the middle, squares and their sum

BoxAround box_around_one(const Triangle &triangle)
{
  BoxAround bounds;
  for (int d = 0; d < 3; ++d) {
    const auto [low, high] = std::minmax({triangle.corner[0][d], triangle.corner[1][d], triangle.corner[2][d]});
    bounds.low[d] = low;
    bounds.high[d] = high;
  }
  return bounds;
}

// Three times the middle.
double middle(const Triangle &triangle, int d)
{
  return triangle.corner[0][d] + triangle.corner[1][d] + triangle.corner[2][d];
}

// The direction in which the middles are spread most.
int longest_direction(std::span<const Triangle> triangles, std::span<const std::int32_t> order)
{
  int longest = 0;
  double most = -1;
  for (int d = 0; d < 3; ++d) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const std::int32_t k : order) {
      const double at = middle(triangles[std::size_t(k)], d);
      low = std::min(low, at);
      high = std::max(high, at);
    }
    if (high - low > most) longest = d;
    most = std::max(most, high - low);
  }
  return longest;
}

}    // namespace

BoxAround box_around(std::span<const Triangle> triangles)
{
  BoxAround bounds = box_around_one(triangles.front());
  for (const Triangle &triangle : triangles) bounds.include(box_around_one(triangle));
  return bounds;
}

TriangleTree::TriangleTree(AlignedVector<Triangle> &triangles)
{
  const BoxAround all = box_around(triangles);
  double longest = 0;
  middle_ = Vec4{};
  for (int d = 0; d < 3; ++d) {
    middle_[d] = 0.5 * (all.low[d] + all.high[d]);
    longest = std::max(longest, all.high[d] - all.low[d]);
  }
  round_off_ = float(float_round_off * longest);
  std::vector<std::int32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(triangles.size() / 2 + 1);
  divide(triangles, order, 0);
  AlignedVector<Triangle> ordered;
  ordered.reserve(triangles.size());
  for (const std::int32_t k : order) ordered.push_back(triangles[std::size_t(k)]);
  triangles.swap(ordered);
}

// At the middle of the numbers, so that the depth is that of a balanced tree whatever the triangles are. Returns the
// node of these triangles, the first of which comes to have the number `first`.
std::int32_t TriangleTree::divide(std::span<const Triangle> triangles, std::span<std::int32_t> order,
                                  std::int32_t first)
{
  const auto halve = [&](std::span<std::int32_t> part) {
    const std::size_t half = (part.size() + 1) / 2;
    const int d = longest_direction(triangles, part);
    if (part.size() > 1)
      std::nth_element(part.begin(), part.begin() + std::ptrdiff_t(half), part.end(), [&](auto a, auto b) {
        const double of_a = middle(triangles[std::size_t(a)], d), of_b = middle(triangles[std::size_t(b)], d);
        return of_a < of_b || (of_a == of_b && a < b);
      });
    return half;
  };
  const std::size_t half = halve(order);
  const std::span<std::int32_t> low = order.first(half), high = order.subspan(half);
  const std::size_t of_low = halve(low), of_high = halve(high);
  const std::span<std::int32_t> parts[4] = {low.first(of_low), low.subspan(of_low), high.first(of_high),
                                            high.subspan(of_high)};
  const std::size_t own = nodes_.size();
  nodes_.push_back({});
  for (int k = 0; k < 4; ++k) {
    if (parts[k].empty()) continue;
    BoxAround box = box_around_one(triangles[std::size_t(parts[k][0])]);
    for (const std::int32_t triangle : parts[k]) box.include(box_around_one(triangles[std::size_t(triangle)]));
    for (int d = 0; d < 3; ++d) {
      nodes_[own].low[d][k] = float(box.low[d] - middle_[d]);
      nodes_[own].high[d][k] = float(box.high[d] - middle_[d]);
    }
    const std::int32_t child = parts[k].size() == 1 ? -1 - first : divide(triangles, parts[k], first);
    nodes_[own].child[k] = child;
    first += std::int32_t(parts[k].size());
  }
  return std::int32_t(own);
}

}    // namespace nscd
