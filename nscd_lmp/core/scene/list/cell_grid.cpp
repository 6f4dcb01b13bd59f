// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/cell_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nscd {

CellGrid::Cell CellGrid::cell_of(const Vec4 &point) const
{
  Cell cell;
  for (int d = 0; d < 3; ++d)
    cell.at[d] = std::int64_t(std::floor(std::clamp(point[d] * per_edge_, -double(outermost), double(outermost))));
  return cell;
}

std::uint64_t CellGrid::key_of(const Cell &cell)
{
  std::uint64_t key = 0;
  for (const std::int64_t at : cell.at) key = key << 21 | std::uint64_t(at + outermost);
  return key;
}

// By counting: the points of a bucket in their order.
void CellGrid::fill(std::span<const Vec4> points, double edge)
{
  const std::size_t n = points.size();
  const int bits = std::max(1, int(std::bit_width(n)));
  per_edge_ = 1 / edge;
  shift_ = 64 - bits;
  key_.resize(n);
  entries_.resize(n);
  first_.assign((std::size_t(1) << bits) + 1, 0);
  for (std::size_t k = 0; k < n; ++k) {
    key_[k] = key_of(cell_of(points[k]));
    ++first_[bucket_of(key_[k])];
  }
  std::uint32_t end = 0;
  for (std::uint32_t &first : first_) first = end += first;
  for (std::size_t k = n; k-- > 0;) entries_[--first_[bucket_of(key_[k])]] = {points[k], key_[k], int(k)};
}

}    // namespace nscd
