// SPDX-License-Identifier: GPL-2.0-or-later
// How fast contacts may approach in a step that is called solved.
#pragma once

#include "scene/state.hpp"

namespace nscd {

// Sets state.table.per_approach of the contacts from `first` on, whose biases are there: so that none is deeper than
// `overlap` at the end of the step, or, where one is already, deeper than it was.
void bound_approach(State &state, std::size_t first);

// The same of the first `count` contacts while their biases are those of impacts.
void bound_approach_of_impacts(State &state, std::size_t count);

}    // namespace nscd
