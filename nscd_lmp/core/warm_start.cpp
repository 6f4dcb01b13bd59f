#include "warm_start.hpp"

#include "hot.hpp"

namespace nscd {

namespace {

NSCD_INLINE Vec4 load(const double *v) { return Vec4{v[0], v[1], v[2], 0}; }

NSCD_INLINE void store(double *at, const Vec4 &v)
{
  for (int d = 0; d < 3; ++d) at[d] = v[d];
}

PlanarImpulse entry(const Contact &c, const ContactInfo &info, const Planar::Slide &slide)
{
  return {info.key, c.impulse, slide.impulse};
}

SpatialImpulse entry(const Contact &c, const ContactInfo &info, const Spatial::Slide &slide)
{
  SpatialImpulse e{.key = info.key, .normal = c.impulse};
  store(e.tangential, slide.impulse);
  store(e.direction, c.normal);
  return e;
}

double turned_impulse(const PlanarImpulse &e, const Vec4 &) { return e.tangential; }

// A pair may be listed the other way round than before: then normal and impulse both change sign.
NSCD_INLINE Vec4 turned_impulse(const SpatialImpulse &e, const Vec4 &normal)
{
  const Vec4 before = load(e.direction), p = load(e.tangential);
  const bool same = dot(before, normal) > 0;
  return same ? turn_along(p, before, normal) : turn_along(-p, -before, normal);
}

template <class M, class Memory>
NSCD_HOT void remember_all(const State &s, Memory &memory)
{
  const auto &slides = s.friction.slides<M>();
  memory.remember(s.infos, [&](std::size_t k) { return entry(s.contacts[k], s.infos[k], slides[k]); });
}

template <class M, class Memory>
NSCD_HOT void recall_all(State &s, const Memory &memory, std::size_t first)
{
  auto &slides = s.friction.slides<M>();
  for (std::size_t k = first; k < s.contacts.size(); ++k) {
    if (k + prefetch_distance < s.infos.size()) memory.prefetch(s.infos[k + prefetch_distance].key);
    const auto *known = memory.recall(s.infos[k].key);
    Contact &c = s.contacts[k];
    c.impulse = known ? known->normal : 0;
    slides[k].impulse = known ? turned_impulse(*known, c.normal) : typename M::Tangent{};
    if (!known) continue;
    apply_impulse(c, c.impulse, s.bodies.data());
    apply_tangential<M>(c, slides[k].impulse, s.friction.spin_response, s.bodies.data(), s.friction.spins.data());
  }
}

}    // namespace

void WarmStart::remember(const State &s)
{
  switch (s.friction.model) {
    case Model::frictionless:
      normal_.remember(s.infos, [&](std::size_t k) { return NormalImpulse{s.infos[k].key, s.contacts[k].impulse}; });
      break;
    case Model::planar: remember_all<Planar>(s, planar_); break;
    case Model::spatial: remember_all<Spatial>(s, spatial_); break;
  }
}

NSCD_HOT void WarmStart::recall_normal(State &s, std::size_t first) const
{
  for (std::size_t k = first; k < s.contacts.size(); ++k) {
    if (k + prefetch_distance < s.infos.size()) normal_.prefetch(s.infos[k + prefetch_distance].key);
    const NormalImpulse *known = normal_.recall(s.infos[k].key);
    Contact &c = s.contacts[k];
    c.impulse = known ? known->normal : 0;
    apply_impulse(c, c.impulse, s.bodies.data());
  }
}

void WarmStart::recall(State &s, std::size_t first) const
{
  switch (s.friction.model) {
    case Model::frictionless: recall_normal(s, first); break;
    case Model::planar: recall_all<Planar>(s, planar_, first); break;
    case Model::spatial: recall_all<Spatial>(s, spatial_, first); break;
  }
}

}    // namespace nscd
