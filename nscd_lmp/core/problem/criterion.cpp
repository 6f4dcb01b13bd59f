// SPDX-License-Identifier: GPL-2.0-or-later
#include "problem/criterion.hpp"

#include "base/hot.hpp"
#include "contact/carried_velocity.hpp"
#include "contact/frame.hpp"
#include "parallel/chunks.hpp"
#include "parallel/halo.hpp"
#include "problem/closer_look.hpp"
#include "problem/natural_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace nscd {

namespace {

// A contact's own block of W and its friction, as the sums need them.
struct Own {
  double w, w_inverse, wt, mu;
};

// What makes v~ of v in (42), along the normal and along the tangents.
struct Scale {
  double normal = 1, tangential = 1;
};

NSCD_INLINE Scale scale_of(const MaterialsOf &restitution, std::size_t k)
{
  if (restitution.empty()) return {};
  return {1 / (1 + restitution[k].restitution), 1 / (1 + restitution[k].e_t)};
}

// What is summed: the natural map alone, or (42) beside it.
enum class Sum { natural, all };

struct Sums {
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
  NSCD_INLINE void add_frictional(const Own &own, const Split<Tangent> &p, const Split<Tangent> &v,
                                  const Scale &scale)
  {
    add_normal<sum>(own.w, p.n, v.n, scale);
    const double radius = coulomb_radius(own.mu, p.n);
    const double residual = natural_tangential(own.wt, radius, p.t, v.t);
    natural += residual * residual;
    if (sum == Sum::natural) return;
    // What pushes and separates: v p of small grains is too small a number to see it, and friction depends on p.
    of.bipotential += scale.normal * std::max(0.0, std::min(v.n, p.n / own.w_inverse));
    if (std::isinf(own.mu)) of.bipotential += scale.normal * std::abs(v.n * p.n);
    else of.bipotential += scale.normal * std::abs(v.n * p.n + inner(v.t, p.t) + radius * length(v.t));
    of.bipotential += scale.tangential * residual;
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

  void add(const Sums &other)
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

template <Sum what>
NSCD_HOT Sums frictionless(const Problem &problem, const Range &range, const double *local_velocity)
{
  Sums sum;
  const Body *bodies = problem.bodies.data();
  const double *const per_approach = problem.per_approach.data();
  for (std::size_t k = range.first; k < range.last; ++k) {
    const Contact &c = problem.contacts[k];
    fetch_bodies(problem.contacts[std::min(k + fetch_ahead, range.last - 1)], bodies);
    const double v = normal_velocity(c, bodies) + c.bias;
    const Scale scale = scale_of(problem.restitution, k);
    sum.add_frictionless<what>(1 / c.w_inverse, c.impulse, v, scale);
    if (per_approach) sum.add_approach(v, per_approach[k]);
    if (local_velocity) sum.of.motion += scale.normal * std::abs(local_velocity[k] - v);
  }
  return sum;
}

template <class M, Sum what>
NSCD_HOT Sums frictional(const Problem &problem, const Range &range, const double *local_velocity)
{
  using Tangent = typename M::Tangent;
  Sums sum;
  const auto *slides = problem.sliding.template slides<M>();
  const double response = problem.sliding.spin_response;
  const double *const per_approach = problem.per_approach.data();
  for (std::size_t k = range.first; k < range.last; ++k) {
    const Contact &c = problem.contacts[k];
    const Contact &soon = problem.contacts[std::min(k + fetch_ahead, range.last - 1)];
    fetch_bodies(soon, problem.bodies.data());
    fetch_bodies(soon, problem.sliding.spins);
    const auto &slide = slides[k];
    const auto bare = velocity<M>(c, problem.bodies.data(), problem.sliding.spins);
    const Split<Tangent> v{bare.n + c.bias, bare.t + bias(slide)};
    const Own own{1 / c.w_inverse, c.w_inverse, (1 + response) / c.w_inverse, slide.mu};
    const Scale scale = scale_of(problem.restitution, k);
    sum.add_frictional<what, Tangent>(own, {c.impulse, slide.impulse}, v, scale);
    if (per_approach) sum.add_approach(v.n, per_approach[k]);
    if (local_velocity)
      sum.add_motion(load_carried<Tangent>(local_velocity + k * carried_doubles<Tangent>), v, scale);
  }
  return sum;
}

template <class F>
NSCD_HOT Sums global(const GlobalProblem &problem, const double *u, const double *local_velocity)
{
  using Tangent = typename F::Tangent;
  Sums sum;
  for (std::size_t k = 0; k < problem.contacts(); ++k) {
    const Scale scale = scale_of(problem.restitution, k);
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
      sum.add_frictional<Sum::all, Tangent>({d.w, 1 / d.w, d.wt, problem.friction(k)}, p, v, scale);
      if (own) sum.add_motion(load_carried<Tangent>(own), v, scale);
    }
  }
  return sum;
}

template <Sum what>
Sums sum_of(const Problem &problem, const Range &range, const double *local_velocity)
{
  Sums sum;
  const Model model = problem.sliding.model;
  if (model == Model::frictionless) sum = frictionless<what>(problem, range, local_velocity);
  with_friction(model, [&]<class M>(M) { sum = frictional<M, what>(problem, range, local_velocity); });
  return sum;
}

Sums sum_of(const Problem &problem, const Range &range, const double *local_velocity)
{
  return problem.sums_paper ? sum_of<Sum::all>(problem, range, local_velocity)
                            : sum_of<Sum::natural>(problem, range, local_velocity);
}

Sums sum_of(const Problem &problem, const double *local_velocity)
{
  const std::size_t n = problem.contacts.size();
  if (!problem.team) return sum_of(problem, Range{0, n}, local_velocity);
  std::array<Sums, most_threads> of_threads;
  in_chunks(problem.team, n, [&](const Range &range, int thread) {
    of_threads[thread] = sum_of(problem, range, local_velocity);
  });
  Sums sum;
  for (int t = 0; t < problem.team->size(); ++t) sum.add(of_threads[t]);
  return sum;
}

}    // namespace

bool is_met_by_sums(const Criterion &criterion, const Goal &goal)
{
  return (goal.stop == Stop::paper ? criterion.total() : criterion.relative) < goal.tol;
}

Criterion measure(const Problem &problem, const double *local_velocity)
{
  if (problem.judges_contacts) {   // a closer look may need them in any step
    resize_closely(problem.workspace.joined, problem.contacts.size() + 1);
    problem.workspace.islands.reserve(problem.bodies.size());
  }
  Sums sum = sum_of(problem, local_velocity);
  double sums[] = {sum.of.motion, sum.of.bipotential, sum.of.penetration, sum.natural,
                   double(problem.contacts.size())};
  if (problem.halo) problem.halo->sum(sums);
  double approach = sum.of.approach;
  if (problem.halo && problem.judges_contacts) problem.halo->max({&approach, 1});
  sum = {{sums[0], sums[1], sums[2]}, sums[3]};
  sum.of.approach = approach;
  Criterion seen = sum.mean(std::size_t(sums[4]), problem.free_norm, problem.round_off);
  if (problem.judges_contacts && approach <= 1 && is_met_by_sums(seen, problem.goal)) look_closer(problem, seen);
  return seen;
}

Criterion measure(const GlobalProblem &problem, const double *u, const double *local_velocity)
{
  Sums sum;
  with_frame(problem.dim(), [&]<class F>(F) { sum = global<F>(problem, u, local_velocity); });
  return sum.mean(problem.contacts(), free_norm(problem));
}

}    // namespace nscd
