// SPDX-License-Identifier: GPL-2.0-or-later
// Iterations of a solver on several ranks, whose threads they use (across_threads.hpp): masses split while it works,
// corrections put together, sums over all ranks.
// On one rank nothing of it is left but a test of a pointer.
#pragma once

#include "parallel/halo.hpp"
#include "problem/criterion.hpp"
#include "solver/across_threads.hpp"
#include "solver/iterate.hpp"

namespace nscd {

// Masses are split for as long as it lives.
class SplitMasses {
 public:
  explicit SplitMasses(Problem &problem) : problem_(problem)
  {
    if (problem.halo) problem.halo->split(problem.bodies, problem.contacts);
  }
  ~SplitMasses()
  {
    if (problem_.halo) problem_.halo->join(problem_.bodies, problem_.contacts);
  }
  SplitMasses(const SplitMasses &) = delete;
  SplitMasses &operator=(const SplitMasses &) = delete;

 private:
  Problem &problem_;
};

// The criterion with true masses; single contacts and islands are looked at where the sums meet the goal.
template <class M>
Criterion measure_across(Problem &problem, const M &mechanics, const Goal &goal, const double *carried = nullptr)
{
  problem.goal = goal;
  if (!problem.halo) return measure(problem, mechanics, carried);
  problem.halo->join(problem.bodies, problem.contacts);
  const Criterion seen = measure(problem, mechanics, carried);
  problem.halo->split(problem.bodies, problem.contacts);
  return seen;
}

// Hands impulses to bodies by `change`, on every rank, and puts together what that did to shared grains.
template <class Change>
void change_across(Halo *halo, std::span<Body> bodies, Vec4 *spins, Change change)
{
  if (halo) halo->open(bodies, spins);
  change();
  if (halo) halo->close(bodies, spins);
}

// A sweep on every rank; sweep(range) is for some of the contacts.
template <class Sweep>
Swept sweep_across(Problem &problem, Sweep sweep)
{
  if (!problem.halo) return sweep_in_parts(problem, sweep);
  Swept swept;
  change_across(problem.halo, problem.bodies, problem.sliding.spins, [&] { swept = sweep_in_parts(problem, sweep); });
  double sums[] = {swept.corrected, swept.against};
  problem.halo->sum(sums);
  return {sums[0], sums[1]};
}

inline Extent extent(const Problem &problem)
{
  const double contacts = double(problem.contacts.size());
  return {std::size_t(problem.halo ? problem.halo->sum(contacts) : contacts), problem.free_norm};
}

// For solvers that know nothing of ranks (additive Schwarz): each rank solves for its own contacts by `solve`, with its
// share of the shared grains' masses, corrections are put together, and so on until the criterion is met.
template <class Solve>
SolverReport solve_by_ranks(Problem &problem, const SolverOptions &options, Solve solve)
{
  SplitMasses split(problem);
  const auto once = [&] {
    change_across(problem.halo, problem.bodies, problem.sliding.spins, [&] { problem.halo->together(solve); });
    return 0.0;   // always worth a look
  };
  return iterate(extent(problem), options, once, [&](const Goal &goal) {
    return with_mechanics(problem, [&](const auto &mechanics) { return measure_across(problem, mechanics, goal); });
  });
}

}    // namespace nscd
