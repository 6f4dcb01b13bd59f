// SPDX-License-Identifier: GPL-2.0-or-later
// The drift of one contact.
#pragma once

#include "base/hot.hpp"
#include "scene/state.hpp"

#include <algorithm>

namespace nscd {

// To be added to v_i - v_j; what the radii grow is along the normal. 0 where nothing drifts.
NSCD_INLINE Vec4 drift_of(const State &s, const Candidate &c, const Vec4 &normal)
{
  if (s.drift.of.empty()) return Vec4{};
  const Vec4 &i = s.drift.of[c.atom_i];
  const Vec4 j = c.atom_j < 0 ? Vec4{} : s.drift.of[c.atom_j];
  return without_fourth(i - j) - normal * (i[3] + j[3]);
}

// That of two centres, without radii.
NSCD_INLINE Vec4 carried_apart(const State &s, const Candidate &c)
{
  if (s.drift.of.empty()) return Vec4{};
  return without_fourth(s.drift.of[c.atom_i] - (c.atom_j < 0 ? Vec4{} : s.drift.of[c.atom_j]));
}

// At which the radii of both grow, m/s.
NSCD_INLINE double growth_of(const State &s, const Candidate &c)
{
  if (s.drift.of.empty()) return 0;
  return s.drift.of[c.atom_i][3] + (c.atom_j < 0 ? 0 : s.drift.of[c.atom_j][3]);
}

NSCD_INLINE Vec4 drift_of(const State &s, std::size_t k)
{
  return drift_of(s, {s.table.infos[k].atom_i, s.table.infos[k].atom_j}, s.table.contacts[k].normal);
}

// Its part of the contact's normal velocity, m/s.
NSCD_INLINE double normal_drift(const State &s, std::size_t k)
{
  return s.drift.of.empty() ? 0 : dot(s.table.contacts[k].normal, drift_of(s, k));
}

// Its part of the contact's tangential velocity.
template <class M>
NSCD_INLINE typename M::Tangent tangential_drift(const State &s, std::size_t k)
{
  return s.drift.of.empty() ? typename M::Tangent{} : M::from_space(s.table.contacts[k].normal, drift_of(s, k));
}

// At which a contact may give back what radii and box have done suddenly, m/s.
NSCD_INLINE double sudden_approach(const State &s, std::size_t k)
{
  const ContactInfo &info = s.table.infos[k];
  double approach = 0;
  if (!s.drift.sudden.empty())
    approach = s.drift.sudden[info.atom_i] + (info.atom_j >= 0 ? s.drift.sudden[info.atom_j] : 0);
  if (s.drift.jump.empty() || info.atom_j < 0) return approach;
  const Vec4 apart = s.drift.jump[info.atom_i] - s.drift.jump[info.atom_j];
  return approach + std::max(0.0, -dot(s.table.contacts[k].normal, apart));
}

}    // namespace nscd
