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

#include "../best_impulses.hpp"
#include "../nlgs.hpp"

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

// The inverse mass in a body's fourth place does not change, and stays.
NSCD_HOT void extrapolate_vectors(double share, const Range &range, Vec4 *vectors, Vec4 *last)
{
  for (std::size_t i = range.first; i < range.last; ++i) {
    const Vec4 now = vectors[i];
    vectors[i] = now + (now - last[i]) * share;
    last[i] = now;
  }
}

// Bodies and their spins, as they were at the start and as the last sweep left them, to extrapolate from.
//
// Round-off between them and the impulses grows by 1 / (1 - beta): `restore` gives bodies that carry their impulses.
class BodyMomentum {
 public:
  // `kept`: room for them.
  BodyMomentum(Problem &problem, AlignedVector<Vec4> &kept) :
      problem_(problem), kept_(kept), count_(problem.bodies.size())
  {
    kept.clear();
    for (int copies = 0; copies < 2; ++copies) {
      kept.insert(kept.end(), problem.bodies.begin(), problem.bodies.end());
      if (problem.sliding.spins) kept.insert(kept.end(), problem.sliding.spins, problem.sliding.spins + count_);
    }
  }

  void extrapolate(double share)
  {
    Vec4 *const last = kept_.data() + kept_each();
    in_chunks(problem_.team, count_, [&](const Range &range, int) {
      extrapolate_vectors(share, range, problem_.bodies.data(), last);
      if (problem_.sliding.spins) extrapolate_vectors(share, range, problem_.sliding.spins, last + count_);
    });
  }

  // add(k) hands contact k's bodies what it has gained since the start. The last sweep is moved along, or the next one
  // would take the correction for momentum.
  template <class Add>
  void restore(Add add)
  {
    const Vec4 *const first = kept_.data();
    move_last(-1);
    std::copy(first, first + count_, problem_.bodies.begin());
    if (problem_.sliding.spins) std::copy(first + count_, first + 2 * count_, problem_.sliding.spins);
    change_across(problem_.halo, problem_.bodies, problem_.sliding.spins, [&] {
      for (std::size_t k = 0; k < problem_.contacts.size(); ++k) add(k);
    });
    move_last(1);
  }

 private:
  // By the bodies' own velocities; the inverse masses come back.
  void move_last(double sign)
  {
    Vec4 *const last = kept_.data() + kept_each();
    for (std::size_t i = 0; i < count_; ++i) {
      last[i] += problem_.bodies[i] * sign;
      if (problem_.sliding.spins) last[count_ + i] += problem_.sliding.spins[i] * sign;
    }
  }

  std::size_t kept_each() const { return problem_.sliding.spins ? 2 * count_ : count_; }

  Problem &problem_;
  AlignedVector<Vec4> &kept_;
  const std::size_t count_;
};

// An exact visit along the normal that leaves the impulse as large as the tangential one needs it.
struct AtLeast : Pdas {
  static constexpr bool carries_velocity = true;
  static Local visit(Local now, double v, double w_inverse, double)
  {
    return {std::max(now.velocity, now.impulse - v * w_inverse), now.velocity};
  }
};

template <class M>
void find_least_normals(const Problem &problem, double *least)
{
  const auto *const slides = problem.sliding.slides<M>();
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const double needed = slides[k].mu > 0 ? length(slides[k].impulse) / slides[k].mu : 0;
    least[k] = std::min(needed, problem.contacts[k].impulse);
  }
}

NSCD_HOT double largest_approach(const Problem &problem)
{
  double largest = 0;
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    largest = std::max(largest, -(normal_velocity(c, problem.bodies.data()) + c.bias) * problem.per_approach[k]);
  }
  return problem.halo ? problem.halo->max(largest) : largest;
}

// Sweeps along the normals, as without friction, with the tangential impulses as they are: until no contact approaches
// faster than it may. Friction makes that slow, and is not worth it (docs/friction.md). Returns how many.
int part_normals(Problem &problem)
{
  constexpr int most = 300, looked_every = 8;
  const std::size_t n = problem.contacts.size();
  std::vector<double> &numbers = problem.workspace.normals;   // impulses before the last sweep, and the least ones
  numbers.resize(2 * n);
  double *const least = numbers.data() + n;
  for (std::size_t k = 0; k < n; ++k) numbers[k] = problem.contacts[k].impulse;
  with_friction(problem.sliding.model, [&]<class M>(M) { find_least_normals<M>(problem, least); });
  Pace pace(false);
  pace.momentum.previous = numbers.data();
  BodyMomentum bodies(problem, problem.workspace.more_vectors);
  int sweeps = 0;
  const auto some = [&](const Range &range) { return sweep<AtLeast, true>(problem, range, least, 1, pace.momentum); };
  do {
    for (int k = 0; k < looked_every; ++k, ++sweeps) {
      bodies.extrapolate(pace.momentum.share());
      pace.look(sweep_across(problem, some));
    }
  } while (sweeps < most && !(largest_approach(problem) <= 1));
  return sweeps;
}

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
    Criterion seen = measure_across(problem, goal);
    if constexpr (std::remove_reference_t<Best>::keeps)
      if (is_met_by_sums(seen, goal) && seen.approach > 1) {
        extra += part_normals(problem);
        pace.momentum.restart();
        seen = measure_across(problem, goal);
      }
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

const RegisterSolver registered({60, "apgs", "APGS", "global", "", 0, true, true, apgs, matrix_apgs});

}    // namespace

}    // namespace nscd
