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
#pragma once

#include "solver/best_impulses.hpp"
#include "solver/body_momentum.hpp"
#include "solver/local/pdas.hpp"
#include "solver/nlgs.hpp"
#include "solver/normal_sweeps.hpp"

#include <algorithm>
#include <utility>

namespace nscd {

// PDAS' exact visit without its branch: under momentum contacts change sides often, and a wrong guess costs more than
// the wait for the maximum.
struct ExactVisit : Pdas {
  static Local visit(Local now, double v, double w_inverse, double)
  {
    return {std::max(0.0, now.impulse - v * w_inverse), 0};
  }
};

constexpr int restored_every = 200;  // sweeps: a pass over the contacts costs nothing then

template <class M>
Criterion measure_with_parts(Problem &problem, const M &mechanics, const SolverOptions &options, const Goal &goal,
                             int &extra)
{
  if constexpr (M::parts > 0) return measure_parted(problem, mechanics, options, goal, extra);
  else return measure_across(problem, mechanics, goal);
}

// sweep(range, momentum, share) sweeps over some of the contacts; add(k) is as above. The workspace starts with the
// impulses of the last sweep.
// What looks solved is looked at again with bodies that carry their impulses.
template <class M, class Sweep, class Add, class Best = KeepNone>
SolverReport accelerate(Problem &problem, const M &mechanics, const SolverOptions &options, Sweep sweep, Add add,
                        Best &&best = {})
{
  int extra = 0;   // sweeps along normals alone
  Pace pace(M::parts > 0);
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
    const Criterion seen = measure_with_parts(problem, mechanics, options, goal, extra);
    problem.sums_paper = true;
    if (extra > before) pace.momentum.restart();
    if (!meets(seen, goal)) return seen;
    bodies.restore(add);
    const bool islands = std::exchange(problem.judges_islands, false);   // they have changed by round-off alone
    Criterion again = measure_across(problem, mechanics, goal);
    problem.judges_islands = islands;
    again.island = std::max(again.island, seen.island);
    return again;
  };
  SolverReport report = iterate(extent(problem), options, once, look, best);
  report.iterations += extra;
  if (report.converged) return report;
  bodies.restore(add);
  report.criterion = measure_across(problem, mechanics, options.goal());
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
      swept.against += bound_of_row<F>(problem_.diagonals[i / F::dim], int(i % F::dim)) * (start_[i] - problem_.p[i]) *
          (problem_.p[i] - now_[i]);
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

struct Apgs {
  static constexpr double default_parameter = 0;

  template <class M>
  static SolverReport solve(Problem &problem, const M &mechanics, const SolverOptions &options)
  {
    SplitMasses split(problem);
    if constexpr (M::parts == 0) return without_friction(problem, mechanics, options);
    else return with_parts(problem, mechanics, options);
  }

  template <class F>
  static SolverReport solve(GlobalProblem &problem, const F &, const SolverOptions &options)
  {
    find_diagonals<F>(problem);
    MatrixMomentum<F> sweeps(problem);
    Pace pace(F::dim > 1);
    const auto once = [&] { return pace.look(sweeps.sweep(pace.momentum, pace.share())); };
    const auto look = [&](const Goal &) { return sweeps.look(); };
    const Extent all{problem.contacts(), free_norm(problem)};
    if constexpr (F::dim > 1) return iterate(all, options, once, look, BestMatrixImpulses(problem));
    else return iterate(all, options, once, look);
  }

 private:
  // In problem.workspace.numbers: impulses of the last sweep, then those of the start.
  template <class M>
  static SolverReport with_parts(Problem &problem, const M &mechanics, const SolverOptions &options)
  {
    using Tangent = typename M::Tangent;
    using Vector = typename M::Vector;
    const std::size_t n = problem.contacts.size(), width = carried_doubles<Tangent>;
    std::vector<double> &numbers = problem.workspace.numbers;
    numbers.resize(2 * n * width);
    for (std::size_t k = 0; k < 2 * n; ++k)
      store_carried<Tangent>(&numbers[k * width], mechanics.impulse(problem.contacts[k % n], k % n));
    const auto sweep = [&](const Range &range, const Momentum &momentum, double share) {
      return frictional_sweep<Pdas, M, true>(problem, mechanics, range, nullptr, 1, share, momentum);
    };
    const auto add = [&](std::size_t k) {
      const Vector start = load_carried<Tangent>(&numbers[(n + k) * width]);
      const Vector now = mechanics.impulse(problem.contacts[k], k);
      mechanics.push(problem.contacts[k], k, {now.n - start.n, now.t - start.t});
    };
    return accelerate(problem, mechanics, options, sweep, add, BestImpulses<M>(problem, mechanics));
  }

  template <class M>
  static SolverReport without_friction(Problem &problem, const M &mechanics, const SolverOptions &options)
  {
    const std::size_t n = problem.contacts.size();
    std::vector<double> &numbers = problem.workspace.numbers;
    numbers.resize(2 * n);
    for (std::size_t k = 0; k < 2 * n; ++k) numbers[k] = problem.contacts[k % n].impulse;
    const auto sweep_some = [&](const Range &range, const Momentum &momentum, double) {
      return sweep<ExactVisit, true>(problem, range, nullptr, 1, momentum);
    };
    return accelerate(problem, mechanics, options, sweep_some, [&](std::size_t k) {
      const Contact &c = problem.contacts[k];
      apply_impulse(c, c.impulse - numbers[n + k], problem.bodies.data());
    });
  }
};

}    // namespace nscd
