// SPDX-License-Identifier: GPL-2.0-or-later
// Points in space sorted into cells, to find those near a place. Cells are hashed, so points may lie at any distance.
#pragma once

#include "base/storage.hpp"
#include "contact/contact.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace nscd {

class CellGrid {
 public:
  // `edge` of a cell, m. Points are known by their place in `points`; the fourth component is the caller's.
  void fill(std::span<const Vec4> points, double edge);

  // visit(k, point) for every point within `reach` of the centre, along each axis, and for some others.
  template <class Visit>
  void near(const Vec4 &centre, double reach, Visit visit) const
  {
    const Cell lo = cell_of(centre - reach), hi = cell_of(centre + reach);
    double cells = 1;
    for (int d = 0; d < 3; ++d) cells *= double(hi.at[d] - lo.at[d] + 1);
    if (cells >= double(entries_.size())) {
      for (const Entry &e : entries_) visit(e.index, e.point);
      return;
    }
    for (std::int64_t z = lo.at[2]; z <= hi.at[2]; ++z)
      for (std::int64_t y = lo.at[1]; y <= hi.at[1]; ++y)
        for (std::int64_t x = lo.at[0]; x <= hi.at[0]; ++x) visit_cell(key_of({{x, y, z}}), visit);
  }

 private:
  struct Cell {
    std::int64_t at[3];
  };
  struct alignas(64) Entry {
    alignas(vec4_alignment) Vec4 point;
    std::uint64_t key;
    int index;
  };
  // Points farther out share the outermost cells.
  static constexpr std::int64_t outermost = (1 << 20) - 1;

  Cell cell_of(const Vec4 &point) const;
  static std::uint64_t key_of(const Cell &cell);
  std::size_t bucket_of(std::uint64_t key) const { return (key * 0x9E3779B97F4A7C15u) >> shift_; }

  template <class Visit>
  void visit_cell(std::uint64_t key, Visit &visit) const
  {
    const std::size_t bucket = bucket_of(key);
    for (std::uint32_t e = first_[bucket]; e < first_[bucket + 1]; ++e)
      if (entries_[e].key == key) visit(entries_[e].index, entries_[e].point);
  }

  double per_edge_ = 1;
  int shift_ = 63;                      // so that buckets_ are numbered by the top bits of the hash
  std::vector<std::uint64_t> key_;      // (points)
  std::vector<std::uint32_t> first_;    // (buckets + 1) in entries_
  AlignedVector<Entry> entries_;        // (points) by bucket
};

}    // namespace nscd
