#include "step/approach_bound.hpp"

#include "base/hot.hpp"
#include "scene/contact_plane.hpp"
#include "scene/drift_of.hpp"

#include <algorithm>

namespace nscd {

// Where no deeper overlap is allowed, a step may still add this share of what is: sweeps end, but never quite.
constexpr double least_share = 0.01;
// Of the bound, at which a step aims: what contacts that are there may still add keeps within it.
constexpr double aim = 1 - 2 * least_share;

NSCD_HOT void bound_approach(State &s, std::size_t first)
{
  if (!s.settings.overlap) return;
  resize_closely(s.per_approach, s.contacts.size());
  for (std::size_t k = first; k < s.contacts.size(); ++k) {
    const ContactInfo &info = s.infos[k];
    const double deepest = aim * *s.settings.overlap * info.radius;
    const double deeper = std::max(deepest + info.gap, least_share * deepest);
    s.per_approach[k] = 1 / ((deeper + open_gap(s, k) - info.gap) / s.dt - (s.contacts[k].bias - normal_drift(s, k)));
  }
}

void bound_approach_of_impacts(State &s, std::size_t count)
{
  if (!s.settings.overlap) return;
  resize_closely(s.per_approach, s.contacts.size());
  for (std::size_t k = 0; k < count; ++k) s.per_approach[k] = s.dt / (*s.settings.overlap * s.infos[k].radius);
}

}    // namespace nscd
