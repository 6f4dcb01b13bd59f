#include "belts.hpp"

#include <algorithm>

namespace nscd {

namespace {

bool is_under_way(const Grains &g, int i)
{
  const double *v = g.v + 3 * std::size_t(i);
  return !g.moves(i) && (v[0] != 0 || v[1] != 0 || v[2] != 0);
}

std::array<double, 3> place(const Grains &g, int i)
{
  const double *x = g.x + 3 * std::size_t(i);
  return {x[0], x[1], x[2]};
}

}    // namespace

void Belts::see(const Grains &g)
{
  seen_.clear();
  for (int i = 0; i < g.owned; ++i)
    if (is_under_way(g, i)) seen_.push_back({g.tag[i], place(g, i)});
  std::sort(seen_.begin(), seen_.end(), [](const Seen &a, const Seen &b) { return a.tag < b.tag; });
}

void Belts::find(State &s) const
{
  s.ways.clear();
  for (int i = 0; i < s.grains.owned; ++i) {
    if (!is_under_way(s.grains, i)) continue;
    if (s.ways.empty()) s.ways.assign(s.moving(), Way::has_moved);
    const std::int32_t tag = s.grains.tag[i];
    const auto at = std::lower_bound(seen_.begin(), seen_.end(), tag, [](const Seen &a, int b) { return a.tag < b; });
    if (s.grains.mask[i] & s.grains.later) s.ways[i] = Way::will_move;
    else if (at != seen_.end() && at->tag == tag && at->x == place(s.grains, i)) s.ways[i] = Way::stands;
  }
}

}    // namespace nscd
