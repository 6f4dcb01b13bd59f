// SPDX-License-Identifier: GPL-2.0-or-later
// Whether grains are still where the last step left them: what else moves them integrates them a second time.
#pragma once

#include "scene/state.hpp"

#include <cstdint>
#include <vector>

namespace nscd {

class LeftPlaces {
 public:
  // Grains may be elsewhere at the next step, for a good reason.
  void forget() { tags_.clear(); }
  // At the end of a step.
  void remember(const State &state);
  // At the start of the next one, while the state still holds the last one's places. Raises Error for a grain that is
  // elsewhere. A new list has wrapped grains round the box and put them in another order: of two new lists in a row the
  // second is looked at.
  void require(const State &state, bool list_is_new);

 private:
  double moved(const State &state, std::size_t before, int now) const;

  std::vector<std::int32_t> tags_;   // of the last step's owned atoms; empty if forgotten
  bool was_new_ = false;
};

}    // namespace nscd
