// SPDX-License-Identifier: GPL-2.0-or-later
// Contact detection: from the neighbor list and the walls to the contact set S of the step.
#pragma once

#include "scene/state.hpp"

namespace nscd {

// Which pairs are contacts from the start: all whose gap is at most the reach of their atoms, or, of those, only the
// ones that free motion brings together and the closest of the rest.
enum class Sought { within_reach, foreseen };

// Fills contacts and infos of state.table, from the list and search.unlisted. Impulses and biases are left 0. Other
// candidates within search.watch go to search.near. Raises Error for an overlap beyond the smaller radius.
void detect(State &state, const PairList &pairs, Sought sought);

// Watched candidates that the solution drives into each other, by state.motion.displacement or by dt times the bodies'
// velocities, and by more than a solved step leaves of its contacts, become contacts, at the end of state.table.
// Returns how many. What the others overlap by is left in state.search.watched_overlap.
std::size_t promote_near(State &state);
// That alone, for laws that do not look ahead.
void look_at_near(State &state);

// Before that: if grains get farther, by their displacement or dt times their velocities, than pairs are watched,
// listed pairs farther apart are watched too.
void watch_farther(State &state, const PairList &pairs);

}    // namespace nscd
