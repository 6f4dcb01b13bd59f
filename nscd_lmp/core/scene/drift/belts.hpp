// SPDX-License-Identifier: GPL-2.0-or-later
// How obstacles that have a velocity move in a step: by what they have moved since they were seen last, which need not
// be the velocity that their atoms show (of the end of the step, of half a step, or of a belt, which does not move at
// all). Where grains move by the mean of their velocities, as under law moreau, the velocity at the end of the step is
// the right one: then the obstacle too moves by the mean.
#pragma once

#include "scene/state.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace nscd {

class Belts {
 public:
  // Remembers where obstacles are: at a run's start, and at the end of every step.
  void see(const Grains &grains);
  // Fills motion.ways and, if `paces`, motion.paces of this rank's atoms. Obstacles that were not seen, since they came
  // from elsewhere, are taken to have moved by their velocity. Both are empty if no obstacle has a velocity.
  void find(State &state, bool paces) const;

 private:
  struct Seen {
    std::int32_t tag;
    std::array<double, 3> x;
  };
  const Seen *last_seen(std::int32_t tag) const;

  std::vector<Seen> seen_;   // sorted by tag; those with a velocity
};

}    // namespace nscd
