// SPDX-License-Identifier: GPL-2.0-or-later
// The contact problems of a step: what of the state a solver is handed, and what came of it.
#pragma once

#include "parallel/halo.hpp"
#include "parallel/team.hpp"
#include "scene/state.hpp"
#include "solver/solver.hpp"
#include "step/energy_limit.hpp"

#include <functional>
#include <memory>
#include <span>

namespace nscd {

// Takes the place of the built-in solver: reads the first `contacts` contacts (all of the step's, or those of a round
// of impacts), overwrites their start impulses (N s; per contact N, or N, T1[, T2] along tangents()).
using CustomSolver = std::function<void(const State &, std::size_t contacts, std::span<double>)>;

class Solves {
 public:
  // The contacts of one solve.
  struct Part {
    std::size_t contacts;  // the first ones of the step
    bool restitution;      // whether the biases hold it
    double norm;           // of free velocities and biases
    double tol = 1;        // of the step's
  };
  // Of the solves of a step so far.
  struct Outcome {
    int iterations = 0;
    double seconds = 0;
    Criterion criterion{};        // of the last solve, or of the one that failed
    bool converged = true;        // or accepted
    bool accepted = false;        // above tol, but good enough for the sweeps that it has cost
    bool energy_limited = false;  // impulses were scaled back, since they made energy
  };

  // `looks_ahead`: biases give overlaps back. What is handed in must outlive it.
  Solves(State &state, const Settings &settings, CustomSolver custom, bool looks_ahead);

  void begin_step();
  // An answer is accepted, or not, in each round anew.
  void begin_round() { outcome_.accepted = false; }
  // The solves so far are given up, and only what they cost counts.
  void take_back();
  // The solves from here on share a budget.
  void begin_budget() { started_at_ = outcome_.iterations; }

  // A few sweeps, to see which pairs they drive together before more are spent on contacts that are not all there yet.
  // Returns whether they have solved the step. No energy limit: what it looks for, steps that are given up and impacts,
  // is not among them.
  bool sweep_briefly(const Part &part, int sweeps);
  // What is given up or accepted, and with friction Newton's law, is kept from making energy; what a custom solver
  // answers is taken as it is.
  void solve(const Part &part, EnergyLimit::From from);

  const Outcome &outcome() const { return outcome_; }
  const SolverOptions &options() const { return options_; }
  bool is_custom() const { return bool(custom_); }
  // Whether contacts may be solved before all of them are known: another round then costs less than the first.
  bool can_go_on() const { return !custom_ && solver_->ranks; }

 private:
  bool solve_part(const Part &part, int maxiter);
  void share_among_threads(std::size_t contacts);
  Problem problem_of(const Part &part);
  SolverReport solve_problem(Problem &problem, const SolverOptions &options);
  void refuse_diverged(const SolverReport &solved) const;
  void add(const SolverReport &solved);
  void ask_custom(std::size_t count);

  State &state_;
  const Settings &settings_;
  const SolverEntry *solver_;
  const CustomSolver custom_;
  const std::unique_ptr<Team> team_;   // none on one thread
  const bool looks_ahead_;
  SolverOptions options_;
  Workspace workspace_;
  EnergyLimit energy_limit_;
  Outcome outcome_;
  bool shared_among_threads_ = false;  // the contacts that are being solved
  int started_at_ = 0;                 // iterations of the step before the solves that share a budget
};

}    // namespace nscd
