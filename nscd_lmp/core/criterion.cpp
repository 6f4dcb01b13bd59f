#include "criterion.hpp"

#include "carried_velocity.hpp"
#include "hot.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

struct Sums {
  Criterion of;
  double natural = 0;  // (m/s)^2

  // What is as without friction; v includes the bias.
  NSCD_INLINE void add_normal(const Contact &c, double v)
  {
    const double w = 1 / c.w_inverse;
    of.bipotential += w * std::max(0.0, -c.impulse);
    of.penetration += std::max(0.0, -v);
    const double residual = w * (c.impulse - std::max(0.0, c.impulse - v * c.w_inverse));
    natural += residual * residual;
  }
};

NSCD_HOT Sums frictionless(const Problem &problem, const double *local_velocity)
{
  Sums sum;
  const Body *bodies = problem.bodies.data();
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    const double v = normal_velocity(c, bodies) + c.bias;
    sum.add_normal(c, v);
    sum.of.bipotential += std::abs(v * c.impulse);
    if (local_velocity) sum.of.motion += std::abs(local_velocity[k] - v);
  }
  return sum;
}

template <class M>
NSCD_HOT Sums frictional(const Problem &problem, const double *local_velocity)
{
  using Tangent = typename M::Tangent;
  Sums sum;
  const auto *slides = problem.sliding.template slides<M>();
  const double response = problem.sliding.spin_response;
  const double tangential_scale = (1 + problem.restitution) / (1 + problem.sliding.restitution);
  for (std::size_t k = 0; k < problem.contacts.size(); ++k) {
    const Contact &c = problem.contacts[k];
    const auto &slide = slides[k];
    const auto bare = velocity<M>(c, problem.bodies.data(), problem.sliding.spins);
    const Split<Tangent> v{bare.n + c.bias, bare.t + bias(slide)};
    sum.add_normal(c, v.n);
    // What pushes and separates: v p of small grains is too small a number to see it, and friction depends on p.
    sum.of.bipotential += std::max(0.0, std::min(v.n, c.impulse / c.w_inverse));
    const double radius = coulomb_radius(slide.mu, c.impulse);
    if (std::isinf(slide.mu)) sum.of.bipotential += std::abs(v.n * c.impulse);
    else sum.of.bipotential += std::abs(v.n * c.impulse + inner(v.t, slide.impulse) + radius * length(v.t));
    const double wt = (1 + response) / c.w_inverse;
    const Tangent projected = onto_ball<Tangent>(slide.impulse - v.t * (1 / wt), radius);
    const double residual = wt * length(slide.impulse - projected);
    sum.of.bipotential += tangential_scale * residual;
    sum.natural += residual * residual;
    if (!local_velocity) continue;
    const auto own = load_carried<Tangent>(local_velocity + k * carried_doubles<Tangent>);
    const Split<Tangent> off{own.n - v.n, own.t - v.t};
    sum.of.motion += std::sqrt(off.n * off.n + inner(off.t, off.t));
  }
  return sum;
}

}    // namespace

Criterion measure(const Problem &problem, const double *local_velocity)
{
  Sums sum;
  const Model model = problem.sliding.model;
  if (model == Model::frictionless) sum = frictionless(problem, local_velocity);
  with_friction(model, [&]<class M>(M) { sum = frictional<M>(problem, local_velocity); });
  Criterion &result = sum.of;
  if (problem.contacts.empty()) return result;
  const double scale = 1 / (double(problem.contacts.size()) * (1 + problem.restitution));
  result.motion *= scale;
  result.bipotential *= scale;
  result.penetration *= scale;
  if (sum.natural == 0) return result;
  // If nothing drives the contacts, what start impulses have left over is all there is: 1.
  result.relative = problem.free_norm > 0 ? std::sqrt(sum.natural) / problem.free_norm : 1;
  return result;
}

}    // namespace nscd
