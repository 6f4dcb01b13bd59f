#include "energy_limit.hpp"

#include "across_ranks.hpp"
#include "slides.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Work that is the solver's own error, J.
double negligible(const State &s, std::size_t count)
{
  double sum = 0;
  for (std::size_t k = 0; k < count; ++k) sum += tolerance(s, worth(s.infos[k])) * std::abs(s.contacts[k].impulse);
  return tolerances * sum_everywhere(s, sum);
}

void clear_biases(State &s, std::size_t count)
{
  for (std::size_t k = 0; k < count; ++k) s.contacts[k].bias = 0;
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k) set_bias(s.friction.slides<M>()[k], typename M::Tangent{});
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
  m.bodies = s.bodies;
  m.spins = s.friction.spins;
  m.normal.resize(count);
  m.tangential.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    m.normal[k] = s.contacts[k].impulse;
    m.tangential[k] = tangential_impulse(s, k);
  }
}

void EnergyLimit::load(State &s, std::size_t count, const Motion &a, const Motion &b, double share) const
{
  const auto mix = [share](const auto &x, const auto &y) { return x + (y - x) * share; };
  for (std::size_t i = 0; i < s.bodies.size(); ++i) {
    s.bodies[i] = mix(a.bodies[i], b.bodies[i]);
    s.friction.spins[i] = mix(a.spins[i], b.spins[i]);
  }
  for (std::size_t k = 0; k < count; ++k) s.contacts[k].impulse = mix(a.normal[k], b.normal[k]);
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k)
      s.friction.slides<M>()[k].impulse = M::from_space(s.contacts[k].normal, mix(a.tangential[k], b.tangential[k]));
  });
}

// Half the sum of p (u- + u+), J; u- with the velocities of `before`, or with those at the start of the step.
double EnergyLimit::work(const State &s, std::size_t count, const Motion *before) const
{
  double sum = 0;
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k) {
      const Contact &c = s.contacts[k];
      const auto after = velocity<M>(c, s.bodies.data(), s.friction.spins.data());
      using Velocity = Split<typename M::Tangent>;
      const Velocity first = before ? velocity<M>(c, before->bodies.data(), before->spins.data())
                                    : Velocity{s.infos[k].speed_before, slip_at_start<M>(s, k)};
      sum += c.impulse * (first.n + after.n) + inner(s.friction.slides<M>()[k].impulse, first.t + after.t);
    }
  });
  return sum_everywhere(s, sum) / 2;
}

// Loads the blend of first_ and second_ whose work is down to `limit`.
void EnergyLimit::blend(State &s, std::size_t count, const Motion *before, double limit)
{
  load(s, count, first_, first_, 0);
  const double at0 = work(s, count, before);
  load(s, count, first_, second_, 1);
  const double at1 = work(s, count, before);
  load(s, count, first_, second_, 0.5);
  const double share = share_down_to(std::max(limit, at1), at0, work(s, count, before), at1);
  load(s, count, first_, second_, share);
}

bool EnergyLimit::limit_restitution(State &s, std::size_t count, From from, const std::function<bool()> &solver)
{
  const Motion *const before = from == From::step ? nullptr : &before_;
  if (work(s, count, before) <= negligible(s, count)) return false;
  store(s, count, first_);
  load(s, count, before_, before_, 0);
  clear_biases(s, count);
  solver();
  store(s, count, second_);
  blend(s, count, before, 0);
  return true;
}

bool EnergyLimit::limit_unsolved(State &s, std::size_t count)
{
  store(s, count, first_);
  const double limit = negligible(s, count);
  change_across(s.halo, s.bodies, s.friction.spins.data(), [&] {
    for (std::size_t k = 0; k < count; ++k) remove_impulse(s, k);
  });
  store(s, count, second_);
  load(s, count, first_, second_, 0);
  if (work(s, count, &second_) <= limit) return false;
  blend(s, count, &second_, limit);
  return true;
}

bool EnergyLimit::solve(State &s, std::size_t count, bool newton, From from, const std::function<bool()> &solver)
{
  bool solved = true;
  const auto watched = [&] { return solved = solver() && solved; };
  if (newton) store(s, count, before_);
  watched();
  bool limited = newton && limit_restitution(s, count, from, watched);
  if (!solved) limited |= limit_unsolved(s, count);
  return limited;
}

}    // namespace nscd
