// SPDX-License-Identifier: GPL-2.0-or-later
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
// (Relaxation, iterate.hpp). With friction the last approaches are stopped by sweeps along the normals alone.
//
// Here: sweeps over grains, matrix free. Sweeps over the rows of a Delassus matrix: matrix_nlgs.hpp.
#pragma once

#include "base/hot.hpp"
#include "contact/carried_velocity.hpp"
#include "solver/across_ranks.hpp"
#include "solver/best_impulses.hpp"
#include "solver/iterate.hpp"
#include "solver/matrix_nlgs.hpp"
#include "solver/momentum.hpp"
#include "solver/normal_sweeps.hpp"
#include "solver/visit.hpp"

#include <algorithm>

namespace nscd {

// One frictionless sweep over some of the contacts, with momentum if there are impulses before the last one (bodies are
// extrapolated already).
template <class Law, bool accelerated = false>
NSCD_HOT Swept sweep(Problem &problem, const Range &range, [[maybe_unused]] double *carried, double parameter,
                     const Momentum &momentum = {})
{
  Body *const bodies = problem.bodies.data();
  Contact *const contacts = problem.contacts.data();
  [[maybe_unused]] const double share = momentum.share();
  [[maybe_unused]] double *const previous = momentum.previous;
  double corrected = 0, against = 0;
  for (std::size_t k = range.first; k < range.last; ++k) {
    Contact &c = contacts[k];
    fetch_bodies(contacts[std::min(k + fetch_ahead, range.last - 1)], bodies);
    const Body bi = bodies[c.i], bj = bodies[c.j];
    const double v = dot(c.normal, bi - bj) + c.bias;
    double start = c.impulse;
    if constexpr (accelerated) start += share * (c.impulse - previous[k]);
    Local local{start, 0};
    if constexpr (Law::carries_velocity) local.velocity = carried[k];
    local = Law::visit(local, v, c.w_inverse, parameter);
    if constexpr (Law::carries_velocity) carried[k] = local.velocity;
    const double dp = local.impulse - start;
    const double corrects = dp * (bi[3] + bj[3]);
    if constexpr (accelerated) {
      against -= corrects * (local.impulse - c.impulse);
      previous[k] = c.impulse;
    }
    c.impulse = local.impulse;
    bodies[c.i] = bi + c.normal * (dp * bi[3]);
    bodies[c.j] = bj - c.normal * (dp * bj[3]);
    corrected += std::abs(corrects);
  }
  return {corrected, against};
}

// A visit of a frictional contact that does `share` of its step.
template <class Law, class M, class Local>
NSCD_INLINE Local visit_contact(const Contact &c, const Local &now, const Split<typename M::Tangent> &v,
                                const OwnBlock &own, double parameter, double share)
{
  Local next = visit_partly<Law>(now, v, own, parameter, share);
  if constexpr (Law::carries_velocity) {
    // A part along the normal would go from p_t to u_t and back, and grow.
    next.p.t = M::tangential(c.normal, next.p.t);
    next.v.t = M::tangential(c.normal, next.v.t);
  }
  return next;
}

// The same with friction; M is Planar or Spatial. Visits do `share` of their step.
template <class Law, class M, bool accelerated = false>
NSCD_HOT Swept frictional_sweep(Problem &problem, const Range &range, [[maybe_unused]] double *carried,
                                double parameter, double share, const Momentum &momentum = {})
{
  [[maybe_unused]] const double gain = 1 + momentum.share();
  [[maybe_unused]] double *const previous = momentum.previous;
  using Tangent = typename M::Tangent;
  Body *const bodies = problem.bodies.data();
  Vec4 *const spins = problem.sliding.spins;
  auto *const slides = problem.sliding.template slides<M>();
  const double response = problem.sliding.spin_response, ratio = 1 + response, ratio_inverse = 1 / ratio;
  alignas(vec4_alignment) Vec4 corrected{};
  double against = 0;
  for (std::size_t k = range.first; k < range.last; ++k) {
    Contact &c = problem.contacts[k];
    const Contact &soon = problem.contacts[std::min(k + fetch_ahead, range.last - 1)];
    fetch_bodies(soon, bodies);
    fetch_bodies(soon, spins);
    auto &slide = slides[k];
    const Body bi = bodies[c.i], bj = bodies[c.j];
    const Tangent si = M::spin(spins[c.i]), sj = M::spin(spins[c.j]);
    const Vec4 difference = bi - bj;
    const double vn = dot(c.normal, difference), w = bi[3] + bj[3];
    const Split<Tangent> v{vn + c.bias, M::slip(c.normal, difference, vn, si + sj) + bias(slide)};
    const OwnBlock own{w, w * ratio, c.w_inverse, c.w_inverse * ratio_inverse, ratio, slide.mu};
    FrictionalLocal<Tangent> now{{c.impulse, slide.impulse}, {}};
    [[maybe_unused]] const Split<Tangent> last = now.p;
    if constexpr (accelerated) {
      double *const place = previous + k * carried_doubles<Tangent>;
      now.p = part_way(load_carried<Tangent>(place), last, gain);
      store_carried<Tangent>(place, last);
    }
    if constexpr (Law::carries_velocity) now.v = load_carried<Tangent>(carried + k * carried_doubles<Tangent>);
    FrictionalLocal<Tangent> next = visit_contact<Law, M>(c, now, v, own, parameter, share);
    // Visits do not feel a part along the normal, and momentum makes it grow.
    if constexpr (accelerated) next.p.t = M::tangential(c.normal, next.p.t);
    if constexpr (Law::carries_velocity) store_carried<Tangent>(carried + k * carried_doubles<Tangent>, next.v);
    c.impulse = next.p.n;
    slide.impulse = next.p.t;
    const Tangent slid = next.p.t - now.p.t, turn = M::turned(c.normal, slid) * response;
    const Vec4 push = c.normal * (next.p.n - now.p.n) + M::in_space(c.normal, slid);
    if constexpr (accelerated)
      against -= w * ((next.p.n - now.p.n) * (next.p.n - last.n) + ratio * inner(slid, next.p.t - last.t));
    bodies[c.i] = bi + push * bi[3];
    bodies[c.j] = bj - push * bj[3];
    M::set_spin(spins[c.i], si - turn * bi[3]);
    M::set_spin(spins[c.j], sj - turn * bj[3]);
    corrected += magnitudes(push) * w;
  }
  // Between the mean of normal and tangential corrections; a root a contact would cost a tenth of the sweep.
  return {0.5 * (1 + ratio) * (corrected[0] + corrected[1] + corrected[2]), against};
}

template <class Law, class M>
SolverReport nlgs_with_friction(Problem &problem, const SolverOptions &options)
{
  double *carried = nullptr;
  if constexpr (Law::carries_velocity) {
    problem.workspace.numbers.assign(problem.contacts.size() * carried_doubles<typename M::Tangent>, 0.0);
    carried = problem.workspace.numbers.data();
  }
  Relaxation relaxation;
  const auto once = [&] {
    const double share = relaxation.share();
    const Swept swept = sweep_across(problem, [&](const Range &range) {
      return frictional_sweep<Law, M>(problem, range, carried, options.parameter, share);
    });
    relaxation.look(swept.corrected / share);
    return swept.corrected / share;
  };
  int extra = 0;   // sweeps along normals alone
  const auto look = [&](const Goal &goal) { return measure_parted(problem, options, goal, extra, carried); };
  SolverReport report = iterate(extent(problem), options, once, look, BestImpulses<M>(problem));
  report.iterations += extra;
  return report;
}

template <class Law>
SolverReport nlgs_without_friction(Problem &problem, const SolverOptions &options)
{
  double *carried = nullptr;
  if constexpr (Law::carries_velocity) {
    problem.workspace.numbers.assign(problem.contacts.size(), 0.0);
    carried = problem.workspace.numbers.data();
  }
  const auto once = [&] {
    const auto some = [&](const Range &range) { return sweep<Law>(problem, range, carried, options.parameter); };
    return sweep_across(problem, some).corrected;
  };
  return iterate(extent(problem), options, once,
                 [&](const Goal &goal) { return measure_across(problem, goal, carried); });
}

template <class Law>
SolverReport nlgs(Problem &problem, const SolverOptions &options)
{
  SolverReport report;
  SplitMasses split(problem);
  if (problem.sliding.model == Model::frictionless) return nlgs_without_friction<Law>(problem, options);
  with_friction(problem.sliding.model,
                [&]<class M>(M) { report = nlgs_with_friction<Law, M>(problem, options); });
  return report;
}

// What a local law tells the registry, as in SolverEntry.
struct LocalLawEntry {
  int order;
  std::string_view name, title, parameter;
  double default_parameter;
};

// The registry's entry of a local law inside NLGS.
template <class Law>
SolverEntry local_law(const LocalLawEntry &law)
{
  return {.order = law.order,
          .name = law.name,
          .title = law.title,
          .kind = "local law",
          .parameter = law.parameter,
          .default_parameter = law.default_parameter,
          .friction = true,
          .ranks = true,
          .solve = nlgs<Law>,
          .solve_global = matrix_nlgs<Law>};
}

}    // namespace nscd
