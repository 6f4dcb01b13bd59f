// SPDX-License-Identifier: GPL-2.0-or-later
// The rounds of a step: solve, see where grains go, and go on with the pairs that are driven together.
//
// The contact set grows while the solution drives watched pairs together; that ends, for lack of pairs. Where impacts
// come first, all of it starts again with the larger set; otherwise the solution is carried on. Where many pairs within
// reach are no contacts yet, the first rounds are short.
#pragma once

#include "scene/detection.hpp"
#include "scene/state.hpp"
#include "scheme/scheme.hpp"
#include "step/calm.hpp"
#include "step/few_bodies.hpp"
#include "step/list_watch.hpp"
#include "step/solves.hpp"
#include "warm_start/warm_start.hpp"

#include <cstdint>

namespace nscd {

class Rounds {
 public:
  // What came of them, beside the outcome of the solves.
  struct Result {
    std::int64_t contacts = 0;   // of all ranks
    bool jammed = false;         // given up, since obstacles approach and nothing can give way
    bool impacts_left = false;   // impacts under restitution that did not end were taken as inelastic
    double calmed = 0;           // kinetic energy taken from jammed islands, J; of this rank
  };
  // `looks_ahead`: as the scheme does. What is handed in must outlive it.
  Rounds(State &state, Scheme &scheme, Solves &solves, WarmStart &memory, Sought sought, bool looks_ahead,
         ListWatch &watch);

  // Contacts have been sought: finds their impulses, and the displacements. Collective.
  Result run(const PairList &pairs);

 private:
  // Why there is a round. In those behind the first, contacts that are not new go on with their impulses, unless
  // impacts come first: then all of it starts again.
  enum class Reason {
    first,
    unsolved,        // brief sweeps have not solved the contacts that are there
    more_contacts,   // watched pairs are driven together
    turned,          // the scheme has turned planes or courses; there may be more contacts too
    none             // solved, and nothing has come up
  };
  enum class Effort { brief, full };
  struct Next {
    Reason reason = Reason::first;
    Effort effort = Effort::full;
    int sweeps = 0;                // of a brief round
    std::size_t new_from = 0;      // contacts from here on are new
  };

  bool impacts_first() const { return scheme_.constants.impacts_first; }
  void begin();
  Effort first_effort() const;
  void start(const Next &now);
  bool solve(const Next &now);
  Next look_on(const Next &now, bool solved, const PairList &pairs);
  void start_contacts(std::size_t first, bool goes_on);
  void start_turned();
  void resolve_impacts_first(Reason reason);
  bool promote(const PairList &pairs);

  State &state_;
  Scheme &scheme_;
  Solves &solves_;
  WarmStart &memory_;
  const Sought sought_;
  const bool looks_ahead_;
  ListWatch &watch_;
  FewBodies few_bodies_;
  Calm calm_;
  Calm::Found calmed_;               // in the last solve
  AlignedVector<Body> free_bodies_;  // as gathered, where impacts may have to be resolved again
  AlignedVector<Vec4> free_spins_;
  double free_norm_ = 0;             // of the step's contacts, m/s
  bool impacts_left_ = false;
};

}    // namespace nscd
