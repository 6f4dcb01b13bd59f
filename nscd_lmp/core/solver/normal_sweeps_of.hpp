// SPDX-License-Identifier: GPL-2.0-or-later
// part_normals() of any mechanics.
#pragma once

#include "base/hot.hpp"
#include "solver/body_momentum.hpp"
#include "solver/local/pdas.hpp"
#include "solver/momentum.hpp"
#include "solver/nlgs.hpp"

#include <algorithm>

namespace nscd {

constexpr int most_along_normals = 300, looked_every = 8;   // sweeps

// An exact visit along the normal that leaves the impulse as large as the tangential one needs it.
struct AtLeast : Pdas {
  static constexpr bool carries_velocity = true;
  static Local visit(Local now, double v, double w_inverse, double)
  {
    return {std::max(now.velocity, now.impulse - v * w_inverse), now.velocity};
  }
};

template <class M>
void find_least_normals(const Problem &problem, const M &mechanics, double *least)
{
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    const auto own = mechanics.own(c, k, 1 / c.w_inverse);
    double needed = 0;
    for_each_disc([&](std::size_t d, const auto &p) {
      if (own.discs[d].mu > 0) needed = std::max(needed, length(p) / own.discs[d].mu);
    }, mechanics.impulse(c, k).t);
    least[k] = std::min(needed, c.impulse);
  }
}

inline double largest_approach(const Problem &problem)
{
  double largest = 0;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    largest = std::max(largest, -(normal_velocity(c, problem.bodies.data()) + c.bias) * problem.per_approach[k]);
  }
  return problem.halo ? problem.halo->max(largest) : largest;
}

// On several ranks: all contacts, with momentum. For spheres, which no push along a normal turns.
inline int part_all(Problem &problem, double *least)
{
  const std::size_t n = problem.contacts.size();
  std::vector<double> &numbers = problem.workspace.numbers_of_normals;   // impulses before the last sweep
  numbers.resize(n);
  for (std::size_t k = 0; k < n; ++k) numbers[k] = problem.contacts[k].impulse;
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
  } while (sweeps < most_along_normals && !(largest_approach(problem) <= 1));
  return sweeps;
}

// The contacts of grains that approach another too fast.
template <class M>
NSCD_HOT void find_nearby(Problem &problem, const M &mechanics)
{
  std::vector<char> &fast = problem.workspace.marks;
  std::vector<std::int32_t> &nearby = problem.workspace.nearby;
  const Body *const bodies = problem.bodies.data();
  fast.assign(problem.bodies.size(), 0);
  nearby.clear();
  bool any = false;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    if (-(mechanics.load(c, k).normal(c.normal) + c.bias) * problem.per_approach[k] <= 1) continue;
    any = true;
    for (const int body : {c.i, c.j}) fast[body] = bodies[body][3] > 0;
  }
  for (std::size_t k = 0; k < problem.contacts.size() && any; ++k)
    if (fast[problem.contacts[k].i] | fast[problem.contacts[k].j]) nearby.push_back(std::int32_t(k));
}

template <class M>
NSCD_HOT void sweep_nearby(Problem &problem, const M &given, const double *least)
{
  const M mechanics = given;
  for (const std::int32_t k : problem.workspace.nearby) {
    Contact &c = problem.contacts[k];
    const double v = mechanics.load(c, k).normal(c.normal) + c.bias;
    const double p = std::max(least[k], c.impulse - v * c.w_inverse);
    mechanics.dynamics().push(c, k, p - c.impulse);
    c.impulse = p;
  }
}

// On one rank: where it is needed. Returns the sweeps that its visits come to.
template <class M>
int part_nearby(Problem &problem, const M &mechanics, const double *least)
{
  const std::size_t n = problem.contacts.size();
  std::size_t visits = 0;
  for (int sweeps = 0; sweeps < most_along_normals; sweeps += looked_every) {
    find_nearby(problem, mechanics);
    if (problem.workspace.nearby.empty()) break;
    for (int s = 0; s < looked_every; ++s) sweep_nearby(problem, mechanics, least);
    visits += n + looked_every * problem.workspace.nearby.size();
  }
  return int((visits + n - 1) / n);
}

template <class M>
int part_normals(Problem &problem, const M &mechanics)
{
  std::vector<double> &least = problem.workspace.normals;
  least.resize(problem.contacts.size());
  find_least_normals(problem, mechanics, least.data());
  return problem.halo ? part_all(problem, least.data()) : part_nearby(problem, mechanics, least.data());
}

}    // namespace nscd
