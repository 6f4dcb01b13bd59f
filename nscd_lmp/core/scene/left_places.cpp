// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/left_places.hpp"

#include "base/error.hpp"
#include "scene/gap.hpp"

#include <algorithm>
#include <cmath>

namespace nscd {

namespace {

// Of a radius. A new list wraps grains by the box' edges, which are longer than a radius, and rounds what it wraps. A
// box that carries grains rounds too.
constexpr double rounded = 1e-9, wrapped = 1;

}    // namespace

void LeftPlaces::remember(const State &s)
{
  tags_.assign(s.in.grains.tag, s.in.grains.tag + s.in.grains.owned);
}

// How far the grain that was atom `before` and is atom `now` is from where the last step left it, in its radii.
double LeftPlaces::moved(const State &s, std::size_t before, int now) const
{
  if (s.motion.bodies[before][3] == 0 || !s.in.grains.moves(now)) return 0;
  const Vec4 left = moved_in_arrays(s, int(before));
  const double *x = s.in.grains.x + 3 * std::size_t(now);
  const double far = std::max({std::abs(x[0] - left[0]), std::abs(x[1] - left[1]), std::abs(x[2] - left[2])});
  return far / s.in.grains.radius[now];
}

void LeftPlaces::require(const State &s, bool list_is_new)
{
  const bool in_order = !list_is_new && int(tags_.size()) == s.in.grains.owned;
  const bool look = !tags_.empty() && (in_order || was_new_);
  was_new_ = list_is_new;
  if (!look) return;
  std::vector<std::pair<std::int32_t, int>> now;
  if (!in_order) {
    for (int i = 0; i < s.in.grains.owned; ++i) now.push_back({s.in.grains.tag[i], i});
    std::sort(now.begin(), now.end());
  }
  for (std::size_t k = 0; k < tags_.size(); ++k) {
    int i = int(k);
    if (!in_order) {
      const auto at = std::lower_bound(now.begin(), now.end(), std::pair<std::int32_t, int>{tags_[k], 0});
      if (at == now.end() || at->first != tags_[k]) continue;   // on another rank, or gone
      i = at->second;
    }
    const double radii = moved(s, k, i);
    if (radii > rounded && !(radii >= wrapped))
      fail("grain ", tags_[k], " has been moved by another fix since the last step, by ", radii, " of its radius: two ",
           "integrators; remove the other one, or give the two disjoint groups");
  }
}

}    // namespace nscd
