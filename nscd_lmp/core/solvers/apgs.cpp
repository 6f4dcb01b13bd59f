// APGS: accelerated projected Gauss-Seidel, sweeps of NLGS-PDAS with Nesterov's momentum (momentum.hpp).
//
//   y = x_k + beta_k (x_k - x_{k-1}),  x_{k+1} = one sweep of exact visits from y
//
// Needs the square root of NLGS' sweeps, about: error modes of a force chain that a sweep shrinks by 1 - c shrink by
// 1 - sqrt(c). Each costs 1.1 sweeps of NLGS, 1.5 with friction.
// Makes exact: the motion, p >= 0 and |p_t| <= mu p_n.
// Fails: Gauss-Seidel's sweep is no gradient step, so momentum has no proof; restarts keep it on course.
//
// Source: Nesterov (1983) for the momentum; Mazhar et al. (2015) use it with gradient steps (APGD), which need about as
// many iterations as APGS sweeps to low accuracy and more to high (docs/solvers.md).
#include "../local/pdas.hpp"

#include "../nlgs.hpp"

#include <algorithm>

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

// The inverse mass in a body's fourth place does not change, and stays.
NSCD_HOT void extrapolate_vectors(double share, std::size_t count, Vec4 *vectors, Vec4 *last)
{
  for (std::size_t i = 0; i < count; ++i) {
    const Vec4 now = vectors[i];
    vectors[i] = now + (now - last[i]) * share;
    last[i] = now;
  }
}

// Bodies and their spins as the last sweep left them, to extrapolate from.
class BodyMomentum {
 public:
  explicit BodyMomentum(Problem &problem) : problem_(problem), count_(problem.bodies.size())
  {
    AlignedVector<Vec4> &kept = problem.workspace.vectors;
    kept.assign(problem.bodies.begin(), problem.bodies.end());
    if (problem.sliding.spins) kept.insert(kept.end(), problem.sliding.spins, problem.sliding.spins + count_);
  }

  void extrapolate(double share)
  {
    Vec4 *const last = problem_.workspace.vectors.data();
    extrapolate_vectors(share, count_, problem_.bodies.data(), last);
    if (problem_.sliding.spins) extrapolate_vectors(share, count_, problem_.sliding.spins, last + count_);
  }

 private:
  Problem &problem_;
  const std::size_t count_;
};

// sweep(momentum, share) sweeps once; the workspace holds the start impulses.
template <class Sweep>
SolverReport accelerate(Problem &problem, const SolverOptions &options, Sweep sweep)
{
  Pace pace(problem.sliding.model != Model::frictionless);
  pace.momentum.previous = problem.workspace.numbers.data();
  BodyMomentum bodies(problem);
  const auto once = [&] {
    bodies.extrapolate(pace.momentum.share());
    return pace.look(sweep(pace.momentum, pace.share()));
  };
  return iterate({problem.contacts.size(), problem.free_norm}, options, once, [&] { return measure(problem); });
}

template <class M>
SolverReport apgs_with_friction(Problem &problem, const SolverOptions &options)
{
  using Tangent = typename M::Tangent;
  problem.workspace.numbers.resize(problem.contacts.size() * carried_doubles<Tangent>);
  double *place = problem.workspace.numbers.data();
  for (std::size_t k = 0; k < problem.contacts.size(); ++k, place += carried_doubles<Tangent>)
    store_carried<Tangent>(place, {problem.contacts[k].impulse, problem.sliding.slides<M>()[k].impulse});
  return accelerate(problem, options, [&](const Momentum &momentum, double share) {
    return frictional_sweep<Pdas, M, true>(problem, nullptr, 1, share, momentum);
  });
}

SolverReport apgs_without_friction(Problem &problem, const SolverOptions &options)
{
  problem.workspace.numbers.resize(problem.contacts.size());
  for (std::size_t k = 0; k < problem.contacts.size(); ++k)
    problem.workspace.numbers[k] = problem.contacts[k].impulse;
  return accelerate(problem, options, [&](const Momentum &momentum, double) {
    return sweep<Exact, true>(problem, nullptr, 1, momentum);
  });
}

SolverReport apgs(Problem &problem, const SolverOptions &options)
{
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
    report = iterate({problem.contacts(), free_norm(problem)}, options, once, [&] { return sweeps.look(); });
  });
  return report;
}

const RegisterSolver registered({60, "apgs", "APGS", "global", "", 0, true, apgs, matrix_apgs});

}    // namespace

}    // namespace nscd
