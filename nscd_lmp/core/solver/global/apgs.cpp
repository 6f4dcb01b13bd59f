// SPDX-License-Identifier: GPL-2.0-or-later
// APGS: accelerated projected Gauss-Seidel, sweeps of NLGS-PDAS with Nesterov's momentum (momentum.hpp).
//
//   y = x_k + beta_k (x_k - x_{k-1}),  x_{k+1} = one sweep of exact visits from y
//
// Needs the square root of NLGS' sweeps, about: error modes of a force chain that a sweep shrinks by 1 - c shrink by
// 1 - sqrt(c). Each costs 1.1 sweeps of NLGS, 1.5 with friction.
// Makes exact: the motion, p >= 0 and |p_t| <= mu p_n.
// With friction the last approaches are stopped by sweeps along the normals alone (normal_sweeps.hpp).
// Fails: Gauss-Seidel's sweep is no gradient step, so momentum has no proof; restarts keep it on course.
//
// Source: Nesterov (1983) for the momentum; Mazhar et al. (2015) use it with gradient steps (APGD), which need about as
// many iterations as APGS sweeps to low accuracy and more to high (docs/solvers.md).
#include "solver/local/pdas.hpp"

#include "solver/best_impulses.hpp"
#include "solver/body_momentum.hpp"
#include "solver/nlgs.hpp"
#include "solver/normal_sweeps.hpp"

#include <algorithm>
#include <utility>

namespace nscd {

namespace {

// PDAS' exact visit without its branch: under momentum contacts change sides often, and a wrong guess costs more than
// the wait for the maximum.
struct Exact : Pdas {
  static Local visit(Local now, double v, double w_inverse, double)
  {
    return {std::max(0.0, now.impulse - v * w_inverse), 0};
  }
};

constexpr int restored_every = 200;  // sweeps: a pass over the contacts costs nothing then

// sweep(range, momentum, share) sweeps over some of the contacts; add(k) is as above. The workspace starts with the
// impulses of the last sweep.
// What looks solved is looked at again with bodies that carry their impulses.
template <class Sweep, class Add, class Best = KeepNone>
SolverReport accelerate(Problem &problem, const SolverOptions &options, Sweep sweep, Add add, Best &&best = {})
{
  int extra = 0;   // sweeps along normals alone
  Pace pace(problem.sliding.model != Model::frictionless);
  pace.momentum.previous = problem.workspace.numbers.data();
  BodyMomentum bodies(problem, problem.workspace.vectors);
  int sweeps = 0;
  const auto once = [&] {
    if (++sweeps % restored_every == 0) bodies.restore(add);
    bodies.extrapolate(pace.momentum.share());
    const auto some = [&](const Range &range) { return sweep(range, pace.momentum, pace.share()); };
    return pace.look(sweep_across(problem, some));
  };
  const auto look = [&](const Goal &goal) {
    const int before = extra;
    problem.sums_paper = options.stop == Stop::paper || options.history;
    const Criterion seen = std::remove_reference_t<Best>::keeps ? measure_parted(problem, options, goal, extra)
                                                                : measure_across(problem, goal);
    problem.sums_paper = true;
    if (extra > before) pace.momentum.restart();
    if (!meets(seen, goal)) return seen;
    bodies.restore(add);
    const bool islands = std::exchange(problem.judges_islands, false);   // they have changed by round-off alone
    Criterion again = measure_across(problem, goal);
    problem.judges_islands = islands;
    again.island = std::max(again.island, seen.island);
    return again;
  };
  SolverReport report = iterate(extent(problem), options, once, look, best);
  report.iterations += extra;
  if (report.converged) return report;
  bodies.restore(add);
  report.criterion = measure_across(problem, options.goal());
  return report;
}

template <class M>
SolverReport apgs_with_friction(Problem &problem, const SolverOptions &options)
{
  using Tangent = typename M::Tangent;
  const std::size_t n = problem.contacts.size(), width = carried_doubles<Tangent>;
  std::vector<double> &numbers = problem.workspace.numbers;  // impulses of the last sweep, and of the start
  numbers.resize(2 * n * width);
  auto *const slides = problem.sliding.slides<M>();
  for (std::size_t k = 0; k < 2 * n; ++k)
    store_carried<Tangent>(&numbers[k * width], {problem.contacts[k % n].impulse, slides[k % n].impulse});
  const auto sweep = [&](const Range &range, const Momentum &momentum, double share) {
    return frictional_sweep<Pdas, M, true>(problem, range, nullptr, 1, share, momentum);
  };
  const auto add = [&](std::size_t k) {
    const Contact &c = problem.contacts[k];
    const Split<Tangent> start = load_carried<Tangent>(&numbers[(n + k) * width]);
    apply_impulse(c, c.impulse - start.n, problem.bodies.data());
    apply_tangential<M>(c, slides[k].impulse - start.t, problem.sliding.spin_response, problem.bodies.data(),
                        problem.sliding.spins);
  };
  return accelerate(problem, options, sweep, add, BestImpulses<M>(problem));
}

SolverReport apgs_without_friction(Problem &problem, const SolverOptions &options)
{
  const std::size_t n = problem.contacts.size();
  std::vector<double> &numbers = problem.workspace.numbers;  // as with friction
  numbers.resize(2 * n);
  for (std::size_t k = 0; k < 2 * n; ++k) numbers[k] = problem.contacts[k % n].impulse;
  const auto sweep_some = [&](const Range &range, const Momentum &momentum, double) {
    return sweep<Exact, true>(problem, range, nullptr, 1, momentum);
  };
  return accelerate(problem, options, sweep_some, [&](std::size_t k) {
    const Contact &c = problem.contacts[k];
    apply_impulse(c, c.impulse - numbers[n + k], problem.bodies.data());
  });
}

SolverReport apgs(Problem &problem, const SolverOptions &options)
{
  SplitMasses split(problem);
  if (problem.sliding.model == Model::frictionless) return apgs_without_friction(problem, options);
  SolverReport report;
  with_friction(problem.sliding.model, [&]<class M>(M) { report = apgs_with_friction<M>(problem, options); });
  return report;
}

// The same on the rows of a matrix.
template <class F>
class MatrixMomentum {
 public:
  explicit MatrixMomentum(GlobalProblem &problem) :
      problem_(problem), sweeps_(problem, 1), last_(problem.p.begin(), problem.p.end()), start_(last_), now_(last_)
  {
  }

  Swept sweep(const Momentum &momentum, double share)
  {
    for (std::size_t i = 0; i < last_.size(); ++i) {
      now_[i] = problem_.p[i];
      start_[i] = problem_.p[i] += momentum.share() * (problem_.p[i] - last_[i]);
    }
    Swept swept{sweeps_.sweep(share), 0};
    for (std::size_t i = 0; i < last_.size(); ++i) {
      const Diagonal &d = problem_.diagonals[i / F::dim];
      swept.against += (i % F::dim ? d.wt : d.w) * (start_[i] - problem_.p[i]) * (problem_.p[i] - now_[i]);
    }
    last_.swap(now_);
    return swept;
  }

  Criterion look() { return sweeps_.look(); }

 private:
  GlobalProblem &problem_;
  MatrixSweeps<Pdas, F> sweeps_;
  std::vector<double> last_, start_, now_;
};

SolverReport matrix_apgs(GlobalProblem &problem, const SolverOptions &options)
{
  SolverReport report;
  find_diagonals(problem);
  with_frame(problem.dim(), [&]<class F>(F) {
    MatrixMomentum<F> sweeps(problem);
    Pace pace(F::dim > 1);
    const auto once = [&] { return pace.look(sweeps.sweep(pace.momentum, pace.share())); };
    const auto look = [&](const Goal &) { return sweeps.look(); };
    const Extent all{problem.contacts(), free_norm(problem)};
    if constexpr (F::dim > 1) report = iterate(all, options, once, look, BestMatrixImpulses(problem));
    else report = iterate(all, options, once, look);
  });
  return report;
}

const RegisterSolver registered({.order = 60,
                                 .name = "apgs",
                                 .title = "APGS",
                                 .kind = "global",
                                 .friction = true,
                                 .ranks = true,
                                 .solve = apgs,
                                 .solve_global = matrix_apgs});

}    // namespace

}    // namespace nscd
