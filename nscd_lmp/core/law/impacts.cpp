#include "impacts.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

constexpr double resting_kicks = 2;    // slower than so many smooth velocity changes of the step: resting
constexpr double tolerances = 10;      // slower than so many times the solver's tolerance: resting
constexpr int max_rounds = 50;

}    // namespace

// Adds sign times half the smooth velocity change of the step.
void Impacts::smooth_half(State &s, double sign) const
{
  for (int i = 0; i < s.grains.owned; ++i) {
    const double *f = s.grains.f + 3 * std::size_t(i);
    const double scale = 0.5 * sign * s.dt * s.grains.force_to_acceleration * s.bodies[i][3];
    s.bodies[i] += Vec4{f[0], f[1], f[2], 0} * scale;
  }
}

void Impacts::select(const State &s)
{
  closing_.clear();
  contacts_.clear();
  infos_.clear();
  const double slow = resting_kicks * s.smooth_kick + tolerances * s.settings.tol;
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const double u = normal_velocity(s.contacts[k], s.bodies.data());
    if (u >= -slow || std::max(s.infos[k].gap, 0.0) + s.dt * u >= 0) continue;
    closing_.push_back(std::uint32_t(k));
    contacts_.push_back(s.contacts[k]);
    contacts_.back().impulse = 0;
    contacts_.back().bias = s.settings.restitution * u;
    infos_.push_back(s.infos[k]);
  }
}

void Impacts::keep_impulses(State &s)
{
  s.impact_impulse.resize(s.contacts.size(), 0.0);
  for (std::size_t k = 0; k < closing_.size(); ++k) s.impact_impulse[closing_[k]] += contacts_[k].impulse;
}

void Impacts::resolve(State &s, const SolvePart &solve)
{
  smooth_half(s, -1);
  select(s);
  for (int round = 0; round < max_rounds && !closing_.empty(); ++round) {
    solve(contacts_, infos_, s.settings.restitution);
    keep_impulses(s);
    select(s);
  }
  smooth_half(s, +1);
}

}    // namespace nscd
