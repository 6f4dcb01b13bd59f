// SPDX-License-Identifier: GPL-2.0-or-later
// Which corners of triangles are one point.
#pragma once

#include "base/storage.hpp"
#include "obstacle/triangle.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace nscd {

struct Welded {
  AlignedVector<Vec4> vertices;
  std::vector<std::int32_t> vertex_of;   // of each triangle its three corners
};

// Corners are one point if none of their coordinates differ by more than `joined` (m) from those of the first.
Welded weld(std::span<const Triangle> triangles, double joined);

}    // namespace nscd
