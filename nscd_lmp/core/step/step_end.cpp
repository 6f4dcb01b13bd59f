// SPDX-License-Identifier: GPL-2.0-or-later
// The end of a step: what it has done, and back into the arrays.
#include "base/hot.hpp"
#include "scene/drift/drift_of.hpp"
#include "scene/gap.hpp"
#include "scene/slides.hpp"
#include "scene/spins.hpp"
#include "step/step.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nscd {

// Warm start remembers what lasts, the contacts' impulses; what the step reports has the impacts' too.
Step::Tally Step::finish(double calmed)
{
  if (settings_.warmstart) memory_.remember(state_);
  ContactTable &table = state_.table;
  for (std::size_t k = 0; k < table.impact_impulse.size(); ++k) table.contacts[k].impulse += table.impact_impulse[k];
  add_slide_impulses(state_, state_.table.impact_tangential);
  return tally_contacts(calmed);
}

// Twice what contacts have done to grains, without what moving obstacles gave, J in the units of m v^2. Where planes
// turn between impacts, no contact alone knows its part.
static double work_on_grains(const State &s)
{
  const bool spins = s.friction.model != Model::frictionless;
  double work = 2 * s.courses.work;
  for (int i = 0; i < s.in.grains.owned; ++i) {
    const Body &b = s.motion.bodies[i];
    if (b[3] == 0) continue;
    const Vec4 before = start_velocity(s, i), after = without_fourth(b);
    work += dot(after - before - smooth_kick(s, i), before + after) / b[3];
    if (!spins) continue;
    const Vec4 spin = s.motion.spins[i], start = start_spin(s, i);
    work += dot(spin - start - smooth_spin_kick(s, i), start + spin) / (b[3] * s.friction.spin_response);
  }
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const Contact &c = s.table.contacts[k];
    const Vec4 push = c.normal * c.impulse + tangential_impulse(s, k);
    if (s.motion.bodies[c.i][3] == 0) work += 2 * dot(push, without_fourth(s.motion.bodies[c.i]));
    if (s.motion.bodies[c.j][3] == 0) work -= 2 * dot(push, without_fourth(s.motion.bodies[c.j]));
  }
  return work;
}

// Overlap at q_{k+1}, and the energy the contacts took: -sum p (u^k + u^{k+1}) / 2, exact for any step.
NSCD_HOT Step::Tally Step::tally_contacts(double calmed)
{
  const State &s = state_;
  double overlap = 0, ratio = 0, work = tangential_work(s);
  double pushed = 0, passed2 = 0;   // impulses, and how far their pairs pass each other, squared and weighed by them
  for (std::size_t k = 0; k < s.table.contacts.size(); ++k) {
    const Contact &c = s.table.contacts[k];
    ContactInfo &info = state_.table.infos[k];
    work += c.impulse * (info.speed_before + normal_velocity(c, s.motion.bodies.data()));
    info.gap = gap_at(s, {info.atom_i, info.atom_j}, in_arrays);
    if (!s.drift.of.empty()) {
      info.radius = s.in.grains.radius[info.atom_i];
      if (info.atom_j >= 0) info.radius = std::min(info.radius, s.in.grains.radius[info.atom_j]);
      work -= c.impulse * normal_drift(s, k);   // which speed_before has
    } else if (info.atom_j >= 0) {
      pushed += c.impulse;
      passed2 += c.impulse * speed2(s.motion.bodies[c.i] - s.motion.bodies[c.j]) / (info.radius * info.radius);
    }
    overlap = std::max(overlap, -info.gap);
    ratio = std::max(ratio, -info.gap / info.radius);
  }
  const Overlap &watched = s.search.watched_overlap;
  double largest[] = {std::max(overlap, watched.length), std::max(ratio, watched.ratio)};
  if (halo_) halo_->max(largest);
  if (!s.courses.start.empty()) work = work_on_grains(s);
  work -= 2 * calmed;
  double sums[] = {work, pushed, passed2};
  if (halo_) halo_->sum(sums);
  const double dissipated = -0.5 * s.in.grains.square_to_energy * sums[0];
  return {{largest[0], largest[1]}, dissipated, sums[1], 0.25 * s.in.dt * s.in.dt * sums[2]};
}

void Step::write_back()
{
  assert(state_.motion.stage == Motion::Stage::solved);
  const Grains &g = state_.in.grains;
  for (int i = 0; i < g.owned; ++i) {
    const Body &b = state_.motion.bodies[i];
    if (b[3] == 0) continue;
    double *x = g.x + 3 * std::size_t(i), *v = g.v + 3 * std::size_t(i), *f = g.f + 3 * std::size_t(i);
    const Vec4 moved = moved_in_arrays(state_, i);
    const double per_force = state_.in.dt * g.force_to_acceleration * b[3];
    for (int d = 0; d < 3; ++d) {
      const double free = v[d] + f[d] * per_force;
      f[d] = (b[d] - free) / per_force;
      x[d] = moved[d];
      v[d] = b[d];
    }
  }
  if (state_.friction.model != Model::frictionless) write_back_spins(state_);
  drifts_.leave(state_);
  state_.obstacles.end_step();
  belts_.see(g);
}

void Step::write_report(const Seen &seen, const Rounds::Result &rounds, const Tally &tally, double seconds)
{
  const Solves::Outcome &solved = solves_.outcome();
  totals_.dissipated += tally.dissipated;
  report_ = {.contacts = rounds.contacts,
             .iterations = solved.iterations,
             .criterion = solved.criterion,
             .largest_overlap = tally.largest.length,
             .largest_overlap_ratio = tally.largest.ratio,
             .largest_move_ratio = seen.move_ratio,
             .cutoff_to_list = seen.cutoff_to_list,
             .pushed = tally.pushed,
             .passed2 = tally.passed2,
             .dissipated_in_step = tally.dissipated,
             .dissipated = totals_.dissipated,
             .unconverged = totals_.unconverged,
             .accepted_steps = totals_.accepted,
             .energy_limited = totals_.energy_limited,
             .unread_torque = seen.unread_torque,
             .converged = solved.converged,
             .accepted = solved.accepted,
             .jammed = rounds.jammed,
             .impacts_left = rounds.impacts_left,
             .seconds_contacts = seconds - solved.seconds,
             .seconds_solver = solved.seconds};
}

}    // namespace nscd
