// SPDX-License-Identifier: GPL-2.0-or-later
// Impacts with restitution under law gap, resolved one after another within the step.
//
// Newton's law with the velocities at the start of a step (21) cannot serve here: a contact that is separating then,
// and is pressed only because another impact of the same step drives it, would be handed energy. So impacts propagate
// in rounds, each from the velocities that the round before has left:
//
//   S_m     = { contacts that meet within the step, faster than resting ones do; of each grain the first (bends.hpp) }
//   u_{m+1} >= -e u_m,  p >= 0,  complementary, on S_m                  until S_m is empty
//   with friction: u_t,m+1 + e_t u_t,m and p_t obey Coulomb's law
//
// Half the smooth velocity change of the step acts before the rounds and half after; u_m is what it is when the pair
// meets. With the midpoint displacement, and what impacts displace more, this conserves the energy exactly for e = 1,
// in every round and in the smooth part.
// In Newton's cradle the ball at the far end leaves.
//
// "Faster than resting contacts do" is faster than 2 dt |f|/m + 10 tolerances, f/m the larger one of the two grains. It
// is the whole smooth force: one along the wall, or common to both, makes slow impacts count as resting too. Keyword
// min_bounce raises that bound.
//
// Fails: a dense bed under e > 0 would take rounds without end (inelastic collapse). After 1000 rounds, or when they
// have visited the contacts 50 times in the mean (1000 visits are free), the rest is left to the gap constraint, which
// is inelastic, and impacts of the islands with such a rest act half-way. A front that runs through a row visits each
// contact once, in as many rounds as there are contacts.
#pragma once

#include "scene/state.hpp"
#include "scheme/bends.hpp"

#include <functional>

namespace nscd {

// Solves for the impulses of the first `count` contacts, whose biases are those of impacts, and applies them to the
// bodies.
using SolvePart = std::function<void(std::size_t count)>;

// Bodies: in, free velocities; out, the same plus what the impacts gave them. Contacts: in and out, no impulses; the
// closing ones are brought to the front. impact_impulse: out, what the impacts took, closed if there were none.
// Returns whether impacts are left that would have given back more than 1 % of the energy that the first round had: the
// gap constraint will take it. The same on all ranks.
// `bends`: works on the courses; kept, so that steps do not allocate.
bool resolve_impacts(State &state, Bends &bends, const SolvePart &solve);

}    // namespace nscd
