// SPDX-License-Identifier: GPL-2.0-or-later
// INTERIOR POINT: contacts with friction by a primal-dual interior point method, all at once:
//
//   p in K,  z in K*,  p . z = 0,  z = u + mu |u_t| e_n,  u = W p + q      (de Saxce & Feng 1998)
//
// which is Coulomb's law, u_n = 0 while sliding included: nothing is relaxed. W symmetric or nearly, of any rank.
// In unit cones (unit_cones.hpp) an iteration is one factorisation and two or three solutions (Mehrotra 1992) of
//   (G W + S^2) dx = S r - (u + |u_t| e - z),   dz = S (r - S dx),   G = I + e (0, u_t / |u_t|)^T,
// with the scaling S of Nesterov and Todd (cone.hpp) and r from S x o S^-1 z = sigma gap e: first with sigma = 0, then
// with the sigma and the second-order term that this step suggests. Steps end short of the boundary.
//
// Source: Acary, Armand, Nguyen & Shpakovych (2022), Second-order cone programming for frictional contact mechanics
// using interior point algorithm. They solve the convex problem of a given s = mu |u_t|. What is done otherwise:
//   s        is part of the unknowns: G has its derivative. The matrix is unsymmetric then (LU, not LDL^T), but there
//            is no outer iteration, which converges linearly if at all.
//   W        is factorised itself, not the equations of bodies: a matrix has none.
//   the end  Newton's method on the projections (newton_end.hpp) leaves round-off as the only error, where the path
//            runs out of digits at 1e-8. It comes first of all too: starts that know what contacts do take few steps.
//   starts   two: the impulses given, moved into the cones, then a centre far inside.
//   several  discs of a contact are cones of their own with the same x_0: S^2 is the sum of theirs.
//   stick    mu infinite is a finite one on the path, and exact at the end. Contacts with mu = 0 are half lines.
// Impulses are judged by measure() alone, and the best met are returned, by what tol is compared with.
//
// Beds of 500 grains (1,340 contacts), relative natural map 1e-8, mu = 0.05 to 0.2: 18 to 24 factorisations of 17 to
// 22 ms after 300 sweeps of APGS, 21 to 34 from nothing. NLGS takes 20,000 sweeps and more.
//
// Fails (reported, never silent):
//   large mu     where s depends on p the central path need not lead to a solution: it folds. On these beds mu = 0.25
//                is hit or miss, from 0.3 on it mostly ends at 1e-1 to 1e-5. So do some heaps of 60 grains at mu = 0.8.
//   maxiter      iterates are good at the end only: fewer than about 15 factorisations give back the start.
//   no solution  impulses so large that round-off hides the velocities are not accepted.
//   fill         as for any factorisation of a packing: O(n^(4/3)) memory and O(n^2) time, three unknowns a contact.
//   many         where solutions are not unique, this one need not be that of sweeps.
//
// Iterations are factorisations.
#include "solver/global/central_path.hpp"
#include "solver/global/newton_end.hpp"
#include "solver/any_mechanics.hpp"
#include "solver/global/interior_point.hpp"
#include "solver/global/on_grains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace nscd {

namespace {

constexpr Tuning from_start{0.3, 2, 0.99}, from_centre{1, 3, 0.95};
constexpr int most_steps = 60;        // from one start
constexpr int most_short_steps = 5;   // the path folds
constexpr double short_step = 0.05, no_step = 1e-4;
constexpr int most_newton_steps = 30;
constexpr double gain = 0.5;
constexpr int once = 1, patient = 4;  // Newton steps without a gain

// Measures impulses and keeps the best of them, by what tol is compared with.
class Best {
 public:
  Best(GlobalProblem &problem, const MeasuredFrame &frame, const SolverOptions &options) :
      problem_(problem), frame_(frame), options_(options), kept_(problem.p.begin(), problem.p.end()), u_(kept_.size())
  {
    find_velocities();
    report_.criterion = frame_.measured(problem_, u_.data());
    trusted_ = is_trustworthy();
    report_.converged = trusted_ && solved(report_.criterion, options_);
  }

  void look(const std::vector<double> &p)
  {
    std::copy(p.begin(), p.end(), problem_.p.begin());
    find_velocities();
    if (open_sticking_contacts()) find_velocities();
    const Criterion now = frame_.measured(problem_, u_.data());
    if (!is_trustworthy() || (trusted_ && value() <= judged(now, options_))) return;
    trusted_ = true;
    report_.criterion = now;
    report_.converged = solved(now, options_);
    kept_.assign(problem_.p.begin(), problem_.p.end());
  }

  void count_iteration()
  {
    ++report_.iterations;
    if (options_.history) options_.history->push_back(report_);
  }

  double value() const { return judged(report_.criterion, options_); }
  bool goes_on() const { return !report_.converged && report_.iterations < options_.maxiter; }
  const std::vector<double> &impulses() const { return kept_; }

  SolverReport finish()
  {
    std::copy(kept_.begin(), kept_.end(), problem_.p.begin());
    return report_;
  }

 private:
  static constexpr double hidden = 1e-6;  // share of the free velocities that round-off may hide

  void find_velocities()
  {
    problem_.w.multiply(problem_.p.data(), u_.data());
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] += problem_.q[i];
  }

  // No NaN, which maxima swallow, and no impulses so large that p - u / W_nn is p: there the natural map is 0.
  bool is_trustworthy() const
  {
    double sum = 0, round_off = 0;
    for (std::size_t i = 0; i < u_.size(); ++i) {
      const double push = problem_.p[i] * problem_.diagonals[i / problem_.dim()].w;
      sum += u_[i];
      round_off += push * push;
    }
    round_off = std::numeric_limits<double>::epsilon() * std::sqrt(round_off);
    return std::isfinite(sum) && round_off <= hidden * free_norm(problem_);
  }

  // Infinite friction makes a stick of any impulse, also of one that is on its way to 0.
  bool open_sticking_contacts()
  {
    const int dim = problem_.dim();
    bool any = false;
    for (std::size_t k = 0; k < problem_.contacts(); ++k) {
      double *p = &problem_.p[k * dim];
      if (!problem_.sticks(k) || !(problem_.diagonals[k].w * *p < u_[k * dim])) continue;
      std::fill_n(p, dim, 0.0);
      any = true;
    }
    return any;
  }

  GlobalProblem &problem_;
  const MeasuredFrame &frame_;
  const SolverOptions &options_;
  SolverReport report_;
  std::vector<double> kept_, u_;
  bool trusted_ = false;
};

// The stages of the search. Each goes on from the best impulses met.
template <int most>
class Search {
 public:
  using Cones = UnitCones<most>;
  using Vectors = typename Cones::Vectors;

  Search(const Cones &cones, std::size_t contacts, Best &best) :
      cones_(cones), contacts_(contacts), best_(best), path_(cones), newton_(cones)
  {
  }

  // Steps from the impulses given until solved or until the path ends: round-off, or a fold.
  void follow_path(const Vectors &start, const Tuning &tuning)
  {
    int short_steps = 0;
    path_.start(start, tuning.shift);
    for (int s = 0; s < most_steps && best_.goes_on() && short_steps < most_short_steps; ++s) {
      const double reach = path_.step(tuning);
      if (!(reach > no_step)) return best_.count_iteration();
      look(path_.impulses());
      short_steps += reach < short_step;
    }
  }

  // As long as `patience` steps together bring a gain.
  void newton(int patience)
  {
    Vectors x = best();
    for (int s = 0, idle = 0; idle < patience && s < most_newton_steps && best_.goes_on(); ++s) {
      const double before = best_.value();
      if (!newton_.step(path_.factor(), x)) return best_.count_iteration();
      look(x);
      idle = best_.value() < gain * before ? 0 : idle + 1;
    }
  }

  Vectors best() const { return cones_.from_impulses(best_.impulses().data()); }

 private:
  void look(const Vectors &x)
  {
    best_.look(cones_.impulses(x, contacts_));
    best_.count_iteration();
  }

  const Cones &cones_;
  const std::size_t contacts_;
  Best &best_;
  CentralPath<most> path_;
  NewtonEnd<most> newton_;
};

template <int most>
SolverReport search_cones(GlobalProblem &problem, const MeasuredFrame &frame, const SolverOptions &options)
{
  Best best(problem, frame, options);
  best.look(std::vector<double>(problem.p.size(), 0.0));
  const UnitCones<most> cones(problem, frame.groups);
  if (!best.goes_on() || cones.size() == 0 || !(cones.speed() > 0)) {
    best.count_iteration();
    return best.finish();
  }
  Search<most> search(cones, problem.contacts(), best);
  search.newton(once);
  search.follow_path(search.best(), from_start);
  search.newton(patient);
  search.follow_path(cones.zero(), from_centre);
  search.newton(patient);
  return best.finish();
}

}    // namespace

SolverReport InteriorPoint::search(GlobalProblem &problem, const MeasuredFrame &frame, const SolverOptions &options)
{
  constexpr int slides = 3;
  if (problem.contacts() == 0) return {};
  return problem.dim() <= slides ? search_cones<slides>(problem, frame, options)
                                 : search_cones<most_unknowns>(problem, frame, options);
}

namespace {

const RegisterSolver registered({.order = 80,
                                 .name = "interior_point",
                                 .title = "interior point",
                                 .kind = "global",
                                 .friction = true,
                                 .ranks = false,
                                 .solve = on_any_grains<Assembled<InteriorPoint>>,
                                 .solve_global = on_any_matrix<Assembled<InteriorPoint>>});

}    // namespace

}    // namespace nscd
