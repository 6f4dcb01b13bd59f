// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/drift/belts.hpp"

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

const Belts::Seen *Belts::last_seen(std::int32_t tag) const
{
  const auto at = std::lower_bound(seen_.begin(), seen_.end(), tag, [](const Seen &a, int b) { return a.tag < b; });
  return at != seen_.end() && at->tag == tag ? &*at : nullptr;
}

// A new list wraps atoms round the box, which looks like a long way that has nothing to do with their velocity.
void Belts::find(State &s, bool paces) const
{
  const Grains &g = s.in.grains;
  s.motion.ways.clear();
  s.motion.paces.clear();
  for (int i = 0; i < g.owned; ++i) {
    if (!is_under_way(g, i)) continue;
    if (s.motion.ways.empty()) s.motion.ways.assign(s.moving(), Way::has_moved);
    if (paces) s.motion.paces.resize(g.owned);
    const double *x = g.x + 3 * std::size_t(i), *v = g.v + 3 * std::size_t(i);
    const Vec4 velocity{v[0], v[1], v[2], 0};
    if (paces) s.motion.paces[i] = velocity;
    const Seen *const seen = last_seen(g.tag[i]);
    if (g.mask[i] & g.later) {
      s.motion.ways[i] = Way::will_move;
    } else if (seen && seen->x == place(g, i)) {
      s.motion.ways[i] = Way::stands;
    } else if (seen && paces) {
      const Vec4 moved{x[0] - seen->x[0], x[1] - seen->x[1], x[2] - seen->x[2], 0};
      const Vec4 off = moved - velocity * s.in.dt;
      if (std::min(dot(moved, moved), dot(off, off)) < g.radius[i] * g.radius[i])
        s.motion.paces[i] = moved * (1 / s.in.dt);
    }
  }
}

}    // namespace nscd
