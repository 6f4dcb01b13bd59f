// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/energy_limit.hpp"

#include "base/storage.hpp"
#include "scene/contact_plane.hpp"
#include "scene/drift/drift_of.hpp"
#include "scene/slides.hpp"
#include "solver/across_ranks.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Of what there is but the contacts' own drift.
void clear_biases(State &s, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k) s.table.contacts[k].bias = normal_drift(s, k);
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k) set_bias(s.table.slides<M>()[k], tangential_drift<M>(s, k));
  });
}

// The smallest share in [0, 1] at which the parabola through (0, at0), (1/2, half), (1, at1) is down to `limit`.
double share_down_to(double limit, double at0, double half, double at1)
{
  const double c = 2 * (at0 + at1 - 2 * half), b = at1 - at0 - c, a = at0 - limit;
  const double root = b * b - 4 * a * c;
  if (!(root >= 0)) return 1;
  const double share = 2 * a / (-b + std::sqrt(root));  // the smaller one, without cancellation; b < 0 here
  return share >= 0 && share <= 1 ? share : 1;
}

}    // namespace

void EnergyLimit::store(const State &s, std::size_t count, Motion &m) const
{
  m.bodies = s.motion.bodies;
  m.spins = s.motion.spins;
  const bool slides = s.friction.model != Model::frictionless;
  m.normal.resize(count);
  if (slides) m.tangential.resize(count);
  for (std::size_t k = 0; k < count; ++k) m.normal[k] = s.table.contacts[k].impulse;
  for (std::size_t k = 0; slides && k < count; ++k) m.tangential[k] = tangential_impulse(s, k);
}

void EnergyLimit::load(State &s, const Motion &motion) const
{
  s.motion.bodies = motion.bodies;
  s.motion.spins = motion.spins;
  for (std::size_t k = 0; k < motion.normal.size(); ++k) s.table.contacts[k].impulse = motion.normal[k];
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < motion.normal.size(); ++k)
      s.table.slides<M>()[k].impulse = M::from_space(s.table.contacts[k].normal, motion.tangential[k]);
  });
}

// first_ and second_, mixed by their islands' shares.
void EnergyLimit::load_blend(State &s, std::size_t count) const
{
  const auto mix = [](const auto &a, const auto &b, double share) { return share == 0 ? a : a + (b - a) * share; };
  for (std::size_t i = 0; i < s.motion.bodies.size(); ++i) {
    const double share = share_[islands_.of(int(i))];
    s.motion.bodies[i] = mix(first_.bodies[i], second_.bodies[i], share);
    if (!first_.spins.empty()) s.motion.spins[i] = mix(first_.spins[i], second_.spins[i], share);
  }
  const auto share_of = [&](std::size_t k) {
    return share_[islands_.of(grain_of(s.table.contacts[k], s.motion.bodies.data()))];
  };
  for (std::size_t k = 0; k < count; ++k)
    s.table.contacts[k].impulse = mix(first_.normal[k], second_.normal[k], share_of(k));
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k) {
      const Vec4 tangential = mix(first_.tangential[k], second_.tangential[k], share_of(k));
      s.table.slides<M>()[k].impulse = M::from_space(s.table.contacts[k].normal, tangential);
    }
  });
}

// By the contacts that push in first_ or in second_.
void EnergyLimit::find_islands(const State &s, std::size_t count)
{
  for (std::vector<double> *of_islands : {&share_, &limit_, &at_first_, &at_second_, &half_way_})
    of_islands->reserve(s.motion.bodies.size());   // more islands need no more
  joined_.clear();
  reserve_closely(joined_, count);
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    const bool pushes = first_.normal[k] != 0 || second_.normal[k] != 0;
    if (pushes && s.motion.bodies[c.i][3] > 0 && s.motion.bodies[c.j][3] > 0) joined_.push_back({c.i, c.j});
  }
  islands_.find(s.motion.bodies.size(), joined_, s.exec.halo);
  share_.assign(islands_.count(), 0);
}

// Half the sum of p (u- + u+), J, of every island; u- with the velocities of `before`, or with those at the start of
// the step. Both with the contacts' drift, since what drifts may do work.
void EnergyLimit::find_work(const State &s, std::size_t count, const Motion *before, std::vector<double> &work)
{
  work.assign(islands_.count(), 0);
  for (std::size_t k = 0; s.friction.model == Model::frictionless && k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    const double first = before ? normal_velocity(c, before->bodies.data()) + normal_drift(s, k)
                                : s.table.infos[k].speed_before;
    const double after = normal_velocity(c, s.motion.bodies.data()) + normal_drift(s, k) + 2 * impact_kick(s, k);
    work[islands_.of(grain_of(c, s.motion.bodies.data()))] += 0.5 * c.impulse * (first + after);
  }
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k) {
      const Contact &c = s.table.contacts[k];
      const auto after = velocity<M>(c, s.motion.bodies.data(), s.motion.spins.data());
      using Velocity = Split<typename M::Tangent>;
      const Velocity first = before ? velocity<M>(c, before->bodies.data(), before->spins.data())
                                    : Velocity{s.table.infos[k].speed_before, slip_at_start<M>(s, k)};
      double twice = c.impulse * (first.n + after.n) + inner(s.table.slides<M>()[k].impulse, first.t + after.t);
      twice += 2 * c.impulse * impact_kick(s, k);
      if (!s.drift.of.empty()) {
        twice += (before ? 2 : 1) * c.impulse * normal_drift(s, k);   // speed_before has it
        twice += 2 * inner(s.table.slides<M>()[k].impulse, tangential_drift<M>(s, k));
      }
      work[islands_.of(grain_of(c, s.motion.bodies.data()))] += 0.5 * twice;
    }
  });
  if (s.exec.halo) work[0] = s.exec.halo->sum(work[0]);
}

// Contacts that overlap, or whose plane is nearer than their gap, are pushed apart at the speed in their biases.
void EnergyLimit::allow_recovery(const State &s, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    const double apart = std::max(0.0, normal_drift(s, k) - c.bias);
    limit_[islands_.of(grain_of(c, s.motion.bodies.data()))] += apart * c.impulse;
  }
}

// What every island's work is now, in first_, and what of it is the solver's own error. Returns whether any makes more
// than that, on any rank.
bool EnergyLimit::find_excess(State &s, std::size_t count, const Motion *before, bool gives_back)
{
  find_islands(s, count);
  find_work(s, count, before, at_first_);
  limit_.assign(islands_.count(), 0);
  if (gives_back) allow_recovery(s, count);
  for (std::size_t k = 0; k < count; ++k) {
    const Contact &c = s.table.contacts[k];
    const double error = tolerances * tolerance(s.scales, worth(s.table.infos[k])) * std::abs(c.impulse);
    limit_[islands_.of(grain_of(c, s.motion.bodies.data()))] += error;
  }
  if (s.exec.halo) limit_[0] = s.exec.halo->sum(limit_[0]);
  bool any = false;
  for (int island = 0; island < islands_.count(); ++island) any |= at_first_[island] > limit_[island];
  return sum_everywhere(s, any) > 0;
}

// Islands that make too much in first_ take of second_ what brings them down to this share of their limit.
void EnergyLimit::blend(State &s, std::size_t count, const Motion *before, double of_limit)
{
  const auto look_at = [&](double share, std::vector<double> &work) {
    std::fill(share_.begin(), share_.end(), share);
    load_blend(s, count);
    find_work(s, count, before, work);
  };
  look_at(1, at_second_);
  look_at(0.5, half_way_);
  for (std::size_t island = 0; island < share_.size(); ++island) {
    const double at0 = at_first_[island], at1 = at_second_[island], limit = std::max(of_limit * limit_[island], at1);
    share_[island] = at0 > limit_[island] ? share_down_to(limit, at0, half_way_[island], at1) : 0;
  }
  load_blend(s, count);
}

bool EnergyLimit::limit_restitution(State &s, std::size_t count, From from, const std::function<bool()> &solver)
{
  const Motion *const before = from == From::step ? nullptr : &before_;
  store(s, count, first_);
  second_.normal.assign(count, 0);   // not known yet
  if (!find_excess(s, count, before)) return false;
  load(s, before_);
  clear_biases(s, count);
  solver();
  store(s, count, second_);
  load(s, first_);
  find_excess(s, count, before);   // with the islands that second_ joins
  blend(s, count, before, 0);
  return true;
}

// Against no impulses at all, which are second_ then.
bool EnergyLimit::makes_energy(State &s, std::size_t count, bool gives_back)
{
  store(s, count, first_);
  change_across(s.exec.halo, s.motion.bodies, s.motion.spins.data(), [&] {
    for (std::size_t k = 0; k < count; ++k) remove_impulse(s, k);
  });
  store(s, count, second_);
  load(s, first_);
  return find_excess(s, count, &second_, gives_back);
}

bool EnergyLimit::limit_unsolved(State &s, std::size_t count, bool gives_back, const std::function<bool()> &go_on)
{
  if (!makes_energy(s, count, gives_back) || go_on() || !makes_energy(s, count, gives_back)) return false;
  blend(s, count, &second_, 1);
  return true;
}

bool EnergyLimit::solve(State &s, std::size_t count, bool newton, From from, bool gives_back,
                        const std::function<bool()> &solver, const std::function<bool()> &go_on)
{
  bool solved = true;
  const auto watched = [&] { return solved = solver() && solved; };
  if (newton) store(s, count, before_);
  watched();
  bool limited = newton && limit_restitution(s, count, from, watched);
  if (!solved) limited |= limit_unsolved(s, count, gives_back, [&] { return !limited && go_on(); });
  return limited;
}

}    // namespace nscd
