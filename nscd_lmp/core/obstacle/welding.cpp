// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/welding.hpp"

#include <array>
#include <cmath>
#include <unordered_map>

namespace nscd {

namespace {

using Cell = std::array<std::int64_t, 3>;

struct Hash {
  std::size_t operator()(const Cell &cell) const
  {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) hash = (hash ^ std::uint64_t(c)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
    return std::size_t(hash);
  }
};

// Vertices by cells that are much larger than what is joined, so that most look into one cell.
class Cells {
 public:
  Cells(const Vec4 &low, double joined) : low_(low), joined_(joined) {}

  // The number of the vertex that this point is.
  std::int32_t find_or_add(const Vec4 &point, AlignedVector<Vec4> &vertices)
  {
    Cell seen{-1, -1, -1};
    for (int corner = 0; corner < 8; ++corner) {
      const Vec4 sign{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0, 0};
      const Cell cell = cell_of(point + sign * joined_);
      if (cell == seen) continue;
      seen = cell;
      for (auto [at, last] = of_.equal_range(cell); at != last; ++at) {
        const Vec4 apart = magnitudes(vertices[std::size_t(at->second)] - point);
        if (std::max({apart[0], apart[1], apart[2]}) <= joined_) return at->second;
      }
    }
    of_.emplace(cell_of(point), std::int32_t(vertices.size()));
    vertices.push_back(point);
    return std::int32_t(vertices.size()) - 1;
  }

 private:
  Cell cell_of(const Vec4 &point) const
  {
    Cell cell;
    for (int d = 0; d < 3; ++d) cell[std::size_t(d)] = std::int64_t(std::floor((point[d] - low_[d]) / (32 * joined_)));
    return cell;
  }

  alignas(vec4_alignment) Vec4 low_;
  double joined_;
  std::unordered_multimap<Cell, std::int32_t, Hash> of_;
};

}    // namespace

Welded weld(std::span<const Triangle> triangles, double joined)
{
  Welded welded;
  Vec4 low = triangles.front().corner[0];
  for (const Triangle &triangle : triangles)
    for (const Vec4 &corner : triangle.corner)
      for (int d = 0; d < 3; ++d) low[d] = std::min(low[d], corner[d]);
  Cells cells(low, joined);
  welded.vertex_of.reserve(3 * triangles.size());
  for (const Triangle &triangle : triangles)
    for (const Vec4 &corner : triangle.corner)
      welded.vertex_of.push_back(cells.find_or_add(corner, welded.vertices));
  return welded;
}

}    // namespace nscd
