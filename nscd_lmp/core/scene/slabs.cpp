// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/slabs.hpp"

#include "scene/contact_geometry.hpp"

#include <algorithm>

namespace nscd {

// The longest side of the box round all pairs.
static int longest_side(const State &s)
{
  Vec4 low = s.atoms.spheres[s.search.found[0].atom_i].centre, high = low;
  for (std::size_t k = 1; k < s.search.found_count; ++k) {
    const Vec4 &centre = s.atoms.spheres[s.search.found[k].atom_i].centre;
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], centre[d]);
      high[d] = std::max(high[d], centre[d]);
    }
  }
  const Vec4 side = high - low;
  int axis = 0;
  for (int d = 1; d < 3; ++d)
    if (side[d] > side[axis]) axis = d;
  return axis;
}

// Slabs of as many pairs each.
void Slabs::divide(const State &s)
{
  if (int(slab_.size()) == s.moving()) return;
  slab_.assign(s.moving(), 0);
  if (s.search.found_count == 0) return;
  const int axis = longest_side(s);
  const std::size_t found = s.search.found_count;
  places_.resize(found);
  for (std::size_t k = 0; k < found; ++k) places_[k] = s.atoms.spheres[s.search.found[k].atom_i].centre[axis];
  std::vector<double> cuts;
  auto rest = places_.begin();
  for (int t = 0; t + 1 < threads_; ++t) {
    const auto cut = places_.begin() + std::ptrdiff_t(found * std::size_t(t + 1) / std::size_t(threads_));
    std::nth_element(rest, cut, places_.end());
    cuts.push_back(*cut);
    rest = cut;
  }
  for (std::size_t atom = 0; atom < s.atoms.spheres.size(); ++atom) {
    const bool own = int(atom) < s.in.grains.owned;
    if (!own && s.atoms.owner[atom] < s.in.grains.owned) continue;   // an image of a grain that has its place
    const double place = s.atoms.spheres[atom].centre[axis];
    slab_[s.atoms.owner[atom]] = std::uint8_t(std::upper_bound(cuts.begin(), cuts.end(), place) - cuts.begin());
  }
}

template <class PartOf>
void Slabs::count_parts(std::size_t count, PartOf part_of)
{
  sizes_.assign(parts_.count(), 0);
  for (std::size_t k = 0; k < count; ++k) ++sizes_[part_of(k)];
  parts_.set_sizes(sizes_);
  next_.resize(parts_.count());
  for (int p = 0; p < parts_.count(); ++p) next_[p] = parts_.range(p).first;
}

void Slabs::order_candidates(State &s)
{
  std::vector<Candidate> &touching = s.search.touching;
  const auto part_of = [&](std::size_t k) {
    const Candidate &c = touching[k];
    const int slab = of(s.atoms.owner[c.atom_i]);
    return is_wall(c) ? slab : parts_.between(slab, of(s.atoms.owner[c.atom_j]));
  };
  count_parts(touching.size(), part_of);
  s.search.ordered.resize(touching.size());
  for (std::size_t k = 0; k < touching.size(); ++k) s.search.ordered[next_[part_of(k)]++] = touching[k];
  touching.swap(s.search.ordered);
}

int Slabs::part_of_contact(const State &s, std::size_t k) const
{
  const Contact &c = s.table.contacts[k];
  return c.j >= s.moving() ? of(c.i) : parts_.between(of(c.i), of(c.j));
}

bool Slabs::order_contacts(State &s, std::size_t count)
{
  count_parts(count, [&](std::size_t k) { return part_of_contact(s, k); });
  bool moved = false;
  for (int part = 0; part < parts_.count(); ++part) {
    while (next_[part] < parts_.range(part).last) {
      const std::size_t k = next_[part];
      const int own = part_of_contact(s, k);
      if (own != part) {
        s.table.swap(k, next_[own]);
        moved = true;
      }
      ++next_[own];
    }
  }
  return moved;
}

}    // namespace nscd
