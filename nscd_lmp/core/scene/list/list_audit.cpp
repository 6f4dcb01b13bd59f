// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/list/list_audit.hpp"

#include "scene/list/cell_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nscd {

namespace {

// Whether they can be a contact nearer than `reach`; a grain is none with its own image.
bool are_near(const Grains &g, int i, int j, double reach)
{
  if (g.tag[i] == g.tag[j] || !(g.moves(i) || g.moves(j))) return false;
  const double *a = g.x + 3 * std::size_t(i), *b = g.x + 3 * std::size_t(j);
  const double near = g.radius[i] + g.radius[j] + reach;
  const double d[] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return near > 0 && d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < near * near;
}

// Powers of two that the radius is below the largest; those that no cell could be made for are left out.
constexpr int levels = 12;
int level_of(double radius, double largest) { return std::min(levels - 1, int(std::log2(largest / radius))); }

Vec4 place(const Grains &g, int i)
{
  const double *x = g.x + 3 * std::size_t(i);
  return Vec4{x[0], x[1], x[2], 0};
}

bool has_place(const Grains &g, int i)
{
  const double *x = g.x + 3 * std::size_t(i);
  return g.radius[i] > 0 && std::isfinite(g.radius[i]) && std::isfinite(x[0] + x[1] + x[2]);
}

double count_there(const Grains &g, double reach)
{
  // Distances to images are rounded as those to their grains are not.
  constexpr double round_off = 1e-9;
  const int all = g.owned + g.ghosts;
  double largest = 0, count = 0;
  for (int i = 0; i < all; ++i)
    if (has_place(g, i)) largest = std::max(largest, g.radius[i]);
  reach -= round_off * (reach + largest);
  std::array<std::vector<int>, levels> of_size;
  for (int i = 0; i < all; ++i)
    if (has_place(g, i)) of_size[level_of(g.radius[i], largest)].push_back(i);
  CellGrid cells;
  std::vector<Vec4> points;
  for (int large = 0; large < levels; ++large) {
    points.clear();
    for (const int j : of_size[large]) points.push_back(place(g, j));
    const double most = std::ldexp(largest, -large);   // radius of this size
    cells.fill(points, 2 * most + reach);
    for (int small = large; small < levels && !points.empty(); ++small)
      for (const int i : of_size[small])
        cells.near(place(g, i), g.radius[i] + most + reach, [&](int k, const Vec4 &) {
          const int j = of_size[large][k];
          if ((small == large && j <= i) || (i >= g.owned && j >= g.owned) || !are_near(g, i, j, reach)) return;
          count += i < g.owned && j < g.owned ? 2 : 1;
        });
  }
  return count;
}

double count_listed(const Grains &g, const PairList &pairs, double reach)
{
  double count = 0;
  for (int entry = 0; entry < pairs.count; ++entry)
    for (int k = 0; k < pairs.neighbors[entry]; ++k) {
      const int i = pairs.atom[entry], j = pairs.first[entry][k] & neighbor_index_mask;
      if (are_near(g, i, j, reach)) count += j >= g.owned && pairs.cross_pairs_twice ? 1 : 2;
    }
  return count;
}

}    // namespace

double count_unlisted(const Grains &g, const PairList &pairs, double reach)
{
  if (!(reach > 0) || !std::isfinite(reach)) return 0;
  return count_there(g, reach) - count_listed(g, pairs, reach);
}

}    // namespace nscd
