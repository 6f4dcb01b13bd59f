// SPDX-License-Identifier: GPL-2.0-or-later
// Nonlinear Gauss-Seidel (section 3.2): sweep over the contacts, solve each with the others held, until the
// criterion is met. The local law is a template argument, so each law gets its own inlined loop. So are the mechanics:
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
#include "solver/any_mechanics.hpp"
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

// A visit of a contact that does `share` of its step.
template <class Law, class M, class Local>
NSCD_INLINE Local visit_contact(const Contact &c, const Local &now, const typename M::Vector &v,
                                const typename M::Own &own, double parameter, double share)
{
  Local next = visit_partly<Law>(now, v, own, parameter, share);
  if constexpr (Law::carries_velocity) {
    // A part along the normal would go from p_t to u_t and back, and grow.
    next.p.t = M::tangential(c, next.p.t);
    next.v.t = M::tangential(c, next.v.t);
  }
  return next;
}

// Of the corrections of a visit, by components; what is no push is its own.
template <class Wrench, class Tangent>
NSCD_INLINE Vec4 corrections(const Wrench &wrench, const Tangent &slid)
{
  Vec4 sum = magnitudes(wrench.push);
  for_each_disc([&](std::size_t d, const auto &one) NSCD_INLINED {
    if (d > 0) sum[0] += length(one);
  }, slid);
  return sum;
}

// The same with friction, and whatever parts contacts have. Visits do `share` of their step.
template <class Law, class M, bool accelerated = false>
NSCD_HOT Swept frictional_sweep(Problem &problem, const M &given, const Range &range,
                                [[maybe_unused]] double *carried, double parameter, double share,
                                const Momentum &momentum = {})
{
  [[maybe_unused]] const double gain = 1 + momentum.share();
  [[maybe_unused]] double *const previous = momentum.previous;
  using Tangent = typename M::Tangent;
  using Vector = typename M::Vector;
  const M mechanics = given;   // whose members no store can change
  Contact *const contacts = problem.contacts.data();
  alignas(vec4_alignment) Vec4 corrected{};
  double against = 0, factor = 1;
  for (std::size_t k = range.first; k < range.last; ++k) {
    Contact &c = contacts[k];
    mechanics.prefetch(contacts[std::min(k + fetch_ahead, range.last - 1)]);
    auto pair = mechanics.load(c, k);
    const Vector v = mechanics.velocity(c, k, pair);
    const auto own = mechanics.own(c, k, pair.mobility());
    FrictionalLocal<Tangent> now{mechanics.impulse(c, k), {}};
    [[maybe_unused]] const Vector last = now.p;
    if constexpr (accelerated) {
      double *const place = previous + k * carried_doubles<Tangent>;
      now.p = part_way(load_carried<Tangent>(place), last, gain);
      store_carried<Tangent>(place, last);
    }
    if constexpr (Law::carries_velocity) now.v = load_carried<Tangent>(carried + k * carried_doubles<Tangent>);
    FrictionalLocal<Tangent> next = visit_contact<Law, M>(c, now, v, own, parameter, share);
    // Visits do not feel a part along the normal, and momentum makes it grow.
    if constexpr (accelerated) next.p.t = M::tangential(c, next.p.t);
    const Vector change{next.p.n - now.p.n, next.p.t - now.p.t};
    const auto wrench = mechanics.wrench(c, k, pair, change);
    pair.add(wrench);
    if constexpr (!M::diagonal) {
      const double first = most_of(own, change);
      Vector by = change;
      for (int times = 1; times < most_visits && most_of(own, by) > 1e-2 * first; ++times) {
        const FrictionalLocal<Tangent> before = next;
        next = visit_contact<Law, M>(c, before, mechanics.velocity(c, k, pair), own, parameter, share);
        by = {next.p.n - before.p.n, next.p.t - before.p.t};
        pair.add(mechanics.wrench(c, k, pair, by));
      }
    }
    if constexpr (Law::carries_velocity) store_carried<Tangent>(carried + k * carried_doubles<Tangent>, next.v);
    if constexpr (accelerated) against -= own.w * weighed(own, change, next.p, last);
    mechanics.store(c, pair);
    mechanics.set_impulse(c, k, next.p);
    corrected += corrections(wrench, change.t) * own.w;
    factor = own.discs[0].ratio;
  }
  // Between the mean of normal and tangential corrections; a root a contact would cost a tenth of the sweep.
  return {0.5 * (1 + factor) * (corrected[0] + corrected[1] + corrected[2]), against};
}

template <class Law>
struct Nlgs {
  static constexpr double default_parameter = 1;   // of laws that another solver sweeps by

  template <class M>
  static SolverReport solve(Problem &problem, const M &mechanics, const SolverOptions &options)
  {
    SplitMasses split(problem);
    if constexpr (M::parts == 0) return without_friction(problem, mechanics, options);
    else return with_parts(problem, mechanics, options);
  }

  template <class F>
  static SolverReport solve(GlobalProblem &problem, const F &frame, const SolverOptions &options)
  {
    return MatrixNlgs<Law>::solve(problem, frame, options);
  }

 private:
  static double *carried(Problem &problem, std::size_t doubles)
  {
    if constexpr (!Law::carries_velocity) return nullptr;
    problem.workspace.numbers.assign(problem.contacts.size() * doubles, 0.0);
    return problem.workspace.numbers.data();
  }

  template <class M>
  static SolverReport with_parts(Problem &problem, const M &mechanics, const SolverOptions &options)
  {
    double *const velocities = carried(problem, carried_doubles<typename M::Tangent>);
    Relaxation relaxation;
    const auto once = [&] {
      const double share = relaxation.share();
      const Swept swept = sweep_across(problem, [&](const Range &range) {
        return frictional_sweep<Law, M>(problem, mechanics, range, velocities, options.parameter, share);
      });
      relaxation.look(swept.corrected / share);
      return swept.corrected / share;
    };
    int extra = 0;   // sweeps along normals alone
    const auto look = [&](const Goal &goal) {
      return measure_parted(problem, mechanics, options, goal, extra, velocities);
    };
    SolverReport report = iterate(extent(problem), options, once, look, BestImpulses<M>(problem, mechanics));
    report.iterations += extra;
    return report;
  }

  template <class M>
  static SolverReport without_friction(Problem &problem, const M &mechanics, const SolverOptions &options)
  {
    double *const velocities = carried(problem, 1);
    const auto once = [&] {
      const auto some = [&](const Range &range) { return sweep<Law>(problem, range, velocities, options.parameter); };
      return sweep_across(problem, some).corrected;
    };
    return iterate(extent(problem), options, once,
                   [&](const Goal &goal) { return measure_across(problem, mechanics, goal, velocities); });
  }
};

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
          .solve = on_any_grains<Nlgs<Law>>,
          .solve_global = on_any_matrix<Nlgs<Law>>};
}

}    // namespace nscd
