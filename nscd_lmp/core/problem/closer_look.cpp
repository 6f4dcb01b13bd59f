// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/closer_look_of.hpp"

#include "base/hot.hpp"
#include "parallel/halo.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// The natural map of the island where it is largest.
NSCD_HOT double worst_island(const Problem &problem)
{
  Workspace &w = problem.workspace;
  w.islands.find(problem.bodies.size(), w.joined, problem.halo);
  w.islands.clear_sums();
  for (const Joined &contact : w.joined) {
    w.islands.add(contact.i, {contact.residual2, std::max(0.0, contact.stake2)});
    if (!contact.connects()) w.islands.add(contact.j, {contact.residual2, 0});
  }
  if (problem.halo) problem.halo->sum(w.islands.sum(0));
  double worst = 0;
  for (int island = 0; island < w.islands.count(); ++island) {
    const auto [residual2, stake2] = w.islands.sum(island);
    // without a stake there is but a contact that does not push, which is judged by its own
    if (stake2 > 0) worst = std::max(worst, std::sqrt(residual2 / stake2));
  }
  return problem.halo ? problem.halo->max(worst) : worst;
}

}    // namespace

void judge(const Problem &problem, const Look &look, Criterion &seen)
{
  double sums[] = {look.of_kicks2, double(problem.contacts.size())};
  if (problem.halo) problem.halo->sum(sums);
  seen.worst = std::sqrt(problem.halo ? problem.halo->max(look.worst2) : look.worst2);
  seen.typical = sums[1] > 0 ? std::sqrt(sums[0] / sums[1]) : 0;
  if (seen.worst > problem.goal.worst || !problem.judges_islands) return;
  seen.island = std::max(seen.relative, worst_island(problem));
}

void look_closer(const Problem &problem, Criterion &seen)
{
  with_mechanics(problem, [&](const auto &mechanics) { look_closer(problem, mechanics, seen); });
}

}    // namespace nscd
