// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/step.hpp"

#include "base/error.hpp"
#include "scene/copies.hpp"
#include "scene/detection.hpp"
#include "scene/gather.hpp"
#include "scene/planar.hpp"
#include "scene/slides.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace nscd {

using Clock = std::chrono::steady_clock;

static double seconds(Clock::time_point from, Clock::time_point to)
{
  return std::chrono::duration<double>(to - from).count();
}

Step::Step(const Settings &settings, CustomSolver custom, int dimension, Ranks *ranks, int types) :
    settings_(checked(settings, dimension)), types_(types), materials_(settings_, types),
    scheme_(find_scheme(settings_.law).make(settings_)),
    state_{.in = {.settings = settings_, .materials = materials_, .dimension = dimension},
           .obstacles = Obstacles(settings_)},
    halo_(ranks && ranks->count() > 1 ? std::make_unique<Halo>(*ranks) : nullptr),
    prediction_(scheme_->constants.prediction), look_ahead_(find_scheme(settings_.law).looks_ahead ? 1 : 0),
    solves_(state_, settings_, std::move(custom), looks_ahead()),
    sought_(looks_ahead() && !scheme_->constants.impacts_first && solves_.can_go_on() ? Sought::foreseen
                                                                                      : Sought::within_reach),
    rounds_(state_, *scheme_, solves_, memory_, sought_, looks_ahead(), watch_),
    crowding_(nscd::crowding(settings_.threads, ranks))
{
  state_.exec.halo = halo_.get();
  state_.exec.slabs = Slabs(settings_.threads);
  (*settings_.criterion == Stop::natural ? state_.scales.tol_of_worth : state_.scales.tol_absolute) = *settings_.tol;
  const Inertia inertia = settings_.inertia.value_or(dimension == 2 ? Inertia::disc : Inertia::sphere);
  state_.friction.model = choose_model(settings_, dimension);
  state_.table.open_slides(state_.friction.model);
  if (settings_.restitutive()) state_.table.material.open();
  state_.friction.spin_response = inertia == Inertia::disc ? disc_spin_response : sphere_spin_response;
}

void Step::change_materials(const std::vector<PairMaterial> &pairs, Mixing mixing)
{
  Settings changed = settings_;
  changed.pairs = pairs;
  changed.mixing = mixing;
  change(changed);
}

void Step::change_walls(std::size_t kept, std::span<const Wall> others)
{
  Settings changed = settings_;
  changed.walls.resize(kept);
  changed.walls.insert(changed.walls.end(), others.begin(), others.end());
  change(changed);
  state_.obstacles.change(settings_, kept);
}

void Step::change(const Settings &wanted)
{
  const Settings changed = checked(wanted, state_.in.dimension);
  if (changed.frictional() != settings_.frictional() || changed.restitutive() != settings_.restitutive())
    fail("whether any contact has friction, or restitution, has changed since it was defined: define it anew behind ",
         "the materials");
  materials_ = Materials(changed, types_);
  settings_ = changed;
}

void Step::begin_run(bool list_just_built)
{
  report_ = {};
  totals_ = {};
  left_.forget();
  drifts_.begin_run();
  if (list_just_built) list_.expect_new_list();
}

const StepReport &Step::advance(const Grains &grains, const PairList &pairs, double dt)
{
  const auto start = Clock::now();
  if (!(dt > 0 && std::isfinite(dt))) fail("the timestep is ", dt, ": it must be > 0");
  if (materials_.by_type() && grains.owned > 0 && !grains.type) fail("materials differ by type, and atoms have none");
  state_.in.dt = dt;
  state_.scales.lasting_moment = scheme_->constants.moment * dt;
  state_.in.grains = grains;
  state_.obstacles.begin_step(dt, dt * prediction_, state_.scales.lasting_moment);
  const Seen seen = prepare(pairs);
  together(halo_.get(), [&] { detect(state_, pairs, sought_); });
  const Rounds::Result rounds = rounds_.run(pairs);
  count(solves_.outcome());
  refuse_unsolved(rounds);
  const Tally tally = finish(rounds.calmed);
  write_back();
  if (grains.watched) left_.remember(state_);
  write_report(seen, rounds, tally, seconds(start, Clock::now()));
  remarks_.add(report_, *settings_.criterion);
  return report_;
}

// From arrays to bodies and spheres, here and of other ranks.
Step::Seen Step::prepare(const PairList &pairs)
{
  Largest largest;
  double reduced[7];
  auto &[kick2, speed2, moved, unlisted, smallest, torque, grown] = reduced;
  hold_still(state_.in.grains);
  together(halo_.get(), [&] {
    if (state_.in.dimension == 2) require_planar(state_);
    list_.inspect(state_, pairs);
    if (state_.in.grains.watched) left_.require(state_, list_.is_new());
  });
  if (list_.is_new()) state_.exec.slabs.forget();
  if (halo_ && list_.is_new()) {
    plan_copies(state_);
    if (settings_.warmstart) memory_.follow_grains(*halo_, state_.friction.model);
  }
  belts_.find(state_, looks_ahead());
  together(halo_.get(), [&] { largest = gather_owned(state_, prediction_, look_ahead_); });
  grown = drifts_.look(state_, list_.is_new());
  kick2 = largest.kick2, speed2 = largest.speed2, moved = list_.farthest_moved(state_), unlisted = -pairs.reach;
  smallest = -largest.smallest_radius;
  torque = !remarks_.tell_of_torque() && has_unread_torque(state_.in.grains);
  if (halo_) {
    share_motion(state_);
    halo_->max(reduced);
  }
  gather_images(state_, prediction_, look_ahead_, {kick2, speed2});
  drifts_.settle(state_, grown > 0, list_.is_new());
  drifts_.place(state_, state_.in.dt * prediction_, look_ahead_);
  const double speed = std::sqrt(speed2) + state_.drift.fastest;
  state_.scales.round_off = 1e-14 * speed;
  const double cutoff = watch_.complete(pairs, -unlisted, moved + 0.5 * drifts_.neared(), speed);
  return {torque > 0, state_.in.dt * speed / -smallest, cutoff};
}

void Step::count(const Solves::Outcome &solved)
{
  totals_.energy_limited += solved.energy_limited;
  totals_.accepted += solved.converged && solved.accepted;
  totals_.unconverged += !solved.converged;
}

void Step::refuse_unsolved(const Rounds::Result &rounds) const
{
  const Solves::Outcome &solved = solves_.outcome();
  if (solved.converged || settings_.unconverged != Unconverged::error) return;
  const Criterion &seen = solved.criterion;
  const SolverOptions &options = solves_.options();
  if (rounds.jammed) fail("step not solved: ", nothing_gives_way, ", or use `unconverged warn`");
  const std::string_view remedy = "use `unconverged warn`";
  if (judged(seen, options) >= options.tol)
    fail("step not solved: criterion ", options.stop == Stop::paper ? "(42)" : "natural", " is ",
         judged(seen, options), " after ", solved.iterations, " iterations, tol is ", options.tol,
         ": raise maxiter or tol, or ", remedy);
  if (seen.approach > 1)
    fail("step not solved: after ", solved.iterations, " iterations a contact approaches ", seen.approach,
         " times as fast as overlap ", *settings_.overlap, " allows: raise maxiter or overlap, or ", remedy);
  fail("step not solved: after ", solved.iterations, " iterations a contact is off by ", seen.worst,
       " of what its velocity is worth, more than ", off_of_solved, ": raise maxiter, or ", remedy);
}

}    // namespace nscd
