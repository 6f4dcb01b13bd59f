#include "step/step.hpp"

#include "base/error.hpp"
#include "base/hot.hpp"
#include "problem/closer_look.hpp"
#include "scene/copies.hpp"
#include "scene/detection.hpp"
#include "scene/gather.hpp"
#include "scene/planar.hpp"
#include "scene/slides.hpp"
#include "solver/across_ranks.hpp"
#include "step/approach_bound.hpp"

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

Step::Step(const Settings &settings, CustomSolver custom, int dimension, Ranks *ranks) :
    settings_(checked(settings, dimension)), solver_(&find_solver(settings_.solver)), custom_(std::move(custom)),
    law_(find_law(settings_.law).make()), state_{.settings = settings_, .grains = {}, .dimension = dimension},
    halo_(ranks && ranks->count() > 1 ? std::make_unique<Halo>(*ranks) : nullptr),
    team_(settings_.threads > 1 ? std::make_unique<Team>(settings_.threads) : nullptr),
    prediction_(law_->prediction(settings_)), look_ahead_(find_law(settings_.law).looks_ahead ? 1 : 0),
    sought_(looks_ahead() && !law_->resolves_impacts(settings_) && !custom_ && solver_->ranks
                ? Sought::foreseen : Sought::within_reach),
    crowding_(nscd::crowding(settings_.threads, ranks))
{
  state_.halo = halo_.get();
  state_.slabs = Slabs(settings_.threads);
  options_.tol = *settings_.tol;
  options_.stop = *settings_.criterion;
  (options_.stop == Stop::natural ? state_.tol_of_worth : state_.tol_absolute) = options_.tol;
  options_.maxiter = settings_.maxiter;
  options_.budget = budget_of(settings_);
  options_.parameter = solver_parameter(settings_, *solver_);
  const Inertia inertia = settings_.inertia.value_or(dimension == 2 ? Inertia::disc : Inertia::sphere);
  state_.friction.model = choose_model(settings_, dimension);
  state_.table.open_slides(state_.friction.model);
  state_.friction.spin_response = inertia == Inertia::disc ? disc_spin_response : sphere_spin_response;
}

void Step::begin_run(bool list_just_built)
{
  report_ = {};
  left_.forget();
  drifts_.begin_run();
  if (list_just_built) list_.expect_new_list();
}

const StepReport &Step::advance(const Grains &grains, const PairList &pairs, double dt)
{
  const auto start = Clock::now();
  if (!(dt > 0 && std::isfinite(dt))) fail("the timestep is ", dt, ": it must be > 0");
  state_.dt = dt;
  state_.lasting_moment = law_->moment() * dt;
  state_.grains = grains;
  pairs_ = &pairs;
  prepare(pairs);
  together([&] { detect(state_, pairs, sought_); });
  solve();
  finish();
  write_back();
  if (grains.watched) left_.remember(state_);
  remarks_.add(report_, options_.stop);
  report_.seconds_contacts = seconds(start, Clock::now()) - report_.seconds_solver;
  return report_;
}

void Step::together(const std::function<void()> &local)
{
  if (halo_) halo_->together(local);
  else local();
}

// From arrays to bodies and spheres, here and of other ranks.
void Step::prepare(const PairList &pairs)
{
  Largest largest;
  double reduced[7];
  auto &[kick2, speed2, moved, unlisted, smallest, torque, grown] = reduced;
  hold_still(state_.grains);
  together([&] {
    if (state_.dimension == 2) require_planar(state_);
    list_.inspect(state_, pairs);
    if (state_.grains.watched) left_.require(state_, list_.is_new());
  });
  if (list_.is_new()) state_.slabs.forget();
  if (halo_ && list_.is_new()) {
    plan_copies(state_);
    if (settings_.warmstart) memory_.follow_grains(*halo_, state_.friction.model);
  }
  belts_.find(state_, looks_ahead());
  together([&] { largest = gather_owned(state_, prediction_, look_ahead_); });
  grown = drifts_.look(state_, list_.is_new());
  kick2 = largest.kick2, speed2 = largest.speed2, moved = list_.farthest_moved(state_), unlisted = -pairs.reach;
  smallest = -largest.smallest_radius;
  torque = !remarks_.tell_of_torque() && has_unread_torque(state_.grains);
  if (halo_) {
    share_motion(state_);
    halo_->max(reduced);
  }
  gather_images(state_, prediction_, look_ahead_, {kick2, speed2});
  drifts_.settle(state_, grown > 0, list_.is_new());
  drifts_.place(state_, state_.dt * prediction_, look_ahead_);
  listed_ = -unlisted;
  report_.unread_torque = torque > 0;
  moved_ = moved + 0.5 * drifts_.neared();
  const double speed = std::sqrt(speed2) + state_.drift.fastest;
  state_.round_off = 1e-14 * speed;
  report_.largest_move_ratio = state_.dt * speed / -smallest;
  missed_.begin(pairs, listed_);
  require_list(speed);
}

// Biases and start impulses of the contacts from `first` on; `again`: those before have theirs.
NSCD_HOT void Step::start_contacts(std::size_t first, bool again)
{
  law_->set_bias(state_, first);
  set_tangential_bias(state_, first, law_->tangential_restitution_in_bias(settings_));
  const double added = keep_free_velocities(state_, first, state_.table.contacts.size());
  free_norm_ = std::hypot(again ? free_norm_ : 0, added);
  bound_approach(state_, first);
  if (!settings_.warmstart) return;
  change_across(halo_.get(), state_.bodies, state_.friction.spins.data(), [&] { memory_.recall(state_, first); });
}

// Biases once the law has turned some contacts.
void Step::start_turned()
{
  law_->set_bias(state_, 0);
  set_tangential_bias(state_, 0, law_->tangential_restitution_in_bias(settings_));
  bound_approach(state_, 0);
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

// Puts the first contacts in the threads' order, if there are enough of them: few are swept faster by one thread than
// threads tell each other so.
void Step::share_among_threads(std::size_t contacts)
{
  constexpr std::size_t worth_a_thread = 1000;
  shared_among_threads_ = team_ && contacts >= worth_a_thread * std::size_t(team_->size());
  if (!shared_among_threads_) return;
  const bool moved = state_.slabs.order_contacts(state_, contacts);
  if (moved && halo_) halo_->find_touching(state_.table.contacts);
}

// What is given up or accepted, and with friction Newton's law, is kept from making energy; what a custom solver
// answers is taken as it is.
void Step::solve_within_energy(const Part &part, EnergyLimit::From from)
{
  share_among_threads(part.contacts);
  const bool newton = state_.friction.model != Model::frictionless && part.e != part.e_t;
  const bool before = std::exchange(report_.accepted, false);   // of impacts
  const auto solve = [&] { return solve_part(part, options_.maxiter); };
  const auto go_on = [&] {
    if (!std::exchange(report_.accepted, false)) return false;
    const Budget budget = std::exchange(options_.budget, {});
    const bool solved = solve();
    options_.budget = budget;
    return solved;
  };
  const bool gives_back = looks_ahead() && from == EnergyLimit::From::step;
  if (custom_) solve();
  else energy_limited_ |= energy_limit_.solve(state_, part.contacts, newton, from, gives_back, solve,
                                                std::ref(go_on));   // as a copy it would be allocated
  report_.accepted |= before;
}

SolverReport Step::solve_problem(Problem &problem, const SolverOptions &options)
{
  if (!custom_ && (!halo_ || solver_->ranks)) return solver_->solve(problem, options);
  if (halo_)
    return solve_by_ranks(problem, options, [&] {
      Problem own = problem;
      own.halo = nullptr;
      if (custom_) ask_custom(problem.contacts.size());
      else solver_->solve(own, options);
    });
  ask_custom(problem.contacts.size());
  SolverReport solved{.iterations = 1, .criterion = measure(problem)};
  solved.converged = nscd::solved(solved.criterion, options);
  return solved;
}

// Returns whether it is solved, not just accepted.
bool Step::solve_part(const Part &part, int maxiter)
{
  const auto start = Clock::now();
  const std::span contacts = std::span(state_.table.contacts).first(part.contacts);
  Problem problem{state_.bodies, contacts, part.e, part.norm, workspace_, sliding(state_, part.e_t),
                  halo_.get()};
  problem.round_off = state_.round_off;
  problem.infos = std::span(state_.table.infos).first(part.contacts);
  if (settings_.overlap) problem.per_approach = std::span(state_.table.per_approach).first(part.contacts);
  problem.judges_contacts = true;
  problem.judges_islands = options_.stop == Stop::natural;
  SolverOptions options = options_;
  options.tol *= part.tol;
  problem.goal = options.goal();
  if (shared_among_threads_) {
    problem.team = team_.get();
    problem.parts = &state_.slabs.parts();
  }
  options.maxiter = maxiter;
  options.goes_on = maxiter < options_.maxiter;
  options.budget.spent = report_.iterations - started_at_;
  SolverReport solved = solve_problem(problem, options);
  if (!solved.converged && maxiter == options_.maxiter) {   // it is told how far off; what is swept briefly goes on
    problem.goal.worst = INFINITY;
    look_closer(problem, solved.criterion);
  }
  report_.seconds_solver += seconds(start, Clock::now());
  if (!std::isfinite(solved.criterion.total()))
    fail("solver ", settings_.solver,
         " diverged: the criterion is not a number; take another solver, or rho or gamma closer to its default");
  if (solved.ran_away)
    fail("solver ", settings_.solver, " diverged: impulses ran away, and what they rounded off is in the velocities; "
         "take another solver, or rho or gamma closer to its default");
  report_.iterations += solved.iterations;
  // The criterion of the last solve, or of the one that failed.
  if (report_.converged || !solved.converged) report_.criterion = solved.criterion;
  report_.converged = report_.converged && solved.converged;
  report_.accepted |= solved.accepted;
  return solved.converged && !solved.accepted;
}

void Step::judge()
{
  const Criterion &seen = report_.criterion;
  report_.accepted_steps += report_.converged && report_.accepted;
  if (report_.converged) return;
  ++report_.unconverged;
  if (settings_.unconverged != Unconverged::error) return;
  if (report_.jammed) fail("step not solved: ", nothing_gives_way, ", or use `unconverged warn`");
  const std::string_view remedy = "use `unconverged warn`";
  if (judged(seen, options_) >= options_.tol)
    fail("step not solved: criterion ", options_.stop == Stop::paper ? "(42)" : "natural", " is ",
         judged(seen, options_), " after ", report_.iterations, " iterations, tol is ", options_.tol,
         ": raise maxiter or tol, or ", remedy);
  if (seen.approach > 1)
    fail("step not solved: after ", report_.iterations, " iterations a contact approaches ", seen.approach,
         " times as fast as overlap ", *settings_.overlap, " allows: raise maxiter or overlap, or ", remedy);
  fail("step not solved: after ", report_.iterations, " iterations a contact is off by ", seen.worst,
       " of what its velocity is worth, more than ", off_of_solved, ": raise maxiter, or ", remedy);
}

}    // namespace nscd
