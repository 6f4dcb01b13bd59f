// Contacts change places with all that stands beside them.
#pragma once

#include "scene/state.hpp"

#include <algorithm>
#include <utility>

namespace nscd {

inline void swap_contacts(State &s, std::size_t a, std::size_t b)
{
  std::swap(s.contacts[a], s.contacts[b]);
  std::swap(s.infos[a], s.infos[b]);
  if (!s.per_approach.empty()) std::swap(s.per_approach[a], s.per_approach[b]);
  if (!s.impact_impulse.empty()) std::swap(s.impact_impulse[a], s.impact_impulse[b]);
  for (auto *const beside : {&s.courses.moment, &s.courses.kick})   // of the first contacts
    if (std::max(a, b) < beside->size()) std::swap((*beside)[a], (*beside)[b]);
  if (!s.friction.impact_impulse.empty()) std::swap(s.friction.impact_impulse[a], s.friction.impact_impulse[b]);
  with_friction(s.friction.model, [&]<class M>(M) {
    auto &slides = s.friction.slides<M>();
    std::swap(slides[a], slides[b]);
  });
}

}    // namespace nscd
