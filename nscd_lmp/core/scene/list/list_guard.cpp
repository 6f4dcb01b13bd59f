// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/list_guard.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nscd {

namespace {

bool lists(const PairList &pairs, int entry, int atom)
{
  const int *first = pairs.first[entry], *last = first + pairs.neighbors[entry];
  return std::any_of(first, last, [atom](int j) { return (j & neighbor_index_mask) == atom; });
}

// One pair of owned atoms tells: in a full list its second atom lists the first one too.
void refuse_full_list(const PairList &pairs, int owned)
{
  for (int entry = 0; entry < pairs.count; ++entry)
    for (int k = 0; k < pairs.neighbors[entry]; ++k) {
      const int j = pairs.first[entry][k] & neighbor_index_mask;
      if (j >= owned || j >= pairs.count || pairs.atom[j] != j) continue;
      if (lists(pairs, j, pairs.atom[entry]))
        fail("the pair style's neighbor list is full, it holds every pair twice: use one with a half list, such as "
             "pair_style zero without the keyword full");
      return;
    }
}

}    // namespace

void ListGuard::inspect(State &s, const PairList &pairs)
{
  new_ = pairs.just_built || unknown_;
  if (!new_) return;
  refuse_full_list(pairs, s.in.grains.owned);
  find_owners(s);
  listed_x_.assign(s.in.grains.x, s.in.grains.x + 3 * (std::size_t(s.in.grains.owned) + s.in.grains.ghosts));
  unknown_ = false;
}

// Which grain an image is of stays the same until the list is rebuilt. Those of other ranks are left to the halo.
void ListGuard::find_owners(State &s)
{
  const Grains &g = s.in.grains;
  s.atoms.owner.resize(std::size_t(g.owned) + g.ghosts);
  std::iota(s.atoms.owner.begin(), s.atoms.owner.begin() + g.owned, 0);
  if (g.ghosts == 0 && !s.exec.halo) return;
  s.atoms.own_tags.resize(g.owned);
  for (int i = 0; i < g.owned; ++i) s.atoms.own_tags[i] = {g.tag[i], i};
  std::sort(s.atoms.own_tags.begin(), s.atoms.own_tags.end());
  for (int j = g.owned; j < g.owned + g.ghosts; ++j) {
    const int home = s.exec.halo ? g.home[j - g.owned] : 0;
    if (s.exec.halo && home >= 0 && home != s.exec.halo->ranks().rank()) continue;
    const auto &tags = s.atoms.own_tags;
    const auto at = std::lower_bound(tags.begin(), tags.end(), std::pair<std::int32_t, int>{g.tag[j], 0});
    if (at == s.atoms.own_tags.end() || at->first != g.tag[j])
      fail("image of grain ", g.tag[j], " has no grain on ", s.exec.halo ? "any rank" : "this rank");
    s.atoms.owner[j] = at->second;
  }
}

double ListGuard::farthest_moved(const State &s) const
{
  const double *x = s.in.grains.x;
  double farthest2 = 0;
  for (std::size_t i = 0; i < 3 * std::size_t(s.in.grains.owned); i += 3) {
    const double a = x[i] - listed_x_[i], b = x[i + 1] - listed_x_[i + 1], c = x[i + 2] - listed_x_[i + 2];
    farthest2 = std::max(farthest2, a * a + b * b + c * c);
  }
  return std::sqrt(farthest2);
}

}    // namespace nscd
