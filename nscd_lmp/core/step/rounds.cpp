// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/rounds.hpp"

#include "base/hot.hpp"
#include "scene/contact_materials.hpp"
#include "scene/copies.hpp"
#include "scene/slides.hpp"
#include "solver/across_ranks.hpp"
#include "step/approach_bound.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nscd {

constexpr int first_sweeps = 32, most_sweeps = 128;   // of brief rounds; each has twice those of the one before

Rounds::Rounds(State &state, Scheme &scheme, Solves &solves, WarmStart &memory, Sought sought, bool looks_ahead,
               ListWatch &watch) :
    state_(state), scheme_(scheme), solves_(solves), memory_(memory), sought_(sought), looks_ahead_(looks_ahead),
    watch_(watch)
{
}

Rounds::Result Rounds::run(const PairList &pairs)
{
  begin();
  Next next{Reason::first, first_effort(), first_sweeps};
  while (next.reason != Reason::none) {
    start(next);
    const bool solved = solve(next);
    next = look_on(next, solved, pairs);
  }
  state_.motion.stage = Motion::Stage::solved;
  const double contacts = sum_everywhere(state_, double(state_.table.size()));
  return {std::int64_t(contacts), calmed_.jammed, impacts_left_, calmed_.energy};
}

// Everything that a step sums up over its solves.
void Rounds::begin()
{
  assert(state_.motion.stage == Motion::Stage::free);
  solves_.begin_step();
  impacts_left_ = false;
  state_.table.close_impacts();
  state_.courses.clear();
  place_materials(state_, 0);
  if (state_.exec.halo) state_.exec.halo->share_contacts(state_.motion.bodies, state_.table.contacts);
  if (!impacts_first()) return;
  free_bodies_ = state_.motion.bodies;
  free_spins_ = state_.motion.spins;
}

// Brief if some sweeps are likely to make contacts of watched pairs.
Rounds::Effort Rounds::first_effort() const
{
  constexpr double few = 0.05;
  if (sought_ != Sought::foreseen) return Effort::full;
  double counts[] = {double(state_.search.unforeseen), double(state_.table.size())};
  if (state_.exec.halo) state_.exec.halo->sum(counts);
  return counts[0] > few * counts[1] ? Effort::brief : Effort::full;
}

void Rounds::start(const Next &now)
{
  solves_.begin_round();
  if (impacts_first()) {
    resolve_impacts_first(now.reason);
    solves_.begin_budget();
    start_contacts(0, false);
    return;
  }
  start_contacts(now.new_from, now.reason != Reason::first);
  if (now.reason == Reason::turned) start_turned();
}

// Returns whether the contacts that are there are solved, or given up.
bool Rounds::solve(const Next &now)
{
  const Solves::Part part{state_.table.size(), scheme_.constants.restitution, free_norm_};
  calmed_ = {};
  if (now.effort == Effort::brief) return solves_.sweep_briefly(part, now.sweeps);
  solves_.solve(part, EnergyLimit::From::step);
  if (!solves_.outcome().converged) calmed_ = calm_.slow_down(state_, part.contacts);
  return true;
}

// Moves the grains, and sees what that asks for.
Rounds::Next Rounds::look_on(const Next &now, bool solved, const PairList &pairs)
{
  if (state_.exec.halo) refresh_copies(state_);
  const bool turned = scheme_.displace(state_, calmed_.bodies);
  const std::size_t before = state_.table.size();
  const bool more = promote(pairs);
  Next next{.sweeps = 2 * now.sweeps, .new_from = before};
  next.reason = turned ? Reason::turned : more ? Reason::more_contacts : solved ? Reason::none : Reason::unsolved;
  const bool may_be_brief = now.effort == Effort::brief && next.sweeps <= most_sweeps;
  next.effort = may_be_brief && (turned || more) ? Effort::brief : Effort::full;
  return next;
}

// Biases and start impulses of the contacts from `first` on; `goes_on`: those before have theirs.
NSCD_HOT void Rounds::start_contacts(std::size_t first, bool goes_on)
{
  scheme_.set_bias(state_, first);
  set_tangential_bias(state_, first, scheme_.constants.restitution);
  const double added = keep_free_velocities(state_, first, state_.table.size());
  free_norm_ = std::hypot(goes_on ? free_norm_ : 0, added);
  bound_approach(state_, first);
  Motion &motion = state_.motion;
  assert(goes_on == (motion.stage == Motion::Stage::with_impulses));
  motion.stage = Motion::Stage::with_impulses;
  if (!state_.in.settings.warmstart) return;
  change_across(state_.exec.halo, motion.bodies, motion.spins.data(), [&] { memory_.recall(state_, first); });
}

// Biases once the scheme has turned some contacts.
void Rounds::start_turned()
{
  scheme_.set_bias(state_, 0);
  set_tangential_bias(state_, 0, scheme_.constants.restitution);
  bound_approach(state_, 0);
}

// Whether watched pairs have become contacts.
bool Rounds::promote(const PairList &pairs)
{
  const std::size_t before = state_.table.size();
  std::size_t more = 0;
  watch_.watch_unlisted();
  together(state_.exec.halo, [&] {
    watch_farther(state_, pairs);
    if (looks_ahead_) more = promote_near(state_);
    else look_at_near(state_);
  });
  if (sum_everywhere(state_, double(more)) == 0) return false;
  place_materials(state_, before);
  if (state_.exec.halo) state_.exec.halo->share_contacts(state_.motion.bodies, state_.table.contacts);
  return true;
}

void Rounds::resolve_impacts_first(Reason reason)
{
  if (reason != Reason::first) {
    solves_.take_back();
    // Those of walls that move have come in since; nothing changes them.
    std::copy(free_bodies_.begin(), free_bodies_.end(), state_.motion.bodies.begin());
    std::copy(free_spins_.begin(), free_spins_.end(), state_.motion.spins.begin());
    state_.motion.stage = Motion::Stage::free;
    place_materials(state_, 0);
  }
  const Settings &settings = state_.in.settings;
  for (Contact &c : state_.table.contacts) c.impulse = 0;
  const double tol = solves_.options().stop == Stop::natural && !settings.frictional() ? tol_of_impacts : 1;
  const auto solve = [this, tol](std::size_t count) {
    const double norm = keep_free_velocities(state_, 0, count);
    bound_approach_of_impacts(state_, count);
    solves_.begin_budget();
    solves_.solve({count, true, norm, tol}, EnergyLimit::From::solve);
  };
  constexpr std::size_t few = 8;   // contacts, each for so many bodies: what all of those cost is little beside that
  impacts_left_ = scheme_.impacts(state_, [&](std::size_t count) {
    if (state_.exec.halo || solves_.is_custom() || few * count > state_.motion.bodies.size()) return solve(count);
    few_bodies_.with(state_, count, [&] { solve(count); });
  });
}

}    // namespace nscd
