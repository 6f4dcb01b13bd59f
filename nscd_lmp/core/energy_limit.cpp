#include "energy_limit.hpp"

#include "slides.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

constexpr double tolerances = 10;  // single contacts miss the solver's tolerance by about so much

// The velocity scale below which work is the solver's own error, times the impulses, J.
double negligible(const State &s, std::size_t count)
{
  double impulses = 0;
  for (std::size_t k = 0; k < count; ++k) impulses += std::abs(s.contacts[k].impulse);
  return tolerances * s.settings.tol * impulses;
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

// Half the sum of p (u- + u+), J.
double EnergyLimit::work(const State &s, std::size_t count, From from) const
{
  double sum = 0;
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < count; ++k) {
      const Contact &c = s.contacts[k];
      const auto after = velocity<M>(c, s.bodies.data(), s.friction.spins.data());
      auto before = velocity<M>(c, before_.bodies.data(), before_.spins.data());
      if (from == From::step) before = {s.infos[k].speed_before, slip_at_start<M>(s, k)};
      sum += c.impulse * (before.n + after.n) + inner(s.friction.slides<M>()[k].impulse, before.t + after.t);
    }
  });
  return sum / 2;
}

bool EnergyLimit::solve(State &s, std::size_t count, From from, const std::function<void()> &solver)
{
  store(s, count, before_);
  solver();
  const double elastic = work(s, count, from);
  if (elastic <= negligible(s, count)) return false;
  store(s, count, elastic_);
  load(s, count, before_, before_, 0);
  clear_biases(s, count);
  solver();
  const double inelastic = work(s, count, from);
  store(s, count, inelastic_);
  load(s, count, elastic_, inelastic_, 0.5);
  const double half = work(s, count, from);
  load(s, count, elastic_, inelastic_, share_down_to(std::max(0.0, inelastic), elastic, half, inelastic));
  return true;
}

}    // namespace nscd
