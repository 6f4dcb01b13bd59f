// SPDX-License-Identifier: GPL-2.0-or-later
#include "grain_arrays.hpp"

#include "scene/state.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

Model model_of(std::size_t dim)
{
  return dim == 1 ? Model::frictionless : dim == 2 ? Model::planar : Model::spatial;
}

double norm(const double *values, std::size_t count)
{
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += values[i] * values[i];
  return std::sqrt(sum);
}

}    // namespace

Vec4 GrainProblem::direction(std::size_t k, std::size_t along) const
{
  const double *at = along == 0 ? arrays_.normal + 3 * k : arrays_.tangents + 3 * (k * (arrays_.dim - 1) + along - 1);
  return Vec4{at[0], at[1], at[2], 0};
}

// The sum of components 1, 2 along their tangents.
Vec4 GrainProblem::tangential(std::size_t k, const double *components) const
{
  Vec4 sum{};
  for (std::size_t a = 1; a < arrays_.dim; ++a) sum += direction(k, a) * components[a];
  return sum;
}

GrainProblem::GrainProblem(const GrainArrays &a) :
    arrays_(a), bodies_(a.bodies + obstacle_copies), spins_(bodies_.size()), contacts_(a.contacts),
    problem_{bodies_, contacts_, norm(a.q, a.contacts * a.dim), workspace_}
{
  const Model model = model_of(a.dim);
  for (std::size_t i = 0; i < a.bodies; ++i) bodies_[i] = Body{0, 0, 0, a.inverse_mass[i]};
  std::fill(bodies_.begin() + a.bodies, bodies_.end(), Body{});  // obstacles
  if (model == Model::planar) planar_.resize(a.contacts);
  if (model == Model::spatial) spatial_.resize(a.contacts);
  problem_.sliding = {model, a.spin_response, model == Model::frictionless ? nullptr : spins_.data(),
                      planar_.data(), spatial_.data()};
  for (std::size_t k = 0; k < a.contacts; ++k) {
    const auto obstacle = std::int32_t(a.bodies + k % obstacle_copies);
    const auto body = [&](std::int32_t i) { return i < 0 ? obstacle : i; };
    Contact &c = contacts_[k];
    c = {direction(k, 0), a.q[k * a.dim], 0, a.start[k * a.dim], body(a.body_i[k]), body(a.body_j[k])};
    c.w_inverse = 1 / (bodies_[c.i][3] + bodies_[c.j][3]);
    apply_impulse(c, c.impulse, bodies_.data());
    with_friction(model, [&]<class M>(M) {
      auto &slide = problem_.sliding.slides<M>()[k];
      slide.mu = a.mu[k];
      slide.impulse = M::from_space(c.normal, tangential(k, a.start + k * a.dim));
      set_bias(slide, M::from_space(c.normal, tangential(k, a.q + k * a.dim)));
      problem_.sliding.mechanics<M>(bodies_.data()).template push_part<0>(c, k, slide.impulse);
    });
  }
}

void GrainProblem::rebuild_bodies()
{
  for (Body &b : bodies_) b = Body{0, 0, 0, b[3]};
  std::fill(spins_.begin(), spins_.end(), Vec4{});
  for (std::size_t k = 0; k < arrays_.contacts; ++k) {
    const Contact &c = contacts_[k];
    apply_impulse(c, c.impulse, bodies_.data());
    with_friction(problem_.sliding.model, [&]<class M>(M) {
      const auto impulse = problem_.sliding.slides<M>()[k].impulse;
      problem_.sliding.mechanics<M>(bodies_.data()).template push_part<0>(c, k, impulse);
    });
  }
}

std::vector<double> GrainProblem::impulses() const
{
  std::vector<double> p(arrays_.contacts * arrays_.dim);
  for (std::size_t k = 0; k < arrays_.contacts; ++k) {
    p[k * arrays_.dim] = contacts_[k].impulse;
    with_friction(problem_.sliding.model, [&]<class M>(M) {
      const Vec4 t = M::in_space(contacts_[k].normal, problem_.sliding.slides<M>()[k].impulse);
      for (std::size_t a = 1; a < arrays_.dim; ++a) p[k * arrays_.dim + a] = dot(direction(k, a), t);
    });
  }
  return p;
}

std::vector<double> GrainProblem::velocities() const
{
  std::vector<double> u(arrays_.contacts * arrays_.dim);
  for (std::size_t k = 0; k < arrays_.contacts; ++k) {
    const Contact &c = contacts_[k];
    u[k * arrays_.dim] = normal_velocity(c, bodies_.data()) + c.bias;
    with_friction(problem_.sliding.model, [&]<class M>(M) {
      const auto slip = velocity<M>(c, bodies_.data(), spins_.data()).t + bias(problem_.sliding.slides<M>()[k]);
      const Vec4 t = M::in_space(c.normal, slip);
      for (std::size_t a = 1; a < arrays_.dim; ++a) u[k * arrays_.dim + a] = dot(direction(k, a), t);
    });
  }
  return u;
}

}    // namespace nscd
