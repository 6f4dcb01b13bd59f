// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/slides.hpp"

#include "base/hot.hpp"
#include "scene/contact_geometry.hpp"
#include "scene/drift/drift_of.hpp"

#include <algorithm>

namespace nscd {

Model choose_model(const Settings &settings, int dimension)
{
  if (!settings.frictional()) return Model::frictionless;
  return dimension == 2 ? Model::planar : Model::spatial;
}

namespace {

template <class M>
NSCD_HOT double keep_free_velocities_of(State &s, std::size_t first, std::size_t last)
{
  const auto &slides = s.table.slides<M>();
  double sum = 0;
  for (std::size_t k = first; k < last; ++k) {
    const auto u = velocity<M>(s.table.contacts[k], s.motion.bodies.data(), s.motion.spins.data());
    const auto normal = u.n + s.table.contacts[k].bias;
    const auto slip = u.t + bias(slides[k]);
    sum += s.table.infos[k].free2 = normal * normal + inner(slip, slip);
  }
  return sum;
}

NSCD_HOT double keep_free_normal_velocities(State &s, std::size_t first, std::size_t last)
{
  double sum = 0;
  for (std::size_t k = first; k < last; ++k) {
    const double v = normal_velocity(s.table.contacts[k], s.motion.bodies.data()) + s.table.contacts[k].bias;
    sum += s.table.infos[k].free2 = v * v;
  }
  return sum;
}

template <class M>
NSCD_HOT double tangential_work_of(const State &s)
{
  const auto &slides = s.table.slides<M>();
  double sum = 0;
  for (std::size_t k = 0; k < slides.size(); ++k) {
    const auto after = velocity<M>(s.table.contacts[k], s.motion.bodies.data(), s.motion.spins.data()).t;
    sum += inner(slides[k].impulse, slip_at_start<M>(s, k) + after);
  }
  return sum;
}

}    // namespace

void set_tangential_bias(State &s, std::size_t first, bool restitution)
{
  with_friction(s.friction.model, [&]<class M>(M) {
    auto &slides = s.table.slides<M>();
    for (std::size_t k = first; k < slides.size(); ++k) {
      const double e_t = restitution ? s.material(k).e_t : 0;
      const auto before = e_t > 0 ? slip_at_start<M>(s, k) * e_t : typename M::Tangent{};
      set_bias(slides[k], s.drift.of.empty() ? before : before + tangential_drift<M>(s, k) * (1 + e_t));
    }
  });
}

double keep_free_velocities(State &s, std::size_t first, std::size_t last)
{
  double sum = 0;
  with_friction(s.friction.model, [&]<class M>(M) { sum = keep_free_velocities_of<M>(s, first, last); });
  if (s.friction.model == Model::frictionless) sum = keep_free_normal_velocities(s, first, last);
  return std::sqrt(sum_everywhere(s, sum));
}

double tangential_work(const State &s)
{
  double sum = 0;
  with_friction(s.friction.model, [&]<class M>(M) { sum = tangential_work_of<M>(s); });
  return sum;
}

Vec4 tangential_impulse(const State &s, std::size_t k)
{
  Vec4 p{};
  with_friction(s.friction.model, [&]<class M>(M) {
    p = M::in_space(s.table.contacts[k].normal, s.table.slides<M>()[k].impulse);
  });
  return p;
}

void add_slide_impulses(State &s, std::span<const Vec4> impulses)
{
  with_friction(s.friction.model, [&]<class M>(M) {
    for (std::size_t k = 0; k < impulses.size(); ++k)
      s.table.slides<M>()[k].impulse += M::from_space(s.table.contacts[k].normal, impulses[k]);
  });
}

void add_impulse(State &s, std::size_t k, double normal, const Vec4 &tangential)
{
  Contact &c = s.table.contacts[k];
  c.impulse += normal;
  apply_impulse(c, normal, s.motion.bodies.data());
  with_friction(s.friction.model, [&]<class M>(M) {
    const auto dp = M::from_space(c.normal, tangential);
    s.table.slides<M>()[k].impulse += dp;
    sliding(s).mechanics<M>(s.motion.bodies.data()).template push_part<0>(c, k, dp);
  });
}

void read_impulse(const State &s, std::size_t k, double *components)
{
  const int count = unknowns(s.friction.model);
  components[0] = s.table.contacts[k].impulse;
  if (count == 1) return;
  const Tangents t = tangents(s.table.contacts[k].normal, s.friction.model);
  const Vec4 p = tangential_impulse(s, k);
  components[1] = dot(t.first, p);
  if (count == 3) components[2] = dot(t.second, p);
}

void remove_impulse(State &s, std::size_t k)
{
  add_impulse(s, k, -s.table.contacts[k].impulse, -tangential_impulse(s, k));
}

void write_impulse(State &s, std::size_t k, const double *components)
{
  const int count = unknowns(s.friction.model);
  Vec4 tangential{};
  if (count > 1) {
    const Tangents t = tangents(s.table.contacts[k].normal, s.friction.model);
    tangential = t.first * components[1] + t.second * (count == 3 ? components[2] : 0.0);
  }
  add_impulse(s, k, components[0], tangential);
}

Sliding sliding(State &s)
{
  const Friction &f = s.friction;
  ContactTable &table = s.table;
  return {f.model, f.spin_response, s.motion.spins.data(), table.planar.data(), table.spatial.data()};
}

}    // namespace nscd
