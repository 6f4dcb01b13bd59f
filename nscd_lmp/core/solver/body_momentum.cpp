// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/body_momentum.hpp"

#include "base/hot.hpp"

namespace nscd {

// The inverse mass in a body's fourth place does not change, and stays.
NSCD_HOT void extrapolate_vectors(double share, const Range &range, Vec4 *vectors, Vec4 *last)
{
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Vec4 now = vectors[i];
    vectors[i] = now + (now - last[i]) * share;
    last[i] = now;
  }
}

}    // namespace nscd
