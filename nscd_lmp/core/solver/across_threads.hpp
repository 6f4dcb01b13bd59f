// SPDX-License-Identifier: GPL-2.0-or-later
// Iterations of a solver on the threads of a rank. What they sum is put together in one order, so the result is the
// same to the last bit however the threads are scheduled. On one thread nothing of it is left but a test of a pointer.
#pragma once

#include "parallel/parts.hpp"
#include "parallel/team.hpp"
#include "problem/problem.hpp"
#include "solver/iterate.hpp"

#include <array>

namespace nscd {

// A sweep over all contacts; sweep(range) is for some of them.
template <class Sweep>
Swept sweep_in_parts(Problem &problem, Sweep sweep)
{
  if (!problem.team) return sweep(Range{0, problem.contacts.size()});
  const Parts &parts = *problem.parts;
  std::array<Swept, 2 * most_threads + 1> swept;
  for (int phase = 0; phase < Parts::phases; ++phase) {
    const auto work = [&](int thread) {
      const int part = parts.of(phase, thread);
      if (part >= 0 && parts.range(part).size() > 0) swept[part] = sweep(parts.range(part));
    };
    const int busy = parts.busy(phase);
    if (busy > 1) problem.team->run(work);
    else if (busy == 1) work(0);
  }
  Swept sum;
  for (int part = 0; part < parts.count(); ++part) {
    sum.corrected += swept[part].corrected;
    sum.against += swept[part].against;
  }
  return sum;
}

}    // namespace nscd
