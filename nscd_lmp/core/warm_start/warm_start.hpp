// SPDX-License-Identifier: GPL-2.0-or-later
// Start impulses of a step: those of the last one, where the contact was there, turned with its normal.
#pragma once

#include "scene/state.hpp"
#include "warm_start/remembered.hpp"

#include <functional>
#include <span>
#include <tuple>

namespace nscd {

class WarmStart {
 public:
  // Keeps the impulses of all contacts.
  void remember(State &state);
  // Gives the contacts from `first` on their start impulses, and the bodies what those do.
  void recall(State &state, std::size_t first) const;
  // Everything that is remembered, contact by contact: the tags of its grains, the lower one 0 for a wall, and `words`
  // numbers to be kept bit by bit; `add` takes them again.
  using Visit = std::function<void(std::int32_t low, std::int32_t high, std::span<const double> words)>;
  static std::size_t words(Model model);
  void for_each(Model model, const Visit &visit) const;
  void add(Model model, std::span<const double> words);
  // After a new plan: every impulse to the ranks that have the contact's grains now. Collective.
  void follow_grains(Halo &halo, Model model);

 private:
  template <class M>
  using Memory = ImpulseMemory<Entry<M>>;

  // One of them is used, the others stay empty.
  std::tuple<Memory<Frictionless>, Memory<Frictional<Planar>>, Memory<Frictional<Spatial>>> memories_;
};

}    // namespace nscd
