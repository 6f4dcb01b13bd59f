// SPDX-License-Identifier: GPL-2.0-or-later
// Contacts judged one by one and island by island, by what each has at stake.
//
// A sum over a scene says nothing of a contact in it: where forces of 1 N and of 1e5 N act side by side, the small
// ones could be left out and hardly change it. So where the sums of the criterion are met, this is looked at too:
//   island   the natural map over (|dt f / m|^2 + v_free^2)^1/2, 2-norms, of the island where it is largest
//   worst    a contact's natural map over (|dt f / m|^2 + v_free^2 + (W_nn p)^2)^1/2, the largest
//   typical  the root of the mean square of a contact's natural map over |dt f / m|, 0 where no force acts
#pragma once

#include "problem/criterion.hpp"

namespace nscd {

// Fills these of `seen`; problem.infos are there, here or on another rank. Collective. Defined in closer_look_of.hpp.
template <class M>
void look_closer(const Problem &problem, const M &mechanics, Criterion &seen);
// For whom the mechanics are of no matter.
void look_closer(const Problem &problem, Criterion &seen);

}    // namespace nscd
