// SPDX-License-Identifier: GPL-2.0-or-later
// The bodies of some contacts alone, while these are solved. A round of impacts is often of few contacts, and what a
// solve keeps of bodies, to go back to them or to sum over them, it then keeps of few.
#pragma once

#include "scene/state.hpp"

#include <vector>

namespace nscd {

class FewBodies {
 public:
  // Calls solve() with the state's bodies, spins and the indices of the first `count` contacts being those of their
  // bodies. Of one rank.
  template <class Solve>
  void with(State &s, std::size_t count, Solve solve)
  {
    take(s, count);
    struct GivenBack {   // also if the solve raises an error
      FewBodies &few;
      State &state;
      std::size_t contacts;
      ~GivenBack() { few.give_back(state, contacts); }
    } given_back{*this, s, count};
    solve();
  }

 private:
  void take(State &state, std::size_t count);
  void give_back(State &state, std::size_t count);
  int number(const State &state, int body);

  std::vector<int> numbers_;    // (all bodies) in the few, or -1
  std::vector<int> bodies_;     // (few) which they are
  AlignedVector<Body> few_;
  AlignedVector<Vec4> few_spins_;
};

}    // namespace nscd
