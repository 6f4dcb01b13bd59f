#include "list_audit.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace nscd {

namespace {

using Cell = std::array<std::int64_t, 3>;

// Atoms of about one size, by cells as wide as two of them and the reach: what is near an atom that is no larger lies
// in its cell and the 26 around it. Cells are found by a hash.
class Cells {
 public:
  Cells(const Grains &g, std::vector<int> atoms, double width) : g_(g), atoms_(std::move(atoms)), width_(width)
  {
    first_.assign(std::bit_ceil(2 * atoms_.size() + 1), -1);
    next_.resize(atoms_.size());
    cells_.resize(atoms_.size());
    for (std::size_t k = 0; k < atoms_.size(); ++k) {
      cells_[k] = cell_of(atoms_[k]);
      int &first = first_[slot(cells_[k])];
      next_[k] = first;
      first = int(k);
    }
  }

  template <class See>
  void around(int atom, See see) const
  {
    const Cell middle = cell_of(atom);
    for (int n = 0; n < 27; ++n) {
      const Cell cell{middle[0] + n % 3 - 1, middle[1] + n / 3 % 3 - 1, middle[2] + n / 9 - 1};
      for (int k = first_[slot(cell)]; k >= 0; k = next_[k])
        if (cells_[k] == cell) see(atoms_[k]);
    }
  }

 private:
  Cell cell_of(int atom) const
  {
    const double *x = g_.x + 3 * std::size_t(atom);
    return {std::int64_t(std::floor(x[0] / width_)), std::int64_t(std::floor(x[1] / width_)),
            std::int64_t(std::floor(x[2] / width_))};
  }
  std::size_t slot(const Cell &c) const
  {
    const auto mixed = std::uint64_t(c[0]) * 73856093 ^ std::uint64_t(c[1]) * 19349663 ^ std::uint64_t(c[2]) * 83492791;
    return mixed & (first_.size() - 1);
  }

  const Grains &g_;
  std::vector<int> atoms_, first_, next_;   // first_: of a slot, next_: of an atom's slot, places in atoms_; or -1
  std::vector<Cell> cells_;                 // (atoms)
  double width_;
};

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
  for (int large = 0; large < levels; ++large) {
    if (of_size[large].empty()) continue;
    const Cells cells(g, of_size[large], 2 * std::ldexp(largest, -large) + reach);
    for (int small = large; small < levels; ++small)
      for (const int i : of_size[small])
        cells.around(i, [&](int j) {
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
