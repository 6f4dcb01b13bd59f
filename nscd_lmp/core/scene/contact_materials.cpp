// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/contact_materials.hpp"

namespace nscd {

namespace {

NSCD_INLINE MaterialNumber material_of(const State &s, std::size_t k)
{
  return material_of(s, Candidate{s.table.infos[k].atom_i, s.table.infos[k].atom_j});
}

}    // namespace

void place_materials(State &s, std::size_t first)
{
  with_friction(s.friction.model, [&]<class M>(M) {
    auto &slides = s.table.slides<M>();
    for (std::size_t k = first; k < slides.size(); ++k) {
      slides[k] = typename M::Slide{};
      slides[k].mu = s.in.materials[material_of(s, k)].friction;
    }
  });
  auto &numbers = s.table.material;
  for (std::size_t k = first; k < numbers.size(); ++k) numbers[k] = material_of(s, k);
}

}    // namespace nscd
