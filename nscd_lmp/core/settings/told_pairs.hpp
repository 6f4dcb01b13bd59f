// SPDX-License-Identifier: GPL-2.0-or-later
// Materials by pair of types as one door tells them to the other, in words: "mix geometric", and a line of each pair.
#pragma once

#include "settings/settings.hpp"

#include <string>
#include <vector>

namespace nscd {

// Of pairs with one type on either side; never empty.
std::string told(const std::vector<PairMaterial> &pairs, Mixing mixing);
// And back. Raises Error for what is no such text.
void take_told(Settings &settings, const std::string &told);

// Raises Error where the settings, beside those of a pair style, have materials of their own, by `keyword`.
void require_no_pairs(const Settings &settings, const std::string &keyword);

}    // namespace nscd
