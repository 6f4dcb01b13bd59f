// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts in an order in which threads can sweep them.
//
// The scene is cut into slabs across its longest side, one a thread, and a body belongs to one of them. Contacts are
// put in order by part:
//
//   0 .. T-1       within slab t               swept first, each by its thread
//   T .. 2T-1      between slabs t and t + 1   then those of even t at the same time, then those of odd t
//   2T             all others                  last, by one thread
//
// Parts that are swept at the same time share no body, so a sweep is one of Gauss-Seidel in this order, and does the
// same to the last bit however the threads are scheduled. Walls are bodies of each slab's own.
#pragma once

#include <cstddef>
#include <vector>

namespace nscd {

struct Range {
  std::size_t first, last;
  std::size_t size() const { return last - first; }
};

// Which contacts are in which part.
class Parts {
 public:
  static constexpr int phases = 4;

  explicit Parts(int threads) : threads_(threads), first_(count() + 1) {}

  int count() const { return 2 * threads_ + 1; }
  Range range(int part) const { return {first_[part], first_[part + 1]}; }
  // Of the contacts between two slabs, either of which may be the first.
  int between(int a, int b) const;
  // What a thread sweeps in a phase; -1 for nothing.
  int of(int phase, int thread) const;
  // Threads that have something to sweep in it: the first `busy`.
  int busy(int phase) const;

  // From how many contacts each part has.
  void set_sizes(const std::vector<std::size_t> &sizes);

 private:
  int threads_;
  std::vector<std::size_t> first_;   // (parts + 1)
};

}    // namespace nscd
