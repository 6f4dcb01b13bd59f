// SPDX-License-Identifier: GPL-2.0-or-later
// One or two planes across an axis of the box, with grains above the lower and below the upper one: `xplane lo hi` and
// its kin, as LAMMPS' fix wall/gran has them.
#include "base/error.hpp"
#include "obstacle/kinds.hpp"
#include "obstacle/obstacle.hpp"

#include <cmath>
#include <limits>

namespace nscd {

namespace {

class Slab final : public ObstacleOf<Slab> {
 public:
  static constexpr int low = 0, high = 1;   // features

  // A side without a plane is at -infinity, infinity.
  Slab(int across, double lo, double hi) : across_(across), at_{lo, hi} {}

  double distance(const Vec4 &centre) const { return std::min(distance(centre, low), distance(centre, high)); }

  Touch at(const Vec4 &centre, double radius, int side) const override
  {
    Vec4 normal{};
    normal[across_] = side == low ? 1 : -1;
    return {normal, distance(centre, side) - radius, side};
  }

  void touch(const Vec4 &centre, double radius, double within, std::vector<Touch> &found) const override
  {
    for (const int side : {low, high})
      if (distance(centre, side) - radius <= within) found.push_back(at(centre, radius, side));
  }

  void require_planar(const std::string &name) const override
  {
    if (across_ == 2) fail(name, ": planes across z do not fit a planar scene (dimension 2): use dimension 3");
  }

  void require_repeats(const std::string &name, const BoxEdges &box) const override
  {
    constexpr double round_off = 1e-9;
    for (int d = 0; d < 3; ++d) {
      const auto &edge = box.edge[d];
      if (box.periodic[d] && std::abs(edge[across_]) > round_off * std::hypot(edge[0], edge[1], edge[2]))
        fail(name, ": it lies across ", "xyz"[across_], ", and the box is periodic in ", "xyz"[d], ": use a boundary ",
             "that is not periodic");
    }
  }

 private:
  double distance(const Vec4 &centre, int side) const
  {
    return side == low ? centre[across_] - at_[low] : at_[high] - centre[across_];
  }

  int across_;
  double at_[2];   // m
};

// LAMMPS' word for a side without a plane.
double read_side(Arguments &words, double none)
{
  return words.skip("NULL") ? none : words.number<double>("a number or NULL");
}

template <int across>
std::shared_ptr<const Obstacle> read(Arguments &words, const std::string &name)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double lo = read_side(words, -infinity), hi = read_side(words, infinity);
  if (std::isinf(lo) && std::isinf(hi)) fail(name, ": both sides are NULL: give one of them a place");
  if (!(lo < hi)) fail(name, ": lo = ", lo, " must be below hi = ", hi);
  return std::make_shared<Slab>(across, lo, hi);
}

constexpr std::string_view words = "lo hi";
const RegisterObstacle xplane({20, "xplane", words, "", read<0>});
const RegisterObstacle yplane({21, "yplane", words, "", read<1>});
const RegisterObstacle zplane({22, "zplane", words, "planes across an axis, lo below the grains and hi above them; "
                               "either may be NULL for none", read<2>});

}    // namespace

}    // namespace nscd
