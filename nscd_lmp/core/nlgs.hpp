// Nonlinear Gauss-Seidel (section 3.2): sweep over the contacts, solve each with the others held, until the
// criterion is met. The local law is a template argument, so each law gets its own inlined loop; so is the model, so
// a frictionless sweep knows nothing of friction.
//
// Makes exact: the motion (bodies always carry the impulses of the contacts). Fails by stalling: the sweeps
// needed grow with the length of force chains (about 0.93 N^2 a decade on a column of N) and with the mass
// ratio of a heavy body on a light one. With friction the problem is not convex and no proof of convergence is known.
//
// Source: Jean & Moreau (1992), Jean (1999). Deviation: no relaxation, but for frictional sweeps that go to and fro.
// Exact visits can: a grain that spins in a corner of friction mu is handed back and forth by a factor -mu^2 a sweep
// (Relaxation, below).
#pragma once

#include "carried_velocity.hpp"
#include "hot.hpp"
#include "solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace nscd {

// What a local law works on: the impulse and (1 + e) v~.
struct Local {
  double impulse;
  double velocity;
};

// The same under friction: impulse, and the velocity of laws that carry it.
template <class Tangent>
struct FrictionalLocal {
  Split<Tangent> p = {};
  Split<Tangent> v = {};
};

// The contact's own part of its problem: its block of W and the inverse, and Coulomb's coefficient, infinite for stick.
struct OwnBlock {
  double w, wt;                  // W_nn and W_tt, 1/kg
  double w_inverse, wt_inverse;  // kg
  double ratio;                  // W_tt / W_nn
  double mu;
};

// One frictionless sweep. Returns the sum over the contacts of the velocity that each visit corrected, m/s.
template <class Law>
NSCD_HOT double sweep(Problem &problem, [[maybe_unused]] double *carried, double parameter)
{
  Body *const bodies = problem.bodies.data();
  Contact *const contacts = problem.contacts.data();
  const std::size_t n = problem.contacts.size();
  double corrected = 0;
  for (std::size_t k = 0; k < n; ++k) {
    Contact &c = contacts[k];
    const Body bi = bodies[c.i], bj = bodies[c.j];
    const double v = dot(c.normal, bi - bj) + c.bias;
    Local local{c.impulse, 0};
    if constexpr (Law::carries_velocity) local.velocity = carried[k];
    local = Law::visit(local, v, c.w_inverse, parameter);
    if constexpr (Law::carries_velocity) carried[k] = local.velocity;
    const double dp = local.impulse - c.impulse;
    c.impulse = local.impulse;
    bodies[c.i] = bi + c.normal * (dp * bi[3]);
    bodies[c.j] = bj - c.normal * (dp * bj[3]);
    corrected += std::abs(dp) * (bi[3] + bj[3]);
  }
  return corrected;
}

template <class Tangent>
NSCD_INLINE Split<Tangent> part_way(const Split<Tangent> &from, const Split<Tangent> &to, double share)
{
  return {from.n + share * (to.n - from.n), from.t + (to.t - from.t) * share};
}

// A visit of a frictional contact that does `share` of its step.
template <class Law, class M, class Local>
NSCD_INLINE Local visit_contact(const Contact &c, const Local &now, const Split<typename M::Tangent> &v,
                                const OwnBlock &own, double parameter, double share)
{
  Local next = Law::visit(now, v, own, parameter);
  if (share != 1) {
    next.p = part_way(now.p, next.p, share);
    next.v = part_way(v, next.v, share);
  }
  if constexpr (Law::carries_velocity) {
    // A part along the normal would go from p_t to u_t and back, and grow.
    next.p.t = M::tangential(c.normal, next.p.t);
    next.v.t = M::tangential(c.normal, next.v.t);
  }
  return next;
}

// One sweep with friction; M is Planar or Spatial. Visits do `share` of their step.
template <class Law, class M>
NSCD_HOT double frictional_sweep(Problem &problem, [[maybe_unused]] double *carried, double parameter, double share)
{
  using Tangent = typename M::Tangent;
  Body *const bodies = problem.bodies.data();
  Vec4 *const spins = problem.sliding.spins;
  auto *const slides = problem.sliding.template slides<M>();
  const double response = problem.sliding.spin_response, ratio = 1 + response, ratio_inverse = 1 / ratio;
  Vec4 corrected{};
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    Contact &c = problem.contacts[k];
    auto &slide = slides[k];
    const Body bi = bodies[c.i], bj = bodies[c.j];
    const Tangent si = M::spin(spins[c.i]), sj = M::spin(spins[c.j]);
    const Vec4 difference = bi - bj;
    const double vn = dot(c.normal, difference), w = bi[3] + bj[3];
    const Split<Tangent> v{vn + c.bias, M::slip(c.normal, difference, vn, si + sj) + bias(slide)};
    const OwnBlock own{w, w * ratio, c.w_inverse, c.w_inverse * ratio_inverse, ratio, slide.mu};
    FrictionalLocal<Tangent> now{{c.impulse, slide.impulse}, {}};
    if constexpr (Law::carries_velocity) now.v = load_carried<Tangent>(carried + k * carried_doubles<Tangent>);
    const FrictionalLocal<Tangent> next = visit_contact<Law, M>(c, now, v, own, parameter, share);
    if constexpr (Law::carries_velocity) store_carried<Tangent>(carried + k * carried_doubles<Tangent>, next.v);
    c.impulse = next.p.n;
    slide.impulse = next.p.t;
    const Tangent slid = next.p.t - now.p.t, turn = M::turned(c.normal, slid) * response;
    const Vec4 push = c.normal * (next.p.n - now.p.n) + M::in_space(c.normal, slid);
    bodies[c.i] = bi + push * bi[3];
    bodies[c.j] = bj - push * bj[3];
    M::set_spin(spins[c.i], si - turn * bi[3]);
    M::set_spin(spins[c.j], sj - turn * bj[3]);
    corrected += magnitudes(push) * w;
  }
  // Between the mean of normal and tangential corrections; a root a contact would cost a tenth of the sweep.
  return 0.5 * (1 + ratio) * (corrected[0] + corrected[1] + corrected[2]);
}

// The criterion costs a pass of its own, so far from convergence it is not taken: (42) is bounded by about
// what the last sweep corrected. Close to it the passes are spread so that the count overshoots by < 2 %.
template <class Sweep>
SolverReport iterate(Problem &problem, const SolverOptions &options, std::size_t carried_a_contact, Sweep once)
{
  constexpr int always_checked = 4;
  SolverReport report;
  const std::size_t n = problem.contacts.size();
  if (n == 0) return report;
  problem.workspace.assign(n * carried_a_contact, 0.0);
  double *const carried = carried_a_contact ? problem.workspace.data() : nullptr;
  int next_check = 0;
  report.converged = false;
  for (int s = 1; s <= options.maxiter && !report.converged; ++s) {
    const double corrected = once(problem, carried, options.parameter);
    report.iterations = s;
    const bool close = !(corrected > 4 * options.tol * double(n)) && s >= next_check;
    if (s > always_checked && !close && s < options.maxiter) continue;
    report.criterion = measure(problem, carried);
    report.converged = report.criterion.total() < options.tol;
    next_check = s + 1 + s / 64;
  }
  return report;
}

// Sees sweeps that go to and fro: the mean correction of the sweeps from s/2 to s is about that of the sweeps from s/4
// to s/2, s = 256, 512, ... From then on visits do a part of their step. Slow convergence, as 1/s or 1/sqrt(s), is left
// alone.
class Relaxation {
 public:
  double share() const { return share_; }
  void look(double corrected)
  {
    sum_ += corrected;
    if (++sweeps_ < end_) return;
    const double mean = sum_ / (end_ - begin_);
    if (mean > no_better * mean_before_ && share_ > least_share) share_ /= 2;
    mean_before_ = mean;
    sum_ = 0;
    begin_ = end_;
    end_ *= 2;
  }

 private:
  static constexpr double no_better = 0.9, least_share = 0.25;
  double share_ = 1;
  int sweeps_ = 0, begin_ = 0, end_ = 128;  // the window of sweeps that is averaged now
  double sum_ = 0, mean_before_ = INFINITY;
};

template <class Law, class M>
SolverReport iterate_with_friction(Problem &problem, const SolverOptions &options)
{
  constexpr std::size_t carried = Law::carries_velocity ? carried_doubles<typename M::Tangent> : 0;
  Relaxation relaxation;
  const auto relaxed = [&](Problem &p, double *velocities, double parameter) {
    const double share = relaxation.share();
    const double corrected = frictional_sweep<Law, M>(p, velocities, parameter, share) / share;
    relaxation.look(corrected);
    return corrected;
  };
  return iterate(problem, options, carried, relaxed);
}

template <class Law>
SolverReport nlgs(Problem &problem, const SolverOptions &options)
{
  switch (problem.sliding.model) {
    case Model::planar: return iterate_with_friction<Law, Planar>(problem, options);
    case Model::spatial: return iterate_with_friction<Law, Spatial>(problem, options);
    case Model::frictionless: break;
  }
  return iterate(problem, options, Law::carries_velocity, &sweep<Law>);
}

}    // namespace nscd
