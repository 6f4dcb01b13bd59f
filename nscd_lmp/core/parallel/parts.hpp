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
#include <cstdint>
#include <vector>

namespace nscd {

struct State;

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

// The slab of each body, and the parts of the contacts. One slab: nothing of it is used.
class Slabs {
 public:
  explicit Slabs(int threads) : parts_(threads), threads_(threads) {}

  int count() const { return threads_; }
  int of(int body) const { return slab_.empty() ? 0 : slab_[body]; }
  const Parts &parts() const { return parts_; }

  // With a new list bodies are others.
  void forget() { slab_.clear(); }
  // After pairs have been found: places bodies in slabs, unless that is done already for this list.
  void divide(const State &s);
  // Puts contacts-to-be in the order of parts, within each as they were.
  void order_candidates(State &s);
  // Puts the first `count` contacts in the order of parts. Returns whether any has changed its place.
  bool order_contacts(State &s, std::size_t count);

 private:
  template <class PartOf>
  void count_parts(std::size_t count, PartOf part_of);
  int part_of_contact(const State &s, std::size_t k) const;

  Parts parts_;
  int threads_;
  std::vector<std::uint8_t> slab_;          // (bodies that are grains)
  std::vector<double> places_;              // scratch: along the axis
  std::vector<std::size_t> sizes_, next_;   // scratch: (parts)
};

}    // namespace nscd
