// SPDX-License-Identifier: GPL-2.0-or-later
#include "scheme/impacts.hpp"

#include "scene/drift/drift_of.hpp"
#include "scene/slides.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace nscd {

namespace {

constexpr double resting_kicks = 2;    // slower than so many smooth velocity changes of its grains: resting
constexpr double most_visits = 50;     // of a contact, in the mean, by the rounds of a step
// Each round looks at all contacts, few as those may be that it visits: so many looks, within these rounds.
constexpr double most_looks = 5e6, least_rounds = 50, most_rounds = 1000;
constexpr double cheap_visits = 1000;  // that any step may have
constexpr double worth_saying = 0.01;  // of the energy that the first round had

// Adds sign times half the smooth velocity change of the step.
void smooth_half(State &s, double sign)
{
  for (int i = 0; i < s.moving(); ++i) s.motion.bodies[i] += smooth_kick(s, i) * (0.5 * sign);
  if (s.friction.model != Model::frictionless) add_smooth_spins(s, 0.5 * sign);
}

// Biases of an impact: what is left of the velocity when they meet, drift included, reversed.
void bias_impact(State &s, std::size_t k, double u, double kick)
{
  const double e = s.material(k).restitution, e_t = s.material(k).e_t;
  s.table.contacts[k].bias = e * (u + kick) + kick + normal_drift(s, k);
  with_friction(s.friction.model, [&]<class M>(M) {
    const auto slip = velocity<M>(s.table.contacts[k], s.motion.bodies.data(), s.motion.spins.data()).t;
    const auto drift = tangential_drift<M>(s, k);
    set_bias(s.table.slides<M>()[k], (slip + drift) * e_t + drift);
  });
}

// The contacts of S_m.
struct Closing {
  std::size_t here = 0;   // of this rank, at the front
  double all = 0;         // of all ranks
  // Of all ranks, J: what they approach each other with, and what they would give back of it.
  double energy = 0, given_back = 0;
};

// Brings the contacts of S_m to the front and gives them their bias. In place: copies of them would double the memory
// of a contact.
Closing select_closing(State &s, Bends &bends)
{
  std::size_t closing = 0;
  double energy = 0, given_back = 0;
  const double least = s.in.settings.min_bounce;
  bends.look(s, [&](std::size_t k, double u) {
    const ContactInfo &info = s.table.infos[k];
    const double rests = resting_kicks * info.kick + tolerances * tolerance(s.scales, worth(info));
    return u < -std::max(rests, least);
  });
  for (const std::size_t k : bends.first_meetings(s)) {
    s.table.swap(k, closing);
    const double u = normal_velocity(s.table.contacts[closing], s.motion.bodies.data()) + normal_drift(s, closing);
    const double e = s.material(closing).restitution, approach = 0.5 * s.table.contacts[closing].w_inverse * u * u;
    energy += approach;
    given_back += e * e * approach;
    bias_impact(s, closing, u, s.table.impact_kick[closing]);
    ++closing;
  }
  double sums[] = {double(closing), energy, given_back};
  if (s.exec.halo) {
    s.exec.halo->find_touching(s.table.contacts);
    s.exec.halo->sum(sums);
  }
  return {closing, sums[0], sums[1], sums[2]};
}

void keep_impulses(State &s, std::size_t closing)
{
  auto &normal = s.table.impact_impulse;
  normal.open();
  for (std::size_t k = 0; k < closing; ++k) normal[k] += std::exchange(s.table.contacts[k].impulse, 0.0);
  with_friction(s.friction.model, [&]<class M>(M) {
    auto &kept = s.table.impact_tangential;
    kept.open();
    for (std::size_t k = 0; k < closing; ++k) {
      const auto impulse = std::exchange(s.table.slides<M>()[k].impulse, typename M::Tangent{});
      kept[k] += M::in_space(s.table.contacts[k].normal, impulse);
    }
  });
}

}    // namespace

bool resolve_impacts(State &s, Bends &bends, const SolvePart &solve)
{
  s.table.close_impacts();
  s.table.per_approach.close();   // of the last step's contacts, which are others
  assert(s.motion.stage == Motion::Stage::free);
  s.motion.stage = Motion::Stage::in_impacts;
  smooth_half(s, -1);
  bends.begin(s);
  Closing closing = select_closing(s, bends);
  const double first_energy = closing.energy;
  const double contacts = sum_everywhere(s, double(s.table.contacts.size()));
  const double rounds = std::clamp(most_looks / std::max(contacts, 1.0), least_rounds, most_rounds);
  double visits = std::max(cheap_visits, most_visits * contacts);
  for (int round = 0; round < rounds && visits > 0; ++round) {
    if (closing.all == 0) {
      if (!bends.straighten(s)) break;
      closing = select_closing(s, bends);
      continue;
    }
    visits -= closing.all;
    solve(closing.here);
    bends.act(s, closing.here);
    keep_impulses(s, closing.here);
    closing = select_closing(s, bends);
  }
  if (closing.all > 0) bends.straighten_connected(s, closing.here);
  s.table.impact_moment.close();
  s.table.impact_kick.close();
  smooth_half(s, +1);
  s.motion.stage = Motion::Stage::free;
  return closing.given_back > worth_saying * first_energy;
}

}    // namespace nscd
