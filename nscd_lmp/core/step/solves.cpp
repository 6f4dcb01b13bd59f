// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/solves.hpp"

#include "base/error.hpp"
#include "problem/closer_look.hpp"
#include "scene/slides.hpp"
#include "solver/across_ranks.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace nscd {

using Clock = std::chrono::steady_clock;

static SolverOptions options_of(const Settings &settings, const SolverEntry &solver)
{
  SolverOptions options;
  options.tol = *settings.tol;
  options.stop = *settings.criterion;
  options.maxiter = settings.maxiter;
  options.budget = budget_of(settings);
  options.parameter = solver_parameter(settings, solver);
  return options;
}

Solves::Solves(State &state, const Settings &settings, CustomSolver custom, bool looks_ahead) :
    state_(state), settings_(settings), solver_(&find_solver(settings.solver)), custom_(std::move(custom)),
    team_(settings.threads > 1 ? std::make_unique<Team>(settings.threads) : nullptr), looks_ahead_(looks_ahead),
    options_(options_of(settings, *solver_))
{
}

void Solves::begin_step()
{
  outcome_ = {};
  started_at_ = 0;
}

void Solves::take_back()
{
  outcome_.converged = true;
  outcome_.energy_limited = false;
}

// A custom solver is shown the bodies without the impulses that it is to find.
void Solves::ask_custom(std::size_t count)
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
void Solves::share_among_threads(std::size_t contacts)
{
  constexpr std::size_t worth_a_thread = 1000;
  shared_among_threads_ = team_ && contacts >= worth_a_thread * std::size_t(team_->size());
  if (!shared_among_threads_) return;
  const bool moved = state_.exec.slabs.order_contacts(state_, contacts);
  if (moved && state_.exec.halo) state_.exec.halo->find_touching(state_.table.contacts);
}

bool Solves::sweep_briefly(const Part &part, int sweeps)
{
  share_among_threads(part.contacts);
  const bool solved = solve_part(part, std::min(sweeps, options_.maxiter));
  outcome_.converged = true;   // that is not known yet
  return solved;
}

void Solves::solve(const Part &part, EnergyLimit::From from)
{
  share_among_threads(part.contacts);
  const bool newton = part.restitution && state_.in.materials.may_make_energy();
  const bool before = std::exchange(outcome_.accepted, false);   // of impacts
  const auto solve_all = [&] { return solve_part(part, options_.maxiter); };
  const auto go_on = [&] {
    if (!std::exchange(outcome_.accepted, false)) return false;
    const Budget budget = std::exchange(options_.budget, {});
    const bool solved = solve_all();
    options_.budget = budget;
    return solved;
  };
  const bool gives_back = looks_ahead_ && from == EnergyLimit::From::step;
  if (custom_) solve_all();
  else outcome_.energy_limited |= energy_limit_.solve(state_, part.contacts, newton, from, gives_back, solve_all,
                                                      std::ref(go_on));   // as a copy it would be allocated
  outcome_.accepted |= before;
}

SolverReport Solves::solve_problem(Problem &problem, const SolverOptions &options)
{
  if (!custom_ && (!state_.exec.halo || solver_->ranks)) return solver_->solve(problem, options);
  if (state_.exec.halo)
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

Problem Solves::problem_of(const Part &part)
{
  const std::span contacts = std::span(state_.table.contacts).first(part.contacts);
  Problem problem{state_.motion.bodies, contacts, part.norm, workspace_, sliding(state_), state_.exec.halo};
  const std::span numbers(state_.table.material);
  if (part.restitution) problem.restitution = {numbers.first(part.contacts), state_.in.materials.all()};
  problem.round_off = state_.scales.round_off;
  problem.infos = std::span(state_.table.infos).first(part.contacts);
  if (settings_.overlap) problem.per_approach = std::span(state_.table.per_approach).first(part.contacts);
  problem.judges_contacts = true;
  problem.judges_islands = options_.stop == Stop::natural;
  if (shared_among_threads_) {
    problem.team = team_.get();
    problem.parts = &state_.exec.slabs.parts();
  }
  return problem;
}

// Returns whether it is solved, not just accepted.
bool Solves::solve_part(const Part &part, int maxiter)
{
  const auto start = Clock::now();
  Problem problem = problem_of(part);
  SolverOptions options = options_;
  options.tol *= part.tol;
  problem.goal = options.goal();
  options.maxiter = maxiter;
  options.goes_on = maxiter < options_.maxiter;
  options.budget.spent = outcome_.iterations - started_at_;
  SolverReport solved = solve_problem(problem, options);
  if (!solved.converged && maxiter == options_.maxiter) {   // it is told how far off; what is swept briefly goes on
    problem.goal.worst = INFINITY;
    look_closer(problem, solved.criterion);
  }
  outcome_.seconds += std::chrono::duration<double>(Clock::now() - start).count();
  refuse_diverged(solved);
  add(solved);
  return solved.converged && !solved.accepted;
}

void Solves::refuse_diverged(const SolverReport &solved) const
{
  if (!std::isfinite(solved.criterion.total()))
    fail("solver ", settings_.solver,
         " diverged: the criterion is not a number; take another solver, or rho or gamma closer to its default");
  if (solved.ran_away)
    fail("solver ", settings_.solver, " diverged: impulses ran away, and what they rounded off is in the velocities; "
         "take another solver, or rho or gamma closer to its default");
}

void Solves::add(const SolverReport &solved)
{
  outcome_.iterations += solved.iterations;
  if (outcome_.converged || !solved.converged) outcome_.criterion = solved.criterion;
  outcome_.converged = outcome_.converged && solved.converged;
  outcome_.accepted |= solved.accepted;
}

}    // namespace nscd
