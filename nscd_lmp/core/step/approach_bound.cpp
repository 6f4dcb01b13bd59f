// SPDX-License-Identifier: GPL-2.0-or-later
#include "step/approach_bound.hpp"

#include "base/hot.hpp"
#include "scene/contact_plane.hpp"
#include "scene/drift/drift_of.hpp"

#include <algorithm>

namespace nscd {

// Where no deeper overlap is allowed, a step may still add this share of what is: sweeps end, but never quite.
constexpr double least_share = 0.01;
// Of the bound, at which a step aims: what contacts that are there may still add keeps within it.
constexpr double aim = 1 - 2 * least_share;

NSCD_HOT void bound_approach(State &s, std::size_t first)
{
  if (!s.in.settings.overlap) return;
  s.table.per_approach.open();
  for (std::size_t k = first; k < s.table.contacts.size(); ++k) {
    const ContactInfo &info = s.table.infos[k];
    const double deepest = aim * *s.in.settings.overlap * info.radius;
    const double deeper = std::max(deepest + info.gap, least_share * deepest);
    const double bias = s.table.contacts[k].bias - normal_drift(s, k);
    s.table.per_approach[k] = 1 / ((deeper + open_gap(s, k) - info.gap) / s.in.dt - bias);
  }
}

void bound_approach_of_impacts(State &s, std::size_t count)
{
  if (!s.in.settings.overlap) return;
  auto &per_approach = s.table.per_approach;
  per_approach.open();
  const double overlap = *s.in.settings.overlap;
  for (std::size_t k = 0; k < count; ++k) per_approach[k] = s.in.dt / (overlap * s.table.infos[k].radius);
}

}    // namespace nscd
