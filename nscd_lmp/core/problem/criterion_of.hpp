// SPDX-License-Identifier: GPL-2.0-or-later
// measure() of any mechanics and any frame: what criterion.cpp instantiates for those of scenes.
#pragma once

#include "base/hot.hpp"
#include "contact/carried_velocity.hpp"
#include "contact/frame.hpp"
#include "parallel/chunks.hpp"
#include "parallel/halo.hpp"
#include "problem/closer_look_of.hpp"
#include "problem/criterion.hpp"
#include "problem/natural_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace nscd {

// What makes v~ of v in (42), along the normal and along the tangents.
struct CriterionScale {
  double normal = 1, tangential = 1;
};

NSCD_INLINE CriterionScale criterion_scale(const MaterialsOf &restitution, std::size_t k)
{
  if (restitution.empty()) return {};
  return {1 / (1 + restitution[k].restitution), 1 / (1 + restitution[k].e_t)};
}

// What is summed: the natural map alone, or (42) beside it.
enum class Sum { natural, all };

struct CriterionSums {
  using Scale = CriterionScale;
  Criterion of;
  double natural = 0;  // (m/s)^2

  // What is as without friction; v includes the bias.
  template <Sum sum>
  NSCD_INLINE void add_normal(double w, double p, double v, const Scale &scale)
  {
    if (sum == Sum::all) of.bipotential += scale.normal * (w * std::max(0.0, -p));
    if (sum == Sum::all) of.penetration += scale.normal * std::max(-v, 0.0);   // this order lets NaN through
    const double residual = natural_normal(w, p, v);
    natural += residual * residual;
  }

  template <Sum sum>
  NSCD_INLINE void add_frictionless(double w, double p, double v, const Scale &scale)
  {
    add_normal<sum>(w, p, v, scale);
    if (sum == Sum::all) of.bipotential += scale.normal * std::abs(v * p);
  }

  template <Sum sum, class Tangent>
  NSCD_INLINE void add_frictional(const OwnBlock<Tangent> &own, const Split<Tangent> &p, const Split<Tangent> &v,
                                  const Scale &scale)
  {
    add_normal<sum>(own.w, p.n, v.n, scale);
    if (sum == Sum::all) of.bipotential += scale.normal * bipotential(own, p, v);
    for_each_disc([&](std::size_t d, const auto &pt, const auto &vt) NSCD_INLINED {
      const Disc &disc = own.discs[d];
      const double residual = natural_tangential(disc.w, coulomb_radius(disc.mu, p.n), pt, vt);
      natural += residual * residual;
      if (sum == Sum::all) of.bipotential += scale.tangential * residual;
    }, p.t, v.t);
  }

  // Without what the indicator stands for; infinite coefficients have none.
  template <class Tangent>
  NSCD_INLINE static double bipotential(const OwnBlock<Tangent> &own, const Split<Tangent> &p,
                                        const Split<Tangent> &v)
  {
    double sum = v.n * p.n;
    for_each_disc([&](std::size_t d, const auto &pt, const auto &vt) NSCD_INLINED {
      const double mu = own.discs[d].mu;
      if (!std::isinf(mu)) sum = sum + inner(vt, pt) + coulomb_radius(mu, p.n) * length(vt);
    }, p.t, v.t);
    // What pushes and separates: v p of small grains is too small a number to see it, and friction depends on p.
    return std::max(0.0, std::min(v.n, p.n / own.w_inverse)) + std::abs(sum);
  }

  template <class Tangent>
  NSCD_INLINE void add_motion(const Split<Tangent> &own, const Split<Tangent> &v, const Scale &scale)
  {
    const Split<Tangent> off{own.n - v.n, own.t - v.t};
    of.motion += scale.normal * std::sqrt(off.n * off.n + inner(off.t, off.t));
  }

  NSCD_INLINE void add_approach(double v, double per_approach)
  {
    of.approach = std::max(of.approach, -v * per_approach);
  }

  void add(const CriterionSums &other)
  {
    of.motion += other.of.motion;
    of.bipotential += other.of.bipotential;
    of.penetration += other.of.penetration;
    of.approach = std::max(of.approach, other.of.approach);
    natural += other.natural;
  }

  Criterion mean(std::size_t contacts, double free_norm, double round_off = 0)
  {
    if (contacts == 0) return of;
    const double scale = 1 / double(contacts);
    of.motion *= scale;
    of.bipotential *= scale;
    of.penetration *= scale;
    // If nothing drives the contacts, what start impulses have left over is all there is: 1.
    const bool residual = !(natural <= double(contacts) * round_off * round_off);  // NaN is one
    if (residual) of.relative = free_norm > 0 ? std::sqrt(natural) / free_norm : 1;
    of.island = of.relative;
    return of;
  }
};

template <class M, Sum what>
NSCD_HOT CriterionSums criterion_sums(const Problem &problem, const M &given, const Range &range,
                                      const double *local_velocity)
{
  using Tangent = typename M::Tangent;
  const M mechanics = given;   // whose members no store can change
  CriterionSums sum;
  const double *const per_approach = problem.per_approach.data();
  for (std::size_t k = range.first; k < range.last; ++k) {
    const Contact &c = problem.contacts[k];
    mechanics.prefetch(problem.contacts[std::min(k + fetch_ahead, range.last - 1)]);
    const auto v = mechanics.velocity(c, k);
    const CriterionScale scale = criterion_scale(problem.restitution, k);
    if constexpr (M::parts == 0) sum.add_frictionless<what>(1 / c.w_inverse, c.impulse, v.n, scale);
    else sum.add_frictional<what, Tangent>(mechanics.own(c, k, 1 / c.w_inverse), mechanics.impulse(c, k), v, scale);
    if (per_approach) sum.add_approach(v.n, per_approach[k]);
    if (!local_velocity) continue;
    if constexpr (M::parts == 0) sum.of.motion += scale.normal * std::abs(local_velocity[k] - v.n);
    else sum.add_motion(load_carried<Tangent>(local_velocity + k * carried_doubles<Tangent>), v, scale);
  }
  return sum;
}

template <class M>
CriterionSums criterion_sums(const Problem &problem, const M &mechanics, const Range &range,
                             const double *local_velocity)
{
  return problem.sums_paper ? criterion_sums<M, Sum::all>(problem, mechanics, range, local_velocity)
                            : criterion_sums<M, Sum::natural>(problem, mechanics, range, local_velocity);
}

template <class M>
CriterionSums criterion_sums(const Problem &problem, const M &mechanics, const double *local_velocity)
{
  const std::size_t n = problem.contacts.size();
  if (!problem.team) return criterion_sums(problem, mechanics, Range{0, n}, local_velocity);
  std::array<CriterionSums, most_threads> of_threads;
  in_chunks(problem.team, n, [&](const Range &range, int thread) {
    of_threads[thread] = criterion_sums(problem, mechanics, range, local_velocity);
  });
  CriterionSums sum;
  for (int t = 0; t < problem.team->size(); ++t) sum.add(of_threads[t]);
  return sum;
}

template <class M>
Criterion measure(const Problem &problem, const M &mechanics, const double *local_velocity)
{
  if (problem.judges_contacts) {   // a closer look may need them in any step
    resize_closely(problem.workspace.joined, problem.contacts.size() + 1);
    problem.workspace.islands.reserve(problem.bodies.size());
  }
  CriterionSums sum = criterion_sums(problem, mechanics, local_velocity);
  double sums[] = {sum.of.motion, sum.of.bipotential, sum.of.penetration, sum.natural,
                   double(problem.contacts.size())};
  if (problem.halo) problem.halo->sum(sums);
  double approach = sum.of.approach;
  if (problem.halo && problem.judges_contacts) problem.halo->max({&approach, 1});
  sum = {{sums[0], sums[1], sums[2]}, sums[3]};
  sum.of.approach = approach;
  Criterion seen = sum.mean(std::size_t(sums[4]), problem.free_norm, problem.round_off);
  if (problem.judges_contacts && approach <= 1 && is_met_by_sums(seen, problem.goal))
    look_closer(problem, mechanics, seen);
  return seen;
}

template <class F>
NSCD_HOT Criterion measure(const GlobalProblem &problem, const F &, const double *u, const double *local_velocity)
{
  using Tangent = typename F::Tangent;
  CriterionSums sum;
  for (std::size_t k = 0; k < problem.contacts(); ++k) {
    const CriterionScale scale = criterion_scale(problem.restitution, k);
    const auto p = F::load(problem.p.data() + k * F::dim), v = F::load(u + k * F::dim);
    const Diagonal &d = problem.diagonals[k];
    if (!problem.per_approach.empty()) sum.add_approach(v.n, problem.per_approach[k]);
    if (d.w == 0) {  // nothing moves: what there is to see is whether it penetrates
      sum.of.penetration += scale.normal * std::max(-v.n, 0.0);
      sum.natural += std::pow(std::min(v.n, 0.0), 2);
      continue;
    }
    const double *own = local_velocity ? local_velocity + k * F::carried : nullptr;
    if constexpr (F::dim == 1) {
      sum.add_frictionless<Sum::all>(d.w, p.n, v.n, scale);
      if (own) sum.of.motion += scale.normal * std::abs(*own - v.n);
    } else {
      sum.add_frictional<Sum::all, Tangent>(own_block<F>(problem, k), p, v, scale);
      if (own) sum.add_motion(load_carried<Tangent>(own), v, scale);
    }
  }
  return sum.mean(problem.contacts(), free_norm(problem));
}

}    // namespace nscd
