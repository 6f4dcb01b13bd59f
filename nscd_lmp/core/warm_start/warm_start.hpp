// SPDX-License-Identifier: GPL-2.0-or-later
// Start impulses of a step: those of the last one, where the contact was there, turned with its normal.
#pragma once

#include "scene/state.hpp"
#include "warm_start/impulse_memory.hpp"

#include <functional>
#include <span>

namespace nscd {

class WarmStart {
 public:
  // Keeps the impulses of all contacts.
  void remember(const State &state);
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
  void recall_normal(State &state, std::size_t first) const;

  // One of them is used, the others stay empty.
  ImpulseMemory<NormalImpulse> normal_;
  ImpulseMemory<PlanarImpulse> planar_;
  ImpulseMemory<SpatialImpulse> spatial_;
};

// The rotation that takes the unit vector `from` to `to` the shortest way, applied to p perpendicular to `from`.
NSCD_INLINE Vec4 turn_along(const Vec4 &p, const Vec4 &from, const Vec4 &to)
{
  const double cosine = dot(from, to);
  if (cosine <= -1) return p;  // opposite: every half turn is as short
  const Vec4 turned = p - (from + to) * (dot(p, to) / (1 + cosine));
  return turned - to * dot(turned, to);
}

}    // namespace nscd
