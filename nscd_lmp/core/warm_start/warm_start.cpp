// SPDX-License-Identifier: GPL-2.0-or-later
#include "warm_start/warm_start.hpp"

#include "base/hot.hpp"

#include <tuple>

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
  const auto &slides = s.table.slides<M>();
  const ContactTable &table = s.table;
  memory.remember(table.infos, [&](std::size_t k) { return entry(table.contacts[k], table.infos[k], slides[k]); });
}

template <class M, class Memory>
NSCD_HOT void recall_all(State &s, const Memory &memory, std::size_t first)
{
  auto &slides = s.table.slides<M>();
  for (std::size_t k = first; k < s.table.contacts.size(); ++k) {
    if (k + prefetch_distance < s.table.infos.size()) memory.prefetch(s.table.infos[k + prefetch_distance].key);
    const auto *known = memory.recall(s.table.infos[k].key);
    Contact &c = s.table.contacts[k];
    c.impulse = known ? known->normal : 0;
    slides[k].impulse = known ? turned_impulse(*known, c.normal) : typename M::Tangent{};
    if (!known) continue;
    apply_impulse(c, c.impulse, s.motion.bodies.data());
    apply_tangential<M>(c, slides[k].impulse, s.friction.spin_response, s.motion.bodies.data(), s.motion.spins.data());
  }
}

}    // namespace

void WarmStart::remember(const State &s)
{
  switch (s.friction.model) {
    case Model::frictionless:
      normal_.remember(s.table.infos, [&](std::size_t k) {
        return NormalImpulse{s.table.infos[k].key, s.table.contacts[k].impulse};
      });
      break;
    case Model::planar: remember_all<Planar>(s, planar_); break;
    case Model::spatial: remember_all<Spatial>(s, spatial_); break;
  }
}

NSCD_HOT void WarmStart::recall_normal(State &s, std::size_t first) const
{
  for (std::size_t k = first; k < s.table.contacts.size(); ++k) {
    if (k + prefetch_distance < s.table.infos.size()) normal_.prefetch(s.table.infos[k + prefetch_distance].key);
    const NormalImpulse *known = normal_.recall(s.table.infos[k].key);
    Contact &c = s.table.contacts[k];
    c.impulse = known ? known->normal : 0;
    apply_impulse(c, c.impulse, s.motion.bodies.data());
  }
}

namespace {

template <class Entry>
void visit_all(const ImpulseMemory<Entry> &memory, const WarmStart::Visit &visit)
{
  memory.for_each([&](const Entry &entry) {
    const auto tags = tags_of(entry.key);
    const Words<Entry> words = as_words(entry);
    visit(tags[0], tags[1], words);
  });
}

}    // namespace

std::size_t WarmStart::words(Model model)
{
  switch (model) {
    case Model::planar: return std::tuple_size_v<Words<PlanarImpulse>>;
    case Model::spatial: return std::tuple_size_v<Words<SpatialImpulse>>;
    default: return std::tuple_size_v<Words<NormalImpulse>>;
  }
}

void WarmStart::for_each(Model model, const Visit &visit) const
{
  switch (model) {
    case Model::frictionless: visit_all(normal_, visit); break;
    case Model::planar: visit_all(planar_, visit); break;
    case Model::spatial: visit_all(spatial_, visit); break;
  }
}

void WarmStart::add(Model model, std::span<const double> words)
{
  switch (model) {
    case Model::frictionless: normal_.add(from_words<NormalImpulse>(words.data())); break;
    case Model::planar: planar_.add(from_words<PlanarImpulse>(words.data())); break;
    case Model::spatial: spatial_.add(from_words<SpatialImpulse>(words.data())); break;
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
