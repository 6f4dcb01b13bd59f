#include "step.hpp"

#include "detection.hpp"
#include "error.hpp"
#include "gather.hpp"
#include "hot.hpp"
#include "plane.hpp"
#include "slides.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace nscd {

using Clock = std::chrono::steady_clock;

static double seconds(Clock::time_point from, Clock::time_point to)
{
  return std::chrono::duration<double>(to - from).count();
}

Step::Step(const Settings &settings, CustomSolver custom, int dimension) :
    settings_(checked(settings, dimension)), solver_(&find_solver(settings_.solver)), custom_(std::move(custom)),
    law_(find_law(settings_.law).make()), state_{.settings = settings_, .grains = {}, .dimension = dimension},
    prediction_(law_->prediction(settings_)), look_ahead_(law_->looks_ahead() ? 1 : 0)
{
  options_.tol = settings_.tol;
  options_.stop = settings_.criterion;
  options_.maxiter = settings_.maxiter;
  options_.parameter = solver_parameter(settings_, *solver_);
  const Inertia inertia = settings_.inertia.value_or(dimension == 2 ? Inertia::disc : Inertia::sphere);
  state_.friction.model = choose_model(settings_, dimension);
  state_.friction.spin_response = inertia == Inertia::disc ? disc_spin_response : sphere_spin_response;
}

void Step::begin_run(bool list_just_built)
{
  report_ = {};
  if (list_just_built) list_.expect_new_list();
}

const StepReport &Step::advance(const Grains &grains, const PairList &pairs, double dt)
{
  const auto start = Clock::now();
  if (!(dt > 0 && std::isfinite(dt))) fail("the timestep is ", dt, ": it must be > 0");
  state_.dt = dt;
  state_.grains = grains;
  if (state_.dimension == 2) require_planar(state_);
  list_.inspect(state_, pairs);
  const double speed = gather(state_, prediction_, look_ahead_);
  list_.require_reach(state_, pairs, longest_move(speed), speed);
  detect(state_, pairs);
  solve();
  finish();
  write_back(pairs);
  report_.seconds_contacts = seconds(start, Clock::now()) - report_.seconds_solver;
  return report_;
}

// Biases and start impulses of the contacts from `first` on.
NSCD_HOT void Step::start_contacts(std::size_t first)
{
  law_->set_bias(state_, first);
  set_tangential_bias(state_, first, law_->tangential_restitution_in_bias(settings_));
  const double added = velocity_norm(state_, first, state_.contacts.size());
  free_norm_ = std::hypot(first == 0 ? 0 : free_norm_, added);
  if (settings_.warmstart) memory_.recall(state_, first);
}

// A custom solver is shown the bodies without the impulses that it is to find.
void Step::ask_custom(std::size_t count)
{
  const std::size_t width = unknowns(state_.friction.model);
  std::vector<double> &impulses = workspace_.numbers;
  impulses.assign(count * width, 0.0);
  for (std::size_t k = 0; k < count; ++k) read_impulse(state_, k, &impulses[k * width]);
  for (std::size_t k = 0; k < count; ++k) remove_impulse(state_, k);
  if (count > 0) custom_(state_, count, impulses);
  for (const double impulse : impulses)
    if (!std::isfinite(impulse)) fail("the solver handed in returned an impulse that is not a finite number");
  for (std::size_t k = 0; k < count; ++k) write_impulse(state_, k, &impulses[k * width]);
}

// With friction the solution is kept from making energy; what a custom solver answers is taken as it is.
void Step::solve_within_energy(const Part &part, EnergyLimit::From from)
{
  const bool newton = part.e != part.e_t;
  const auto solve = [&] { return solve_part(part); };
  const bool as_it_is = custom_ || state_.friction.model == Model::frictionless;
  if (as_it_is) solve();
  else energy_limited_ |= energy_limit_.solve(state_, part.contacts, newton, from, solve);
}

// Returns whether it is solved.
bool Step::solve_part(const Part &part)
{
  const auto start = Clock::now();
  const std::span contacts = std::span(state_.contacts).first(part.contacts);
  Problem problem{state_.bodies, contacts, part.e, part.norm, workspace_, sliding(state_, part.e_t)};
  SolverReport solved;
  if (custom_) {
    ask_custom(part.contacts);
    solved.iterations = 1;
    solved.criterion = measure(problem);
    solved.converged = nscd::solved(solved.criterion, options_);
  } else {
    solved = solver_->solve(problem, options_);
  }
  report_.seconds_solver += seconds(start, Clock::now());
  if (!std::isfinite(solved.criterion.total()))
    fail("solver ", settings_.solver,
         " diverged: the criterion is not a number; take another solver, or rho or gamma closer to its default");
  report_.iterations += solved.iterations;
  // The criterion of the last solve, or of the one that failed.
  if (report_.converged || !solved.converged) report_.criterion = solved.criterion;
  report_.converged = report_.converged && solved.converged;
  return solved.converged;
}

// The contact set grows while the solution drives watched pairs together; that ends, for lack of pairs. Where impacts
// come first, all of it starts again with the larger set; otherwise the solution is carried on.
void Step::solve()
{
  report_.iterations = 0;
  report_.seconds_solver = 0;
  report_.converged = true;
  energy_limited_ = false;
  state_.impact_impulse.clear();
  state_.friction.impact_impulse.clear();
  place_slides(state_, 0);
  std::size_t first = 0;
  const bool impacts_first = law_->resolves_impacts(settings_);
  if (impacts_first) {
    free_bodies_ = state_.bodies;
    free_spins_ = state_.friction.spins;
  }
  do {
    if (impacts_first) {
      resolve_impacts_first(first > 0);
      first = 0;
    }
    start_contacts(first);
    solve_within_energy({state_.contacts.size(), law_->restitution_in_bias(settings_),
                         law_->tangential_restitution_in_bias(settings_), free_norm_}, EnergyLimit::From::step);
    law_->displace(state_);
    first = state_.contacts.size();
  } while (promote());
  report_.contacts = int(state_.contacts.size());
  report_.energy_limited += energy_limited_;
  judge();
}

// Whether watched pairs have become contacts.
bool Step::promote()
{
  const std::size_t before = state_.contacts.size();
  if (promote_near(state_) == 0) return false;
  place_slides(state_, before);
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
  for (Contact &c : state_.contacts) c.impulse = 0;
  law_->impacts(state_, [this](std::size_t count) {
    const double norm = velocity_norm(state_, 0, count);
    solve_within_energy({count, settings_.restitution, settings_.e_t, norm}, EnergyLimit::From::solve);
  });
}

void Step::judge()
{
  if (report_.converged) return;
  if (settings_.unconverged == Unconverged::error)
    fail("step not solved: criterion ", settings_.criterion == Stop::paper ? "(42)" : "natural", " is ",
         judged(report_.criterion, options_), " after ", report_.iterations,
         " iterations, tol is ", settings_.tol, ": raise maxiter or tol, or use `unconverged warn`");
  ++report_.unconverged;
}

// Warm start remembers what lasts, the contacts' impulses; what the step reports has the impacts' too.
void Step::finish()
{
  if (settings_.warmstart) memory_.remember(state_);
  for (std::size_t k = 0; k < state_.impact_impulse.size(); ++k) state_.contacts[k].impulse += state_.impact_impulse[k];
  add_slide_impulses(state_, state_.friction.impact_impulse);
  tally_contacts();
}

// Overlap at q_{k+1}, and the energy the contacts took: -sum p (u^k + u^{k+1}) / 2, exact for any step.
NSCD_HOT void Step::tally_contacts()
{
  const State &s = state_;
  double overlap = 0, ratio = 0, work = tangential_work(s);
  for (std::size_t k = 0; k < s.contacts.size(); ++k) {
    const Contact &c = s.contacts[k];
    ContactInfo &info = state_.infos[k];
    work += c.impulse * (info.speed_before + normal_velocity(c, s.bodies.data()));
    const Sphere &a = s.spheres[info.atom_i];
    Vec4 separation = a.centre + s.displacement[c.i];
    double smaller = a.radius;
    if (info.atom_j >= 0) {
      const Sphere &b = s.spheres[info.atom_j];
      separation -= b.centre + s.displacement[c.j];
      info.gap = std::sqrt(dot(separation, separation)) - a.radius - b.radius;
      smaller = std::min(smaller, b.radius);
    } else {
      info.gap += dot(c.normal, s.displacement[c.i]);
    }
    overlap = std::max(overlap, -info.gap);
    ratio = std::max(ratio, -info.gap / smaller);
  }
  report_.largest_overlap = overlap;
  report_.largest_overlap_ratio = ratio;
  report_.dissipated_in_step = -0.5 * work;
  report_.dissipated += report_.dissipated_in_step;
}

void Step::write_back(const PairList &pairs)
{
  const Grains &g = state_.grains;
  double fastest2 = 0;
  for (int i = 0; i < g.owned; ++i) {
    const Body &b = state_.bodies[i];
    if (b[3] == 0) continue;
    double *x = g.x + 3 * std::size_t(i), *v = g.v + 3 * std::size_t(i), *f = g.f + 3 * std::size_t(i);
    const Vec4 moved = state_.spheres[i].centre + state_.displacement[i];
    const double per_force = state_.dt * g.force_to_acceleration * b[3];
    for (int d = 0; d < 3; ++d) {
      const double free = v[d] + f[d] * per_force;
      f[d] = (b[d] - free) / per_force;
      x[d] = moved[d];
      v[d] = b[d];
    }
    fastest2 = std::max(fastest2, b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
  }
  if (state_.friction.model != Model::frictionless) write_back_spins(state_);
  const double next = longest_move(std::sqrt(fastest2) + state_.smooth_kick);
  wants_rebuild_ = list_.too_old(state_, pairs, next);
}

}    // namespace nscd
