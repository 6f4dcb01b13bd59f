// SPDX-License-Identifier: GPL-2.0-or-later
// Work on many things of one kind, a chunk a thread.
#pragma once

#include "parallel/parts.hpp"
#include "parallel/team.hpp"

#include <cstddef>

namespace nscd {

// some(range, thread) for as many of the indices below `count` a thread.
template <class Some>
void in_chunks(Team *team, std::size_t count, Some some)
{
  if (!team) return some(Range{0, count}, 0);
  const std::size_t threads = std::size_t(team->size());
  team->run([&](int t) { some(Range{count * std::size_t(t) / threads, count * std::size_t(t + 1) / threads}, t); });
}

}    // namespace nscd
