// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/list_watch.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Three digits, upwards: a number to type.
double rounded_up(double value)
{
  const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::ceil(value / digit * (1 - 1e-9)) * digit;
}

// The longest way of a body of this rank or a copy, m: `prediction` of a step with v_k to where contacts are sought,
// and on by the displacement or, if the law looks ahead, by dt v_{k+1}.
double farthest_solved(const State &s, double prediction, double look_ahead)
{
  double farthest = 0;
  for (int b = 0; b < s.moving(); ++b) {
    const double ahead = look_ahead * s.in.dt, sought = prediction * s.in.dt;
    const Vec4 &displacement = s.motion.displacement[b];
    const double on2 = std::max(dot(displacement, displacement), ahead * ahead * speed2(s.motion.bodies[b]));
    farthest = std::max(farthest, sought * std::sqrt(speed2(start_velocity(s, b))) + std::sqrt(on2));
  }
  return farthest;
}

// Collective.
double largest_radius(const State &s)
{
  const double *radius = s.in.grains.radius;
  const double here = s.in.grains.owned ? *std::max_element(radius, radius + s.in.grains.owned) : 0;
  return s.exec.halo ? s.exec.halo->max(here) : here;
}

}    // namespace

// A cutoff, if given to the pair style, with which the missed pairs would have been listed: as far apart as they were,
// with as much again as they approach, for any two grains as large as the largest.
static double cutoff_to_type(const State &s, const MissedPairs &missed)
{
  double needed = 2 * missed.largest_radius();
  for (const Missed &m : missed.pairs()) {
    const double radii = s.atoms.spheres[m.pair.atom_i].radius + s.atoms.spheres[m.pair.atom_j].radius;
    needed = std::max(needed, m.listed + std::max(m.approach, 0.0) + 2 * missed.largest_radius() - radii);
  }
  if (missed.beyond()) needed = std::max(needed, missed.beyond()->distance);
  return rounded_up(s.exec.halo ? s.exec.halo->max(needed) : needed);
}

// Of several the one that was farthest.
void ListWatch::refuse_missed(double cutoff) const
{
  const auto nearer = [](const Missed &a, const Missed &b) { return a.listed < b.listed; };
  const Missed &m = *std::max_element(missed_.pairs().begin(), missed_.pairs().end(), nearer);
  const auto [i, j] = m.pair;
  const double held = missed_.cutoff(state_, i, j);
  const double now = m.gap + state_.atoms.spheres[i].radius + state_.atoms.spheres[j].radius;
  fail("contacts could be missed: grains ", state_.in.grains.tag[i], " and ", state_.in.grains.tag[j], " are ", m.gap,
       " apart and approach by ", m.approach, " in this step, but were not listed: their centres were ", m.listed,
       " apart when the neighbor list was built, and it holds pairs up to ", held,
       ": raise the cutoff of the pair style to ", cutoff, ", or use a ",
       now < held ? "neighbor list that is built more often (neigh_modify every 1 delay 0 check yes) or a " : "",
       "smaller timestep");
}

// Raises Error if images do not reach as far as some grain gets.
void ListWatch::refuse_unless_all_known() const
{
  if (!missed_.beyond()) return;
  const auto [atom, distance] = *missed_.beyond();
  fail("contacts could be missed: grain ", state_.in.grains.tag[atom], " can meet one that was ", distance,
       " away when ", "the neighbor list was built, and images reach only ", missed_.images(),
       " beyond the border of the box, or ",
       "of a rank's part of it: use comm_modify cutoff ", rounded_up(distance), ", or a smaller timestep");
}

// The closer looks know how grains move, not what boxes and radii do beside it. `ahead` as Reach has it.
void ListWatch::refuse_drifting(double ahead) const
{
  if (state_.drift.of.empty()) return;
  fail("contacts could be missed: in a box that moves, or of grains that grow, two can be ", 2 * (moved_ + ahead),
       " nearer at the end of this step than when the neighbor list was built, and it holds pairs up to ", listed_,
       " apart: raise the cutoff of the pair style to ", rounded_up(2 * (largest_radius(state_) + moved_ + ahead)),
       ", or use a smaller timestep");
}

double ListWatch::complete(const PairList &pairs, double listed, double moved, double speed)
{
  listed_ = listed, moved_ = moved;
  unlisted_.clear();
  state_.search.unlisted.clear();
  missed_.begin(pairs, listed_);
  const double ahead = longest_move(speed);
  if (listed_ < 0)
    fail("contacts could be missed: pair cutoff plus neighbor skin are ", -listed_, " less than the largest diameter: ",
         "raise the cutoff of the pair style to ", rounded_up(2 * (largest_radius(state_) + ahead)), ", that diameter ",
         "and 2 dt v of the fastest grain");
  if (Reach{listed_, moved_, ahead}.is_enough()) return 0;
  refuse_drifting(ahead);
  free_motion(missed_.motion(), state_, prediction_, look_ahead_);
  if (!missed_.find(state_, 0)) return 0;
  const double cutoff = refuse_unwatchable();
  for (const Missed &m : missed_.pairs())
    if (is_first(m.pair)) state_.search.unlisted.push_back(m.pair);
  return cutoff;
}

// Where contacts are not sought ahead they can only overlap: that is reported, and no reason to refuse the step.
void ListWatch::watch_unlisted()
{
  double farthest = farthest_solved(state_, prediction_, look_ahead_) + state_.in.dt * state_.drift.fastest;
  if (state_.exec.halo) farthest = state_.exec.halo->max(farthest);
  if (Reach{listed_, moved_, farthest}.is_enough()) return;
  const bool for_contacts = look_ahead_ > 0;
  if (for_contacts) refuse_drifting(farthest);
  solved_motion(missed_.motion(), state_, look_ahead_);
  if (!missed_.find(state_, 0)) return;
  if (for_contacts) refuse_unwatchable();
  if (missed_.excludes()) return;
  for (const Missed &m : missed_.pairs())
    if (is_first(m.pair)) state_.search.near.push_back({m.pair, m.gap});
}

bool ListWatch::is_first(const Candidate &pair) { return unlisted_.insert({pair.atom_i, pair.atom_j}).second; }

// Pairs that cannot be taken in, since they may be excluded ones, or an image is not here. Returns the cutoff that has
// them all.
double ListWatch::refuse_unwatchable()
{
  const double cutoff = cutoff_to_type(state_, missed_);
  together(state_.exec.halo, [&] {
    refuse_unless_all_known();
    if (missed_.excludes() && !missed_.pairs().empty()) refuse_missed(cutoff);
  });
  return cutoff;
}

// Forces can change by as much as they do to velocities in a step.
bool ListWatch::wants_rebuild()
{
  const double drifts = state_.in.dt * state_.drift.fastest;
  double reduced[] = {0, list_.farthest_moved(state_) + 0.5 * drifts_.neared() + drifts};
  auto &[farthest, moved] = reduced;
  for (int i = 0; i < state_.in.grains.owned; ++i) {
    const Body &b = state_.motion.bodies[i];
    const double speed = std::sqrt(speed2(b));
    farthest = std::max(farthest, longest_move(b[3] > 0 ? speed + state_.scales.smooth_kick : speed));
  }
  if (state_.exec.halo) state_.exec.halo->max(reduced);
  if (Reach{listed_, moved, farthest + drifts}.is_enough()) return false;
  if (drifts > 0) return true;
  next_motion(missed_.motion(), state_, look_ahead_ + prediction_);
  const double margin = 2 * longest_move(state_.scales.smooth_kick);
  // A new list costs no more than a closer look, and serves for more than a step if it reaches far enough.
  const bool new_one_is_enough = Reach{listed_, 0, farthest}.is_enough();
  return new_one_is_enough ? missed_.may_find(state_, margin) : missed_.find(state_, margin);
}

}    // namespace nscd
