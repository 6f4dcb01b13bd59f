// Contact detection: from the neighbor list and the walls to the contact set S of the step.
#pragma once

#include "state.hpp"

namespace nscd {

// Fills state.contacts and state.infos with every pair and wall contact whose gap is at most the reach of its atoms.
// Impulses and biases are left 0. Candidates beyond that but within state.watch go to state.near.
// Raises Error for an overlap beyond the smaller radius.
void detect(State &state, const PairList &pairs);

// Watched candidates that state.displacement would make overlap become contacts, at the end of state.contacts.
// Returns how many.
std::size_t promote_near(State &state);

}    // namespace nscd
