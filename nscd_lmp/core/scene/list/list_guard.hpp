// SPDX-License-Identifier: GPL-2.0-or-later
// What must hold of the neighbor list, so that no contact is missed and none is counted twice.
#pragma once

#include "scene/state.hpp"

#include <utility>
#include <vector>

namespace nscd {

class ListGuard {
 public:
  // The list may have been rebuilt since the last step although it does not say so.
  void expect_new_list() { unknown_ = true; }
  // Before each step: if the list is new, remembers where atoms were and finds the owners of images (atoms.owner).
  // Raises Error for a list that holds pairs twice, or an image without a grain.
  void inspect(State &state, const PairList &pairs);
  // How far a grain of this rank has moved since the list was built, m, at most.
  double farthest_moved(const State &state) const;
  // Whether the list of this step is new.
  bool is_new() const { return new_; }
  // Where an atom was when it was built, m.
  Vec4 listed_at(int atom) const
  {
    const double *x = listed_x_.data() + 3 * std::size_t(atom);
    return Vec4{x[0], x[1], x[2], 0};
  }

 private:
  void find_owners(State &state);

  std::vector<double> listed_x_;   // (owned + ghosts, 3) positions at which the list was built
  bool unknown_ = true, new_ = false;
};

// The cheap judgement: no grain has gone, or will go, so far that it matters. Lengths in m, largest or least of all.
struct Reach {
  double listed = 0;   // surface distance up to which the list has all pairs
  double moved = 0;    // by a grain since the list was built
  double ahead = 0;    // by a grain in the step to come

  bool is_enough() const { return 2 * (moved + ahead) <= listed * (1 + 1e-12); }
};

}    // namespace nscd
