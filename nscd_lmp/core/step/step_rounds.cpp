// The rounds of a step: solve, see where grains go, and go on with the pairs that are driven together.
#include "step/step.hpp"

#include "scene/copies.hpp"
#include "scene/slides.hpp"
#include "step/approach_bound.hpp"

#include <algorithm>

namespace nscd {

// A few sweeps, to see which pairs they drive together before more are spent on contacts that are not all there yet.
// Returns whether they have solved the step. No energy limit: what it looks for, steps that are given up and impacts,
// is not among them.
bool Step::sweep_briefly(const Part &part, int sweeps)
{
  share_among_threads(part.contacts);
  const bool solved = solve_part(part, std::min(sweeps, options_.maxiter));
  report_.converged = true;   // that is not known yet
  return solved;
}

// Whether some sweeps are likely to make contacts of watched pairs.
bool Step::doubts_contacts() const
{
  constexpr double few = 0.05;
  if (sought_ != Sought::foreseen) return false;
  double counts[] = {double(state_.unforeseen), double(state_.table.contacts.size())};
  if (halo_) halo_->sum(counts);
  return counts[0] > few * counts[1];
}

// Everything that a step sums up over its solves.
void Step::begin_rounds()
{
  report_.iterations = started_at_ = 0;
  report_.seconds_solver = 0;
  report_.converged = true;
  energy_limited_ = false;
  state_.table.close_impacts();
  state_.courses.clear();
  place_slides(state_, 0);
  if (halo_) halo_->share_contacts(state_.bodies, state_.table.contacts);
  if (!law_->resolves_impacts(settings_)) return;
  free_bodies_ = state_.bodies;
  free_spins_ = state_.friction.spins;
}

// The contact set grows while the solution drives watched pairs together; that ends, for lack of pairs. Where impacts
// come first, all of it starts again with the larger set; otherwise the solution is carried on. Where many pairs within
// reach are no contacts yet, the first rounds are short.
void Step::solve()
{
  constexpr int first_sweeps = 32, most_sweeps = 128;
  const bool impacts_first = law_->resolves_impacts(settings_);
  const double e = law_->restitution_in_bias(settings_), e_t = law_->tangential_restitution_in_bias(settings_);
  begin_rounds();
  std::size_t first = 0;
  int sweeps = first_sweeps;
  bool briefly = doubts_contacts(), solved = false;
  for (bool again = false, grows = false, differently = false; !solved || grows; again = true) {
    report_.accepted = false;
    if (impacts_first) {
      resolve_impacts_first(again);
      first = 0;
      started_at_ = report_.iterations;
    }
    start_contacts(first, again && !impacts_first);
    if (differently && !impacts_first) start_turned();
    const Part part{state_.table.contacts.size(), e, e_t, free_norm_};
    solved = !briefly || sweep_briefly(part, sweeps);
    if (!briefly) solve_within_energy(part, EnergyLimit::From::step);
    calmed_ = !briefly && !report_.converged ? calm_.slow_down(state_, part.contacts) : Calm::Found{};
    if (halo_) refresh_copies(state_);
    differently = law_->displace(state_, calmed_.bodies);
    first = state_.table.contacts.size();
    grows = promote() || differently;
    sweeps *= 2;
    briefly = briefly && grows && sweeps <= most_sweeps;
  }
  report_.contacts = std::int64_t(sum_everywhere(state_, double(state_.table.contacts.size())));
  report_.energy_limited += energy_limited_;
  report_.jammed = calmed_.jammed;
  judge();
}

// Whether watched pairs have become contacts.
bool Step::promote()
{
  const std::size_t before = state_.table.contacts.size();
  std::size_t more = 0;
  watch_unlisted();
  together([&] {
    watch_farther(state_, *pairs_);
    if (looks_ahead()) more = promote_near(state_);
    else look_at_near(state_);
  });
  if (sum_everywhere(state_, double(more)) == 0) return false;
  place_slides(state_, before);
  if (halo_) halo_->share_contacts(state_.bodies, state_.table.contacts);
  return true;
}

void Step::resolve_impacts_first(bool again)
{
  if (again) {
    report_.converged = true;  // of the pass that is given up
    energy_limited_ = false;
    state_.bodies = free_bodies_;
    state_.friction.spins = free_spins_;
    place_slides(state_, 0);
  }
  for (Contact &c : state_.table.contacts) c.impulse = 0;
  const double tol = options_.stop == Stop::natural && !settings_.frictional() ? tol_of_impacts : 1;
  report_.impacts_left = law_->impacts(state_, [this, tol](std::size_t count) {
    const double norm = keep_free_velocities(state_, 0, count);
    bound_approach_of_impacts(state_, count);
    started_at_ = report_.iterations;
    solve_within_energy({count, settings_.restitution, settings_.e_t, norm, tol}, EnergyLimit::From::solve);
  });
}

}    // namespace nscd
