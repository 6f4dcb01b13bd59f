// SPDX-License-Identifier: GPL-2.0-or-later
#include "parallel/parts.hpp"

#include <algorithm>

namespace nscd {

int Parts::between(int a, int b) const
{
  const int low = std::min(a, b), high = std::max(a, b);
  if (low == high) return low;
  if (high == low + 1) return threads_ + low;
  // Round a periodic box: the last slab and the first. With an odd number of slabs that is no phase's.
  if (low == 0 && high == threads_ - 1 && threads_ % 2 == 0) return threads_ + high;
  return 2 * threads_;
}

int Parts::of(int phase, int thread) const
{
  switch (phase) {
    case 0: return thread;
    case 1: return thread % 2 == 0 ? threads_ + thread : -1;
    case 2: return thread % 2 == 1 ? threads_ + thread : -1;
    default: return thread == 0 ? 2 * threads_ : -1;
  }
}

int Parts::busy(int phase) const
{
  for (int t = threads_; t > 0; --t)
    if (const int part = of(phase, t - 1); part >= 0 && range(part).size() > 0) return t;
  return 0;
}

void Parts::set_sizes(const std::vector<std::size_t> &sizes)
{
  for (int p = 0; p < count(); ++p) first_[p + 1] = first_[p] + sizes[p];
}

}    // namespace nscd
