// SPDX-License-Identifier: GPL-2.0-or-later
#include "obstacle/distance_grid.hpp"

#include <cmath>

namespace nscd {

// Nothing is sought that is nearer by less than this share: in the middle of a tube all triangles would be.
constexpr double sought = 0.85;

// As near to cubes as whole numbers of cells allow; one cell where the box is thin.
void DistanceGrid::choose_cells(double most)
{
  double longest = 0;
  for (int d = 0; d < 3; ++d) longest = std::max(longest, bounds_.high[d] - bounds_.low[d]);
  const auto count = [&](double edge, int d) {
    return std::max(1.0, std::floor((bounds_.high[d] - bounds_.low[d]) / edge));
  };
  double edge = longest;
  while (count(0.9 * edge, 0) * count(0.9 * edge, 1) * count(0.9 * edge, 2) <= most) edge *= 0.9;
  for (int d = 0; d < 3; ++d) {
    count_[d] = int(count(edge, d));
    edge_[d] = (bounds_.high[d] - bounds_.low[d]) / count_[d];
    per_metre_[d] = edge_[d] > 0 ? 1 / edge_[d] : 0;
  }
}

DistanceGrid::DistanceGrid(std::span<const Triangle> triangles, const TriangleTree &tree) :
    bounds_(box_around(triangles))
{
  constexpr double fewest = 1 << 12, most = 1 << 20, of_a_triangle = 2;
  choose_cells(std::clamp(of_a_triangle * double(triangles.size()), fewest, most));
  const double half = 0.5 * std::hypot(edge_[0], edge_[1], edge_[2]);
  bound_.reserve(std::size_t(count_[0]) * std::size_t(count_[1]) * std::size_t(count_[2]));
  double near = std::numeric_limits<double>::infinity();   // the surface is no farther than that
  for (int z = 0; z < count_[2]; ++z)
    for (int y = 0; y < count_[1]; ++y)
      for (int x = 0; x < count_[0]; ++x) {
        const Vec4 centre{bounds_.low[0] + (x + 0.5) * edge_[0], bounds_.low[1] + (y + 0.5) * edge_[1],
                          bounds_.low[2] + (z + 0.5) * edge_[2], 0};
        near = x > 0 ? near + edge_[0] : std::numeric_limits<double>::infinity();
        double reach = sought * near;
        tree.visit(centre, reach, [&](std::int32_t k) {
          near = std::min(near, std::sqrt(distance2(centre, triangles[std::size_t(k)])));
          reach = sought * near;
        });
        // Less than it is by more than a float rounds.
        bound_.push_back(float(std::max(sought * near * (1 - 1e-6) - half * (1 + 1e-6), 0.0)));
      }
}

}    // namespace nscd
