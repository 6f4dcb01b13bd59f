// What must hold of the neighbor list, so that no contact is missed and none is counted twice.
#pragma once

#include "state.hpp"

#include <utility>
#include <vector>

namespace nscd {

class ListGuard {
 public:
  // The list may have been rebuilt since the last step although it does not say so.
  void expect_new_list() { unknown_ = true; }
  // Before each step: if the list is new, remembers where grains were and finds the owners of images (state.owner).
  // Raises Error for a list that holds pairs twice, or an image without a grain.
  void inspect(State &state, const PairList &pairs);
  // Raises Error if grains that move by `ahead` (m) in this step could meet without being listed.
  void require_reach(const State &state, const PairList &pairs, double ahead, double speed) const;
  // Whether a next step in which grains move by `ahead` needs a new list; state.grains.x has the new positions.
  bool too_old(const State &state, const PairList &pairs, double ahead) const;

 private:
  double farthest_moved(const State &state) const;
  void find_owners(State &state);

  std::vector<double> listed_x_;   // (owned, 3) positions at which the list was built
  std::vector<std::pair<std::int32_t, int>> by_tag_;
  bool unknown_ = true;
};

}    // namespace nscd
