// SPDX-License-Identifier: GPL-2.0-or-later
// Which slab of the scene each body is in, and contacts in the order of parts that threads sweep (parallel/parts.hpp).
#pragma once

#include "parallel/parts.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nscd {

struct State;

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
