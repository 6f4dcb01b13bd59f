// SPDX-License-Identifier: GPL-2.0-or-later
// Impulses of any mechanics as a memory keeps them, and given back to contacts whose normals have turned since.
//
// In the plane the tangent (-n_y, n_x) turns with the normal and brings the impulse along. In space the normal that the
// vectors were perpendicular to is kept beside them. A pair may be listed the other way round than before: then normal
// and vectors change sign. In the plane the tangent does too, so a number stays, unless its part says that it mirrors.
#pragma once

#include "base/hot.hpp"
#include "contact/mechanics.hpp"
#include "warm_start/impulse_memory.hpp"

#include <algorithm>
#include <type_traits>

namespace nscd {

// The rotation that takes the unit vector `from` to `to` the shortest way, applied to p perpendicular to `from`.
NSCD_INLINE Vec4 turn_along(const Vec4 &p, const Vec4 &from, const Vec4 &to)
{
  const double cosine = dot(from, to);
  if (cosine <= -1) return p;  // opposite: every half turn is as short
  const Vec4 turned = p - (from + to) * (dot(p, to) / (1 + cosine));
  return turned - to * dot(turned, to);
}

template <class M>
class MemoryOf;

template <class Dynamics, class... Parts>
class MemoryOf<Mechanics<Dynamics, Parts...>> {
  using M = Mechanics<Dynamics, Parts...>;
  using Vector = typename M::Vector;

  template <class T>
  static constexpr std::size_t kept = std::is_same_v<T, double> ? 1 : 3;
  static constexpr bool directed = ((kept<typename Parts::Vector> > 1 || Parts::mirrors) || ...);
  static constexpr std::size_t count = 1 + (0 + ... + kept<typename Parts::Vector>) + (directed ? 3 : 0);

 public:
  using Entry = Remembered<count>;

  NSCD_INLINE static Entry entry(const M &mechanics, const Contact &c, std::size_t k, std::uint64_t key)
  {
    Entry e{key, {c.impulse}};
    double *to = e.numbers.data() + 1;
    if constexpr (M::parts > 0)
      for_each_disc([&](std::size_t, const auto &one) NSCD_INLINED { to = keep(one, to); }, mechanics.impulse(c, k).t);
    if constexpr (directed) keep(c.normal, to);
    return e;
  }

  // The impulse at a contact that has this normal now.
  NSCD_INLINE static Vector impulse(const Entry &e, const Vec4 &normal)
  {
    Vector p{e.numbers[0], {}};
    if constexpr (M::parts > 0) {
      alignas(vec4_alignment) Vec4 before = normal;
      bool same = true;
      if constexpr (directed) {
        before = vector(&e.numbers[count - 3]);
        same = dot(before, normal) > 0;
      }
      constexpr bool mirrors[] = {Parts::mirrors...};
      const double *from = e.numbers.data() + 1;
      for_each_disc([&](std::size_t d, auto &one) NSCD_INLINED {
        from = recall(one, from, before, normal, same, mirrors[d]);
      }, p.t);
    }
    return p;
  }

 private:
  NSCD_INLINE static double *keep(double one, double *to)
  {
    *to = one;
    return to + 1;
  }
  NSCD_INLINE static double *keep(const Vec4 &one, double *to)
  {
    for (int d = 0; d < 3; ++d) to[d] = one[d];
    return to + 3;
  }
  NSCD_INLINE static Vec4 vector(const double *from) { return Vec4{from[0], from[1], from[2], 0}; }

  NSCD_INLINE static const double *recall(double &one, const double *from, const Vec4 &, const Vec4 &, bool same,
                                          bool mirrors)
  {
    one = mirrors && !same ? -*from : *from;
    return from + 1;
  }
  NSCD_INLINE static const double *recall(Vec4 &one, const double *from, const Vec4 &before, const Vec4 &normal,
                                          bool same, bool)
  {
    const Vec4 p = vector(from);
    one = same ? turn_along(p, before, normal) : turn_along(-p, -before, normal);
    return from + 3;
  }
};

template <class M>
using Entry = typename MemoryOf<M>::Entry;

// Keeps the impulses of all contacts.
template <class M>
NSCD_HOT void remember(ImpulseMemory<Entry<M>> &memory, const M &given, std::span<const Contact> contacts,
                       std::span<const ContactInfo> infos)
{
  const M mechanics = given;
  memory.remember(infos, [&](std::size_t k) NSCD_INLINED {
    return MemoryOf<M>::entry(mechanics, contacts[k], k, infos[k].key);
  });
}

// Gives the contacts from `first` on their start impulses, and the bodies what those do.
template <class M>
NSCD_HOT void recall(const ImpulseMemory<Entry<M>> &memory, const M &given, std::span<Contact> contacts,
                     std::span<const ContactInfo> infos, std::size_t first)
{
  const M mechanics = given;
  for (std::size_t k = first; k < contacts.size(); ++k) {
    if (k + prefetch_distance < infos.size()) memory.prefetch(infos[k + prefetch_distance].key);
    const auto *known = memory.recall(infos[k].key);
    Contact &c = contacts[k];
    const auto p = known ? MemoryOf<M>::impulse(*known, c.normal) : typename M::Vector{};
    mechanics.set_impulse(c, k, p);
    if (known) mechanics.push(c, k, p);
  }
}

}    // namespace nscd
