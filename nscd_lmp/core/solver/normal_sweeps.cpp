// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/normal_sweeps.hpp"

#include "base/hot.hpp"
#include "solver/body_momentum.hpp"
#include "solver/local/pdas.hpp"
#include "solver/momentum.hpp"
#include "solver/nlgs.hpp"

#include <algorithm>

namespace nscd {

namespace {

constexpr int most = 300, looked_every = 8;   // sweeps

// An exact visit along the normal that leaves the impulse as large as the tangential one needs it.
struct AtLeast : Pdas {
  static constexpr bool carries_velocity = true;
  static Local visit(Local now, double v, double w_inverse, double)
  {
    return {std::max(now.velocity, now.impulse - v * w_inverse), now.velocity};
  }
};

template <class M>
void find_least_normals(const Problem &problem, double *least)
{
  const auto *const slides = problem.sliding.slides<M>();
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const double needed = slides[k].mu > 0 ? length(slides[k].impulse) / slides[k].mu : 0;
    least[k] = std::min(needed, problem.contacts[k].impulse);
  }
}

NSCD_HOT double largest_approach(const Problem &problem)
{
  double largest = 0;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    largest = std::max(largest, -(normal_velocity(c, problem.bodies.data()) + c.bias) * problem.per_approach[k]);
  }
  return problem.halo ? problem.halo->max(largest) : largest;
}

// On several ranks: all contacts, with momentum.
int part_all(Problem &problem)
{
  const std::size_t n = problem.contacts.size();
  std::vector<double> &numbers = problem.workspace.normals;   // impulses before the last sweep, and the least ones
  numbers.resize(2 * n);
  double *const least = numbers.data() + n;
  for (std::size_t k = 0; k < n; ++k) numbers[k] = problem.contacts[k].impulse;
  with_friction(problem.sliding.model, [&]<class M>(M) { find_least_normals<M>(problem, least); });
  Pace pace(false);
  pace.momentum.previous = numbers.data();
  BodyMomentum bodies(problem, problem.workspace.more_vectors);
  int sweeps = 0;
  const auto some = [&](const Range &range) { return sweep<AtLeast, true>(problem, range, least, 1, pace.momentum); };
  do {
    for (int k = 0; k < looked_every; ++k, ++sweeps) {
      bodies.extrapolate(pace.momentum.share());
      pace.look(sweep_across(problem, some));
    }
  } while (sweeps < most && !(largest_approach(problem) <= 1));
  return sweeps;
}

// The contacts of grains that approach another too fast.
NSCD_HOT void find_nearby(Problem &problem)
{
  std::vector<char> &fast = problem.workspace.marks;
  std::vector<std::int32_t> &nearby = problem.workspace.nearby;
  const Body *const bodies = problem.bodies.data();
  fast.assign(problem.bodies.size(), 0);
  nearby.clear();
  bool any = false;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    if (-(normal_velocity(c, bodies) + c.bias) * problem.per_approach[k] <= 1) continue;
    any = true;
    for (const int body : {c.i, c.j}) fast[body] = bodies[body][3] > 0;
  }
  for (std::size_t k = 0; k < problem.contacts.size() && any; ++k)
    if (fast[problem.contacts[k].i] | fast[problem.contacts[k].j]) nearby.push_back(std::int32_t(k));
}

NSCD_HOT void sweep_nearby(Problem &problem, const double *least)
{
  Body *const bodies = problem.bodies.data();
  for (const std::int32_t k : problem.workspace.nearby) {
    Contact &c = problem.contacts[k];
    const double p = std::max(least[k], c.impulse - (normal_velocity(c, bodies) + c.bias) * c.w_inverse);
    apply_impulse(c, p - c.impulse, bodies);
    c.impulse = p;
  }
}

// On one rank: where it is needed. Returns the sweeps that its visits come to.
int part_nearby(Problem &problem)
{
  const std::size_t n = problem.contacts.size();
  std::vector<double> &least = problem.workspace.normals;
  least.resize(n);
  with_friction(problem.sliding.model, [&]<class M>(M) { find_least_normals<M>(problem, least.data()); });
  std::size_t visits = 0;
  for (int sweeps = 0; sweeps < most; sweeps += looked_every) {
    find_nearby(problem);
    if (problem.workspace.nearby.empty()) break;
    for (int s = 0; s < looked_every; ++s) sweep_nearby(problem, least.data());
    visits += n + looked_every * problem.workspace.nearby.size();
  }
  return int((visits + n - 1) / n);
}

}    // namespace

int part_normals(Problem &problem) { return problem.halo ? part_all(problem) : part_nearby(problem); }

Criterion measure_parted(Problem &problem, const SolverOptions &options, const Goal &goal, int &sweeps,
                         const double *carried)
{
  const Criterion seen = measure_across(problem, goal, carried);
  const bool due = options.budget.sweeps == 0 || goal.worst == off_of_accepted;
  if (!due || !is_met_by_sums(seen, goal) || !(seen.approach > 1)) return seen;
  sweeps += part_normals(problem);
  return measure_across(problem, goal, carried);
}

}    // namespace nscd
