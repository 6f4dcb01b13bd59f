// SPDX-License-Identifier: GPL-2.0-or-later
// What a step needs of the neighbor list: ahead of the solve, after it, and for the step to come.
#pragma once

#include "scene/drift/drift.hpp"
#include "scene/list/list_guard.hpp"
#include "scene/list/missed_pairs.hpp"
#include "scene/state.hpp"

#include <set>
#include <utility>

namespace nscd {

class ListWatch {
 public:
  // Contacts are sought at q_k + `prediction` dt v_k, and `look_ahead` dt |v| (0 or 1) around. What is handed in must
  // outlive it.
  ListWatch(State &state, const ListGuard &list, const Drifts &drifts, double prediction, double look_ahead) :
      state_(state), list_(list), drifts_(drifts), prediction_(prediction), look_ahead_(look_ahead), missed_(list)
  {
  }

  // Ahead of the search for contacts: pairs that the list lacks, and that meet unless contacts change something, go to
  // search.unlisted. Returns the cutoff with which the list would have had them, m, or 0 if it has all. `listed` and
  // `moved` as Reach has them; `speed` of the fastest grain, m/s. Raises Error for a list that lacks pairs that touch,
  // and where there may be pairs that cannot be known. Collective.
  double complete(const PairList &pairs, double listed, double moved, double speed);

  // After a solve: pairs that its impulses drive together from farther apart than the list has them are watched too.
  // Raises Error where they cannot be. Collective.
  void watch_unlisted();

  // After a step: true if the next one needs a fresh list to be sure of every contact. Collective.
  bool wants_rebuild();

 private:
  // How far around q_k contacts are sought, m, for a grain of this speed.
  double longest_move(double speed) const { return state_.in.dt * speed * (look_ahead_ + prediction_); }
  [[noreturn]] void refuse_missed(double cutoff) const;
  void refuse_unless_all_known() const;
  void refuse_drifting(double ahead) const;
  double refuse_unwatchable();
  bool is_first(const Candidate &pair);

  State &state_;
  const ListGuard &list_;
  const Drifts &drifts_;
  const double prediction_, look_ahead_;
  MissedPairs missed_;
  std::set<std::pair<int, int>> unlisted_;   // pairs that were found beyond the list in this step
  double listed_ = 0, moved_ = 0;            // as Reach has them
};

}    // namespace nscd
