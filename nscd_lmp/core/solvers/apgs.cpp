// APGS: accelerated projected Gauss-Seidel, sweeps of NLGS-PDAS with Nesterov's momentum (momentum.hpp).
//
//   y = x_k + beta_k (x_k - x_{k-1}),  x_{k+1} = one sweep of exact visits from y
//
// Needs the square root of NLGS' sweeps, about: error modes of a force chain that a sweep shrinks by 1 - c shrink by
// 1 - sqrt(c). Costs 1.1 to 1.2 sweeps of NLGS each.
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
    extrapolate(share, problem_.bodies.data(), last);
    if (problem_.sliding.spins) extrapolate(share, problem_.sliding.spins, last + count_);
  }

 private:
  // The inverse mass in a body's fourth place does not change, and stays.
  void extrapolate(double share, Vec4 *vectors, Vec4 *last) const
  {
    for (std::size_t i = 0; i < count_; ++i) {
      const Vec4 now = vectors[i];
      vectors[i] = now + (now - last[i]) * share;
      last[i] = now;
    }
  }

  Problem &problem_;
  const std::size_t count_;
};

template <class Sweep>
SolverReport accelerate(Problem &problem, const SolverOptions &options, Sweep sweep)
{
  Momentum momentum;
  momentum.previous = problem.workspace.numbers.data();
  BodyMomentum bodies(problem);
  const auto once = [&] {
    bodies.extrapolate(momentum.share());
    const Swept swept = sweep(momentum);
    momentum.move_on(swept.against);
    return swept.corrected;
  };
  return iterate({problem.contacts.size(), problem.free_norm}, options, once, [&] { return measure(problem); });
}

template <class M>
SolverReport apgs_with_friction(Problem &problem, const SolverOptions &options)
{
  constexpr std::size_t width = carried_doubles<typename M::Tangent>;
  problem.workspace.numbers.resize(problem.contacts.size() * width);
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Split<typename M::Tangent> p{problem.contacts[k].impulse, problem.sliding.slides<M>()[k].impulse};
    store_carried<typename M::Tangent>(&problem.workspace.numbers[k * width], p);
  }
  return accelerate(problem, options, [&](const Momentum &momentum) {
    return frictional_sweep<Pdas, M, true>(problem, nullptr, 1, 1, momentum);
  });
}

SolverReport apgs(Problem &problem, const SolverOptions &options)
{
  SolverReport report;
  if (problem.sliding.model == Model::frictionless) {
    problem.workspace.numbers.resize(problem.contacts.size());
    for (std::size_t k = 0; k < problem.contacts.size(); ++k)
      problem.workspace.numbers[k] = problem.contacts[k].impulse;
    return accelerate(problem, options,
                      [&](const Momentum &momentum) { return sweep<Pdas, true>(problem, nullptr, 1, momentum); });
  }
  with_friction(problem.sliding.model, [&]<class M>(M) { report = apgs_with_friction<M>(problem, options); });
  return report;
}

// The same on the rows of a matrix.
SolverReport matrix_apgs(GlobalProblem &problem, const SolverOptions &options)
{
  SolverReport report;
  find_diagonals(problem);
  with_frame(problem.dim(), [&]<class F>(F) {
    MatrixSweeps<Pdas, F> sweeps(problem, 1);
    Momentum momentum;
    std::vector<double> last(problem.p.begin(), problem.p.end()), start(last), kept(last);
    const auto once = [&] {
      for (std::size_t i = 0; i < last.size(); ++i) {
        kept[i] = problem.p[i];
        start[i] = problem.p[i] += momentum.share() * (problem.p[i] - last[i]);
      }
      const double corrected = sweeps.sweep(1);
      double against = 0;
      for (std::size_t i = 0; i < last.size(); ++i) {
        const Diagonal &d = problem.diagonals[i / F::dim];
        against += (i % F::dim ? d.wt : d.w) * (start[i] - problem.p[i]) * (problem.p[i] - kept[i]);
      }
      last = kept;
      momentum.move_on(against);
      return corrected;
    };
    report = iterate({problem.contacts(), free_norm(problem)}, options, once, [&] { return sweeps.look(); });
  });
  return report;
}

const RegisterSolver registered({60, "apgs", "APGS", "global", "", 0, true, apgs, matrix_apgs});

}    // namespace

}    // namespace nscd
