// SPDX-License-Identifier: GPL-2.0-or-later
// ACTIVE SET: global primal-dual active set method with sparse LDL^T, for frictionless contacts:
//
//   0 <= p_k  perp  v_k = (W p + q)_k >= 0,     W symmetric positive semidefinite, k = 1..n,
//
// (Barboteu & Dumont 2017, section 2.2; Hintermueller, Ito, Kunisch 2002). One iteration:
//   A = {k : p_k - v_k / W_kk >= 0},   W_AA p_A = -q_A,   p = 0 outside A.
// It is Newton's method on the natural map, so the last iteration is exact: the answer has round-off as its only error.
// Ties (p = v = 0) go into A: a column at rest has q = 0 on all contacts but one, and is then one factorisation instead
// of one a contact.
//
// What is added to the paper's method, and why:
//   scaling     y = W_kk^(1/2) p, so that mass ratios of 1e6 leave a matrix S of unit diagonal.
//   sweeps      a factorisation pays only once the face is nearly known. Projected Gauss-Seidel sweeps with Nesterov's
//               momentum come first, until the contacts have kept their sides for `quiet` of them.
//   proximal    S + eps I with + eps z on the right, z the last answer. Without it a hyperstatic (rank-deficient) W has
//               no factorisation; moving z to the solution until the natural map of W itself vanishes makes the answer
//               one of S. As long as the face stays, such a step is one back-substitution.
//   old factor  the system on the face is solved by CG preconditioned with the last factor, in about as many iterations
//               as contacts changed sides, and in one (= iterative refinement) with a fresh factor.
//   safeguard   the plain method can cycle. Where the count of contacts on the wrong side has reached no new minimum in
//               `patience` steps, eps is raised and a monotone step is taken from the best feasible point met so far:
//               sweeps (twice as many each time), then a projected search towards the minimiser on their face. The
//               objective falls strictly at these steps, so no face is met twice there; the sweeps converge by
//               themselves.
//
// Fails (reported, never silent):
//   no solution   q_k < 0 on a zero row, or grains squeezed between walls with no way out: p grows as 1/eps, the
//                 natural map stays up. The best point met is returned.
//   W indefinite or far from symmetric: only its lower triangle is factorised and the safeguard needs an objective.
//   round-off     W p cancels against q. No method gets below machine precision times |W||p|: a column of 1000 grains
//                 of masses 1 and 1e6 in turn is left with 1e-9 m/s.
//   fill          a packing of n contacts takes O(n^(4/3)) memory and O(n^2) time: 2 ms for 1,500 contacts, 2 s for
//                 30,000. Beyond a few thousand contacts in three dimensions the sweeps alone are faster.
//
// Iterations are faces solved; the sweeps before the first one are not counted.
#include "base/error.hpp"
#include "solver/global/face_minimum.hpp"
#include "solver/any_mechanics.hpp"
#include "solver/global/active_set.hpp"
#include "solver/global/on_grains.hpp"
#include "solver/momentum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nscd {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

constexpr double proximal = 1e-12;    // eps; below the smallest eigenvalue of S that matters
constexpr double raise = 1e2, lower = 1e-1, largest = 1e-4;  // eps: where the method cycles; at every solved problem
constexpr int first_sweeps = 500;     // before the first face, at most
constexpr int quiet = 20;             // sweeps without a switch that end them
constexpr int patience = 3;           // faces without a new minimum of wrong sides before a monotone step
constexpr int max_idle = 6;           // proximal problems solved in a row without a gain
constexpr int first_safe_sweeps = 10, most_safe_sweeps = 1000;

class ActiveSet {
 public:
  ActiveSet(const GlobalProblem &problem, double tol, int max_faces) :
      s_(problem.w, problem.q.data()), q_(problem.q), q_norm_(free_norm(problem)), tol_(tol), max_faces_(max_faces),
      n_(s_.size()), y_(n_), proximal_{s_, proximal, Vector::Zero(n_)}, answer_(Vector::Zero(n_)), minimum_(n_)
  {
  }

  // p: in, a start; out, the impulses. Returns the faces solved.
  int solve(std::span<double> p)
  {
    for (int k = 0; k < n_; ++k) y_[k] = std::max(0.0, p[k]) * s_.root[k];
    proximal_.centre = y_;
    if (!finished(y_)) {
      sweep(first_sweeps, quiet);
      move_centre();
      if (!finished(y_)) iterate();
    }
    for (int k = 0; k < n_; ++k) p[k] = s_.root[k] > 0 ? answer_[k] / s_.root[k] : 0;
    return faces_;
  }

  bool at_round_off() const { return at_round_off_; }

 private:
  void iterate()
  {
    std::size_t fewest = none;  // contacts on the wrong side, at best
    int waited = 0;
    Face face = predicted_face();
    while (faces_ < max_faces_ && minimise_on(face)) {
      remember();
      if (finished(y_)) return;
      Face next = predicted_face();
      const std::size_t wrong = changes(face, next);
      waited = wrong < fewest ? 0 : waited + 1;
      fewest = std::min(fewest, wrong);
      if (wrong == 0) {  // the proximal problem is solved
        if (stagnates()) return;
        proximal_.eps = std::max(proximal, proximal_.eps * lower);
        move_centre();
      } else if (waited >= patience) {
        if (!monotone_step()) return;
        next = predicted_face();
      }
      if (wrong == 0 || waited >= patience) {
        fewest = none;
        waited = 0;
      }
      face.swap(next);
    }
  }

  // Round-off reached, or a problem without a solution.
  bool stagnates()
  {
    const bool gained = answer_residual_ < 0.9 * idle_residual_;
    idle_ = gained || proximal_.eps > proximal ? 0 : idle_ + 1;
    idle_residual_ = std::min(idle_residual_, answer_residual_);
    return idle_ >= max_idle;
  }

  Face predicted_face() const
  {
    Face face;
    for (int k = 0; k < n_; ++k)
      if (s_.root[k] > 0 && y_[k] - proximal_.gradient(k, y_) >= 0) face.push_back(k);
    return face;
  }

  // The natural map of W itself, at the projection of y, against tol and against the round-off of W p + q. Keeps the
  // best.
  bool finished(const Vector &y)
  {
    const Vector x = y.cwiseMax(0);
    double map = 0, round_off = 0;
    for (int k = 0; k < n_; ++k) {
      double v = s_.b[k], size = std::abs(v);
      for (auto e = s_.w.row_start[k]; e < s_.w.row_start[k + 1]; ++e) {
        const double term = s_.value[e] * x[s_.w.column[e]];
        v += term;
        size += std::abs(term);
      }
      const double root = s_.root[k];
      map += std::pow(root > 0 ? root * (x[k] < v ? x[k] : v) : std::min(q_[k], 0.0), 2);
      round_off += std::pow(root * size, 2);
    }
    const double residual = std::sqrt(map), floor = std::numeric_limits<double>::epsilon() * std::sqrt(round_off);
    if (residual < answer_residual_) {
      answer_residual_ = residual;
      answer_ = x;
    }
    at_round_off_ = residual <= floor;
    return at_round_off_ || residual <= tol_ * q_norm_;
  }

  void remember()
  {
    const Vector x = y_.cwiseMax(0);
    const double value = proximal_.objective(x);
    if (!(value < best_value_)) return;
    best_value_ = value;
    best_ = x;
  }

  // Values of earlier points no longer compare.
  void move_centre()
  {
    proximal_.centre = best_ = y_.cwiseMax(0);
    best_value_ = proximal_.objective(best_);
  }

  bool minimise_on(const Face &face)
  {
    ++faces_;
    return minimum_.find(proximal_, face, y_);
  }

  // Sweeps from the best point, then a projected search towards the minimiser on the face reached.
  bool monotone_step()
  {
    proximal_.eps = std::min(largest, proximal_.eps * raise);
    y_ = best_;
    best_value_ = proximal_.objective(best_);
    sweep(safe_sweeps_, safe_sweeps_);
    safe_sweeps_ = std::min(2 * safe_sweeps_, most_safe_sweeps);
    if (proximal_.objective(y_) > best_value_) {  // momentum may end uphill, a plain sweep cannot
      y_ = best_;
      proximal_.sweep(y_);
    }
    const Vector start = y_;
    const double value = proximal_.objective(start);
    Face face;
    for (int k = 0; k < n_; ++k)
      if (y_[k] > 0) face.push_back(k);
    if (!minimise_on(face)) return false;
    const Vector step = y_ - start;
    double t = 1;
    do {
      y_ = (start + t * step).cwiseMax(0);
      t *= 0.5;
    } while (proximal_.objective(y_) >= value && t > 1e-9);
    if (t <= 1e-9) y_ = start;
    best_ = y_;
    best_value_ = proximal_.objective(y_);
    return true;
  }

  // Sweeps with momentum until the contacts have kept their sides for `calm` of them: then the face is worth a factor.
  void sweep(int most, int calm)
  {
    Vector last = y_;
    Momentum momentum;
    for (int done = 0, kept = 0; done < most && kept < calm; ++done) {
      now_ = y_;
      y_ += momentum.share() * (y_ - last);
      start_ = y_;
      kept = proximal_.sweep(y_) ? 0 : kept + 1;
      momentum.move_on((start_ - y_).dot(y_ - now_));
      last.swap(now_);
    }
  }

  const ScaledRows s_;
  const std::span<const double> q_;
  const double q_norm_, tol_;
  const int max_faces_, n_;
  Vector y_;  // iterate
  Proximal proximal_;
  Vector best_;  // feasible point of least objective since the centre moved
  double best_value_ = infinity;
  Vector answer_;  // feasible point of least natural map
  double answer_residual_ = infinity, idle_residual_ = infinity;
  int idle_ = 0, safe_sweeps_ = first_safe_sweeps, faces_ = 0;
  bool at_round_off_ = false;
  FaceMinimum minimum_;
  Vector now_, start_;  // of sweeps
};

}    // namespace

SolverReport FactorisedFaces::solve(GlobalProblem &problem, const Frame<> &frame, const SolverOptions &options)
{
  SolverReport report;
  const std::size_t n = problem.contacts();
  if (n == 0) return report;
  find_diagonals<Frame<>>(problem);
  // (42) has impulses in it: its tol may lie below any fraction of |q|, so it gets round-off.
  const double tol = options.stop == Stop::natural ? options.tol : 0;
  ActiveSet solver(problem, tol, options.maxiter);
  report.iterations = std::max(1, solver.solve(problem.p));
  report.at_round_off = solver.at_round_off();
  std::vector<double> u(n);
  problem.w.multiply(problem.p.data(), u.data());
  for (std::size_t k = 0; k < n; ++k) u[k] += problem.q[k];
  report.criterion = measure(problem, frame, u.data(), nullptr);
  report.converged = solved(report.criterion, options);
  if (options.history) options.history->push_back(report);
  return report;
}

namespace {

const RegisterSolver registered({.order = 70,
                                 .name = "active_set",
                                 .title = "active set",
                                 .kind = "global",
                                 .friction = false,
                                 .ranks = false,
                                 .solve = on_any_grains<Assembled<FactorisedFaces>>,
                                 .solve_global = on_any_matrix<Assembled<FactorisedFaces>>});

}    // namespace

}    // namespace nscd
