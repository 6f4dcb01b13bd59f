// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a neighbor list that has just been built holds all pairs that it should, counted without it.
#pragma once

#include "scene/views.hpp"

namespace nscd {

// Pairs of grains that are nearer to each other than `reach`, surface to surface, m, and at least one of which moves:
// how many there are, less how many are listed. Twice each pair: those with an image are seen from both sides, by two
// ranks or by one. To be summed over all ranks. At the places at which the list was built.
double count_unlisted(const Grains &grains, const PairList &pairs, double reach);

}    // namespace nscd
