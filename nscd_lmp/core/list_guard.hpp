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
  // How far a grain of this rank has moved since the list was built, m, at most.
  double farthest_moved(const State &state) const;
  // Whether the list of this step is new.
  bool is_new() const { return new_; }

 private:
  void find_owners(State &state);

  std::vector<double> listed_x_;   // (owned, 3) positions at which the list was built
  bool unknown_ = true, new_ = false;
};

// Lengths, m, largest or least of all ranks.
struct Reach {
  double listed;   // surface distance up to which the list has all pairs
  double moved;    // by a grain since the list was built
  double ahead;    // by a grain in the step to come

  bool is_enough() const { return 2 * (moved + ahead) <= listed * (1 + 1e-12); }
};

// Raises Error if grains could meet without being listed; `speed` of the fastest, m/s.
void require_reach(const Reach &reach, double speed);

}    // namespace nscd
